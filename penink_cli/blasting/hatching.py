"""Hatching a sheet in layers: sweep, trim, fill what is missing, feed the error back, press."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from penink_cli.blasting import candidates, curves, thin, walls
from penink_cli.blasting.sheet import Cells, Sheet
from penink_cli.model import EdgeList, Floats, HatchLayer, Strokes

#: What a run of ink must gain, in cells × tone: less, and it is not worth a stroke.
RUN_COST = 0.25
#: A stroke that fills a place counts its own ink so many times: better a little too light than doubled lines.
FILL_CAUTION = 2.4
#: One that the sweep has laid counts it plainly, and part of the tone besides as due: where it lies is right on the
#: whole, and the noise of what lies around it is no reason to cut it.
TRIM_CAUTION = 1.0
LENIENCE = 0.1
#: It must pass a place where so many times as much is due as it adds itself.
FILL_LEAST = 1.2
#: Rounds: the first ones lay the lines anew, the later ones only trim and fill.
SWEEPS, ROUNDS = 2, 4
#: How much of the error the next sweep's density takes up. More bends the lines.
SWEEP_GAIN = 0.4
#: How far a hand's pressure widens or narrows a stroke.
PRESSURE = 0.22


def shares(tone: Floats, layers: tuple[HatchLayer, ...]) -> list[Floats]:
    """How much each layer is to cover (same shape as tone), so that crossing at random they make the tone."""
    out = []
    bare = np.ones_like(tone)
    for layer in layers:
        until = np.minimum(tone, layer.high)
        cover = np.clip(np.where(tone > layer.low, 1.0 - (1.0 - until) / bare, 0.0), 0.0, 1.0)
        bare = bare * (1.0 - cover)
        out.append(cover)
    return out


def join(parts: list[Strokes], width_pt: float, height_pt: float) -> Strokes:
    """All strokes of the parts, in order, on one sheet."""
    parts = [part for part in parts if len(part)]
    if not parts:
        return Strokes(width_pt, height_pt)
    first = curves.starts(np.concatenate([np.diff(part.first) for part in parts]))
    points = np.concatenate([part.points for part in parts])
    return Strokes(width_pt, height_pt, points, first, np.concatenate([part.widths for part in parts]))


def hatch_sheet(
    sheet: Sheet,
    layers: tuple[HatchLayer, ...],
    edges: EdgeList | None,
    gain_pt: float,
    seed: int,
    pen_pt: float | None,
    tick: Callable[[], None],
) -> Strokes:
    """Strokes of all layers that give the sheet its tone, together with the ink that is there already."""
    borders = walls.build(edges, sheet, max(pen_pt or layer.pen_pt for layer in layers))
    pens = [pen_pt or layer.pen_pt for layer in layers]
    weight = sheet.low_pass(np.ones_like(sheet.tone))
    along = thin.strokes_along(sheet, min(pens), min(pens) + gain_pt * 1.27, pen_pt is not None)
    draw_first(sheet, along)
    there = np.minimum(sheet.low_pass(sheet.ink) / weight, np.float32(0.99))
    wanted: Cells = sheet.tone.copy()
    density: Cells = sheet.tone.copy()
    laid: list[candidates.Candidates] = []
    best: tuple[float, list[Strokes]] | None = None
    for turn in range(ROUNDS):
        tick()
        if turn < SWEEPS:
            smooth = (sheet.low_pass(density) / weight - there) / (1 - there)
            smooth = np.clip(smooth, 0.0, 0.995).astype(np.float64)
            laid = [
                candidates.swept(sheet, cover, layer, pen, gain_pt, borders, seed * 64 + i)
                for i, (layer, pen, cover) in enumerate(zip(layers, pens, shares(smooth, layers)))
            ]
        sheet.clear()
        sheet.owe(wanted)
        strokes = [along]
        for part in laid:
            runs, moved = sheet.place(
                part.lines,
                part.widths,
                part.batches,
                walls=part.bounded,
                cost=RUN_COST,
                caution=TRIM_CAUTION,
                lenience=LENIENCE,
            )
            strokes.append(part.drawn(runs, moved))
        for i, (layer, pen) in enumerate(zip(layers, pens)):
            if layer.spacing_pt > 0:
                continue  # what fills a gap would lie closer than it may
            part = candidates.lattice(
                sheet, layer, pen, gain_pt, 40.0, 1.5, FILL_LEAST, borders, seed * 64 + turn * 8 + i
            )
            runs, moved = sheet.place(
                part.lines, part.widths, part.batches, walls=part.bounded, cost=RUN_COST, caution=FILL_CAUTION,
            )  # fmt: skip
            strokes.append(part.drawn(runs, moved))
        error = sheet.error()
        size = float(np.mean(np.square(error, dtype=np.float64)))
        if best is None or size < best[0]:
            best = size, strokes
        error = sheet.spread(error)
        wanted = wanted + error
        density = density + np.float32(SWEEP_GAIN) * error
    assert best is not None
    joined = join(best[1], sheet.width, sheet.height)
    if pen_pt is None and len(joined):
        joined = press(sheet, joined, seed)
    return joined


def draw_first(sheet: Sheet, strokes: Strokes) -> None:
    """Ink strokes on the sheet for good: outlines, thin things."""
    if len(strokes):
        pieces = curves.pieces_of(strokes.points, strokes.first, candidates.STEP_PT)
        sheet.paint(curves.sample(strokes.points, strokes.first, pieces), strokes.widths)
        sheet.keep()


def press(sheet: Sheet, strokes: Strokes, seed: int) -> Strokes:
    """Vary the strokes' widths, as a hand's pressure does, to bring the tone closer."""
    order = np.random.default_rng([seed, 5]).permutation(len(strokes))
    pieces = curves.pieces_of(strokes.points, strokes.first, candidates.STEP_PT)
    lines = curves.sample(strokes.points, strokes.first, pieces)
    widths = strokes.widths
    for _ in range(3):
        sheet.clear()
        sheet.paint(lines, widths)
        sheet.owe(sheet.tone)
        widths = sheet.press(lines, widths, strokes.widths * (1 - PRESSURE), strokes.widths * (1 + PRESSURE), [order])
    widths = np.maximum(np.round(widths, 2), 0.01)
    return Strokes(strokes.width, strokes.height, strokes.points, strokes.first, widths)
