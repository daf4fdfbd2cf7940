"""Strokes drawn on to the frame.

While its width is still open a stroke ends so far within the frame that no pressing lets its ink reach over it, and
most ink then ends some tenths of a point before the frame: a light rim, which plates of several inks all have. Once
widths are known the ends are drawn on, along the stroke's direction there, until the ink touches the frame.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from penink_cli.ground.exact import length
from penink_cli.ground.model import Floats, Ints, Strokes

#: How far from the frame the ink of an end may be that is drawn on, and by how much it is at the most, points.
NEAR_PT, MOST_PT = 0.6, 1.2
ROUNDING_PT = 0.01  # of a file's coordinates


def drawn_on(strokes: Strokes) -> Strokes:
    """The strokes, those that end just before the frame as far as it."""
    curves = np.flatnonzero(np.diff(strokes.first) > 1)
    if not len(curves):
        return strokes
    points, widths, knots = strokes.points.copy(), strokes.at_knots, strokes.knots
    sheet = np.array((strokes.width, strokes.height))
    starts, ends = strokes.first[:-1][curves], strokes.first[1:][curves] - 1
    _draw_on(points, starts, starts + 1, widths[knots[:-1][curves]] / 2, sheet)
    _draw_on(points, ends, ends - 1, widths[knots[1:][curves] - 1] / 2, sheet)
    return replace(strokes, points=points)


def _draw_on(points: Floats, end: Ints, before: Ints, half: Floats, sheet: Floats) -> None:
    """Move these ends (n,) of points (p, 2), which come from the points before them; half: of the pen's width there."""
    at = points[end]
    way = at - points[before]
    far = length(way)
    way /= np.where(far > 0, far, 1.0)[:, None]
    ahead = np.where(way > 0, sheet - at, at) - (half + ROUNDING_PT)[:, None]  # to each side that it goes towards
    steep = np.abs(way) > 0.2  # and not along it
    rest = np.where(steep & (ahead > 0) & (ahead < NEAR_PT), ahead / np.where(steep, np.abs(way), 1.0), np.inf)
    on = np.minimum(rest[:, 0], rest[:, 1])
    # neither side is to be passed on the way to the other
    room = np.where(way != 0, np.maximum(ahead, 0.0) / np.where(way != 0, np.abs(way), 1.0), np.inf)
    on = np.where(on <= MOST_PT, np.minimum(on, np.minimum(room[:, 0], room[:, 1])), 0.0)
    points[end] = at + way * on[:, None]
