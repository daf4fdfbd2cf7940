"""The median, as numpy has it, without the tens of milliseconds that its first call takes to load masked arrays."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt


def median(values: npt.NDArray[Any], axis: int = -1) -> Any:
    """The middle one of numbers along an axis, or the mean of the two in the middle; there is at least one, and no NaN.

    >>> float(median(np.array([3.0, 1.0, 9.0, 2.0])))
    2.5
    """
    n = values.shape[axis]
    low, high = (n - 1) // 2, n // 2
    parted = np.partition(values, (low, high), axis=axis)
    return (parted.take(low, axis=axis) + parted.take(high, axis=axis)) / 2
