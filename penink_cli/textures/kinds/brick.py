"""A wall that grows with the picture: its joints, then the bricks one by one, closer where it is larger."""

from __future__ import annotations

import numpy as np

from penink_cli.ground.model import Floats, Texture
from penink_cli.textures.even import Torus
from penink_cli.textures.filling import FULL, GAIN_PT, bowed_line, fill, growing
from penink_cli.textures.normal import normal

#: Lines that hatch a brick at the natural size; they grow in number with the picture, up to the second figure.
HATCHED, ROOM = 16, 128
#: The part that joints and hatching cover at the natural size.
COVERED = 0.5


def make(*, angle: float = -45.0, pen: float = 0.4, seed: int = 0) -> Texture:
    """A wall: the joints first, their shaded sides before the lit ones, then all bricks hatched."""
    rng = np.random.default_rng(seed)
    # No multiples of a printer's dots: all joints would lie alike on the dots, and ink would be off by a twentieth.
    course, stretcher = 11.75, 35.75
    rows, columns = 4, 3
    width, height = columns * stretcher, rows * course
    slant = 5.0
    gap = 1.3
    joints: list[Floats] = []
    spans = []
    for r in range(rows):
        for c in range(columns):
            x, y = c * stretcher + (stretcher / 2 if r % 2 else 0.0), r * course
            box = np.array([x + gap, y + gap, x + stretcher - gap, y + course - gap]) + normal(rng, 0.25, 4)
            spans.append(box)
            # The shaded sides, below and at the right, come before the lit ones.
            for a, b in (((0, 3), (2, 3)), ((2, 1), (2, 3)), ((0, 1), (2, 1)), ((0, 1), (0, 3))):
                p, q = box[list(a)], box[list(b)]
                t = np.array([0.02, 0.34, 0.66, 0.98])[:, None]
                line = p * (1 - t) + q * t
                line[1:3] += normal(rng, 0.25, 2)
                joints.append(line)
    sides = [joints[k::4] for k in range(4)]
    strokes = [group[i] for group in sides for i in rng.permutation(len(group))]
    scales = [0.0] * len(strokes)
    # Each round adds a line to every brick, half way between two that are there: bits reversed are such an order.
    bits = ROOM.bit_length() - 1
    for k in range(ROOM):
        across = (int(f"{k:0{bits}b}"[::-1], 2) + rng.uniform(0.2, 0.8, len(spans))) / ROOM
        for i in rng.permutation(len(spans)):
            left, top, right, bottom = spans[i] + np.array([0.7, rng.uniform(0.3, 1.2), -0.7, -rng.uniform(0.3, 1.2)])
            foot = left - slant + float(across[i]) * (right - left + slant)
            # The part of the slanting line that lies within the brick.
            t = np.clip((np.array([left, right]) - foot) / slant, 0.0, 1.0)
            if (t[1] - t[0]) * (bottom - top) < 1.5:
                continue
            at = t[0] + np.array([0.0, 1 / 3, 2 / 3, 1.0]) * (t[1] - t[0])
            line = np.column_stack([foot + slant * at, bottom + (top - bottom) * at])
            line[1:3, 0] += float(normal(rng, 0.15, 1)[0])
            strokes.append(line)
            scales.append((k + 1) / HATCHED)

    def course_lines(rng: np.random.Generator, n: int) -> Floats:
        centre = rng.uniform(0, 1, (n, 2)) * (width, height)
        return bowed_line(centre, angle + normal(rng, 1.2, n), rng.uniform(14, 30, n), normal(rng, 0.2, n))

    rest = fill(Torus(width, height, 0.7), course_lines, pen + GAIN_PT, FULL + 0.012, COVERED, 32, rng)
    return growing("brick", strokes, scales, rest, pen, width, height, seed)
