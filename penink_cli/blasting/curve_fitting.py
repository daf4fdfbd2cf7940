"""Curves through points, within a tolerance: smooth ones (Schneider, Graphics Gems 1990), and ones of few numbers.

This module alone imports the compiled kernel.
"""

from __future__ import annotations

import numpy as np

from penink_cli.blasting._compiled import curve_fitting as _curve_fitting
from penink_cli.blasting.curves import starts
from penink_cli.ground.model import Floats, Ints


def fit(points: Floats, tolerance: float, ring: bool = False) -> Floats:
    """Control points (3k + 1, 2) of k cubic Bézier segments that pass all of points (n, 2) within tolerance.

    The curve begins and ends at the first and last point and is smooth in between. A ring's last point is
    its first, and the curve is smooth there too.
    """
    if len(points) < 2:
        return points[:1].copy()
    control = np.empty((3 * len(points) - 2, 2))
    return control[: _curve_fitting.fit(np.ascontiguousarray(points), tolerance, ring, control)]


def over_chords(points: Floats, first: Ints, tolerance: float) -> tuple[Floats, Ints]:
    """Control points of runs of points (n, 2), each within tolerance, in few cubics; and where each run's begin.

    They lie beside a third and two thirds of each cubic's chord, so that two numbers say where: PostScript is written
    so. Joints are not quite smooth, by no more than is seen within the tolerance.
    """
    control, count = np.empty((3 * len(points), 2)), np.empty(len(first) - 1, np.int64)
    _curve_fitting.over_chords(np.ascontiguousarray(points), np.ascontiguousarray(first), tolerance, control, count)
    begin = starts(count)
    return control[: begin[-1]], begin
