"""White lines in the black: paper left bare along the form, as on scraperboard, where the dark is not quite black.

Layers that cross each other in the dark are a grainy net, and black without them is darker than the picture. So the
black is whole, and what it lacks of white is hatched in it: a hatching of the negative, one layer along the form. Its
lines are not drawn but left out when the black is filled (`bordered`): each has a stroke to either side of it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from penink_cli.blasting import curves, hatching, marks, polylines, small, walls
from penink_cli.blasting.form import Form
from penink_cli.blasting.gaps import Gaps
from penink_cli.blasting.sheet import CELL_PT, Cells, Sheet, look_up, resample
from penink_cli.composition.filters import Picture, blurred
from penink_cli.ground.masks import near, parts, sizes
from penink_cli.ground.model import EdgeList, HatchLayer, Strokes

#: Width of a white line, points.
LINE_PT = 0.35
#: Of the tone the mean around counts (σ): what is finer than the lines' distance they cannot show.
AROUND_PT = 2.0
#: The least white for which there are lines: farther apart they are scratches, and black as a whole is near enough. The
#: most that there may be: closer lines would leave no black between.
LEAST, MOST = 0.028, 0.36
#: Where there is less of that in one piece, square points, there would be a line or two, which are scratches too.
ALONE_PT2 = 250.0
#: Lines are told by places so far apart, points; they end in points over TAPER_PT, and shorter ones are left out.
STEP_PT, TAPER_PT, SHORTEST_PT = 1.0, 5.0, 12.0
#: Rounds in which their widths are corrected, how much of what is wrong each round corrects, and the greatest width.
ROUNDS, CORRECTION, WIDEST_PT = 10, 1.0, 0.7


def white_lines(
    sheet: Sheet, value: Picture, field: tuple[Cells, Cells] | None, layer: HatchLayer, edges: EdgeList | None,
    pen_pt: float, seed: int, tick: Callable[[], None],
) -> Gaps | None:  # fmt: skip
    """White lines, tapered, in what is black where value (h, w) exceeds `marks.LEVEL`.

    field: as `hatching.hatch_sheet` has it. layer: whose angle and turn they have. pen_pt: how wide a device paints the
    strokes beside them.
    """
    within: Picture = resample((value > marks.LEVEL).astype(np.float64), sheet.rows, sheet.columns).astype(np.float32)
    white = blurred((1 - sheet.tone) * within, AROUND_PT / CELL_PT)
    white /= np.maximum(blurred(within, AROUND_PT / CELL_PT), np.float32(1e-3))
    part, count = parts(white > LEAST)
    large = sizes(part, count, part > 0) >= ALONE_PT2 / CELL_PT**2
    large[0] = False
    white = np.where(large[part], np.minimum(white, np.float32(MOST)), np.float32(0))
    dark, reach = value > marks.LEVEL, small.HALF_PT * value.shape[1] / sheet.width
    opened = near(near(dark, reach, threads=sheet.threads), reach, threads=sheet.threads)  # small things are black
    broad = resample(opened.astype(np.float64), sheet.rows, sheet.columns)
    room = np.where((within > 0.99) & (broad > 0.5), white, np.float32(0))
    if not (room > 0).any():
        return None
    negative = Sheet(room.astype(np.float64), sheet.width, sheet.height, 0.0, sheet.threads)
    borders = walls.build(edges, sheet, LINE_PT)
    layers = (HatchLayer(layer.angle, 0.0, 1.0, LINE_PT, turn=layer.turn),)
    form = None if field is None else Form(negative, *field, layers, borders)
    hatch = hatching.Hatch(layers, [LINE_PT], [LINE_PT], 0.0, borders, form, seed, sweeps=1)
    strokes = hatching.lines(negative, hatch, tick)
    gaps = _within(strokes, value, pen_pt)
    return gaps and _swollen(negative, gaps, white * within)


def _swollen(negative: Sheet, gaps: Gaps, white: Cells) -> Gaps:
    """The gaps, as wide along their way as makes them the white (rows, columns) that there is to be."""
    negative.tone = white
    share = np.maximum(negative.spread(negative.seen(white)), np.float32(LEAST))
    for _ in range(ROUNDS):
        negative.clear()
        negative.swell(gaps.strokes(negative.width, negative.height))
        part = negative.spread(negative.error()) / share
        part = look_up(part, gaps.lines.points, negative.width, negative.height)
        half = gaps.half * (1 + CORRECTION * np.clip(part, -0.5, 0.5))
        gaps = replace(gaps, half=np.minimum(half, WIDEST_PT / 2))
    return gaps


def _within(strokes: Strokes, value: Picture, pen_pt: float) -> Gaps | None:
    """As much of the strokes as has room for black on both sides, in places `STEP_PT` apart, tapered."""
    pieces = curves.pieces_of(strokes.points, strokes.first, STEP_PT)
    lines = curves.sample(strokes.points, strokes.first, pieces)
    who = np.repeat(np.arange(len(strokes)), np.diff(lines.first))
    half = strokes.widths[who] / 2
    away = polylines.normals(lines.points, lines.first) * (half + pen_pt)[:, None]
    room = np.minimum(lines.points, (strokes.width, strokes.height) - lines.points).min(axis=1)
    inside = room > pen_pt + LINE_PT
    for place in (lines.points - away, lines.points, lines.points + away):
        inside &= look_up(value, place, strokes.width, strokes.height) > marks.LEVEL
    key = np.concatenate([[-1], np.where(inside, who, -1), [-1]])
    change = np.flatnonzero(key[1:] != key[:-1])
    begin = change[key[change + 1] >= 0]
    end = change[np.searchsorted(change, begin) + 1]
    long = (end - begin - 1) * STEP_PT >= SHORTEST_PT
    begin, end = begin[long], end[long]
    if not len(begin):
        return None
    counts = end - begin
    at = np.repeat(begin, counts) + curves.ramp(counts)
    first = curves.starts(counts)
    points = lines.points[at]
    legs = np.diff(points, axis=0, prepend=points[:1])
    step = np.sqrt(legs[:, 0] * legs[:, 0] + legs[:, 1] * legs[:, 1])
    step[first[:-1]] = 0.0
    along = np.cumsum(step)
    along = along - np.repeat(along[first[:-1]], counts)
    left = np.repeat(along[first[1:] - 1], counts) - along
    taper = np.minimum(np.minimum(along, left) / TAPER_PT, 1.0)
    return Gaps(curves.Polylines(points, first), half[at] * taper)
