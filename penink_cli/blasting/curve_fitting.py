"""Smooth curves through runs of points, within a tolerance (Schneider, Graphics Gems 1990).

This module alone imports the compiled kernel.
"""

from __future__ import annotations

import numpy as np

from penink_cli.blasting._compiled import curve_fitting as _curve_fitting
from penink_cli.ground.model import Floats


def fit(points: Floats, tolerance: float, ring: bool = False) -> Floats:
    """Control points (3k + 1, 2) of k cubic Bézier segments that pass all of points (n, 2) within tolerance.

    The curve begins and ends at the first and last point and is smooth in between. A ring's last point is
    its first, and the curve is smooth there too.
    """
    if len(points) < 2:
        return points[:1].copy()
    control = np.empty((3 * len(points) - 2, 2))
    return control[: _curve_fitting.fit(np.ascontiguousarray(points), tolerance, ring, control)]
