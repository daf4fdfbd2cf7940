"""Where strokes must end: strong discontinuity edges, and the frame.

This module alone imports the compiled kernel `crossings`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import curves
from penink_cli.blasting._compiled import crossings as _crossings
from penink_cli.blasting.sheet import STEP, Sheet
from penink_cli.geometry import edge_index
from penink_cli.geometry.trails import hanging_together
from penink_cli.ground.model import EdgeList, Floats, Ints

CELL_PT = 6.0
#: The step of tone from which on an edge is a wall, and the one that does where the edge continues a wall. Across a
#: lesser step ink is credited to both sides (`sheet.STEP`), so a stroke may cross it. Cutting strokes at weak edges
#: leaves stubble between edges side by side: with 0.18 astronaut has 80 % of its ink in long strokes, with 0.35 it has
#: 83.
STRONG, WEAK = 0.35, STEP
#: The least length, points, of edges that hang together for them to be a wall. Strokes are trimmed to the tone of what
#: is smaller than they are; cut at its outline they would all be stubs.
SHORTEST_WALL_PT = 40.0
#: How far from an edge the tone of its sides is looked up, points.
BESIDE_PT = 1.4
#: The least length of a piece between walls, points; shorter ones are dropped.
SHORTEST_PT = 0.8


@dataclass(frozen=True, eq=False)
class Walls:
    """Segments (m, 4), points, and a grid over them: the walls near cell c are items[begin[c] : begin[c + 1]].

    inside: (m,) how much of half a pen's width a stroke ends before each: all of it at an edge, nothing at the frame,
    which is half a pen within already.
    box: least x and y, greatest x and y that a stroke's middle line may have.
    """

    segments: Floats
    inside: Floats
    begin: Ints
    items: Ints
    columns: int
    rows: int
    box: tuple[float, float, float, float]


def strong_edges(edges: EdgeList, sheet: Sheet) -> Floats:
    """The edges (m, 4), points, over which the sheet's tone steps strongly, and those that go on from them.

    Only such as are part of a wall longer than `SHORTEST_WALL_PT`.
    """
    vertices = edges.scaled(sheet.width, sheet.height)
    a, b = vertices[edges.edges[:, 0]], vertices[edges.edges[:, 1]]
    along = b - a
    length = np.sqrt((along * along).sum(axis=1))
    normal = np.column_stack([-along[:, 1], along[:, 0]]) / np.maximum(length, 1e-9)[:, None]
    cells = np.array([sheet.columns / sheet.width, sheet.rows / sheet.height])

    def tone(points: Floats) -> Floats:
        at = np.clip(np.floor(points * cells).astype(np.int64), 0, [sheet.columns - 1, sheet.rows - 1])
        return sheet.tone[at[:, 1], at[:, 0]].astype(np.float64)

    step = np.zeros(len(a))
    for t in (0.25, 0.5, 0.75):
        p = a + t * along
        step += np.abs(tone(p + normal * BESIDE_PT) - tone(p - normal * BESIDE_PT)) / 3
    strong = step >= STRONG
    for _ in range(4):
        touched = np.zeros(len(vertices), bool)
        touched[edges.edges[strong].ravel()] = True
        strong |= (step >= WEAK) & touched[edges.edges].any(axis=1)
    kept = np.flatnonzero(strong)
    group = hanging_together(edges.edges[kept], len(vertices))
    kept = kept[np.bincount(group, length[kept], len(vertices))[group] >= SHORTEST_WALL_PT]
    return np.concatenate([a[kept], b[kept]], axis=1)


def margin(pen_pt: float, width_pt: float, height_pt: float) -> float:
    """How far within the frame the middle lines of strokes stay, so that no ink reaches over it.

    Half of what the pen is pressed to at the most, and what coordinates may be rounded by in a drawing; but some of a
    tiny sheet must be left.
    """
    return min(0.61 * pen_pt + 0.1, 0.25 * width_pt, 0.25 * height_pt)


def build(edges: EdgeList | None, sheet: Sheet, pen_pt: float) -> Walls:
    """The frame, so far within that no stroke's ink reaches over it, and the strong edges of the picture."""
    w, h = sheet.width, sheet.height
    d = margin(pen_pt, w, h)
    segments: Floats = np.array(
        [[d, d, w - d, d], [w - d, d, w - d, h - d], [w - d, h - d, d, h - d], [d, h - d, d, d]]
    )
    if edges is not None and len(edges.edges):
        segments = np.concatenate([segments, strong_edges(edges, sheet)])
    # no piece is longer than a cell, so that the bounding boxes touch few cells
    along = segments[:, 2:] - segments[:, :2]
    n = np.maximum(1, np.ceil(np.abs(along).max(axis=1) / CELL_PT)).astype(np.int64)
    which, k = np.repeat(np.arange(len(n)), n), curves.ramp(n)
    inside = (which >= 4).astype(np.float64)
    start = segments[which, :2] + along[which] * (k / n[which])[:, None]
    end = segments[which, :2] + along[which] * ((k + 1) / n[which])[:, None]
    segments = np.ascontiguousarray(np.concatenate([start, end], axis=1))
    columns, rows = int(w / CELL_PT) + 1, int(h / CELL_PT) + 1
    low, high = (np.clip(cells, 0, [columns - 1, rows - 1]) for cells in edge_index.cells(segments, CELL_PT))
    begin, items = edge_index.lists(low, high, columns, rows)
    return Walls(segments, inside, begin, items, columns, rows, (d, d, w - d, h - d))


@dataclass(frozen=True, eq=False)
class Pieces:
    """Parts of curves between walls: of which curve, from where to where (in samples), and which ends are at walls.

    bounded: (n,) bit 0: the start is at a wall, bit 1: the end is.
    """

    curve: Ints
    start: Floats
    end: Floats
    bounded: npt.NDArray[np.uint8]


def _lengths(points: Floats, first: Ints) -> Floats:
    """How long each polyline is: from end to end, but along it where it bends much, as a loop does."""
    chord = np.sqrt(((points[first[1:] - 1] - points[first[:-1]]) ** 2).sum(axis=1))
    pieces = np.sqrt((np.diff(points, axis=0, append=points[-1:]) ** 2).sum(axis=1))
    pieces[first[1:] - 1] = 0.0  # from one polyline to the next
    along = np.add.reduceat(pieces, first[:-1]) if len(chord) else chord
    return np.where(along > 1.2 * chord, along, chord)


def cut(walls: Walls, lines: curves.Polylines, painted: Floats, slack: tuple[Floats, Floats]) -> Pieces:
    """Cut polylines where they cross walls, less half of what they paint, and leave out what is outside the frame.

    painted: (n,) the width that each paints, points. slack: (n,) each, how many samples at the start and at the end
    of each are there only to reach a wall: they are dropped where they do not.
    """
    n = len(lines.first) - 1
    count = np.diff(lines.first)
    room = max(1024, 2 * n)
    points = np.ascontiguousarray(lines.points)
    while True:
        who, wall_at, where, sine = np.empty(room, np.int64), np.empty(room, np.int64), np.empty(room), np.empty(room)
        found = _crossings.crossings(points, lines.first, walls, CELL_PT, who, wall_at, where, sine)
        if found <= room:
            break
        room = found
    order = np.lexsort((where[:found], who[:found]))
    who, where, sine = who[:found][order], where[:found][order], sine[:found][order]
    inside = walls.inside[wall_at[:found][order]]
    # the same crossing may have been found in two cells, or in two walls that meet there
    again = np.zeros(found, bool)
    again[1:] = (who[1:] == who[:-1]) & (where[1:] - where[:-1] < 1e-6)
    who, where, sine, inside = who[~again], where[~again], sine[~again], inside[~again]
    # interleave: each curve's start, its crossings, its end
    per = np.bincount(who, minlength=n)
    step = np.maximum(_lengths(points, lines.first) / np.maximum(count - 1, 1), 1e-6)
    margin = inside * np.minimum(0.42 * painted[who] / np.maximum(sine, 0.2), 2 * painted[who]) / step[who]
    begin = curves.starts(per + 2)
    stop, gap, wall = np.zeros(begin[-1]), np.zeros(begin[-1]), np.ones(begin[-1], np.uint8)
    at = begin[who] + 1 + curves.ramp(per)
    stop[at], gap[at] = where, margin
    for ends, value in ((begin[:-1], 0.0), (begin[1:] - 1, count - 1.0)):
        stop[ends], wall[ends] = value, 0
    curve = np.repeat(np.arange(n), per + 1)
    left = begin[curve] + curves.ramp(per + 1)
    start, end = stop[left] + gap[left], stop[left + 1] - gap[left + 1]
    # slack that reaches no wall goes; so does what lies wholly in it
    start = np.where(wall[left] == 0, start + slack[0][curve], start)
    end = np.where(wall[left + 1] == 0, end - slack[1][curve], end)
    keep = ((end - start) * step[curve] > SHORTEST_PT) | (count[curve] == 1)
    middle = np.clip(0.5 * (start + end), 0, count[curve] - 1)
    lo = np.minimum(middle.astype(np.int64), np.maximum(count[curve] - 2, 0))
    a, b = lines.first[curve] + lo, lines.first[curve] + np.minimum(lo + 1, count[curve] - 1)
    p = points[a] + (middle - lo)[:, None] * (points[b] - points[a])
    low_x, low_y, high_x, high_y = walls.box
    keep &= (p[:, 0] >= low_x) & (p[:, 0] <= high_x) & (p[:, 1] >= low_y) & (p[:, 1] <= high_y)
    bounded = wall[left] | (wall[left + 1] << 1)
    return Pieces(curve[keep], start[keep], end[keep], bounded[keep].astype(np.uint8))


@dataclass(frozen=True, eq=False)
class Beside:
    """What lies between points and the strong edge nearest to each.

    away: (p,) how far it is, points, or infinity where none is within reach. out: (p, 2) the unit vector from there to
    the point; nought where none is.
    """

    away: Floats
    out: Floats


def beside(walls: Walls, points: Floats, reach: float) -> Beside:
    """The strong edge nearest to each of the points (p, 2) within so many points; the frame is none."""
    away, out = np.full(len(points), np.inf), np.zeros((len(points), 2))
    segments = walls.segments[walls.inside > 0]
    if not len(segments) or not len(points):
        return Beside(away, out)
    wide = np.column_stack([np.minimum(segments[:, :2], segments[:, 2:]), np.maximum(segments[:, :2], segments[:, 2:])])
    wide += np.array([-reach, -reach, reach, reach])
    low, high = (np.clip(cells, 0, [walls.columns - 1, walls.rows - 1]) for cells in edge_index.cells(wide, CELL_PT))
    begin, items = edge_index.lists(low, high, walls.columns, walls.rows)
    at = np.floor(points / CELL_PT).astype(np.int64)
    cell = np.clip(at[:, 1], 0, walls.rows - 1) * walls.columns + np.clip(at[:, 0], 0, walls.columns - 1)
    some = np.flatnonzero(begin[cell + 1] > begin[cell])
    count = begin[cell[some] + 1] - begin[cell[some]]
    who = np.repeat(some, count)
    near = segments[items[np.repeat(begin[cell[some]], count) + curves.ramp(count)]]
    along = near[:, 2:] - near[:, :2]
    off = points[who] - near[:, :2]
    length = np.maximum((along * along).sum(axis=1), 1e-18)
    off -= along * np.clip((off * along).sum(axis=1) / length, 0.0, 1.0)[:, None]
    square = (off * off).sum(axis=1)
    # the nearest of each, the first of those as near
    least = np.minimum.reduceat(square, curves.starts(count)[:-1]) if len(who) else square
    found = np.flatnonzero((square == np.repeat(least, count)) & (square < reach * reach))[::-1]
    distance = np.sqrt(square[found])
    away[who[found]] = distance
    out[who[found]] = off[found] / np.maximum(distance, 1e-9)[:, None]
    return Beside(away, out)
