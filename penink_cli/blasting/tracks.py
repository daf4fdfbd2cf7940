"""The middle lines of an engraving: where its lines run, what bounds them, and the tone that each is to have.

Lines are level lines of a phase of constant density: along a field (`phase.solve`), straight, wavering, or rings about
a point, whose phases are known. Those along a field are moved to about the middle between their neighbours. All are cut
at walls. Other lines run along borders (`rims`).
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import curves, joining, pen_lines, polylines, rims, walls
from penink_cli.blasting.form import PAD, box_blurred, normal
from penink_cli.blasting.level_lines import LevelLines, level_lines
from penink_cli.blasting.phase import Field, Nodes, Plane, solve
from penink_cli.blasting.sheet import Cells, Sheet, look_up
from penink_cli.blasting.taking_turns import distances, levels
from penink_cli.ground.angles import direction
from penink_cli.ground.device import FILLED
from penink_cli.ground.model import Engraving, Floats, Ints

Mask = npt.NDArray[np.bool_]

#: Where it is black lines are so wide, in parts of their distance.
CLOSED = 1.5
#: Lines shorter than this are left out.
SHORTEST_PT = 2.0
#: Lines come as near to the frame as those of such a pen do, and to an edge as those of this one, for they narrow
#: before it.
FRAME_PEN_PT, END_PT = 1.15, 0.3
#: The tone is blurred across edges. Nearer to one than this, tone is read this far from it, on the same side. Not so
#: where another edge is nearer than such a part of that: a thing as thin has no tone of its own.
CLEAR_PT, THIN = 1.5, 0.6
#: Lines along a field are moved so many times by such a part of how much further they are from one neighbour.
EVENINGS, EVENED = 5, 0.18
#: At last they are smoothed as if so far apart, points.
SMOOTHED = 3.0
#: Their ends are prolonged by so many samples at the most, while lines there are as far apart as this part of their
#: distance.
PROLONGED, ROOM = 5, 0.78
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


def laid(
    sheet: Sheet, engraving: Engraving, spacing: float, borders: walls.Walls, seed: int,
    field: tuple[Cells, Cells] | None, rim: bool = True,
) -> Tracks:  # fmt: skip
    """The middle lines of one set.

    spacing: of the lines, points. borders: edges and the frame. field: as of `engraving.engrave`. rim: whether lines
    run along borders too.
    """
    dx, dy = sheet.width / sheet.columns, sheet.height / sheet.rows
    pad = max(PAD, int(4 * spacing / dx) + 1)
    nodes = Nodes((0.5 - pad) * dx, (0.5 - pad) * dy, dx, dy, sheet.rows + 2 * pad, sheet.columns + 2 * pad)
    if field is not None and engraving.along:
        nx, ny = normal(*(np.pad(plane, pad, mode="edge") for plane in field))
        asked = Field(nodes, nx, ny, np.full(nx.shape, 1 / spacing, np.float32))
        phase = solve(asked, borders.segments[borders.inside > 0], seed * 7 + 1, sheet.each)
    else:
        asked, phase = _known(nodes, engraving, spacing, sheet, seed)
    lines = pen_lines.evened(level_lines(asked, phase, 0.0, sheet.each), SHORTEST_PT)
    if field is not None and engraving.along:
        lines = joining.joined(lines, spacing)
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
    moved = LevelLines(points, first, lines.ring)
    pen_lines.smooth(moved, np.full(len(points), SMOOTHED))
    return moved


def _moved(points: Floats, first: Ints, spacing: float) -> tuple[Floats, Floats, Mask]:
    """Lines moved towards the middle between their neighbours; and what `distances` tells of them before."""
    normals = polylines.normals(points, first)
    apart, more, both = distances(points, first, normals, spacing)
    return points + normals * (EVENED * polylines.mean_along(more, first, 4))[:, None], apart, both


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
    ahead = polylines.ahead(points, lines.first)[lines.first[which] + inside]
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
        noise = box_blurred(noise, WAVER_LENGTH_PT / nodes.dx)
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
    points = polylines.between(along, lines.first[curve][which], at, lines.first[curve + 1][which] - 1)
    first = curves.starts(steps + 1)
    tracks = _measured(sheet, borders, points, first, spacing)
    # a ring goes on where it began
    ring, last = lines.ring[curve], np.diff(lines.first)[curve] - 1
    tracks.bounded[:, 0], tracks.bounded[:, 1] = bounded & 1 | ring & (start <= 0), bounded & 2 | ring & (end >= last)
    normals = np.column_stack([-tracks.ahead[:, 1], tracks.ahead[:, 0]])
    finest = (finest_pt + tracks.across) / spacing
    tone = look_up(sheet.tone.astype(np.float64), tracks.asked, sheet.width, sheet.height)
    light = 1 - np.clip(tone / finest / 2, 0.0, 1.0)
    tracks.level[:] = levels(points, first, normals, light, spacing)
    tracks.apart[:] = polylines.mean_along(distances(points, first, normals, spacing)[0], first, 2)
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
    ahead = polylines.ahead(points, first)
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
