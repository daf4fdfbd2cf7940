"""What a printer adds to the width of a stroke: the one model that blasting, outputs and self-drawing pictures share.

A PostScript device paints every pixel that a stroke touches. In the ideal that widens a stroke in the direction
(cos θ, sin θ) by |cos θ| + |sin θ| of its pixels; a disc of width w grows to what it sweeps with a pixel of side p, an
area of π w²/4 + 2 w p + p². Ghostscript falls a little short of both, for it counts in 256ths of a pixel and makes
polygons of curves: as if the pixel were a little smaller. By how much is measured at 150 to 1200 dpi by `python -m
tests.benchmarks.devices`. Plotters and anti-aliased screens add nothing.

Dots are written so that polygons are as fine as the language allows, 0.2 pixels from the curve (`setflat`). With the
usual 1 their corners become more in leaps: dots of 5.9 pixels gained 1.16 pixels, of 6 1.20, of 12 1.16, of 24 1.20.
Now no dot of 1 to 30 pixels is off by more than 0.03, and no stipple's tone by more than 0.2 %.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from penink_cli.ground import exact
from penink_cli.ground.model import Floats, Strokes

#: The side p of the smaller pixel, in pixels. A stroke is widened by it times |cos θ| + |sin θ|.
EDGE = 0.985
#: The same for a shape that is filled, as strokes that swell are: it is widened by all of it.
FILLED = 1.0
#: The mean over strokes in all directions, pixels.
MEAN = 1.25
STEP = 0.001  # points: changed widths are whole numbers of it
LEAST = 0.01  # points: no changed width is less


def least(dot_pt: float) -> float:
    """The narrowest stroke, points, that a device with dots of that size widens by `gains`; 0 for one without dots.

    Ghostscript paints a narrower stroke as a hairline, one dot in each row or column: less than half of its ink.
    """
    return (math.floor(100 * dot_pt + 1e-6) + 1) / 100 if dot_pt else 0.0  # the next hundredth above a dot


def disc(width: Floats, pixel: float) -> Floats:
    """The width of the disc that is as dark as what a device paints of a dot. width, pixel: in one unit.

    >>> disc(np.array([0.0, 1.0, 10.0]), 1.0).round(3).tolist()
    [1.111, 2.178, 11.239]
    """
    side = EDGE * pixel
    painted: Floats = np.sqrt(width * width + (8 * side * width + 4 * side * side) / math.pi)
    return painted


def pen_of(width: Floats, pixel: float) -> Floats:
    """The inverse of `disc`: the width of the dot that is painted so wide; below 0 where there is none."""
    side = EDGE * pixel
    told: Floats = np.sqrt(width * width + (4 / math.pi - 1) * 4 / math.pi * side * side) - 4 / math.pi * side
    return told


def gains(strokes: Strokes, dpi: float) -> Floats:
    """Points (s,) that a device of this resolution adds to the width of each stroke, as the mean along the stroke."""
    return _gains(strokes, dpi, disc(strokes.widths, 72 / dpi) - strokes.widths)


def widened(strokes: Strokes, dpi: float) -> Strokes:
    """The strokes as wide as a device of this resolution would paint them."""
    return _with(strokes, gains(strokes, dpi))


def narrowed(strokes: Strokes, dpi: float) -> Strokes:
    """The strokes so narrow that a device of this resolution paints them as wide as they were."""
    return _with(strokes, -_gains(strokes, dpi, strokes.widths - pen_of(strokes.widths, 72 / dpi)))


def _gains(strokes: Strokes, dpi: float, of_dots: Floats) -> Floats:
    """The gain (s,) of each stroke, points. of_dots: (s,) the gain of each if it is a dot."""
    if not len(strokes):
        return np.zeros(0)
    steps = np.diff(strokes.points, axis=0, prepend=strokes.points[:1])
    steps[strokes.first[:-1]] = 0.0
    across = np.add.reduceat(np.abs(steps).sum(axis=1), strokes.first[:-1])
    length = np.add.reduceat(exact.length(steps), strokes.first[:-1])
    edge = np.where(strokes.swells, FILLED, EDGE) * (72 / dpi)
    mean: Floats = np.where(length > 0, edge * across / np.where(length > 0, length, 1.0), of_dots)
    return mean


def _with(strokes: Strokes, more: Floats) -> Strokes:
    """The strokes with so many points (s,) added to the width of each."""
    if strokes.knot_widths is not None:
        wider = strokes.knot_widths + np.repeat(more, np.diff(strokes.knots))
        return strokes.swelling(np.maximum(np.rint(wider / STEP) * STEP, LEAST))
    return replace(strokes, widths=np.maximum(np.rint((strokes.widths + more) / STEP) * STEP, LEAST))
