"""The paper's last factor of two (section 3): plain cubic convolution over a reconstruction of half the size.

It leaves just enough blur along edges for a hand-drawn feel.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from penink_cli.reconstruction import lanes
from penink_cli.reconstruction.kernels import Taps, taps
from penink_cli.reconstruction.lattice import centres

Window = tuple[int, int, int, int]
EIGHT = 8  # columns of room beyond the last: see `separable.expand`


def _axis(count: int, half: int, begin: int, size: int) -> Taps:
    return taps(centres(count, half)[begin : begin + size], max(1.0, half / count))


def source_window(window: Window, width: int, height: int, half_width: int, half_height: int) -> Window:
    """The pixels of the half-size picture that a window of the whole one is made of."""
    x, y, across, down = window
    bounds = []
    for count, half, begin, size in ((width, half_width, x, across), (height, half_height, y, down)):
        table = _axis(count, half, begin, size)
        least, most = int(table.first[0]), int(table.first[-1]) + table.cubic.shape[1]
        bounds.append((min(max(least, 0), half - 1), max(1, min(most, half))))
    (left, right), (top, bottom) = bounds
    return left, top, right - left, bottom - top


def soften(
    halves: Iterator[npt.NDArray[np.float64]],
    inner: Window,
    half_width: int,
    half_height: int,
    window: Window,
    width: int,
    height: int,
    maxval: int,
    stored: np.dtype[Any],
) -> Iterator[npt.NDArray[Any]]:
    """Rows of the window of the whole picture, from those of `inner`, which `source_window` chose."""
    x = _axis(width, half_width, window[0], window[2])
    y = _axis(height, half_height, window[1], window[3])
    across = np.zeros((4, len(x.first) + EIGHT))
    across[:, : len(x.first)] = x.cubic.T
    x_first = x.first - np.intc(inner[0])
    y_first = y.first - np.intc(inner[1])
    kept = np.empty((0, inner[2]))
    start = done = 0  # of the kept rows, and of those delivered
    separable = lanes.kernel("separable")
    for rows in halves:
        kept = np.concatenate([kept, rows])
        if start + len(kept) == inner[3]:
            ready = len(y_first)
        else:
            ready = int(np.searchsorted(y_first, start + len(kept) - y.cubic.shape[1], "right"))
        if ready <= done:
            continue
        begin, end = int(y_first[done]), int(y_first[ready - 1]) + y.cubic.shape[1]
        expanded = np.empty((end - begin, len(x.first) + EIGHT))
        separable.expand(kept, begin - start, x_first, across, expanded)
        out = np.empty((ready - done, len(x.first)), stored)
        separable.combine(expanded, begin, y_first[done:ready], y.cubic[done:ready], maxval, out)
        done = ready
        if done < len(y_first):
            drop = max(0, int(y_first[done]) - start)
            kept, start = kept[drop:], start + drop
        yield out
