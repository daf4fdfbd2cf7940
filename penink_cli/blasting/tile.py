"""Blasting with a tile of prioritized strokes: its copies over the sheet, tried in order of priority."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from penink_cli.blasting import curves, walls
from penink_cli.blasting.sheet import SIGMA_PT, Cells, Sheet, Terms
from penink_cli.ground.median import median
from penink_cli.ground.model import EdgeList, Floats, Ints, Strokes, Texture

#: Strokes that may be trimmed: the gain below which a run is not drawn, and the sideways moves that are tried.
TRIMMED = Terms(cost=0.3, shifts=(-0.5, 0.5, 0.0), spacing_pt=1.0)
#: Rounds of feeding the error back.
ROUNDS = 4
#: The distance at which strokes are sampled, points.
STEP_PT = 1.5
#: Copies of strokes that are laid out at a time, so that memory stays bounded on any sheet.
CHUNK = 12_000
#: A stroke is tried where the tone exceeds the tone at which it enters, less this: tiles have holes that only late
#: strokes fill. Dots lie so evenly that less will do.
SLACK, SLACK_DOTS = 0.4, 0.15
#: Below this part of the tone that one stroke makes, less of the error is fed back, by the square of the ratio. A
#: single stroke is too dark where it is and too light beside it; with the full error fed back it would be dropped.
SINGLE = 0.5
#: The tone from which on dots are laid along the frame: with less ink around they would look like a line.
RIM_TONE = 0.45


def thresholds(texture: Texture, gain_pt: float) -> Floats:
    """(s,) the tone of the tile before each stroke is drawn, all strokes of lower priority being there.

    A stroke belongs in a picture where the tone exceeds its threshold: that is the whole of
    the threshold rule, and all that a renderer without a coverage buffer needs. The tile is
    laid on a torus: strokes over its border come in again on the other side.
    """
    strokes = texture.strokes
    w, h = strokes.width, strokes.height
    sheet = Sheet(np.zeros((1, 1)), w, h, gain_pt)
    lines = curves.sample(strokes.points, strokes.first, curves.pieces_of(strokes.points, strokes.first, STEP_PT))
    lo = np.minimum.reduceat(lines.points, lines.first[:-1])
    hi = np.maximum.reduceat(lines.points, lines.first[:-1])
    pad = strokes.widths[:, None] + gain_pt
    first = np.floor((lo - pad) / (w, h)).astype(np.int64)
    count = np.floor((hi + pad) / (w, h)).astype(np.int64) - first + 1
    copies = count[:, 0] * count[:, 1]
    source = np.repeat(np.arange(len(strokes)), copies)
    k = curves.ramp(copies)
    shift = -(first[source] + np.column_stack([k % count[source, 0], k // count[source, 0]])) * (w, h)
    moved = curves.take(lines, source, shift)
    fresh = np.bincount(source, sheet.newly_inked(moved, strokes.widths[source]), len(strokes))
    total = np.cumsum(fresh)
    return (total - fresh) / float(sheet.rows * sheet.columns * 64)


def darkness(texture: Texture, gain_pt: float) -> float:
    """How dark a stroke of the texture is where it is darkest, low-passed: the median of some early ones."""
    strokes = texture.strokes
    peaks = []
    for i in range(min(9, len(strokes))):
        points = strokes[i] - strokes[i].min(axis=0) + 3 * SIGMA_PT
        width, height = (points.max(axis=0) + 3 * SIGMA_PT).tolist()
        sheet = Sheet(np.zeros((1, 1)), width, height, gain_pt)
        first = np.array([0, len(points)])
        pieces = curves.pieces_of(points, first, STEP_PT)
        sheet.paint(curves.sample(points, first, pieces), strokes.widths[i : i + 1])
        peaks.append(float(sheet.low_pass(sheet.ink).max()))
    return float(median(np.array(peaks))) if peaks else 1.0


def crowd(sheet: Sheet, texture: Texture) -> Cells:
    """See `Sheet.crowd`."""
    return sheet.crowd(SINGLE * darkness(texture, sheet.gain_pt), sheet.low_pass(sheet.tone))


def reach(texture: Texture, gain_pt: float) -> float:
    """The darkest tone that the texture makes, all its strokes drawn."""
    one_more = Strokes(
        texture.strokes.width, texture.strokes.height,
        np.concatenate([texture.strokes.points, np.zeros((1, 2))]),
        np.append(texture.strokes.first, len(texture.strokes.points) + 1), np.append(texture.strokes.widths, 0.001),
    )  # fmt: skip
    return float(thresholds(Texture("", one_more, np.zeros(len(one_more))), gain_pt)[-1])


@dataclass(frozen=True, eq=False)
class Copies:
    """Copies of some of a tile's strokes over a sheet, in order of priority."""

    points: Floats
    first: Ints
    widths: Floats
    enters: Floats


def copies(
    texture: Texture, enters: Floats, sheet: Sheet, seed: int, slack: float, width: float | None
) -> Iterator[Copies]:
    """All copies that touch the sheet and could be wanted, some at a time, the tile's origin drawn from the seed.

    Copies of one stroke come in an order that does not run along the rows of tiles.
    slack: copies are left out where the tone is nowhere along them within this of where they enter.
    """
    tile = texture.strokes
    size = np.array([tile.width, tile.height])
    rng = np.random.default_rng([seed, 1])
    origin = rng.random(2) * size
    pieces = curves.pieces_of(tile.points, tile.first, 4.0)
    probe = curves.sample(tile.points, tile.first, pieces)
    lo = np.minimum.reduceat(probe.points, probe.first[:-1])
    hi = np.maximum.reduceat(probe.points, probe.first[:-1])
    pad = tile.widths[:, None]
    first = np.ceil((-origin - hi - pad) / size).astype(np.int64)
    last = np.floor(((sheet.width, sheet.height) - origin - lo + pad) / size).astype(np.int64)
    across, down = np.maximum(last - first + 1, 0).T
    count = across * down
    total = np.cumsum(count)
    cells = np.array([sheet.columns / sheet.width, sheet.rows / sheet.height])
    begin = 0
    while begin < len(tile):
        done = total[begin - 1] if begin else 0
        end = max(begin + 1, int(np.searchsorted(total, done + CHUNK, side="right")))
        source = np.repeat(np.arange(begin, end), count[begin:end])
        k = curves.ramp(count[begin:end])
        shift = np.column_stack([first[source, 0] + k % across[source], first[source, 1] + k // across[source]]) * size
        order = np.lexsort((rng.random(len(source)), source))
        source, shift = source[order], shift[order] + origin
        begin = end
        if len(source) == 0:
            continue
        where = curves.take(probe, source, shift)
        at = np.floor(where.points * cells).astype(np.int64)
        inside = (at >= 0).all(axis=1) & (at[:, 0] < sheet.columns) & (at[:, 1] < sheet.rows)
        at = np.clip(at, 0, [sheet.columns - 1, sheet.rows - 1])
        tone = np.where(inside, sheet.tone[at[:, 1], at[:, 0]], 0.0)
        wanted = np.maximum.reduceat(tone, where.first[:-1]) + slack > enters[source]
        wanted &= np.maximum.reduceat(tone, where.first[:-1]) > 0.0
        source, shift = source[wanted], shift[wanted]
        if len(source) == 0:
            continue
        part = curves.take(curves.Polylines(tile.points, tile.first), source, shift)
        widths = tile.widths[source] if width is None else np.full(len(source), width)
        yield Copies(part.points, part.first, widths, enters[source])


def blast_tile(
    sheet: Sheet,
    texture: Texture,
    edges: EdgeList | None,
    enters: Floats,
    seed: int,
    strict: bool,
    pen: float | None,
    tick: Callable[[], None],
) -> list[Strokes]:
    """Strokes of the tile, placed by the paper's rule, or in a closed loop that keeps the best of several rounds."""
    if strict:
        sheet.owe_strictly()
        return _place(sheet, texture, enters, seed, True, pen, frame(sheet, texture, pen))
    borders = frame(sheet, texture, pen, None if texture.whole else edges)
    wanted: Cells = sheet.tone.copy()
    many = crowd(sheet, texture)
    best: tuple[float, list[Strokes]] | None = None
    for _ in range(ROUNDS):
        tick()
        sheet.clear()
        sheet.owe(wanted)
        strokes = _place(sheet, texture, enters, seed, False, pen, borders)
        error = sheet.error()
        size = float(np.mean(np.square(error, dtype=np.float64)))
        if best is None or size < best[0]:
            best = size, strokes
        wanted = wanted + sheet.spread(error) * many * many
    assert best is not None
    return best[1]


def frame(sheet: Sheet, texture: Texture, pen: float | None, edges: EdgeList | None = None) -> walls.Walls:
    """Where the texture's strokes must end: at the frame, and at the edges."""
    return walls.build(edges, sheet, pen or float(texture.strokes.widths.max()))


def _place(
    sheet: Sheet,
    texture: Texture,
    enters: Floats,
    seed: int,
    strict: bool,
    pen: float | None,
    borders: walls.Walls,
) -> list[Strokes]:
    """One pass over all copies in order of priority; strokes that may be trimmed end at the borders."""
    out = []
    plain = Terms(strict=strict, whole=texture.whole)
    terms = plain if strict or texture.whole else TRIMMED
    dotted = len(texture.strokes.points) == len(texture.strokes)
    for part in copies(texture, enters, sheet, seed, 2.0 if strict else SLACK_DOTS if dotted else SLACK, pen):
        points, first, widths = part.points, part.first, part.widths
        pieces = curves.pieces_of(points, first, STEP_PT)
        lines = curves.sample(points, first, pieces)
        if not strict:  # in the dark a dot half outside the frame is moved inside, or there would be a white rim
            dots = first[:-1][np.diff(first) == 1]
            at = np.floor(points[dots] * (sheet.columns / sheet.width, sheet.rows / sheet.height)).astype(np.int64)
            at = np.clip(at, 0, (sheet.columns - 1, sheet.rows - 1))
            dots = dots[sheet.tone[at[:, 1], at[:, 0]] > RIM_TONE]
            points[dots] = np.clip(points[dots], borders.box[:2], borders.box[2:])
            lines = curves.sample(points, first, pieces)
        none = np.zeros(len(widths))
        cuts = walls.cut(borders, lines, widths + sheet.gain_pt, (none, none))
        points, first = curves.cut(points, first, pieces, cuts.curve, cuts.start, cuts.end)
        widths, bounded = widths[cuts.curve], cuts.bounded
        pieces = curves.pieces_of(points, first, STEP_PT)
        lines = curves.sample(points, first, pieces)
        n = len(widths)
        if n == 0:
            continue
        batches = [b for b in np.array_split(np.arange(n), max(1, n // 4096)) if len(b)]
        belongs = None if strict else part.enters[cuts.curve]
        runs, moved = sheet.place(lines, widths, batches, terms, bounded, belongs)
        start, end = runs[:, 1].astype(np.float64), runs[:, 2].astype(np.float64)
        points, first = curves.cut(points, first, pieces, runs[:, 0], start, end)
        # a stroke moved sideways may have left the frame by as much
        points = np.clip(points + np.repeat(moved, np.diff(first), axis=0), borders.box[:2], borders.box[2:])
        out.append(Strokes(sheet.width, sheet.height, points, first, widths[runs[:, 0]]))
    return out
