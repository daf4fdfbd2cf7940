"""Telling lines as a renderer is sent them: each with the size of the picture from which on there is room for it.

Which lines there is room for depends on all of them together (`lines.choice`), which takes too long on a printer. Here
it is found out once, for a ladder of sizes; a device draws the lines that enter at its own step of the ladder or below.
A larger picture has more room, so a line that has entered hardly ever leaves again.
"""

from __future__ import annotations

import math

import numpy as np

from penink_cli.blasting.telling import WHITE
from penink_cli.ground.model import Floats, Ints, LineChoice, Lines
from penink_cli.lines.choice import chosen

#: The ladder: widths of the picture on paper, points, from half an inch to 22 inches; larger pictures add no more
#: lines.
LADDER = tuple(round(36 * 2 ** (k / 2), 3) for k in range(12))
#: The grid has SIDE places to the root of the frame's area, as in archives, but no side has more than MOST.
SIDE, MOST = 1280, 65000
#: Weights are kept in 15ths.
WEIGHTS = 15
#: No step from point to point is longer than this along x or y, so that the difference of two steps fits into a byte.
LONGEST = 60


def told(lines: Lines, choice: LineChoice) -> tuple[Ints, Ints]:
    """The lines that are drawn at some size, dark ones first, and the step of the ladder at which each enters."""
    which: list[Ints] = []
    steps: list[Ints] = []
    for kind, white in ((choice, False), (WHITE, True)):
        enters = np.full(len(lines), len(LADDER))
        for step in reversed(range(len(LADDER))):
            wide = LADDER[step]
            enters[chosen(lines, wide, wide * lines.height / lines.width, kind, white)] = step
        order = np.argsort(enters, kind="stable")
        order = order[enters[order] < len(LADDER)]
        which.append(order)
        steps.append(enters[order])
    return np.concatenate(which), np.concatenate(steps)


def grid(lines: Lines) -> tuple[int, int]:
    """How many places the grid has across the frame, and down it."""
    root = math.sqrt(lines.width * lines.height)
    across, down = (min(max(1, math.floor(SIDE * side / root + 0.5)), MOST) for side in (lines.width, lines.height))
    return across, down


def line_bytes(lines: Lines, which: Ints, steps: Ints) -> bytes:
    """The bytes of the lines `which` (n,), one after another; steps: (n,) of the ladder.

    Each line is its step of the ladder (1 byte), its breadth in half places (2 bytes), the number of its points (2
    bytes), the first point (2 bytes for x and y each), steps and weights. A step is two bytes, along x and along y: the
    difference from the step before it, plus 128.
    """
    across, down = grid(lines)
    scale = np.array([across / lines.width, down / lines.height])
    parts = []
    for i, step in zip(which.tolist(), steps.tolist(), strict=True):
        at, weight = _path(lines[i] * scale, lines.weight[lines.first[i] : lines.first[i + 1]])
        breadth = 0
        if lines.breadth[i] > 0:
            wide = 2 * float(lines.breadth[i]) * math.sqrt(float(scale[0] * scale[1]))
            breadth = min(max(math.floor(wide + 0.5), 1), 65535)
        parts.append(bytes([step]))
        parts += [v.to_bytes(2, "big") for v in (breadth, len(at), *at[0].tolist())]
        legs = np.diff(at, axis=0)
        parts.append((np.diff(legs, axis=0, prepend=np.zeros((1, 2), np.int64)) + 128).astype(np.uint8).tobytes())
        parts.append(weight.astype(np.uint8).tobytes())
    return b"".join(parts)


def _path(points: Floats, weight: Floats) -> tuple[Ints, Ints]:
    """Places (k, 2) along a path, no two in a row alike, none too far from the one before, and the weights (k,)."""
    legs = points[1:] - points[:-1]
    parts = np.maximum(np.ceil(np.abs(legs).max(axis=1, initial=0) / LONGEST), 1).astype(np.int64)
    leg = np.repeat(np.arange(len(parts)), parts)
    part = ((np.arange(len(leg)) - np.repeat(np.cumsum(parts) - parts, parts)) / parts[leg])[:, None]
    dense = np.concatenate([points[leg] + legs[leg] * part, points[-1:]])
    weights = np.append(weight[leg] * (1 - part[:, 0]) + weight[leg + 1] * part[:, 0], weight[-1])
    at = np.clip(np.floor(dense + 0.5), 0, 65535).astype(np.int64)
    keep = np.ones(len(at), bool)
    keep[1:] = (at[1:] != at[:-1]).any(axis=1)
    return at[keep][:65535], np.floor(weights[keep] * WEIGHTS + 0.5).astype(np.int64)[:65535]
