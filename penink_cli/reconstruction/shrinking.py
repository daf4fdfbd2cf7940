"""A smaller view of a photo, each pixel the mean of those that it covers, as a coarser camera would see it."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Grey32 = npt.NDArray[np.float32]

_ROWS = 1 << 9  # at a time: the sums are of twice the precision


def shrunk(photo: Grey32, shrink: float) -> Grey32:
    """The photo (h, w) with h / shrink × w / shrink pixels, rounded; shrink: 1 or more."""
    height, width = (max(1, round(side / shrink)) for side in photo.shape)
    return np.ascontiguousarray(_means(_means(photo, width).T, height).T)


def _means(values: Grey32, count: int) -> Grey32:
    """Means of values (h, w) over `count` equal parts of each row, which need not be whole pixels."""
    return np.concatenate([_some(values[top : top + _ROWS], count) for top in range(0, len(values), _ROWS)])


def _some(values: Grey32, count: int) -> Grey32:
    width = values.shape[1]
    sums = np.zeros((values.shape[0], width + 1))
    np.cumsum(values, axis=1, out=sums[:, 1:])
    at = np.linspace(0, width, count + 1)
    left = np.minimum(at.astype(np.int64), width - 1)
    upto = sums[:, left] + (at - left) * values[:, left]
    return (np.diff(upto, axis=1) * (count / width)).astype(np.float32)
