"""What a rule is given to draw, and how a drawing on a sheet begins."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import curves, hatching, marks, solids
from penink_cli.blasting.light import LightThings
from penink_cli.blasting.sheet import Cells, Sheet, cells, coverage, resample
from penink_cli.ground import threads as threading
from penink_cli.ground.angles import direction
from penink_cli.ground.device import MEAN
from penink_cli.ground.model import Directions, EdgeList, Floats, Strokes, Texture
from penink_cli.ground.recall import recalled

#: Cosine and sine of twice the angle of a field in each cell of a sheet, (rows, columns).
Field: TypeAlias = tuple[Cells, Cells]

#: The broadest pen that small dark things are filled with.
MARK_PT = 0.5
#: Cells of which so much lies within a point of a small dark thing belong to it.
NEAR_MARK = 0.3
#: Tone below which nothing asks for a stroke.
BARE = 0.02
#: Layers that go so far reach black.
ALMOST = 0.99
#: Degrees at which a set of strokes lies where no directions are given.
ANGLE = -45.0


def read_field(
    directions: Directions | None, edges: EdgeList | None, width_pt: float, height_pt: float, threads: int
) -> Field | None:
    """The directions on a sheet of that size."""
    if directions is None:
        return None
    from penink_cli.directions.reading import at_size  # the reconstruction is not needed otherwise

    told = directions, edges, *cells(width_pt, height_pt)
    field = recalled("field", told, lambda: at_size(*told, threads, confident=False))
    return np.asarray(field.cos2, np.float32), np.asarray(field.sin2, np.float32)


@dataclass(frozen=True)
class Task:
    """The arguments of `blast.blast`, which tells them.

    field: reads the field of directions; None where there is none. Not all rules and textures follow one.
    told: where telling lines keep hatching away, (rows, columns) cells of the sheet, or None.
    """

    tone: Floats
    width_pt: float
    height_pt: float
    edges: EdgeList | None
    texture: Texture
    seed: int
    pen_pt: float | None
    device_dpi: float | None
    outlines: Strokes | None
    field: Callable[[], Field | None]
    told: npt.NDArray[np.bool_] | None
    swell: float
    natural_pt: float | None
    solid: float | None
    threads: int
    tick: Callable[[], None]

    @property
    def gain(self) -> float:
        """A dot of the printer, points; 0 where nothing is gained."""
        return 72.0 / self.device_dpi if self.device_dpi else 0.0


class Begun:
    """A sheet on which the strokes that are there already, small dark things and solid black have been drawn.

    small: the strokes of those. told: cells (rows, columns) that hatching keeps away from thin things in, or None.
    near: cells (rows, columns) that are those of small dark things, or None.
    """

    def __init__(self, task: Task):
        self.task = task
        texture, gain = task.texture, task.gain
        self.sheet = Sheet(task.tone, task.width_pt, task.height_pt, gain, task.threads)
        if task.outlines is not None:
            hatching.draw_first(self.sheet, task.outlines)
        finest = task.pen_pt or min(
            [*texture.strokes.widths.tolist(), *(layer.pen_pt for layer in texture.layers), MARK_PT]
        )
        dark = task.tone, task.width_pt, task.height_pt, finest, MEAN * gain, task.pen_pt is not None, self.sheet.ink
        self.small = recalled("marks", dark, lambda: marks.marks(*dark))
        hatching.draw_first(self.sheet, self.small)
        self.told = task.told
        self.near: npt.NDArray[np.bool_] | None = None
        if len(self.small):  # nor are they thin things to be drawn along
            self.near = coverage(self.small, self.sheet.rows, self.sheet.columns, 2.0, self.sheet.threads) > NEAR_MARK
            self.told = self.near if self.told is None else self.told | self.near
        self.light = LightThings(task.tone, task.width_pt, task.height_pt)
        black = self._black()
        hatching.draw_first(self.sheet, black)
        self.small = Strokes.joined([self.small, black]) if len(black) else self.small

    def _black(self) -> Strokes:
        """Solid black: everywhere under layers that reach it, else around small light things."""
        task, layers, sheet = self.task, self.task.texture.layers, self.sheet
        size, gain = (task.width_pt, task.height_pt), MEAN * task.gain
        dark = layers[-1] if layers and task.texture.engraving is None and layers[-1].spacing_pt == 0 else None
        light = None if self.light.none else self.light
        whole = dark is not None and dark.high >= 1.0 and task.solid is None
        black, broad = (solids.BLACK, solids.LINED) if whole else (task.solid or solids.DARKEST, 1.0)
        told = task.tone, *size, sheet.ink, black, light, dark is not None and dark.high >= ALMOST, broad
        value = recalled("black", told, lambda: solids.found(*told, threads=sheet.threads))
        gaps = shape = None
        if value is not None and whole:
            assert dark is not None
            from penink_cli.blasting import reserved  # with what follows a field, which other textures do not load

            field = self.field  # waited for with both threads free
            painted = (task.pen_pt or solids.PEN_PT) + gain
            more = value, field, dark, task.edges, painted, task.seed
            with threading.meanwhile(partial(solids.shape, value, *size, task.pen_pt, gain), task.threads) as shaped:
                gaps = recalled("gaps", (task.tone, *more), lambda: reserved.white_lines(sheet, *more, task.tick))
                shape = shaped()
        rest = value, *size, task.pen_pt, gain, gaps
        strokes = recalled("solids", rest, lambda: solids.filled(*rest, shape))
        if gaps is not None and value is not None:
            part = resample((value > marks.LEVEL).astype(np.float64), sheet.rows, sheet.columns).astype(np.float32)
            covered = coverage(strokes, sheet.rows, sheet.columns, gain, sheet.threads)
            # hatching draws nothing there, but is the lighter beside what is too dark
            dark_by = np.minimum(sheet.spread(sheet.seen(sheet.tone * part - covered)), 0)
            sheet.tone = sheet.tone * (1 - part) + np.where(part > 0, covered + dark_by, 0)
        return strokes

    def _brought_on(self, strokes: Strokes, near: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
        """Which strokes (n,) that are never cut a small dark thing has brought on, and run from it over bare paper."""
        lines = curves.sample(strokes.points, strokes.first, curves.pieces_of(strokes.points, strokes.first, 0.5))
        rows, columns = near.shape
        at = np.clip((lines.points * (self.sheet.scale / 8)).astype(np.int64), 0, (columns - 1, rows - 1))
        there = near[at[:, 1], at[:, 0]]
        bare = ~there & (self.sheet.tone[at[:, 1], at[:, 0]] < BARE)
        meets, paper, beyond = (np.add.reduceat(each.astype(int), lines.first[:-1]) for each in (there, bare, ~there))
        found: npt.NDArray[np.bool_] = (meets > 0) & (2 * paper > beyond)
        return found

    @property
    def field(self) -> Field | None:
        """The task's field; None without one."""
        return self.task.field()

    def one_angle(self) -> Field:
        """The same for a field of which nothing is known: one angle everywhere, as of plain hatching."""
        c, s = direction(2 * ANGLE)
        whole = np.ones((self.sheet.rows, self.sheet.columns), np.float32)
        return whole * np.float32(c), whole * np.float32(s)

    def with_small(self, strokes: Strokes) -> Strokes:
        """The strokes, on those of small dark things and solid black, and out of small light ones."""
        strokes = self.light.kept_out(strokes, MEAN * self.task.gain)
        if self.task.texture.whole and self.near is not None and len(strokes):
            strokes = strokes.taken(~self._brought_on(strokes, self.near))
        return Strokes.joined([self.small, strokes]) if len(self.small) else strokes
