"""Hatching a sheet in layers. **The loop on the tone closes here.**

1. Lines are laid as far apart as the tone asks: straight ones (`sweep`), or along a field (`form`).
2. Each is trimmed to the runs that bring the ink nearer to the tone (`Sheet.place`).
3. The error that is left, as the eye sees it, is added to the tone asked for. The first `SWEEPS` rounds go back to 1,
   the later ones to 2. The best round is kept.
4. What is still too light is filled with fine strokes between the lines.
5. Each stroke is pressed a little more or less (`press`).

Strokes are handed out when all of them are done: each round is judged by the whole sheet, and a stroke's pressure
depends on its neighbours on all sides.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import candidates, curves, thin, walls
from penink_cli.blasting.curve_fitting import over_chords
from penink_cli.blasting.shares import ALONE, shares
from penink_cli.blasting.sheet import Cells, Sheet, Terms
from penink_cli.ground import threads as threading
from penink_cli.ground.device import MEAN, least
from penink_cli.ground.model import EdgeList, Floats, HatchLayer, Strokes

if TYPE_CHECKING:
    from penink_cli.blasting.form import Form

#: Of the lines that are laid. The lenience: noise around a well-placed stroke is not to cut it.
LAID = Terms(cost=0.25, lenience=0.1)
#: Below this tone less of the error is fed back: there a single line is too dark where it is and too light beside it.
SINGLE = 0.06
#: Rounds of the loop. The first SWEEPS lay the lines anew, the others only trim them.
SWEEPS, ROUNDS = 2, 3
#: The least bare part of a cell for which a layer's density is reckoned: ink that covers nearly all asks for no lines.
BARE = 0.05
#: Cells of a sheet on which all layers are laid at once.
AT_ONCE = 1 << 18
#: SWEEPS for a set of strokes: laid again it is no truer, and takes as long again.
SET_SWEEPS = 1
#: The part of the error that the next sweep's density takes up.
SWEEP_GAIN = 0.4
#: Along a field the most of an error that is fed back at a time: where lines must end, more of them cannot mend it.
MOST_FED_BACK = np.float32(0.15)
#: Along a field a layer that crosses another begins only where the surroundings, low-passed WIDER times, are as dark
#: too, or where the place itself is darker by BY_ITSELF. Lines that close up show small dark things better than a patch
#: of crossed lines with a ragged border does.
WIDER, BY_ITSELF = 2, 0.25
#: The range of tone over which such a layer comes in.
FEATHER = 0.1
#: Fine strokes: their width in parts of the pen's, the least in dots of the device, and their length, points.
FINE, FINE_DOTS, FINE_PT = 0.5, 1.5, 44.0
#: The distance of the rows of fine strokes tried, points.
FINE_ROW_PT = 1.5
#: A fine stroke must pass a place where FINE_LEAST times its own ink is due.
FINE_LEAST = 0.4
#: By how much of tone the eye must see the place too light.
FINE_SEEN = 0.015
#: Fine strokes count their own ink more than once: a little too light is better than doubled lines. The moves, in rows,
#: find the middle of a gap.
FINE_STROKES = Terms(cost=0.02, caution=1.6, shortest_pt=20.5, shifts=(-0.33, 0.33, 0.0), spacing_pt=FINE_ROW_PT)
#: The short strokes that fill what is too light along a field.
FILLERS = Terms(cost=0.05, caution=1.3, shortest_pt=4.0)
#: Strokes along the frame, and the tone above which there are any.
RIM, RIM_TONE = Terms(cost=0.02, caution=4.0, shortest_pt=candidates.SHORTEST_RIM_PT), 0.85
#: Strokes along strong edges, beside lines that follow a field, and the tone above which there are any.
ALONG_EDGES, EDGE_TONE = Terms(cost=0.02, caution=1.5, shortest_pt=candidates.SHORTEST_RIM_PT), 0.5
#: Strokes along a field are fitted anew: the tolerance, and the distance of the points fitted to, points.
REFIT_PT, REFIT_STEP_PT = 0.15, 2.0
#: The part by which pressure widens or narrows a stroke at the most, and the rounds in which that is found.
PRESSURE, PRESSES = 0.22, 3


@dataclass(frozen=True, eq=False)
class Hatch:
    """What a sheet is hatched with.

    pens: the width of each layer's strokes, points; finest: the least that they thin out to in the light.
    gain_pt: how much wider the device paints each. borders: where strokes end. form: what lays them along a field, None
    for straight ones. sweeps: rounds that lay the lines anew.
    """

    layers: tuple[HatchLayer, ...]
    pens: list[float]
    finest: list[float]
    gain_pt: float
    borders: walls.Walls
    form: Form | None
    seed: int
    sweeps: int = SWEEPS

    def laid(self, sheet: Sheet, covers: list[Floats]) -> list[candidates.Candidates]:
        """The strokes of all layers that cover each cell (rows, columns) as asked."""
        passes = [partial(self._pass, sheet, i, covers) for i in range(len(self.layers))]
        # a set's passes know of no threads; in bands there is not enough to do on a small sheet, or much to do twice
        if (self.form is not None and not self.form.lays_lines) or sheet.rows * sheet.columns <= AT_ONCE:
            return list(threading.in_order(iter(passes), sheet.threads, ahead=len(passes)))
        return [each() for each in passes]

    def _pass(self, sheet: Sheet, i: int, covers: list[Floats]) -> candidates.Candidates:
        cover, covers[i] = covers[i], covers[i][:0]  # frees it when it has been used
        return self.swept(sheet, i, cover)

    def swept(self, sheet: Sheet, i: int, cover: Floats) -> candidates.Candidates:
        """The strokes of layer i that cover each cell (rows, columns) as asked."""
        pen, finest, seed = self.pens[i], self.finest[i], self.seed * 64 + i
        if self.form:
            return self.form.swept(i, cover, pen, finest, seed)
        return candidates.swept(sheet, cover, self.layers[i], pen, finest, self.gain_pt, self.borders, seed)


def hatch_sheet(
    sheet: Sheet,
    layers: tuple[HatchLayer, ...],
    edges: EdgeList | None,
    gain_pt: float,
    seed: int,
    pen_pt: float | None,
    tick: Callable[[], None],
    directions: tuple[Cells, Cells] | None = None,
    told: npt.NDArray[np.bool_] | None = None,
    examples: Strokes | None = None,
) -> Strokes:
    """Strokes of all layers that give the sheet its tone, together with the ink that is there already.

    pen_pt: the one pen there is, which then also draws what else would be fine strokes, and is pressed evenly.
    directions: cosine and sine of twice the angle (rows, columns) along which strokes run, each layer turned from it;
        None for the layers' own angles.
    told: for each cell, whether a telling line is drawn there: thin things are not drawn again.
    examples: strokes of a set, laid along the directions in place of lines; the layers are `stroke_set.passes`.
    """
    pens = [pen_pt or max(layer.pen_pt, least(gain_pt)) for layer in layers]
    finest = pens if pen_pt else [min(pen, max(FINE * pen, FINE_DOTS * gain_pt)) for pen in pens]
    broadest = max(pen_pt or layer.pen_pt for layer in layers)
    with threading.meanwhile(lambda: walls.build(edges, sheet, broadest), sheet.threads) as built:
        along = thin.strokes_along(sheet, min(pens), min(pens) + MEAN * gain_pt, pen_pt is not None, told)
        borders = built()
    draw_first(sheet, along)
    form = None if directions is None else _form(sheet, layers, directions, examples, pen_pt, borders)
    hatch = Hatch(layers, pens, finest, gain_pt, borders, form, seed, SWEEPS if examples is None else SET_SWEEPS)
    with threading.meanwhile(
        lambda: candidates.along_edges(sheet, min(finest), borders, EDGE_TONE), sheet.threads if form else 1
    ) as beside:
        drawn = Strokes.joined([along, lines(sheet, hatch, tick)])
        if form:
            drawn = Strokes.joined([drawn, *fillers(sheet, form, pens, seed)])
        fine = fine_strokes(sheet, layers, finest, gain_pt, borders, seed, form, beside)
    drawn = Strokes.joined([drawn, *fine])
    if form:
        drawn = in_fewer_cubics(drawn)
    if pen_pt is None and len(drawn):
        drawn = press(sheet, drawn, seed)
    return drawn


def lines(sheet: Sheet, hatch: Hatch, tick: Callable[[], None]) -> Strokes:
    """Lay lines on the sheet, round by round, that give it its tone as near as they can; they are inked."""
    along_form = hatch.form is not None and hatch.form.lays_lines
    wide = sheet.low_pass(sheet.tone)
    drawn_wide = sheet.low_pass(sheet.ink)
    there = np.minimum(drawn_wide / sheet.weight, np.float32(0.99))
    wanted: Cells = sheet.tone.copy()
    density: Cells = sheet.tone.copy()
    crowd = sheet.crowd(SINGLE, wide)
    laid: list[candidates.Candidates] = []
    best: tuple[float, int, list[Strokes]] | None = None
    for turn in range(ROUNDS):
        tick()
        if turn < hatch.sweeps:
            laid = []  # frees those of the round before
            smooth = (sheet.low_pass(density) if turn else wide) / sheet.weight - there
            smooth = np.maximum(smooth, 0) / np.maximum(1 - there, np.float32(BARE))
            covers = layer_shares(sheet, smooth, density, hatch.layers, along_form)
            laid = hatch.laid(sheet, covers)
        sheet.clear()
        if turn:
            sheet.owe(wanted)
        else:
            sheet.residual = wide - drawn_wide
        strokes = []
        for part in laid:
            strokes.append(part.placed(sheet, LAID, enters=np.zeros(len(part.widths))))
        error = sheet.error()
        size = float(np.mean(np.square(error, dtype=np.float64)))
        if best is None or size < best[0]:
            best = size, turn, strokes
        error = sheet.spread(error) * crowd
        if hatch.form:
            error = np.clip(error, -MOST_FED_BACK, MOST_FED_BACK)
        wanted = wanted + error
        density = density + np.float32(SWEEP_GAIN) * error
    assert best is not None
    tick()
    drawn = Strokes.joined([Strokes(sheet.width, sheet.height), *best[2]])
    if best[1] != ROUNDS - 1:
        sheet.clear()
        paint(sheet, drawn)
    return drawn


def _form(
    sheet: Sheet, layers: tuple[HatchLayer, ...], directions: tuple[Cells, Cells], examples: Strokes | None,
    pen_pt: float | None, borders: walls.Walls,
) -> Form:  # fmt: skip
    """What lays strokes along directions: lines, or a set's examples. Straight hatching does not load it."""
    if examples is None:
        from penink_cli.blasting.form import Form

        return Form(sheet, *directions, layers, borders)
    from penink_cli.blasting.stroke_set import StrokeSet

    return StrokeSet(sheet, *directions, examples, pen_pt, borders)


def in_fewer_cubics(strokes: Strokes) -> Strokes:
    """The same strokes fitted anew: what trimming has left often needs but one cubic, and that of few numbers."""
    pieces = curves.pieces_of(strokes.points, strokes.first, REFIT_STEP_PT)
    lines = curves.sample(strokes.points, strokes.first, pieces)
    points, first = over_chords(lines.points, lines.first, REFIT_PT)
    return replace(strokes, points=points, first=first)


def layer_shares(
    sheet: Sheet, smooth: Cells, density: Cells, layers: tuple[HatchLayer, ...], along_form: bool
) -> list[Floats]:
    """How much each layer is to cover (rows, columns) of the low-passed tone, by what the eye sees of the density."""
    around = sheet.spread(sheet.seen(density))
    for _ in range(WIDER if along_form else 0):
        around = sheet.spread(sheet.seen(around))
    wanted = np.clip(smooth, 0.0, 0.995).astype(np.float64)
    alone, feather = (BY_ITSELF, FEATHER) if along_form else (ALONE, 0.0)
    return shares(wanted, around.astype(np.float64), layers, alone, feather)


def draw_first(sheet: Sheet, strokes: Strokes) -> None:
    """Ink strokes on the sheet for good: outlines, thin things."""
    if len(strokes):
        paint(sheet, strokes)
        sheet.keep()


def paint(sheet: Sheet, strokes: Strokes) -> None:
    """Ink strokes on the sheet."""
    strokes = strokes.by_segments()
    pieces = curves.pieces_of(strokes.points, strokes.first, candidates.STEP_PT)
    sheet.paint(curves.sample(strokes.points, strokes.first, pieces), strokes.widths)


def fine_strokes(
    sheet: Sheet,
    layers: tuple[HatchLayer, ...],
    pens: list[float],
    gain_pt: float,
    borders: walls.Walls,
    seed: int,
    form: Form | None,
    beside: Callable[[], candidates.Candidates],
) -> list[Strokes]:
    """Strokes between those on the sheet, where these leave it too light, in the directions of the layers there.

    Without them the tone of photographs is off by half as much again (0.95 % RMS at 4 in against 0.61); drawn with the
    full pen they streak the dark with doubled lines.

    beside: strokes along strong edges, which lines that follow a field need. They are of the finest of the pens.
    """
    sheet.owe(sheet.tone)
    rim = candidates.rim(sheet, min(pens), borders, RIM_TONE, seed)
    out = [rim.placed(sheet, RIM)]
    if form:
        out.append(beside().placed(sheet, ALONG_EDGES))
    seen = sheet.spread(sheet.error()) - np.float32(FINE_SEEN)
    terms = FINE_STROKES
    if form:
        terms = replace(terms, shortest_pt=form.fine_shortest_pt, caution=max(terms.caution, form.caution))
    for i, (layer, pen) in enumerate(zip(layers, pens)):
        if layer.spacing_pt > 0:
            continue  # what fills a gap would lie closer than it may
        if form:
            part = form.between(i, pen, FINE_PT, FINE_LEAST, seen, seed * 64 + i)
        else:
            part = candidates.lattice(
                sheet, layer, pen, gain_pt, FINE_PT, FINE_ROW_PT, FINE_LEAST, seen, borders, seed * 64 + i
            )
        out.append(part.placed(sheet, terms))
    return out


def fillers(sheet: Sheet, form: Form, pens: list[float], seed: int) -> list[Strokes]:
    """Short strokes of the full pen along the field, where what is drawn leaves it much too light.

    Lines that follow a field end where they come too close, and at edges of the tone; what they leave is too small for
    a stroke of full length and too dark for a fine one.
    """
    terms, out = replace(FILLERS, caution=max(FILLERS.caution, form.caution)), []
    for i, (layer, pen) in enumerate(zip(form.layers, pens)):
        if layer.spacing_pt > 0:
            continue
        sheet.owe(sheet.tone)
        seen = sheet.spread(sheet.error()) - np.float32(form.filler_seen)
        part = form.fillers(i, pen, seen, seed * 64 + i)
        out.append(part.placed(sheet, terms))
    return out


def press(sheet: Sheet, strokes: Strokes, seed: int, crowd: Cells | None = None) -> Strokes:
    """Vary the widths of the strokes on the sheet, as a hand's pressure does, to bring the tone closer.

    crowd: (rows, columns) how far strokes make the tone together there, as `Sheet.crowd` tells of hatching.
    """
    if crowd is None:
        crowd = sheet.crowd(SINGLE, sheet.low_pass(sheet.tone))
    order = np.random.default_rng([seed, 5]).permutation(len(strokes))
    pieces = curves.pieces_of(strokes.points, strokes.first, candidates.STEP_PT)
    lines = curves.sample(strokes.points, strokes.first, pieces)
    # a single line in a light place is no darker than it should be
    middle = lines.points[(lines.first[:-1] + lines.first[1:]) // 2] * (sheet.scale / 8)
    at = np.clip(middle.astype(np.int64), 0, (sheet.columns - 1, sheet.rows - 1))
    pressure = PRESSURE * crowd[at[:, 1], at[:, 0]].astype(np.float64)
    lightest = np.maximum(strokes.widths * (1 - pressure), np.minimum(strokes.widths, least(sheet.gain_pt)))
    widths = sheet.press(lines, strokes.widths, lightest, strokes.widths * (1 + pressure), order, PRESSES)
    widths = np.maximum(np.round(widths, 2), 0.01)
    return replace(strokes, widths=widths)
