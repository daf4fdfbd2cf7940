"""The two kinds of arrays that most values are made of, and groups that lie one after the other in an array."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


def members(first: Ints, which: Ints, turned: npt.NDArray[np.bool_] | None = None) -> tuple[Ints, Ints]:
    """The places of all members of the groups `which` (k,), and where each group's begin among these (k + 1,).

    first: (g + 1,) group i has the members first[i] … first[i + 1] - 1. turned: (k,) whether a group's members are
    taken backwards.

    >>> [part.tolist() for part in members(np.array([0, 2, 5]), np.array([1, 0]), np.array([True, False]))]
    [[4, 3, 2, 0, 1], [0, 3, 5]]
    """
    counts = np.diff(first)[which]
    begins = np.zeros(len(which) + 1, np.int64)
    np.cumsum(counts, out=begins[1:])
    along = np.arange(begins[-1]) - np.repeat(begins[:-1], counts)
    if turned is None:
        return np.repeat(first[:-1][which], counts) + along, begins
    step = np.where(turned, -1, 1)
    start = first[which] + np.where(turned, counts - 1, 0)
    return np.repeat(start, counts) + np.repeat(step, counts) * along, begins
