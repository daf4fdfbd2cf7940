"""Shingles that grow with the picture: their rounded edges, then the shade under the course above."""

from __future__ import annotations

import numpy as np

from penink_cli.ground.model import Floats, Texture
from penink_cli.textures.even import Torus
from penink_cli.textures.filling import FULL, GAIN_PT, bowed_line, fill, growing
from penink_cli.textures.normal import normal

#: Lines of a shingle's shade at the natural size; they grow in number with the picture, up to the second figure.
SHADED, ROOM = 8, 64
#: The part that edges and shade cover at the natural size.
COVERED = 0.45


def make(*, angle: float = -45.0, pen: float = 0.4, seed: int = 0) -> Texture:
    """A roof: the edges first, then the shade, deepest right under the course above."""
    rng = np.random.default_rng(seed)
    course, shingle = 13.3, 17.7
    rows, columns = 4, 4
    width, height = columns * shingle, rows * course
    strokes: list[Floats] = []
    places = []
    for r in range(rows):
        for c in range(columns):
            x, y = c * shingle + (shingle / 2 if r % 2 else 0.0), r * course
            places.append((x, y))
            # The lower half of an ellipse, of two cubics, a little ragged.
            across, down = shingle / 2 - 0.6, course * 0.72
            middle, top = x + shingle / 2, y + course * 0.28
            bend = 0.5523
            curve = np.array([
                [-1, 0], [-1, bend], [-bend, 1], [0, 1], [bend, 1], [1, bend], [1, 0],
            ]) * (across, down) + (middle, top)  # fmt: skip
            curve[1:6] += normal(rng, 0.2, (5, 2))
            strokes.append(curve)
    strokes = [strokes[i] for i in rng.permutation(len(strokes))]
    scales = [0.0] * len(strokes)
    bits = ROOM.bit_length() - 1  # reversed, they put each line half way between two that are there
    for k in range(ROOM):
        parts = (int(f"{k:0{bits}b}"[::-1], 2) + rng.uniform(0.2, 0.8, len(places))) / ROOM
        for i in rng.permutation(len(places)):
            x, y = places[i]
            part = float(parts[i])
            # The shade is longest in the middle, which lies under the gap between two shingles of the course above.
            long = course * (0.15 + 1.6 * part * (1 - part)) * rng.uniform(0.7, 1.0)
            foot = x + 0.8 + part * (shingle - 1.6)
            top = y + course * 0.3
            t = np.array([0.0, 1 / 3, 2 / 3, 1.0])
            line = np.column_stack([foot + 0.8 * t, top + long * t])
            line[1:3, 0] += float(normal(rng, 0.12, 1)[0])
            strokes.append(line)
            scales.append((k + 1) / SHADED)

    def lines(rng: np.random.Generator, n: int) -> Floats:
        centre = rng.uniform(0, 1, (n, 2)) * (width, height)
        return bowed_line(centre, angle + normal(rng, 1.2, n), rng.uniform(14, 30, n), normal(rng, 0.2, n))

    rest = fill(Torus(width, height, 0.7), lines, pen + GAIN_PT, FULL + 0.012, COVERED, 32, rng)
    return growing("shingle", strokes, scales, rest, pen, width, height, seed)
