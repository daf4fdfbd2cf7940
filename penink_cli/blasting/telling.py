"""What telling lines ask of the hatching: it leaves light ones out, keeps clear of dark ones, and draws none twice."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.blasting.sheet import CELL_PT, Cells, coverage, resample
from penink_cli.composition.filters import blurred
from penink_cli.ground.model import Floats, LineChoice, Lines, Strokes
from penink_cli.lines.strokes import line_strokes

#: Light lines: how broad the broadest is, and how many there may be.
WHITE = LineChoice(pen_pt=1.8, density=0.12, per_inch2=5.0)
#: They show where the tone around, over a Gaussian of this σ, exceeds DARK, and in full from FULL on.
AROUND_PT, DARK, FULL = 3.0, 0.35, 0.65
#: Beside dark lines, within so many points of them, hatching moves this part of the tone away, unless it is nearly
#: black there.
CLEAR_PT, CLEAR, BLACK = 1.0, 0.7, (0.7, 0.9)
#: What is no further than this from a dark line is told by it.
TOLD_PT = 1.6


def told(
    tone: Floats, width_pt: float, height_pt: float, lines: Lines, ink: Strokes | None, threads: int
) -> tuple[Floats, npt.NDArray[np.bool_]]:
    """The tone that is left to the hatching, and where dark lines tell what is there, for each cell of the sheet.

    tone: (h, w). ink: strokes on the sheet already, among them those that the dark lines of the list have become;
    without them no dark line is taken to be drawn. Returns (h, w), or the sheet's cells where those are finer, and
    (rows, columns) of cells.
    """
    rows, columns = max(1, round(height_pt / CELL_PT)), max(1, round(width_pt / CELL_PT))
    fine = tone.shape[0] >= rows and tone.shape[1] >= columns
    tone = tone if fine else resample(tone, rows, columns)
    around = blurred(resample(tone, rows, columns).astype(np.float32), AROUND_PT / CELL_PT, threads)
    light = line_strokes(lines, width_pt, height_pt, WHITE, white=True)
    shown = np.clip((around - DARK) / (FULL - DARK), 0, 1) * coverage(light, rows, columns)
    left = tone * resample((1 - shown).astype(np.float64), *tone.shape)
    near = np.zeros((rows, columns), np.bool_)
    if ink is not None and len(ink):
        beside = coverage(ink, rows, columns, 2 * CLEAR_PT) - coverage(ink, rows, columns)
        grey = np.clip((BLACK[1] - around) / (BLACK[1] - BLACK[0]), 0, 1)
        aside = (CLEAR * grey * beside * resample(left, rows, columns)).astype(np.float32)
        # what is kept away there goes a little further off: the tone is the same
        moved = blurred(aside, AROUND_PT / CELL_PT, threads) - aside
        left = np.clip(left + _spread(moved, *left.shape), 0, 1)
        near = coverage(ink, rows, columns, 2 * TOLD_PT) > 0.5
    return left, near


def _spread(values: Cells, rows: int, columns: int) -> Floats:
    """Values of either sign at another size; `resample` knows none below 0."""
    return resample(0.5 + 0.5 * values.astype(np.float64), rows, columns) * 2 - 1

