"""Engraving: one layer of lines as far apart everywhere, whose width is the tone.

Lines are level lines of a phase of constant density: along a field (`phase.solve`), straight, wavering, or rings about
a point, whose phases are known. The width of a line is its distance from the next times the tone, less what the device
adds. Where that would be less than the finest line, the line is broken into dashes, and where hardly any white would
be left between two they close: so tone goes on evenly from paper to black. The lines of one round are inked on the
sheet, and what is wrong there as the eye sees it is added to the tone that the next round's widths are made for.

Lines end at strong edges, and free ends taper to a point.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import curves, pen_lines, walls
from penink_cli.blasting.form import PAD, _blurred, _normal
from penink_cli.blasting.level_lines import Lines, level_lines
from penink_cli.blasting.low_pass import LowPass
from penink_cli.blasting.phase import Field, Nodes, Plane, solve
from penink_cli.blasting.sheet import CELL_PT, EYE_PT, Cells, Sheet, halve
from penink_cli.ground.angles import direction
from penink_cli.ground.device import EDGE
from penink_cli.ground.model import EdgeList, Engraving, Floats, Ints, Strokes

Mask = npt.NDArray[np.bool_]

#: Rounds of inking and correcting, and how much of the error a round corrects.
ROUNDS, CORRECTION = 6, 0.7
#: As far as the tone that is drawn may be from any that there is.
REACH = (-0.3, 1.3)
#: Tone from which on lines close up, and how wide they are in parts of their distance where it is black.
MOST, CLOSED = 0.97, 1.5
#: Dashes: least length, and the longest stretch of line that holds one of them; below this tone there are none.
DASH_PT, PERIOD_PT, LONGEST_PERIOD_PT, LEAST_TONE = 2.4, 6.0, 40.0, 0.004
#: Knots are about so far apart, points; lines are sampled this many times as finely.
KNOT_PT = 2.0
#: Free ends taper to this width over so many points, or a share of a short stroke, but the less the darker it is from
#: this width on, in parts of the lines' distance: among dark lines a point leaves a speck of white.
TIP_PT, TAPER_PT, TAPER_SHARE, BLUNT = 0.05, 6.0, 0.4, 0.6
#: Lines shorter than this are left out.
SHORTEST_PT = 2.0
#: Lines come as near to the frame as those of such a pen do. Along it, so far within, runs one that fills what their
#: round ends leave, where it is darker than this.
FRAME_PEN_PT, RIM_PT, RIM_TONE = 1.15, 0.4, 0.6
#: Wavering lines: how far, and how far apart the places are between which they waver.
WAVER_PT, WAVER_LENGTH_PT = 2.5, 9.0


@dataclass(frozen=True, eq=False)
class Tracks:
    """Middle lines in samples about a point apart, cut where strokes must end.

    points: (p, 2). first: (n + 1,). step: (n,) distance of samples. bounded: (n, 2) whether an end is at an edge or
    the frame. rim: (n,) whether it is a line along the frame. across: (p,) what a device adds to a line's width there,
    points.
    """

    points: Floats
    first: Ints
    step: Floats
    bounded: Mask
    rim: Mask
    across: Floats


def engrave(
    sheet: Sheet,
    engraving: Engraving,
    edges: EdgeList | None,
    seed: int,
    field: tuple[Cells, Cells] | None,
    tick: Callable[[], None] = lambda: None,
) -> Strokes:
    """Strokes that swell and give the sheet its tone, together with the ink that is there already.

    field: cosine and sine of twice the angle of the lines in each cell of the sheet; without, and where the engraving
    does not follow it, lines are straight, wavering or rings.
    """
    spacing = engraving.spacing_pt
    if engraving.lines:
        spacing = sheet.width / engraving.lines
    borders = walls.build(edges, sheet, FRAME_PEN_PT)
    tracks = _tracks(sheet, engraving, spacing, borders, seed, field)
    wanted = sheet.tone.astype(np.float64)
    # an engraver's lines go on across steps of tone, and so does what the eye sees of them
    eye = LowPass(EYE_PT / CELL_PT / 2, halve(sheet.tone), 2.0, sheet.each)
    seen = eye(np.ones_like(halve(sheet.tone)))
    rng = np.random.default_rng([seed, 21])
    begin = rng.random(len(tracks.step))
    best: tuple[float, Strokes] | None = None
    for turn in range(ROUNDS):
        tick()
        strokes = _strokes(sheet, engraving, spacing, tracks, wanted, begin)
        sheet.clear()
        _ink(sheet, strokes)
        missing = sheet.tone - sheet.ink
        error = eye(halve(missing)) / seen
        size = float(np.mean(np.square(error, dtype=np.float64)))
        if best is None or size < best[0]:
            best = size, strokes
        if turn < ROUNDS - 1:
            mean = float(np.mean(error, dtype=np.float64))  # what small dark things cannot hold goes to all others
            wanted = wanted + CORRECTION * (sheet.spread(error).astype(np.float64) + 0.4 * mean)
            wanted = np.clip(wanted, *REACH)
    assert best is not None
    return best[1]


# ------------------------------------------------------------------- middle lines


def _tracks(
    sheet: Sheet, engraving: Engraving, spacing: float, borders: walls.Walls, seed: int,
    field: tuple[Cells, Cells] | None,
) -> Tracks:  # fmt: skip
    dx, dy = sheet.width / sheet.columns, sheet.height / sheet.rows
    pad = max(PAD, int(4 * spacing / dx) + 1)
    nodes = Nodes((0.5 - pad) * dx, (0.5 - pad) * dy, dx, dy, sheet.rows + 2 * pad, sheet.columns + 2 * pad)
    if field is not None and engraving.along:
        nx, ny = _normal(*(np.pad(plane, pad, mode="edge") for plane in field))
        asked = Field(nodes, nx, ny, np.full(nx.shape, 1 / spacing, np.float32))
        phase = solve(asked, borders.segments[borders.inside > 0], seed * 7 + 1, sheet.each)
    else:
        asked, phase = _known(nodes, engraving, spacing, sheet, seed)
    lines = pen_lines.evened(level_lines(asked, phase, 0.0, sheet.each), SHORTEST_PT)
    pen_lines.smooth(lines, np.full(len(lines.points), max(spacing, 3.0)))
    return _cut(sheet, lines, borders, spacing)


def _known(nodes: Nodes, engraving: Engraving, spacing: float, sheet: Sheet, seed: int) -> tuple[Field, Plane]:
    """The phase of straight, wavering or ring-shaped lines, and the field that it has."""
    x = (nodes.left + nodes.dx * np.arange(nodes.columns))[None, :]
    y = (nodes.top + nodes.dy * np.arange(nodes.rows))[:, None]
    shape = nodes.rows, nodes.columns
    if engraving.centre is not None:
        px, py = x - engraving.centre[0] * sheet.width, y - engraving.centre[1] * sheet.height
        height = np.sqrt(px * px + py * py)
        away = np.maximum(height, 1e-3)
        gx, gy = px / away, py / away
    else:
        c, s = direction(engraving.angle)
        height = np.broadcast_to(c * y - s * x, shape)
        gx, gy = np.full(shape, -s), np.full(shape, c)
    if engraving.waver:
        noise = np.random.default_rng([seed, 22]).uniform(-1, 1, shape).astype(np.float32)
        noise = _blurred(noise, WAVER_LENGTH_PT / nodes.dx)
        noise = noise / max(float(np.abs(noise).max()), 1e-6) * np.float32(engraving.waver * WAVER_PT)
        height = height + noise
        gy, gx = gy + _slope(noise, 0) / nodes.dy, gx + _slope(noise, 1) / nodes.dx
    grows = np.maximum(np.sqrt(gx * gx + gy * gy), 0.2)
    turns = height / spacing
    phase = (turns - np.floor(turns + 0.5)).astype(np.float32)
    wide = np.zeros(shape)
    return (
        Field(
            nodes,
            np.ascontiguousarray(gx / grows + wide, np.float32),
            np.ascontiguousarray(gy / grows + wide, np.float32),
            np.ascontiguousarray(grows / spacing + wide, np.float32),
        ),
        np.ascontiguousarray(phase),
    )


def _slope(values: Plane, axis: int) -> Floats:
    """How values change from one node to the next."""
    ends = np.concatenate([np.take(values, [0], axis), values, np.take(values, [-1], axis)], axis=axis)
    low, high = (np.take(ends, range(k, ends.shape[axis] - 2 + k), axis) for k in (0, 2))
    return np.asarray((high - low) / 2, np.float64)


def _cut(sheet: Sheet, lines: Lines, borders: walls.Walls, spacing: float) -> Tracks:
    """Lines cut at walls, sampled anew."""
    lines, inner = _with_rim(sheet, lines)
    n = len(lines.ring)
    along = np.asarray(lines.points, np.float64)
    polylines = curves.Polylines(along, lines.first)
    none = np.zeros(n)
    sheet_wide = replace(borders, box=(0.0, 0.0, sheet.width, sheet.height))  # for those along the frame
    parts = walls.cut(sheet_wide, polylines, none + 0.5 * spacing, (none, none))
    length = parts.end - parts.start  # in samples, which are a point or so apart
    half = np.asarray((parts.start + parts.end) / 2, np.float64)
    middle = _along(along, lines.first[parts.curve], half, lines.first[parts.curve + 1] - 1)
    within = ((middle >= borders.box[:2]) & (middle <= borders.box[2:])).all(axis=1) | (parts.curve >= inner)
    long = (length * pen_lines.STEP_PT >= SHORTEST_PT) & within
    curve, start, end, bounded = parts.curve[long], parts.start[long], parts.end[long], parts.bounded[long]
    steps = np.maximum(2, np.ceil(end - start)).astype(np.int64)
    first = curves.starts(steps + 1)
    which = np.repeat(np.arange(len(curve)), steps + 1)
    at = start[which] + (end - start)[which] * (curves.ramp(steps + 1) / steps[which])
    points = _along(along, lines.first[curve][which], at, lines.first[curve + 1][which] - 1)
    legs = np.sqrt((np.diff(points, axis=0) ** 2).sum(axis=1))
    legs = np.append(legs, 0.0)
    legs[first[1:] - 1] = 0.0
    step = np.add.reduceat(legs, first[:-1]) / steps if len(steps) else np.zeros(0)
    ahead = _ahead(points, first)
    across = sheet.gain_pt * EDGE * np.abs(ahead).sum(axis=1)
    return Tracks(points, first, step, np.column_stack([bounded & 1, bounded & 2]) > 0, curve >= inner, across)


def _with_rim(sheet: Sheet, lines: Lines) -> tuple[Lines, int]:
    """The lines and four more along the frame; and how many there were."""
    w, h, d = sheet.width, sheet.height, RIM_PT
    corners = np.array([[d, d], [w - d, d], [w - d, h - d], [d, h - d], [d, d]])
    sides = []
    for a, b in pairwise(corners):
        steps = max(2, round(float(np.abs(b - a).sum()) / pen_lines.STEP_PT))
        sides.append(a + (b - a) * (np.arange(steps + 1) / steps)[:, None])
    sizes = np.concatenate([np.diff(lines.first), [len(side) for side in sides]])
    ring = np.concatenate([lines.ring, np.zeros(4, bool)])
    return Lines(np.concatenate([lines.points, *sides]), curves.starts(sizes), ring), len(lines.ring)


def _along(points: Floats, origin: Ints, at: Floats, last: Ints) -> Floats:
    """Points at places `at` (n,), in samples from the sample `origin` on, up to the sample `last`."""
    low = np.minimum(origin + np.maximum(np.floor(at), 0).astype(np.int64), np.maximum(last - 1, origin))
    part = np.clip(at - (low - origin), 0.0, 1.0)[:, None]
    return points[low] * (1 - part) + points[np.minimum(low + 1, last)] * part


def _ahead(points: Floats, first: Ints) -> Floats:
    """Unit vectors along polylines at their samples."""
    before, after = np.arange(len(points)) - 1, np.arange(len(points)) + 1
    before[first[:-1]] = first[:-1]
    after[first[1:] - 1] = first[1:] - 1
    chord = points[after] - points[before]
    length = np.sqrt((chord * chord).sum(axis=1))[:, None]
    return chord / np.maximum(length, 1e-9)


# ------------------------------------------------------------------- widths


def _strokes(
    sheet: Sheet, engraving: Engraving, spacing: float, tracks: Tracks, wanted: Floats, begin: Floats
) -> Strokes:
    """The strokes that the tone wanted (rows, columns) asks for along the tracks, whose dashes begin at begin (n,)."""
    which = np.repeat(np.arange(len(tracks.step)), np.diff(tracks.first))
    tone = _at_points(sheet, wanted, tracks.points)
    tone = _smoothed(tone, tracks.first)
    finest = (engraving.finest_pt + tracks.across) / spacing
    # dashes: the share of the line that is drawn, and how often
    duty = np.clip(tone / finest, 0.0, 1.0)
    period = np.clip(DASH_PT / np.maximum(duty, 1e-3), PERIOD_PT, LONGEST_PERIOD_PT)
    drawn = (duty >= 1) | ((_saw(tracks, which, period, begin) < duty) & (tone > LEAST_TONE))
    width = np.clip(tone, finest, MOST) * spacing - tracks.across
    # and on, from where white hardly shows, until none is left
    width = width + np.clip((tone - MOST) / (1 - MOST), 0.0, 1.0) * (CLOSED * spacing - width)
    width = _smoothed(width, tracks.first)
    rim = tracks.rim[which]
    dark = np.clip((tone - RIM_TONE) / (1 - RIM_TONE), 0.0, 1.0)
    room = np.minimum(tracks.points, (sheet.width, sheet.height) - tracks.points).min(axis=1)
    drawn = np.where(rim, dark > 0.05, drawn)
    width = np.minimum(np.where(rim, 2 * RIM_PT * dark, width), np.maximum(2 * room - 0.1, 0.1))
    return _runs(sheet, engraving, spacing, tracks, which, drawn, width)


def _saw(tracks: Tracks, which: Ints, period: Floats, begin: Floats) -> Floats:
    """(p,) 0 … 1 along the tracks, over and over, once in each period (p,), points."""
    turns = np.cumsum(tracks.step[which] / period)
    turns = turns - turns[tracks.first[:-1]][which] + begin[which]
    return turns - np.floor(turns)


def _smoothed(values: Floats, first: Ints) -> Floats:
    """Means with weights 1 2 1 along each polyline."""
    before, after = np.arange(len(values)) - 1, np.arange(len(values)) + 1
    before[first[:-1]] = first[:-1]
    after[first[1:] - 1] = first[1:] - 1
    return (values[before] + 2 * values + values[after]) / 4


def _at_points(sheet: Sheet, values: Floats, points: Floats) -> Floats:
    """Values (rows, columns) of the sheet's cells at points (p, 2), bilinear."""
    x = np.clip(points[:, 0] * (sheet.columns / sheet.width) - 0.5, 0, sheet.columns - 1)
    y = np.clip(points[:, 1] * (sheet.rows / sheet.height) - 0.5, 0, sheet.rows - 1)
    j, i = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    u, v = x - j, y - i
    k, m = np.minimum(j + 1, sheet.columns - 1), np.minimum(i + 1, sheet.rows - 1)
    top = values[i, j] * (1 - u) + values[i, k] * u
    bottom = values[m, j] * (1 - u) + values[m, k] * u
    return top * (1 - v) + bottom * v


def _runs(
    sheet: Sheet, engraving: Engraving, spacing: float, tracks: Tracks, which: Ints, drawn: Mask, width: Floats
) -> Strokes:
    """Strokes of the runs of samples that are drawn, a knot every `KNOT_PT` or so, their free ends tapered."""
    key = np.concatenate([[-1], np.where(drawn, which, -1), [-1]])
    change = np.flatnonzero(key[1:] != key[:-1])
    low = change[key[change + 1] >= 0]
    if not len(low):
        return Strokes(sheet.width, sheet.height)
    high = change[np.searchsorted(change, low) + 1] - 1
    track = which[low]
    begin, end = tracks.first[track], tracks.first[track + 1] - 1
    # half a step beyond the samples drawn, within the track
    a = np.maximum(low - 0.5, begin) - begin
    b = np.minimum(high + 0.5, end) - begin
    length = (b - a) * tracks.step[track]
    segments = np.maximum(np.where(length > 1.5, 2, 1), np.rint(length / KNOT_PT)).astype(np.int64)
    first = curves.starts(segments + 1)
    run = np.repeat(np.arange(len(low)), segments + 1)
    part = curves.ramp(segments + 1) / segments[run]
    at = a[run] + (b - a)[run] * part
    origin, last = begin[run], end[run]
    knots = _along(tracks.points, origin, at, last)
    widths = _along(width[:, None], origin, at, last)[:, 0]
    if not engraving.blunt:
        free = np.column_stack([(low > begin) | ~tracks.bounded[track, 0], (high < end) | ~tracks.bounded[track, 1]])
        taper = np.minimum(TAPER_PT, TAPER_SHARE * length)[run]
        for side, way in ((0, part), (1, 1 - part)):
            inward = np.clip(way * length[run] / np.maximum(taper, 1e-6), 0.0, 1.0)
            inward = np.maximum(inward, np.clip((widths / spacing - BLUNT) / (1 - BLUNT), 0.0, 1.0))
            thin = np.minimum(TIP_PT, widths) * (1 - inward) + widths * inward
            widths = np.where(free[run, side], thin, widths)
    ahead = _ahead(tracks.points, tracks.first)
    lean = _along(ahead, origin, at, last)
    third = np.repeat((length / segments)[run] / 3, 1)[:, None]
    points = np.empty((len(knots), 3, 2))
    points[:, 0], points[:, 1], points[:, 2] = knots - lean * third, knots, knots + lean * third
    inner = np.ones((len(knots), 3), bool)
    inner[first[:-1], 0] = inner[first[1:] - 1, 2] = False
    strokes = Strokes(
        sheet.width, sheet.height, points[inner], curves.starts(3 * segments + 1), np.ones(len(low))
    ).swelling(np.maximum(widths, 0.01))
    return strokes.rounded()


def _ink(sheet: Sheet, strokes: Strokes) -> None:
    """Ink the strokes on the sheet, each segment as wide as it is on the average."""
    if not len(strokes):
        return
    segments = np.diff(strokes.first) // 3
    knot = np.repeat(strokes.first[:-1] - 3 * strokes.knots[:-1], segments + 1) + 3 * np.arange(strokes.knots[-1])
    at, widths = strokes.points[knot], strokes.at_knots
    start = np.delete(np.arange(len(at)), strokes.knots[1:] - 1)
    pairs = np.stack([at[start], at[start + 1]], axis=1).reshape(-1, 2)
    sheet.paint(curves.Polylines(pairs, 2 * np.arange(len(start) + 1)), (widths[start] + widths[start + 1]) / 2)
