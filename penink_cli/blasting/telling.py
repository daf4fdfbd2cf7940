"""What telling lines ask of the hatching: it leaves light ones out, and draws no dark one twice.

Dark ones are ink on the sheet, as outlines are. Hatching that kept clear of them besides lost more of the picture than
the lines told of it: they lie where it is dark, and what was moved away there is its detail.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.blasting.sheet import CELL_PT, cells, coverage, resample
from penink_cli.composition.filters import Picture, blurred
from penink_cli.ground import pens
from penink_cli.ground.model import Floats, Ints, LineChoice, Lines, Strokes
from penink_cli.lines.choice import chosen
from penink_cli.lines.strokes import line_strokes

#: Light lines: how broad the broadest is, and how many there may be.
WHITE = LineChoice(pen_pt=1.8, density=0.12, per_inch2=5.0)
#: They show where the tone around, over a Gaussian of this σ, exceeds DARK, and in full from FULL on.
AROUND_PT, DARK, FULL = 3.0, 0.35, 0.65
#: The part of them that has to show for one to be worth keeping.
LEAST_SHOWN = 0.3
#: What is no further than this from a dark line is told by it.
TOLD_PT = 1.6


def with_room(
    lines: Lines, width_pt: float, height_pt: float, tone: Picture, choice: LineChoice, threads: int
) -> Ints:
    """Indices of the lines, dark and light, that a drawing of that size, and so a smaller one, has room for.

    tone: (h, w) of the photo. choice: how dark lines are drawn. Light lines of which less than LEAST_SHOWN shows on it
    are left away.
    """
    by = pens.part(width_pt)
    room = 1.0 if choice.even else by
    dark = chosen(lines, width_pt / room, height_pt / room, choice)
    light = chosen(lines, width_pt / by, height_pt / by, WHITE, white=True)
    h, w = tone.shape
    around = blurred(tone, AROUND_PT * w / width_pt, threads)
    at = np.floor(lines.points * (w / lines.width, h / lines.height)).astype(np.int64)
    at = np.clip(at, 0, (w - 1, h - 1))
    there = np.cumsum(np.append(0, np.rint(_shown(around[at[:, 1], at[:, 0]]) * 1024).astype(np.int64)))
    count = np.diff(lines.first)
    shown = [
        i for i in light.tolist() if there[lines.first[i + 1]] - there[lines.first[i]] >= LEAST_SHOWN * 1024 * count[i]
    ]
    return np.sort(np.concatenate([dark, np.array(shown, np.int64)]))


def told(
    tone: Floats, width_pt: float, height_pt: float, lines: Lines, ink: Strokes | None, threads: int
) -> tuple[Floats, npt.NDArray[np.bool_]]:
    """The tone that is left to the hatching, and where lines tell what is there, for each cell of the sheet.

    tone: (h, w). ink: strokes on the sheet already, among them those that the dark lines of the list have become;
    without them no dark line is taken to be drawn. Returns (h, w), or the sheet's cells where those are finer, and
    (rows, columns) of cells.
    """
    rows, columns = cells(width_pt, height_pt)
    fine = tone.shape[0] >= rows and tone.shape[1] >= columns
    tone = tone if fine else resample(tone, rows, columns)
    around = blurred(resample(tone, rows, columns).astype(np.float32), AROUND_PT / CELL_PT, threads)
    light = line_strokes(lines, width_pt, height_pt, WHITE, white=True)
    shown = _shown(around) * coverage(light, rows, columns, threads=threads)
    left = tone * resample((1 - shown).astype(np.float64), *tone.shape)
    # what is dark between two light lines is no thin thing: their ground is
    near = (coverage(light, rows, columns, 2 * TOLD_PT, threads) > 0.5) & (around > DARK)
    if ink is not None and len(ink):
        near |= coverage(ink, rows, columns, 2 * TOLD_PT, threads) > 0.5
    return left, near


def _shown(around: Picture) -> Picture:
    """How much of a light line shows where the tone around it is so dark."""
    return np.clip((around - np.float32(DARK)) / np.float32(FULL - DARK), 0, 1)
