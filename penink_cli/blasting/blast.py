"""Blasting (section 3): a grey image and a stroke texture to strokes of the same tone."""

from __future__ import annotations

import numpy as np

from penink_cli.blasting import curves, tile
from penink_cli.blasting.sheet import Cells, Sheet
from penink_cli.errors import ParameterError
from penink_cli.model import EdgeList, Floats, Ints, Strokes, Texture

#: The rules by which strokes are chosen.
RULES = ("best", "strict", "threshold")
#: Rounds of feeding the remaining error back.
ROUNDS = 4


def blast(
    tone: Floats,
    width_pt: float,
    height_pt: float,
    edges: EdgeList | None,
    texture: Texture,
    *,
    seed: int = 0,
    pen_pt: float | None = None,
    device_dpi: float | None = 600.0,
    rule: str = "best",
    outlines: Strokes | None = None,
    threads: int | None = None,
) -> Strokes:
    """Strokes of `texture` on a sheet of width_pt × height_pt that have the tone (h, w), 0 paper … 1 ink."""
    if rule not in RULES:
        raise ParameterError(f"rule {rule!r}: known are {', '.join(RULES)}")
    gain = 72.0 / device_dpi if device_dpi else 0.0
    sheet = Sheet(tone, width_pt, height_pt, gain, threads or 1)
    candidates = tile.instances(texture, width_pt, height_pt, tile.thresholds(texture, gain), seed)
    strokes = candidates.strokes
    pieces = curves.pieces_of(strokes.points, strokes.first, 1.0)
    lines = curves.sample(strokes.points, strokes.first, pieces)
    order = np.arange(len(strokes))
    batches = [part for part in np.array_split(order, max(1, len(order) // 512)) if len(part)]
    runs: Ints
    if rule == "strict":
        sheet.owe_strictly()
        runs, moved = sheet.place(lines, strokes.widths, batches, strict=True)
    else:
        runs, moved = closed_loop(sheet, lines, strokes.widths, batches, texture.whole)
    points, first = curves.cut(strokes.points, strokes.first, pieces, runs[:, 0], runs[:, 1], runs[:, 2])
    points = points + np.repeat(moved, np.diff(first), axis=0)
    return Strokes(width_pt, height_pt, points, first, strokes.widths[runs[:, 0]], texture=texture.name, seed=seed)


def closed_loop(
    sheet: Sheet, lines: curves.Polylines, widths: Floats, batches: list[Ints], whole: bool
) -> tuple[Ints, Floats]:
    """Place the strokes, then again with the low-passed error added to the tone, and keep the best."""
    wanted: Cells = sheet.tone.copy()
    best: tuple[float, Ints, Floats] | None = None
    for _ in range(ROUNDS):
        sheet.clear()
        sheet.owe(wanted)
        runs, moved = sheet.place(
            lines, widths, batches, whole=whole, cost=0.0 if whole else 0.3, shifts=(-0.5, 0.5, 0.0),
            spacing_pt=np.full(len(widths), 1.0),
        )  # fmt: skip
        error = sheet.low_pass(sheet.tone - sheet.ink)
        size = float(np.mean(np.square(error, dtype=np.float64)))
        if best is None or size < best[0]:
            best = size, runs, moved
        wanted = wanted + error
    assert best is not None
    return best[1], best[2]
