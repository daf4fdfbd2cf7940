"""What a printer adds to the width of a stroke.

A PostScript device paints every pixel that a stroke touches, which widens a stroke in the direction (cos θ, sin θ)
by |cos θ| + |sin θ| pixels, a dot by 4/π, the mean of that. `blast` counts on it; plotters and anti-aliased
screens do nothing of the kind.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from penink_cli.ground.model import Floats, Strokes

STEP = 0.01  # points, to which changed widths are rounded: few pens, short files
FINE_STEP = 0.001  # the same for strokes that swell, whose width would go in steps
LEAST = 0.01


def gains(strokes: Strokes, dpi: float) -> Floats:
    """Points (s,) that a device of this resolution adds to the width of each stroke, on its way's average."""
    steps = np.diff(strokes.points, axis=0, prepend=strokes.points[:1])
    steps[strokes.first[:-1]] = 0.0
    if not len(strokes):
        return np.zeros(0)
    across = np.add.reduceat(np.abs(steps).sum(axis=1), strokes.first[:-1])
    length = np.add.reduceat(np.hypot(*steps.T), strokes.first[:-1])
    mean: Floats = np.where(length > 0, across / np.where(length > 0, length, 1.0), 4 / np.pi)
    return mean * (72 / dpi)


def widened(strokes: Strokes, dpi: float) -> Strokes:
    """As wide as a device of this resolution would paint them."""
    return _with(strokes, gains(strokes, dpi))


def narrowed(strokes: Strokes, dpi: float) -> Strokes:
    """So that a device of this resolution paints them as wide as they were."""
    return _with(strokes, -gains(strokes, dpi))


def _with(strokes: Strokes, more: Floats) -> Strokes:
    if strokes.knot_widths is not None:
        wider = strokes.knot_widths + np.repeat(more, np.diff(strokes.knots))
        return strokes.swelling(np.maximum(np.rint(wider / FINE_STEP) * FINE_STEP, LEAST))
    return replace(strokes, widths=np.maximum(np.rint((strokes.widths + more) / STEP) * STEP, LEAST))
