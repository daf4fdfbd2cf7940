"""What a printer adds to the width of a stroke: the one model that blasting, outputs and self-drawing pictures share.

A PostScript device paints every pixel that a stroke touches. In the ideal that widens a stroke in the direction
(cos θ, sin θ) by |cos θ| + |sin θ| of its pixels, and a dot by the mean over all directions, 4/π. Ghostscript falls a
little short of both, for it flattens curves and inscribes polygons in discs. The factors here are what Ghostscript
paints at 150 to 1200 dpi; `python -m tests.benchmarks.devices` measures it. Plotters and anti-aliased screens add
nothing.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from penink_cli.ground import exact
from penink_cli.ground.model import Floats, Strokes

#: A stroke is widened by this part of |cos θ| + |sin θ| pixels.
EDGE = 0.985
#: The same for a shape that is filled, as strokes that swell are: it is widened by all of it.
FILLED = 1.0
#: Pixels by which a dot is widened. Ghostscript's dots are polygons of few corners: dots of up to 12 pixels gain 1.15
#: to 1.19, those of 16 to 20 gain 1.09, in leaps. One factor for all is off on stipple by .06 % of full scale at 300
#: and 600 dpi, by .6 at 150 and .3 at 1200. A gain by size would follow the leaps of one program; finer polygons
#: (`setflat`) change all dots and leap as well.
DOT = 1.16
#: The mean over strokes in all directions, pixels.
MEAN = 1.25
STEP = 0.001  # points: changed widths are whole numbers of it
LEAST = 0.01  # points: no changed width is less


def least(dot_pt: float) -> float:
    """The narrowest stroke, points, that a device with dots of that size widens by `gains`; 0 for one without dots.

    Ghostscript paints a narrower stroke as a hairline, one dot in each row or column: less than half of its ink.
    """
    return (math.floor(100 * dot_pt + 1e-6) + 1) / 100 if dot_pt else 0.0  # the next hundredth above a dot


def gains(strokes: Strokes, dpi: float) -> Floats:
    """Points (s,) that a device of this resolution adds to the width of each stroke, as the mean along the stroke."""
    steps = np.diff(strokes.points, axis=0, prepend=strokes.points[:1])
    steps[strokes.first[:-1]] = 0.0
    if not len(strokes):
        return np.zeros(0)
    across = np.add.reduceat(np.abs(steps).sum(axis=1), strokes.first[:-1])
    length = np.add.reduceat(exact.length(steps), strokes.first[:-1])
    edge = np.where(strokes.swells, FILLED, EDGE)
    mean: Floats = np.where(length > 0, edge * across / np.where(length > 0, length, 1.0), DOT)
    return mean * (72 / dpi)


def widened(strokes: Strokes, dpi: float) -> Strokes:
    """The strokes as wide as a device of this resolution would paint them."""
    return _with(strokes, gains(strokes, dpi))


def narrowed(strokes: Strokes, dpi: float) -> Strokes:
    """The strokes so much narrower that a device of this resolution paints them as wide as they were."""
    return _with(strokes, -gains(strokes, dpi))


def _with(strokes: Strokes, more: Floats) -> Strokes:
    """The strokes with so many points (s,) added to the width of each."""
    if strokes.knot_widths is not None:
        wider = strokes.knot_widths + np.repeat(more, np.diff(strokes.knots))
        return strokes.swelling(np.maximum(np.rint(wider / STEP) * STEP, LEAST))
    return replace(strokes, widths=np.maximum(np.rint((strokes.widths + more) / STEP) * STEP, LEAST))
