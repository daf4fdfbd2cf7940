"""The output pixels along one axis: where they lie among the samples, their taps, and the tiles they form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from penink_cli.ground.model import Floats
from penink_cli.reconstruction._compiled import kernels as _kernels
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
    cell, first = np.empty(count, np.intc), np.empty(count + 1, np.intc)
    n = _kernels.lay_tiles(where, TILE, cell, first)
    a, b = 0, n
    if end - begin < count:
        a = int(np.searchsorted(first[:n], begin, "right")) - 1
        b = int(np.searchsorted(first[: n + 1], end, "left"))
    table = taps(where[first[a] : first[b]])
    return Axis(samples, int(first[a]), samples / count, table, cell[a:b], first[a : b + 1] - first[a])
