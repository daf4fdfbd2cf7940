"""A smaller view of a photo, each pixel the mean of those that it covers, as a coarser camera would see it."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.reconstruction._compiled import shrinking as _shrinking

Grey32 = npt.NDArray[np.float32]


def shrunk(photo: Grey32, shrink: float) -> Grey32:
    """The photo (h, w) with h / shrink × w / shrink pixels, rounded; shrink: 1 or more.

    >>> shrunk(np.array([[0.0, 5.0, 10.0, 15.0, 20.0]], np.float32), 2.5).tolist()
    [[4.0, 16.0]]
    """
    height, width = (max(1, round(side / shrink)) for side in photo.shape)
    down, across = (np.linspace(0, whole, parts + 1) for whole, parts in zip(photo.shape, (height, width)))
    out = np.empty((height, width), np.float32)
    _shrinking.means(np.ascontiguousarray(photo), down, across, np.empty(photo.shape[1] + 1), out)
    return out
