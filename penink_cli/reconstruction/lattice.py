"""The output pixels along one axis: where they lie among the samples, their taps, and the tiles they form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from penink_cli.model import Floats
from penink_cli.reconstruction.kernels import Taps, taps

TILE = 8  # pixels a side at most: 64 of them are the bits of one word


def centres(count: int, samples: int) -> Floats:
    """Where the centres of `count` output pixels lie along an axis of so many samples, in sample units."""
    return (np.arange(count) + 0.5) * samples / count - 0.5


@dataclass(frozen=True, eq=False)
class Axis:
    """Output pixels `begin` … along one axis, whole tiles of them.

    samples: samples along the axis. step: samples from one pixel to the next. taps: of every pixel, in whole tiles.
    cell, first: (t,), (t + 1,) the cell of each tile, and its first pixel counted from `begin`.
    """

    samples: int
    begin: int
    step: float
    taps: Taps
    cell: np.ndarray
    first: np.ndarray

    @property
    def count(self) -> int:
        """Pixels in all tiles."""
        return int(self.first[-1])


def axis(count: int, samples: int, begin: int, end: int) -> Axis:
    """The tiles that pixels begin … end of `count` touch.

    A tile never depends on which pixels are asked for: that would show in the last digit of its sums.
    """
    where = centres(count, samples)
    cell = np.floor(where).astype(np.intc)
    fresh = np.flatnonzero(np.diff(cell, prepend=-9))
    inside = np.arange(count) - np.repeat(fresh, np.diff(fresh, append=count))
    first = np.append(np.flatnonzero(inside % TILE == 0), count)
    a = int(np.searchsorted(first, begin, "right")) - 1
    b = int(np.searchsorted(first, end, "left"))
    first = first[a : b + 1]
    table = taps(where[first[0] : first[-1]])
    return Axis(
        samples, int(first[0]), samples / count, table, cell[first[:-1]].copy(), (first - first[0]).astype(np.intc)
    )
