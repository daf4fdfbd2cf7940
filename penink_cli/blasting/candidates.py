"""Candidate strokes of hatching: those that the sweep lays, and a lattice of those that may fill what it leaves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import curves, sweep, walls
from penink_cli.blasting.sheet import SIGMA_PT, Cells, Sheet
from penink_cli.model import Floats, HatchLayer, Ints, Strokes
from penink_cli.textures.even import direction

#: Strokes are sampled at about this distance.
STEP_PT = 1.5
#: Candidates of a layer are tried in so many batches.
BATCHES = 4


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

    def drawn(self, runs: Ints, moved: Floats) -> Strokes:
        """The runs of candidates that were drawn, as strokes (of a sheet of no size)."""
        start, end = runs[:, 1].astype(np.float64), runs[:, 2].astype(np.float64)
        points, first = curves.cut(self.points, self.first, self.pieces, runs[:, 0], start, end)
        # a stroke moved sideways may have left the frame by as much
        points = np.clip(points + np.repeat(moved, np.diff(first), axis=0), self.box[:2], self.box[2:])
        return Strokes(0.0, 0.0, points, first, self.widths[runs[:, 0]])


def between_walls(
    points: Floats,
    first: Ints,
    joined: npt.NDArray[np.bool_],
    slack: Floats,
    pen: float,
    painted: float,
    borders: walls.Walls,
    sheet: Sheet,
    rank: Floats,
) -> Candidates:
    """Candidates from curves, cut where they cross walls.

    joined: (n, 2) whether another stroke goes on from the curve's start and its end.
    slack: (n, 2) which part of it, at its start and at its end, is there only to reach a wall.
    rank: (n,) those of lower rank are tried first.
    """
    n = len(first) - 1
    pieces = curves.pieces_of(points, first, STEP_PT)
    lines = curves.sample(points, first, pieces)
    count = np.diff(lines.first) - 1
    extra = (slack[:, 0] * count, slack[:, 1] * count)
    parts = walls.cut(borders, lines, np.full(n, painted), extra)
    points, first = curves.cut(points, first, pieces, parts.curve, parts.start, parts.end)
    order = np.argsort(rank[parts.curve], kind="stable")
    # where another stroke goes on, a short piece is no stub
    goes_on = joined[parts.curve] & np.column_stack([parts.start <= 1e-6, parts.end >= count[parts.curve] - 1e-6])
    bounded = (parts.bounded | goes_on[:, 0] | (goes_on[:, 1].astype(np.uint8) << 1)).astype(np.uint8)
    pieces = curves.pieces_of(points, first, STEP_PT)
    return Candidates(
        points, first, pieces, curves.sample(points, first, pieces), np.full(len(first) - 1, pen), bounded,
        [part for part in np.array_split(order, BATCHES) if len(part)], borders.box,
    )  # fmt: skip


def swept(
    sheet: Sheet, coverage: Floats, layer: HatchLayer, pen: float, gain_pt: float, borders: walls.Walls, seed: int
) -> Candidates:
    """The strokes of one layer that cover each cell as coverage asks, in no order."""
    hatch = sweep.hatch(sheet, coverage, layer, pen, gain_pt, seed)
    rank = np.random.default_rng([seed, 3]).random(len(hatch.joined))
    painted = sweep.painted_width(layer.angle, pen, gain_pt)
    return between_walls(hatch.points, hatch.first, hatch.joined, hatch.slack, pen, painted, borders, sheet, rank)


def lattice(
    sheet: Sheet, layer: HatchLayer, pen: float, gain_pt: float, length: float, apart: float, least: float,
    error: Cells, borders: walls.Walls, seed: int,
) -> Candidates:  # fmt: skip
    """Strokes in a layer's direction all over the sheet, those where most is due first.

    least: they must pass a place where so many times as much is due as the stroke itself adds,
    error: (rows, columns) and where this is positive.
    """
    rng = np.random.default_rng([seed, 4])
    c, s = direction(layer.angle)
    along, across = np.array([c, s]), np.array([-s, c])
    corners = np.array([[0, 0], [sheet.width, 0], [0, sheet.height], [sheet.width, sheet.height]], float)
    u_range, v_range = corners @ along, corners @ across
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
    keep = due > least * painted / (2.5066 * SIGMA_PT)
    middle, half, due = middle[keep], half[keep], due[keep]
    turn, bow = rng.normal(0, 0.012, len(half)), rng.normal(0, 0.12, len(half))
    uu = half[:, None] * np.array([-1.0, -1 / 3, 1 / 3, 1.0])
    vv = turn[:, None] * uu + bow[:, None] * np.array([-0.5, 0.85, 0.85, -0.5])
    cubics = middle[:, None, :] + uu[..., None] * along + vv[..., None] * across
    points, first = cubics.reshape(-1, 2), np.arange(len(half) + 1) * 4
    none = np.zeros((len(half), 2))
    return between_walls(points, first, none.astype(bool), none, pen, painted, borders, sheet, -due)
