"""Median, quantile and distinct numbers. numpy's own functions load masked arrays first, which takes 15 ms or more."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt


def median(values: npt.NDArray[Any], axis: int = -1) -> Any:
    """The middle number along an axis, or the mean of the two middle ones. There is at least one number, and no NaN.

    >>> float(median(np.array([3.0, 1.0, 9.0, 2.0])))
    2.5
    """
    n = values.shape[axis]
    low, high = (n - 1) // 2, n // 2
    parted = np.partition(values, (low, high), axis=axis)
    return (parted.take(low, axis=axis) + parted.take(high, axis=axis)) / 2


def quantile(values: npt.NDArray[Any], share: float) -> float:
    """The number below which that share, 0 … 1, of the numbers (n,) lies, interpolated linearly.

    There is at least one number, and no NaN.

    >>> quantile(np.array([3.0, 1.0, 9.0, 2.0]), 0.4)
    2.2
    """
    at = share * (len(values) - 1)
    low = int(at)
    parted = np.partition(values, (low, min(low + 1, len(values) - 1)))
    a, b = float(parted[low]), float(parted[min(low + 1, len(values) - 1)])
    return a + (b - a) * (at - low) if at - low < 0.5 else b - (b - a) * (1 - (at - low))


def distinct(values: npt.NDArray[np.integer]) -> npt.NDArray[np.integer]:
    """The numbers (n,), each once, in order.

    >>> distinct(np.array([5, 2, 5])).tolist()
    [2, 5]
    """
    ordered = np.sort(values)
    return ordered[np.append(True, ordered[1:] != ordered[:-1])[: len(ordered)]]
