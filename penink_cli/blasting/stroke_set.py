"""Oriented stroke sets: example strokes laid along a field of directions (Salisbury, Wong, Hughes and Salesin 1997).

The next stroke goes where the drawing, blurred the more the lighter it is, lacks most of its tone; it is an example
bent along the field, of a scale, a turn and a place of its own, the best of a few. That order is then the one in which
strokes are tried: what trims, corrects and presses hatching does so with them.

One direction cannot reach black: a second pass crosses the first where it is dark.

This module alone imports the compiled kernel `growth`.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import candidates, curves, sweep, walls
from penink_cli.blasting._compiled import growth
from penink_cli.blasting.form import Form
from penink_cli.blasting.sheet import Cells, Sheet
from penink_cli.ground.device import MEAN
from penink_cli.ground.model import Floats, HatchLayer, Ints, Strokes

#: Of each of the two passes: the tone from which and up to which it draws, and its turn from the field, degrees.
PASSES = ((0.0, 0.72, 0.0), (0.68, 0.99, 25.0))
#: The part of its tone that a cell may lack without needing a further stroke.
STOP = 0.3
#: The same where one pen draws all. No pressure evens the tone out there, and strokes that fill what is left make it
#: too dark: they count their own ink CAUTION times at the least. Photographs were up to 2 % too dark, now within .4.
ONE_PEN_STOP, CAUTION = 0.15, 2.5
#: How far a stroke's ink counts, in square roots of its area over the tone: the lighter, the wider.
SPREAD = 0.45
#: The least and greatest scale of an example, and the most that it is turned from the field, degrees.
SCALES, TURN = (0.8, 1.2), 10.0
#: Examples tried for each place.
TRIES = 4
#: The least length of a fine stroke, points; with one pen for all, by how much too light a place must be for one.
FINE_SHORTEST_PT, ONE_PEN_SEEN = 9.0, np.float32(0.02)
#: The distance of an example's samples, points, and how many samples there are from knot to knot of a stroke.
STEP_PT, KNOTS = 1.5, 4


class StrokeSet(Form):
    """Examples on a sheet, in the place of lines along the form."""

    fine_shortest_pt = FINE_SHORTEST_PT
    filler_seen = 0.06
    lays_lines = False

    def __init__(
        self, sheet: Sheet, cos2: Cells, sin2: Cells, examples: Strokes, pen_pt: float | None, borders: walls.Walls
    ):
        super().__init__(sheet, cos2, sin2, passes(examples), borders)
        self._one_pen = pen_pt is not None
        self._stop = ONE_PEN_STOP if self._one_pen else STOP
        if self._one_pen:
            self.caution = CAUTION
        pieces = curves.pieces_of(examples.points, examples.first, STEP_PT)
        lines = curves.sample(examples.points, examples.first, pieces)
        counts = np.diff(lines.first)
        self._lines_of = curves.Polylines(
            np.ascontiguousarray(lines.points - np.repeat(lines.points[lines.first[:-1]], counts, axis=0)), lines.first
        )
        self._pens = np.full(len(examples), pen_pt) if pen_pt else examples.widths
        reach = lines.points[lines.first[1:] - 1, 0] - lines.points[lines.first[:-1], 0]
        self._area = float(np.mean(reach * self._pens))
        self._most = int(counts.max())

    def swept(self, i: int, coverage: Floats, pen: float, finest: float, seed: int) -> candidates.Candidates:
        """The strokes of pass i that cover each cell (rows, columns) as coverage asks, in the order of their places."""
        sheet = self.sheet
        wanted = coverage.astype(np.float32)
        cell = sheet.width / sheet.columns, sheet.height / sheet.rows
        total = float(np.cumsum(wanted, dtype=np.float64)[-1]) * cell[0] * cell[1]
        room = 1000 + int(4 * total / self._area)
        out, first = np.empty((room * min(self._most, 24) + 256, 2)), np.zeros(room + 1, np.int64)
        which = np.zeros(room, np.int32)
        field = tuple(np.ascontiguousarray(plane) for plane in self.turned(i))
        painted = self._pens + MEAN * sheet.gain_pt
        growing = growth.Growth(wanted, field, cell, self._lines_of, painted, SPREAD, SCALES[1], seed + 1)
        placed = growing.place(self._stop, math.radians(TURN), *SCALES, TRIES, out, first, which)
        first = first[: placed + 1]
        points, starts = smooth(out, first)
        middle = out[(first[:-1] + first[1:]) // 2] if placed else np.zeros((0, 2))
        at = np.clip((middle / cell).astype(np.int64), 0, (sheet.columns - 1, sheet.rows - 1))
        share = self._pens[which[:placed]] / pen
        widths = share * sweep.pressed(coverage[at[:, 1], at[:, 0]], finest, pen)
        rank = np.arange(placed, dtype=np.float64)
        return candidates.between_walls(points, starts, widths, self._painted(pen), self.borders, rank)

    def between(
        self, i: int, pen: float, length: float, least: float, error: Cells, seed: int
    ) -> candidates.Candidates:
        """Short fine strokes along the field, where the error (rows, columns) is positive.

        The one pen there is draws none that are fine: they wait for more, or it all becomes 0.9 % too dark.
        """
        return self.fillers(i, pen, error - ONE_PEN_SEEN if self._one_pen else error, seed + 17)


    def _due(self, i: int, points: npt.NDArray[np.floating], error: Cells) -> Floats:
        """What is due at points (n, 2) where pass i is active and the error (rows, columns) positive."""
        sheet = self.sheet
        at = np.floor(points * (sheet.columns / sheet.width, sheet.rows / sheet.height)).astype(np.int64)
        inside = (at >= 0).all(axis=1) & (at[:, 0] < sheet.columns) & (at[:, 1] < sheet.rows)
        x, y = np.clip(at, 0, [sheet.columns - 1, sheet.rows - 1]).T
        active = inside & (sheet.tone[y, x] > self.layers[i].low) & (error[y, x] > 0)
        return np.where(active, sheet.residual[y, x], 0.0)


def passes(examples: Strokes) -> tuple[HatchLayer, ...]:
    """The passes as layers of hatching, of the examples' mean pen."""
    pen = math.fsum(examples.widths.tolist()) / len(examples)
    return tuple(HatchLayer(turn, low, high, pen, turn=turn) for low, high, turn in PASSES)


def smooth(points: Floats, first: Ints) -> tuple[Floats, Ints]:
    """Chains of cubics through every few of the points of polylines."""
    count = np.diff(first)
    knots = np.maximum(1, (count - 1 + KNOTS // 2) // KNOTS) + 1
    who = np.repeat(np.arange(len(count)), knots)
    rank = curves.ramp(knots)
    last = knots[who] - 1
    at = first[who] + (2 * rank * (count[who] - 1) + last) // (2 * last)
    after, before = np.minimum(at + 1, first[who + 1] - 1), np.maximum(at - 1, first[who])
    along = points[after] - points[before]
    along /= np.maximum(np.sqrt((along * along).sum(axis=1)), 1e-9)[:, None]
    starts = curves.starts(3 * (knots - 1) + 1)
    out = np.empty((starts[-1], 2))
    place = starts[who] + 3 * rank
    out[place] = points[at]
    on = np.flatnonzero(rank < last)
    chord = points[at[on + 1]] - points[at[on]]
    third = np.sqrt((chord * chord).sum(axis=1))[:, None] / 3
    out[place[on] + 1] = points[at[on]] + along[on] * third
    out[place[on + 1] - 1] = points[at[on + 1]] - along[on + 1] * third
    return out, starts
