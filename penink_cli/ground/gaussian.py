"""A Gaussian low-pass with scipy's results. Loading scipy would take longer than most pictures.

This module alone imports the compiled kernel.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from penink_cli.ground import exact
from penink_cli.ground._compiled import gaussian as _gaussian
from penink_cli.ground.model import Floats


def smoothed(grey: npt.NDArray[np.floating], sigma: float) -> npt.NDArray[np.float32]:
    """Grey (h, w), of any range, low-passed by a Gaussian of sigma pixels; beyond its sides grey goes on as it ends.

    >>> smoothed(np.array([[0.0, 0.0, 0.0, 1.0]]), 0.25).round(3).tolist()
    [[0.0, 0.0, 0.0, 1.0]]
    """
    grey = np.ascontiguousarray(grey, np.float32)
    out = np.empty_like(grey)
    _gaussian.smooth(grey, weights(sigma), out)
    return out


def weights(sigma: float) -> Floats:
    """One half (n,) of a Gaussian out to four deviations, the middle weight first; both halves together sum to 1."""
    found = [float(exact.exp(-0.5 * (k / sigma) ** 2)) for k in range(int(4 * sigma + 0.5) + 1)]
    return np.array(found) / (found[0] + 2 * math.fsum(found[1:]))
