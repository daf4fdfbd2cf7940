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
from dataclasses import dataclass, fields, replace

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import curves, pen_lines, rims, walls
from penink_cli.blasting.form import PAD, _blurred, _normal
from penink_cli.blasting.level_lines import LevelLines, level_lines
from penink_cli.blasting.low_pass import LowPass
from penink_cli.blasting.phase import Field, Nodes, Plane, solve
from penink_cli.blasting.sheet import CELL_PT, EYE_PT, Cells, Sheet, halve
from penink_cli.blasting.taking_turns import LEVELS, distances, levels
from penink_cli.ground.angles import direction
from penink_cli.ground.device import FILLED
from penink_cli.ground.model import EdgeList, Engraving, Floats, Ints, Strokes

Mask = npt.NDArray[np.bool_]

#: Rounds of inking and correcting, and how much of the error a round corrects.
ROUNDS, CORRECTION = 6, 0.7
#: As far as the tone that is drawn may be from any that there is.
REACH = (-0.3, 1.3)
#: Tone from which on lines close up, and how wide they are in parts of their distance where it is black.
MOST, CLOSED = 0.97, 1.5
#: Dashes and the gaps between them: length, so far as the shortest and longest stretch of line that holds one of each
#: allow; the least gap; below this tone there are no dashes.
DASH_PT, GAP_PT, PERIOD_PT, LONGEST_PERIOD_PT, LEAST_GAP_PT, LEAST_TONE = 3.0, 5.0, 12.0, 40.0, 0.7, 0.004
#: Whether a line breaks up is decided by the mean over so many samples each way; not where it is so many times as dark.
CALM, SURELY = 5, 1.6
#: Samples whose widths are made at once.
CHUNK = 1 << 16
#: Knots are about so far apart, points; lines are sampled this many times as finely.
KNOT_PT = 2.0
#: Free ends taper to this width over so many points, or a share of a short stroke, but the less the darker it is from
#: this width on, in parts of the lines' distance: among dark lines a point leaves a speck of white.
TIP_PT, TAPER_PT, TAPER_SHARE, BLUNT = 0.05, 6.0, 0.4, 0.25
#: Where a line goes on after a gap, points are no longer than so many times the gap.
TAPER_GAP = 1.2
#: Lines shorter than this are left out.
SHORTEST_PT = 2.0
#: Lines come as near to the frame as those of such a pen do, and to an edge as those of this one, for they narrow
#: before it.
FRAME_PEN_PT, END_PT = 1.15, 0.3
#: So near to an edge the tone is that of a place so far from it on the same side, for it is blurred across the edge;
#: save where another edge is nearer than such a part.
CLEAR_PT, THIN = 1.5, 0.6
#: Lines along a field are moved so many times by such a part of how much further they are from one neighbour.
EVENINGS, EVENED = 5, 0.18
#: Their ends are prolonged by so many samples at the most, while lines there are as far apart as this part of their
#: distance.
PROLONGED, ROOM = 5, 0.78
#: A second set of lines is turned so far from the first.
CROSS_ANGLE = 55.0
#: Wavering lines: how far, and how far apart the places are between which they waver.
WAVER_PT, WAVER_LENGTH_PT = 2.5, 9.0


@dataclass(frozen=True, eq=False)
class Tracks:
    """Middle lines in samples about a point apart, cut where strokes must end.

    points: (p, 2). first: (n + 1,). step: (n,) distance of samples. bounded: (n, 2) whether an end is at an edge or
    the frame, or a ring's. rim: (n, 3) how wide a line along a border is where it is dark, from and to which tone it
    becomes so; nought for other lines. across: (p,) what a device adds to a line's width there, points. ahead: (p, 2)
    directions. level, apart: (p,) see `levels` and `distances` in `taking_turns`. asked: (p, 2) where the tone is
    read. room: (p,) how wide a line may be that does not reach over an edge.
    """

    points: Floats
    first: Ints
    step: Floats
    bounded: Mask
    rim: Floats
    across: Floats
    ahead: Floats
    level: npt.NDArray[np.int8]
    apart: Floats
    asked: Floats
    room: Floats

    def some(self, low: int, high: int) -> Tracks:
        """Those from low to high."""
        a, b = self.first[low], self.first[high]
        of_lines = {"step", "bounded", "rim"}
        parts = {
            part.name: getattr(self, part.name)[low:high] if part.name in of_lines else getattr(self, part.name)[a:b]
            for part in fields(self)
        }
        return Tracks(**parts | {"first": self.first[low : high + 1] - a})

    def and_then(self, others: Tracks) -> Tracks:
        """These and others."""
        both = [np.concatenate([getattr(self, part.name), getattr(others, part.name)]) for part in fields(self)]
        both[1] = np.concatenate([self.first, self.first[-1] + others.first[1:]])
        return Tracks(*both)


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
    sets = [_tracks(sheet, engraving, spacing, borders, seed, field)]
    if engraving.crosses < 1:
        c, s = (np.float32(part) for part in direction(2 * CROSS_ANGLE))
        across = None if field is None else (field[0] * c - field[1] * s, field[1] * c + field[0] * s)
        second = replace(engraving, angle=engraving.angle + CROSS_ANGLE, centre=None)
        sets.append(_tracks(sheet, second, spacing, borders, seed + 1, across, rim=False))
    wanted = sheet.tone.astype(np.float64)
    # an engraver's lines go on across steps of tone, and so does what the eye sees of them
    eye = LowPass(EYE_PT / CELL_PT / 2, halve(sheet.tone), 2.0, sheet.each)
    seen = eye(np.ones_like(halve(sheet.tone)))
    rng = np.random.default_rng([seed, 21])
    begin = [rng.random(len(tracks.step)) for tracks in sets]
    best: tuple[float, Strokes] | None = None
    for turn in range(ROUNDS):
        tick()
        strokes = Strokes.joined(
            [
                some
                for tracks, part, at in zip(sets, _parts(wanted, engraving.crosses), begin)
                for some in _drawn(sheet, engraving, spacing, tracks, part, at)
            ]
        )
        sheet.clear()
        sheet.swell(strokes)
        missing = sheet.tone - sheet.ink
        error = eye(halve(missing)) / seen
        size = float(np.mean(np.square(error, dtype=np.float64)))
        if best is None or size < best[0]:
            best = size, strokes
        if turn < ROUNDS - 1:
            wanted = wanted + CORRECTION * sheet.spread(error).astype(np.float64)
            wanted = np.clip(wanted, *REACH)
    assert best is not None
    return best[1]


def _parts(tone: Floats, crosses: float) -> list[Floats]:
    """What each set of lines covers (rows, columns): above the tone from which on they cross, both grow."""
    first = np.where(tone > crosses, crosses + (tone - crosses) / 2, tone)
    return [first, np.where(tone > crosses, 1 - (1 - tone) / np.maximum(1 - first, 1e-3), 0.0)]


# ------------------------------------------------------------------- middle lines


def _tracks(
    sheet: Sheet, engraving: Engraving, spacing: float, borders: walls.Walls, seed: int,
    field: tuple[Cells, Cells] | None, rim: bool = True,
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
    if field is not None and engraving.along:
        lines = _evened_out(lines, spacing)
    pen_lines.turn_rings(lines, seed)
    return _cut(sheet, lines, borders, spacing, engraving.finest_pt, rim)


def _evened_out(lines: LevelLines, spacing: float) -> LevelLines:
    """Lines moved to about the middle between their neighbours, ends prolonged between two that close up.

    So where a line ends, what is white beside it is a point and no gap.
    """
    lines = _prolonged(lines)
    points: Floats = np.asarray(lines.points, np.float64)
    for _ in range(EVENINGS):
        points, _, _ = _moved(points, lines.first, spacing)
    # of what was added that is kept which has room
    _, apart, both = _moved(points, lines.first, spacing)
    sizes = np.diff(lines.first)
    at = curves.ramp(sizes)
    back = np.repeat(sizes, sizes) - 1 - at
    inner = np.where(np.repeat(lines.ring, sizes), PROLONGED, np.minimum(at, back))
    kept = (inner >= PROLONGED) | (both & (apart > ROOM * spacing))
    for out in range(PROLONGED - 1, -1, -1):
        for place, step in ((at, 1), (back, -1)):
            these = np.flatnonzero((place == out) & (inner == out))
            kept[these] &= kept[these + step]
    sizes = np.add.reduceat(kept.astype(np.int64), lines.first[:-1]) if len(sizes) else sizes
    points, first = points[kept], curves.starts(sizes)
    for _ in range(EVENINGS):
        points, _, _ = _moved(points, first, spacing)
    return LevelLines(points, first, lines.ring)


def _moved(points: Floats, first: Ints, spacing: float) -> tuple[Floats, Floats, Mask]:
    """Lines moved towards the middle between their neighbours; and what `distances` tells of them before."""
    ahead = _ahead(points, first)
    normals = np.column_stack([-ahead[:, 1], ahead[:, 0]])
    apart, more, both = distances(points, first, normals, spacing)
    return points + normals * (EVENED * _mean_along(more, first, 4))[:, None], apart, both


def _prolonged(lines: LevelLines) -> LevelLines:
    """Lines with so many more samples straight on at the ends of those that are no rings."""
    sizes = np.diff(lines.first)
    more = np.where(lines.ring, 0, PROLONGED)
    first = curves.starts(sizes + 2 * more)
    at = curves.ramp(sizes + 2 * more) - np.repeat(more, sizes + 2 * more)
    which = np.repeat(np.arange(len(sizes)), sizes + 2 * more)
    last = sizes[which] - 1
    inside = np.clip(at, 0, last)
    beyond = (at - inside)[:, None]
    points = np.asarray(lines.points, np.float64)
    ahead = _ahead(points, lines.first)[lines.first[which] + inside]
    step = pen_lines.STEP_PT
    return LevelLines(points[lines.first[which] + inside] + ahead * (beyond * step), first, lines.ring)


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


def _cut(
    sheet: Sheet, lines: LevelLines, borders: walls.Walls, spacing: float, finest_pt: float, rim_lines: bool
) -> Tracks:
    """Lines cut at walls, sampled anew; and those along borders."""
    along = np.asarray(lines.points, np.float64)
    none = np.zeros(len(lines.ring))
    parts = walls.cut(borders, curves.Polylines(along, lines.first), none + END_PT, (none, none))
    # in samples, which are a point or so apart
    long = (parts.end - parts.start) * pen_lines.STEP_PT >= SHORTEST_PT
    curve, start, end, bounded = parts.curve[long], parts.start[long], parts.end[long], parts.bounded[long]
    steps = np.maximum(2, np.ceil(end - start)).astype(np.int64)
    which = np.repeat(np.arange(len(curve)), steps + 1)
    at = start[which] + (end - start)[which] * (curves.ramp(steps + 1) / steps[which])
    points = _along(along, lines.first[curve][which], at, lines.first[curve + 1][which] - 1)
    first = curves.starts(steps + 1)
    tracks = _measured(sheet, borders, points, first, spacing)
    # a ring goes on where it began
    ring, last = lines.ring[curve], np.diff(lines.first)[curve] - 1
    tracks.bounded[:, 0], tracks.bounded[:, 1] = bounded & 1 | ring & (start <= 0), bounded & 2 | ring & (end >= last)
    normals = np.column_stack([-tracks.ahead[:, 1], tracks.ahead[:, 0]])
    finest = (finest_pt + tracks.across) / spacing
    light = 1 - np.clip(_at_points(sheet, sheet.tone.astype(np.float64), tracks.asked) / finest / 2, 0.0, 1.0)
    tracks.level[:] = levels(points, first, normals, light, spacing)
    tracks.apart[:] = _mean_along(distances(points, first, normals, spacing)[0], first, 2)
    if not rim_lines:
        return tracks
    frame, inner = rims.along_frame(sheet.width, sheet.height), rims.along_edges(borders, sheet.tone)
    size = np.array([len(line) for line in (*frame, *inner)])
    others = _measured(sheet, borders, np.concatenate([*frame, *inner]), curves.starts(size), spacing)
    others.rim[: len(frame)], others.rim[len(frame) :] = rims.FRAME, rims.EDGE
    others.bounded[:] = True
    return tracks.and_then(others)


def _measured(sheet: Sheet, borders: walls.Walls, points: Floats, first: Ints, spacing: float) -> Tracks:
    """Tracks that end nowhere at a border, as if alone."""
    n = len(first) - 1
    legs = np.sqrt((np.diff(points, axis=0) ** 2).sum(axis=1))
    legs = np.append(legs, 0.0)
    legs[first[1:] - 1] = 0.0
    step = np.add.reduceat(legs, first[:-1]) / (np.diff(first) - 1) if n else np.zeros(0)
    ahead = _ahead(points, first)
    across = sheet.gain_pt * FILLED * np.abs(ahead).sum(axis=1)
    reach = max(CLEAR_PT, spacing * CLOSED / 2)
    beside = walls.beside(borders, points, reach)
    push = np.where(beside.away < CLEAR_PT, CLEAR_PT - beside.away, 0.0)
    asked = points + push[:, None] * beside.out
    # not so where another edge is near: what is as thin as that has no tone of its own
    moved = np.flatnonzero(push)
    thin = moved[walls.beside(borders, asked[moved], THIN * CLEAR_PT).away < THIN * CLEAR_PT]
    asked[thin] = points[thin]
    return Tracks(
        points, first, step, np.zeros((n, 2), bool), np.zeros((n, 3)), across, ahead,
        np.zeros(len(points), np.int8), np.full(len(points), spacing), asked, 2 * beside.away - across,
    )  # fmt: skip


def _along(points: Floats, origin: Ints, at: Floats, last: Ints) -> Floats:
    """Points at places `at` (n,), in samples from the sample `origin` on, up to the sample `last`."""
    low = np.minimum(origin + np.maximum(np.floor(at), 0).astype(np.int64), np.maximum(last - 1, origin))
    part = np.clip(at - (low - origin), 0.0, 1.0)[:, None]
    return points[low] * (1 - part) + points[np.minimum(low + 1, last)] * part


def _ahead(points: Floats, first: Ints) -> Floats:
    """Unit vectors along polylines at their samples."""
    chord = np.zeros_like(points)
    if len(points) > 2:
        np.subtract(points[2:], points[:-2], out=chord[1:-1])
    start, end = first[:-1], first[1:] - 1
    chord[start] = points[np.minimum(start + 1, end)] - points[start]
    chord[end] = points[end] - points[np.maximum(end - 1, start)]
    x, y = chord[:, 0], chord[:, 1]
    chord /= np.maximum(np.sqrt(x * x + y * y), 1e-9)[:, None]
    return chord


# ------------------------------------------------------------------- widths


def _drawn(
    sheet: Sheet, engraving: Engraving, spacing: float, tracks: Tracks, wanted: Floats, begin: Floats
) -> list[Strokes]:
    """`_strokes` of so many tracks at once as keeps the memory small, on threads."""
    cuts = np.searchsorted(tracks.first, np.arange(CHUNK, int(tracks.first[-1]), CHUNK)).tolist()
    cuts = sorted({0, *cuts, len(tracks.step)})
    out = [Strokes(sheet.width, sheet.height)] * (len(cuts) - 1)

    def draw(i: int) -> None:
        low, high = cuts[i : i + 2]
        out[i] = _strokes(sheet, engraving, spacing, tracks.some(low, high), wanted, begin[low:high])

    sheet.each(draw, range(len(out)))
    return out


def _strokes(
    sheet: Sheet, engraving: Engraving, spacing: float, tracks: Tracks, wanted: Floats, begin: Floats
) -> Strokes:
    """The strokes that the tone wanted (rows, columns) asks for along the tracks, whose dashes begin at begin (n,)."""
    which = np.repeat(np.arange(len(tracks.step)), np.diff(tracks.first))
    tone = _at_points(sheet, wanted, tracks.asked)
    tone = _smoothed(tone, tracks.first)
    finest = (engraving.finest_pt + tracks.across) / tracks.apart
    width = np.clip(tone, finest, MOST) * tracks.apart - tracks.across
    # and on, from where white hardly shows, until none is left
    width = width + np.clip((tone - MOST) / (1 - MOST), 0.0, 1.0) * (CLOSED * tracks.apart - width)
    width = _smoothed(width, tracks.first)
    duty, saw = _dashes(engraving, tracks, which, tone, finest, begin)
    full, low, high = tracks.rim[which].T
    rim = full > 0
    dark = np.clip((tone - low) / np.where(rim, high - low, 1.0), 0.0, 1.0)
    room = np.minimum(tracks.points, (sheet.width, sheet.height) - tracks.points).min(axis=1)
    duty = np.where(rim, np.where(dark > 0.05, 1.0, 0.0), duty)
    width = np.where(rim, full * dark, width)
    width = np.minimum(width, np.maximum(np.minimum(2 * room - 0.1, tracks.room), TIP_PT))
    return _runs(sheet, engraving, spacing, tracks, which, duty, saw, width)


def _dashes(
    engraving: Engraving, tracks: Tracks, which: Ints, tone: Floats, finest: Floats, begin: Floats
) -> tuple[Floats, Floats]:
    """What part (p,) of the line is drawn, where the finest line would be darker than the tone (p,); and the saw.

    Of two neighbours one goes on while the other breaks up and leaves off, of those that are left one, and so on. A
    line is drawn where its saw is below its part; that allows for what dashes lose by their pointed ends.
    """
    share = _mean_along(tone / finest, tracks.first, CALM)
    # of the first that leave off each makes half of the tone, of the next a quarter …
    halved = np.array([1 << LEVELS, *(1 << k for k in range(1, LEVELS + 1))], np.float64)[tracks.level]
    share = np.clip(share * halved - (tracks.level > 0), 0.0, 1.0)
    period = np.maximum(DASH_PT / np.maximum(share, 1e-3), GAP_PT / np.maximum(1 - share, 1e-3))
    period = np.clip(period, PERIOD_PT, LONGEST_PERIOD_PT)
    duty = share
    if not engraving.blunt:
        lost = (engraving.finest_pt - min(TIP_PT, engraving.finest_pt)) / (engraving.finest_pt + tracks.across)
        gap = period * (1 - share) / (1 + TAPER_GAP * lost)
        taper = np.minimum(np.minimum(TAPER_PT, TAPER_GAP * gap), TAPER_SHARE * period * share)
        duty = share + lost * taper / period
    duty = np.where((1 - duty) * period < LEAST_GAP_PT, 1.0, duty)
    duty = np.where(tone >= SURELY * finest, 1.0, np.where(tone > LEAST_TONE, duty, 0.0))
    return duty, _saw(tracks, which, period, begin)


def _mean_along(values: Floats, first: Ints, reach: int) -> Floats:
    """Means over so many samples each way along each polyline, as far as it goes."""
    total = np.concatenate([[0.0], np.cumsum(values)])
    who = np.repeat(np.arange(len(first) - 1), np.diff(first))
    at = np.arange(len(values))
    low, high = np.maximum(at - reach, first[who]), np.minimum(at + reach + 1, first[who + 1])
    return np.asarray((total[high] - total[low]) / (high - low), np.float64)


def _saw(tracks: Tracks, which: Ints, period: Floats, begin: Floats) -> Floats:
    """(p,) 0 … 1 along the tracks, over and over, once in each period (p,), points."""
    turns = np.cumsum(tracks.step[which] / period)
    turns = turns - turns[tracks.first[:-1]][which] + begin[which]
    return turns - np.floor(turns)


def _between(saw: Floats, duty: Floats, at: Ints) -> Floats:
    """How far from samples `at` to the next a line begins or leaves off, 0 … 1."""
    before, after = saw[at], saw[at + 1]
    less, more = np.abs(before - duty[at]), np.abs(after - duty[at + 1])
    wrapped = after < before
    less, more = np.where(wrapped, 1 - before, less), np.where(wrapped, after, more)
    return np.asarray(less / np.maximum(less + more, 1e-9), np.float64)


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
    sheet: Sheet, engraving: Engraving, spacing: float, tracks: Tracks, which: Ints, duty: Floats, saw: Floats,
    width: Floats,
) -> Strokes:  # fmt: skip
    """Strokes of the runs of samples that are drawn, a knot every `KNOT_PT` or so, their free ends tapered."""
    drawn = (saw < duty) & (duty > 0)
    key = np.concatenate([[-1], np.where(drawn, which, -1), [-1]])
    change = np.flatnonzero(key[1:] != key[:-1])
    low = change[key[change + 1] >= 0]
    if not len(low):
        return Strokes(sheet.width, sheet.height)
    high = change[np.searchsorted(change, low) + 1] - 1
    track = which[low]
    begin, end = tracks.first[track], tracks.first[track + 1] - 1
    # on to where the saw is as high as the part to be drawn, within the track
    a = low - np.where(low > begin, 1 - _between(saw, duty, np.maximum(low - 1, begin)), 0.0) - begin
    b = high + np.where(high < end, _between(saw, duty, np.minimum(high, end - 1)), 0.0) - begin
    gap = np.full(len(low) + 1, np.inf)  # before each run
    gap[1:-1] = np.where(track[1:] == track[:-1], (a[1:] - b[:-1]) * tracks.step[track[1:]], np.inf)
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
        for side, way in ((0, part), (1, 1 - part)):
            taper = np.minimum(np.minimum(TAPER_PT, TAPER_SHARE * length), TAPER_GAP * gap[side : len(low) + side])[run]
            inward = np.clip(way * length[run] / np.maximum(taper, 1e-6), 0.0, 1.0)
            inward = np.maximum(inward, np.clip((widths / spacing - BLUNT) / (1 - BLUNT), 0.0, 1.0))
            thin = np.minimum(TIP_PT, widths) * (1 - inward) + widths * inward
            widths = np.where(free[run, side], thin, widths)
    lean = _along(tracks.ahead, origin, at, last)
    third = np.repeat((length / segments)[run] / 3, 1)[:, None]
    points = np.empty((len(knots), 3, 2))
    points[:, 0], points[:, 1], points[:, 2] = knots - lean * third, knots, knots + lean * third
    inner = np.ones((len(knots), 3), bool)
    inner[first[:-1], 0] = inner[first[1:] - 1, 2] = False
    strokes = Strokes(
        sheet.width, sheet.height, points[inner], curves.starts(3 * segments + 1), np.ones(len(low))
    ).swelling(np.maximum(widths, 0.01))
    return strokes.rounded()
