"""Candidate strokes of hatching: those that the sweep lays, and a lattice of those that may fill what it leaves."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import curves, sweep, walls
from penink_cli.blasting.curve_fitting import over_chords
from penink_cli.blasting.sheet import SPREAD_PT, Cells, Sheet, Terms
from penink_cli.ground.model import Floats, HatchLayer, Ints, Strokes

#: The distance, about, at which curves are sampled, points.
STEP_PT = 1.5
#: Batches in which a layer's candidates are tried; see `Sheet.place`.
BATCHES = 4
#: Strokes along the frame: their least length, points, and how many rows of them there are at the most.
SHORTEST_RIM_PT, RIM_ROWS = 6.0, 3
#: Strokes along edges follow them within this.
EDGE_TOLERANCE_PT = 0.1
#: A piece shorter than STUB_PT is joined to the stroke that goes on from it, unless the two lie further apart across
#: their direction than STEP_ASIDE_PT.
STUB_PT, STEP_ASIDE_PT = 20.0, 0.9


@dataclass(frozen=True, eq=False)
class Candidates:
    """Curves cut at the walls, sampled, and in which order to try them.

    points, first: the curves. pieces: see `curves.sample`. bounded: see `walls.Pieces`. box: see `walls.Walls`.
    """

    points: Floats
    first: Ints
    pieces: Ints
    lines: curves.Polylines
    widths: Floats
    bounded: npt.NDArray[np.uint8]
    batches: list[Ints]
    box: tuple[float, float, float, float]

    def placed(self, sheet: Sheet, terms: Terms, enters: Floats | None = None) -> Strokes:
        """What is worth drawing of them is drawn, see `Sheet.place`: as strokes (of a sheet of no size)."""
        runs, moved = sheet.place(self.lines, self.widths, self.batches, terms, self.bounded, enters)
        start, end = runs[:, 1].astype(np.float64), runs[:, 2].astype(np.float64)
        points, first = curves.cut(self.points, self.first, self.pieces, runs[:, 0], start, end)
        # A stroke that was moved sideways may have left the frame.
        points = np.clip(points + np.repeat(moved, np.diff(first), axis=0), self.box[:2], self.box[2:])
        return Strokes(0.0, 0.0, points, first, self.widths[runs[:, 0]])


def between_walls(
    points: Floats,
    first: Ints,
    widths: Floats,
    painted: float,
    borders: walls.Walls,
    rank: Floats,
    joined: npt.NDArray[np.bool_] | None = None,
    slack: Floats | None = None,
) -> Candidates:
    """Candidates from curves, cut where they cross walls.

    widths: (n,) of the pen; painted: what a device makes of it, points.
    rank: (n,) those of lower rank are tried first.
    joined: (n, 2) whether another stroke goes on from the curve's start and its end; none does by default.
    slack: (n, 2) which part of it, at its start and at its end, is there only to reach a wall; none by default.
    """
    n = len(first) - 1
    joined = np.zeros((n, 2), bool) if joined is None else joined
    slack = np.zeros((n, 2)) if slack is None else slack
    pieces = curves.pieces_of(points, first, STEP_PT)
    lines = curves.sample(points, first, pieces)
    count = np.diff(lines.first) - 1
    extra = (slack[:, 0] * count, slack[:, 1] * count)
    parts = walls.cut(borders, lines, np.full(n, painted), extra)
    points, first = curves.cut(points, first, pieces, parts.curve, parts.start, parts.end)
    # Where another stroke goes on, a short piece is no stub.
    goes_on = joined[parts.curve] & np.column_stack([parts.start <= 1e-6, parts.end >= count[parts.curve] - 1e-6])
    bounded = (parts.bounded | goes_on[:, 0] | (goes_on[:, 1].astype(np.uint8) << 1)).astype(np.uint8)
    goes_on[:-1, 1] &= goes_on[1:, 0] & (np.diff(parts.curve) == 1)
    points, first, begins = without_stubs(points, first, goes_on[:-1, 1])
    order = np.argsort(rank[parts.curve[begins]], kind="stable")
    ends = np.append(begins[1:], len(bounded))[: len(begins)] - 1
    bounded = (bounded[begins] & 1) | (bounded[ends] & 2)
    pieces = curves.pieces_of(points, first, STEP_PT)
    return Candidates(
        points, first, pieces, curves.sample(points, first, pieces), widths[parts.curve[begins]], bounded,
        [part for part in np.array_split(order, BATCHES) if len(part)], borders.box,
    )  # fmt: skip


def without_stubs(points: Floats, first: Ints, joint: npt.NDArray[np.bool_]) -> tuple[Floats, Ints, Ints]:
    """Curves joined to the next one where either is a stub.

    joint: (n - 1,) whether curve i + 1 goes on where curve i ends. Returns points and first of the curves that result,
    and for each the number of the curve that it begins with.

    The sweep cuts its lines into strokes without regard to edges; edges and the frame then cut these strokes again.
    Without this step a quarter of the ink of coins is in strokes under 20 points, with it a tenth.
    """
    start, end = points[first[:-1]], points[first[1:] - 1]
    chord = end - start
    length = np.sqrt((chord * chord).sum(axis=1))
    gap = start[1:] - end[:-1]
    aside = np.abs(gap[:, 0] * chord[:-1, 1] - gap[:, 1] * chord[:-1, 0]) / np.maximum(length[:-1], 1e-9)
    aside = np.where(joint, aside, np.inf)
    before, after = np.append(np.inf, aside), np.append(aside, np.inf)
    stub = length < STUB_PT
    merged = ((stub & (after <= before))[:-1] | (stub & (before < after))[1:]) & (aside < STEP_ASIDE_PT)
    left = np.flatnonzero(merged)
    # both ends, and the handles beside them, are moved to the middle between them
    half = gap[left] / 2
    points = points.copy()
    for at, by in ((first[left + 1] - 1, half), (first[left + 1], -half)):
        points[at] += by
    points[first[left + 1] - 2] += half
    points[first[left + 1] + 1] -= half
    begins = np.flatnonzero(np.append(True, ~merged)) if len(length) else np.zeros(0, np.int64)
    keep = np.ones(len(points), bool)
    keep[first[left + 1]] = False
    sizes = np.diff(first)
    sizes[left + 1] -= 1
    total = curves.starts(sizes)
    return points[keep], total[np.append(begins, len(length))], begins


def swept(
    sheet: Sheet, coverage: Floats, layer: HatchLayer, pen: float, finest: float, gain_pt: float, borders: walls.Walls,
    seed: int,
) -> Candidates:  # fmt: skip
    """The strokes of one layer that cover each cell as coverage asks, in no order."""
    hatch = sweep.hatch(sheet, coverage, layer, pen, finest, gain_pt, seed)
    rank = np.random.default_rng([seed, 3]).random(len(hatch.joined))
    painted = sweep.painted_width(layer.angle, pen, gain_pt)
    return between_walls(hatch.points, hatch.first, hatch.widths, painted, borders, rank, hatch.joined, hatch.slack)


def lattice(
    sheet: Sheet, layer: HatchLayer, pen: float, gain_pt: float, length: float, apart: float, least: float,
    error: Cells, borders: walls.Walls, seed: int,
) -> Candidates:  # fmt: skip
    """Strokes in a layer's direction all over the sheet, those where most is due first.

    least: they must pass a place where so many times as much is due as the stroke itself adds,
    error: (rows, columns) and where this is positive.
    """
    rng = np.random.default_rng([seed, 4])
    c, s = sweep.heading(layer.angle)
    along, across = np.array([c, s]), np.array([-s, c])
    corners = np.array([[0, 0], [sheet.width, 0], [0, sheet.height], [sheet.width, sheet.height]], float)
    u_range, v_range = (corners[:, 0] * axis[0] + corners[:, 1] * axis[1] for axis in (along, across))
    rows, places = np.arange(v_range.min(), v_range.max(), apart), np.arange(u_range.min(), u_range.max(), length / 2)
    u = (places[None, :] + rng.uniform(-0.5, 0.5, (len(rows), 1)) * length / 2).ravel()
    u = u + rng.uniform(-0.2, 0.2, len(u)) * length
    v = np.repeat(rows, len(places)) + rng.uniform(-0.5, 0.5, len(u)) * apart
    middle = np.column_stack([u * c - v * s, u * s + v * c])
    half = length * rng.uniform(0.35, 0.65, len(u))
    cells = np.array([sheet.columns / sheet.width, sheet.rows / sheet.height])
    due = np.zeros(len(u))
    for t in (-0.6, -0.3, 0.0, 0.3, 0.6):
        at = np.floor((middle + (t * half)[:, None] * along) * cells).astype(np.int64)
        inside = (at >= 0).all(axis=1) & (at[:, 0] < sheet.columns) & (at[:, 1] < sheet.rows)
        at = np.clip(at, 0, [sheet.columns - 1, sheet.rows - 1])
        active = inside & (sheet.tone[at[:, 1], at[:, 0]] > layer.low) & (error[at[:, 1], at[:, 0]] > 0)
        due = np.maximum(due, np.where(active, sheet.residual[at[:, 1], at[:, 0]], 0.0))
    painted = sweep.painted_width(layer.angle, pen, gain_pt)
    keep = due > least * painted / SPREAD_PT
    middle, half, due = middle[keep], half[keep], due[keep]
    turn, bow = rng.normal(0, 0.012, len(half)), rng.normal(0, 0.12, len(half))
    uu = half[:, None] * np.array([-1.0, -1 / 3, 1 / 3, 1.0])
    vv = turn[:, None] * uu + bow[:, None] * np.array([-0.5, 0.85, 0.85, -0.5])
    cubics = middle[:, None, :] + uu[..., None] * along + vv[..., None] * across
    points, first = cubics.reshape(-1, 2), np.arange(len(half) + 1) * 4
    return between_walls(points, first, np.full(len(half), pen), painted, borders, -due)


def along_edges(sheet: Sheet, pen: float, borders: walls.Walls, darkest_from: float) -> Candidates:
    """Strokes along strong edges on their dark side, where it is darker than `darkest_from`, as near as a pen may come.

    Lines that meet an edge at an angle leave notches before it, and where a field turns there are gaps.
    """
    from penink_cli.blasting import rims  # only where lines follow a field

    painted = pen + sheet.gain_pt
    parts = []
    for line in rims.along_edges(borders, sheet.tone, 0.55 * painted, darkest_from):
        n = max(1, round(len(line) * rims.STEP_PT / sweep.STROKE_PT[1]))
        cuts = [(len(line) - 1) * k // n for k in range(n + 1)]
        parts += [line[a : b + 1] for a, b in itertools.pairwise(cuts)]
    first = curves.starts(np.array([len(part) for part in parts], np.int64))
    points, first = over_chords(np.concatenate([np.zeros((0, 2)), *parts]), first, EDGE_TOLERANCE_PT)
    return between_walls(points, first, np.full(len(parts), pen), painted, borders, np.zeros(len(parts)))


def rim(sheet: Sheet, pen: float, borders: walls.Walls, darkest_from: float, seed: int) -> Candidates:
    """Strokes along the frame where the sheet is darker there than `darkest_from`, as near to it as a pen may come.

    The ends of hatching leave bare notches before the frame, which is a white rim round a dark picture, and where an
    edge runs into the frame there is no room for hatching at all.
    """
    rng = np.random.default_rng([seed, 7])
    w, h = sheet.width, sheet.height
    d = walls.margin(pen, w, h)
    starts, ends = [], []
    sides = [
        (np.array(a), np.array(b))
        for x in (d + k * (pen + sheet.gain_pt) for k in range(RIM_ROWS))
        for a, b in itertools.pairwise([(x, x), (w - x, x), (w - x, h - x), (x, h - x), (x, x)])
    ]
    for a, b in sides:
        length = float(np.abs(b - a).max())
        cuts = np.cumsum(rng.uniform(*sweep.STROKE_PT, int(length / sweep.STROKE_PT[0]) + 1))
        cuts = np.concatenate([[0.0], cuts[cuts < length - SHORTEST_RIM_PT], [length]]) / length
        starts.append(a + cuts[:-1, None] * (b - a))
        ends.append(a + cuts[1:, None] * (b - a))
    start, end = np.concatenate(starts), np.concatenate(ends)
    cells = np.array([sheet.columns / w, sheet.rows / h])
    t = np.linspace(0.0, 1.0, 33)[:, None, None]
    at = np.floor((start + t * (end - start)) * cells).astype(np.int64)
    at = np.clip(at, 0, [sheet.columns - 1, sheet.rows - 1])
    dark = (sheet.tone[at[..., 1], at[..., 0]] > darkest_from).any(axis=0)
    start, end = start[dark], end[dark]
    points = np.stack([start, start + (end - start) / 3, end - (end - start) / 3, end], axis=1).reshape(-1, 2)
    n = len(start)
    within = replace(borders, box=(d, d, w - d, h - d))
    return between_walls(
        points, np.arange(n + 1) * 4, np.full(n, pen), pen + sheet.gain_pt, within, np.zeros(n)
    )  # fmt: skip
