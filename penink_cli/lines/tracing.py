"""Lines followed through a bank's responses, each on the layers of its own direction, so that lines may cross.

This module alone imports the compiled kernel `tracing`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from penink_cli.ground.model import Floats, Ints
from penink_cli.lines._compiled import tracing
from penink_cli.lines.oriented import DIRECTIONS, Bank, Picture, units

LONGEST = 4000  # steps of a pixel that a line is followed to each side
WIDE = 2.2  # pixels to each side in which no other line of nearly the same direction may run
LEAST = 5  # points of a line
SEEDS = 64  # there is room for a seed to so many responses; where there are more seeds, room is made
TRIMMED = 0.5  # ends of a line are cut off where the response is below this part of the line's mean


@dataclass(frozen=True, eq=False)
class Traces:
    """Lines as they were followed, a point a pixel, smoothed and trimmed.

    points: (p, 3) x, y (pixel centres at whole numbers) and response.
    span: (n, 2) line i is points[span[i, 0] : span[i, 1]].
    length: (n,) pixels. response: (n,) mean. turning: (n,) radians in all. around: (n,) mean response of the
    surroundings. ground: (n,) mean tone of the surroundings. agreement: (n,) mean of cos 2Δ, Δ the angle to the field.
    closed: (n,) whether a line is a ring.
    """

    points: Floats
    span: Ints
    length: Floats
    response: Floats
    turning: Floats
    around: Floats
    ground: Floats
    agreement: Floats
    closed: npt.NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.span)

    def doubled(self) -> Traces:
        """The lines in a picture of twice the size."""
        points = self.points * (2.0, 2.0, 1.0) + (0.5, 0.5, 0.0)
        return replace(self, points=points, length=2 * self.length)

    def __getitem__(self, i: int) -> Floats:
        """Points (k, 3) of line i."""
        return self.points[self.span[i, 0] : self.span[i, 1]]


def traces(
    bank: Bank, sign: float, high: float, low: float, around: Picture, ground: Picture, cos2: Picture, sin2: Picture
) -> Traces:
    """Lines that reach the response `high` somewhere and go on down to `low`, those with the strongest seeds first.

    bank: (DIRECTIONS, h, w) responses, of which those with this sign count. around, ground: (h, w), see `Traces`. cos2,
    sin2: (h, w) cos 2θ and sin 2θ of the field.
    """
    unit = units(8 * DIRECTIONS)
    seeds = np.empty((bank.size // SEEDS, 3), np.int32)
    count = tracing.peaks(bank, sign, unit, high, seeds)
    if count > len(seeds):
        seeds = np.empty((count, 3), np.int32)
        tracing.peaks(bank, sign, unit, high, seeds)
    seeds = seeds[:count]
    seeds = seeds[np.argsort(-sign * bank[seeds[:, 0], seeds[:, 1], seeds[:, 2]], kind="stable")]
    used = np.zeros(bank.shape[1:], np.uint32)
    tracer = tracing.Tracer(bank, sign, unit, low, WIDE, LONGEST, used)
    room, starts = np.empty((64 * LONGEST, 4)), np.empty(1 << 14, np.int64)
    parts: list[Floats] = []
    sizes: list[Ints] = []
    begin, more = 0, True
    while more:
        begin, count, more = tracer.follow(seeds, begin, LEAST, room, starts)
        parts.append(room[: starts[count], :3].copy())
        sizes.append(np.diff(starts[: count + 1]))
    points, counts = np.ascontiguousarray(np.concatenate(parts)), np.concatenate(sizes)
    first = np.zeros(len(counts) + 1, np.int64)
    np.cumsum(counts, out=first[1:])
    span, told = np.zeros((len(counts), 2), np.int64), np.zeros((len(counts), 7))
    longest = int(counts.max()) if len(counts) else 1
    places = np.stack([around, ground, cos2, sin2])
    tracing.measure(points, first, _half(2.0), _half(5.0), TRIMMED, np.empty((longest, 3)), places, span, told)
    keep = span[:, 1] - span[:, 0] >= LEAST
    span, told = span[keep], told[keep]
    return Traces(points, span, told[:, 0], told[:, 1], told[:, 2], told[:, 3], told[:, 4], told[:, 5], told[:, 6] > 0)


def _half(sigma: float) -> Floats:
    """One half of a low-pass of that σ: the middle weight, then those to one side."""
    from penink_cli.composition.filters import gaussian

    return gaussian(sigma).astype(np.float64)
