"""The telling lines that there is room for at one size on paper: the most telling first, under a local quota."""

from __future__ import annotations

import math

import numpy as np

from penink_cli.geometry.curves import lengths
from penink_cli.ground.model import Floats, Ints, LineChoice, Lines

#: Points: the side of the cells of a map that says how full each place is, and the σ of the Gaussian that blurs the
#: map.
CELL_PT, ROOM_PT = 3.0, 10.0
#: A line of rank r may make a place as full as the choice's density times LEAST_PART + r / USUAL_RANK, at most MOST.
USUAL_RANK, LEAST_PART, MOST = 6.0, 0.7, 1.6
#: The least rank drawn on a sheet the root of whose area is SIZE_PT. It falls with the root of the size, within RANKS:
#: a larger print has room for fainter lines.
SIZE_PT, LEAST_RANK, RANKS = 432.0, 0.8, (0.5, 1.6)
#: The least length of a line, and the least and greatest breadth of a spot, points on paper: broader things are drawn
#: in their own shape by the hatching and its blacks.
SHORTEST_PT, FINEST_SPOT_PT, BROADEST_SPOT_PT = 3.0, 0.25, 5.0


def least_rank(width_pt: float, height_pt: float) -> float:
    """The least rank of lines that are drawn at that size, unless the choice says another."""
    rank = LEAST_RANK * math.sqrt(SIZE_PT / math.sqrt(width_pt * height_pt))
    return min(max(rank, RANKS[0]), RANKS[1])


def chosen(lines: Lines, width_pt: float, height_pt: float, choice: LineChoice, white: bool = False) -> Ints:
    """Indices of the lines that there is room for, by falling rank; spots take no room.

    white: light lines are chosen, else dark ones.
    """
    least = least_rank(width_pt, height_pt) if choice.min_rank is None else choice.min_rank
    scale = np.array([width_pt / lines.width, height_pt / lines.height])
    order = np.argsort(-lines.rank, kind="stable")
    # A stamp has room for few lines, but a face on it still needs its eyes.
    needed = np.where(lines.breadth > 0, min(least, LEAST_RANK), least)
    order = order[(lines.rank[order] >= needed[order]) & (lines.white[order] == white)]
    room = _Room(width_pt, height_pt)
    budget = choice.per_inch2 * width_pt * height_pt / 72.0
    out = []
    for i in order.tolist():
        points = lines[i] * scale
        if lines.breadth[i] > 0:
            if FINEST_SPOT_PT <= lines.breadth[i] * float(scale[0]) <= BROADEST_SPOT_PT:
                out.append(i)
            continue
        steps = lengths(points)
        length = math.fsum(steps.tolist())
        if length < SHORTEST_PT or length > budget:
            continue
        limit = choice.density * min(MOST, LEAST_PART + lines.rank[i] / USUAL_RANK)
        if room.take(points, steps, limit):
            out.append(i)
            budget -= length
    return np.array(out, np.int64)


class _Room:
    """How much line lies around each place of a sheet: points of line in a square point, averaged over a Gaussian."""

    def __init__(self, width_pt: float, height_pt: float):
        sigma = ROOM_PT / CELL_PT
        self.reach = r = math.ceil(2.5 * sigma)
        bell = np.array([round(math.exp(-0.5 * (k / sigma) ** 2), 9) for k in range(-r, r + 1)])
        self.kernel = bell[:, None] * bell
        self.kernel /= math.fsum(self.kernel.ravel().tolist()) * CELL_PT * CELL_PT
        self.map = np.zeros((math.ceil(height_pt / CELL_PT) + 1 + 2 * r, math.ceil(width_pt / CELL_PT) + 1 + 2 * r))

    def take(self, points: Floats, steps: Floats, limit: float) -> bool:
        """Take the room for a line, if there is any; whether there was.

        points: (k, 2). steps: (k - 1,) lengths between them. limit: how full a place may be before.
        """
        middle = (points[1:] + points[:-1]) / 2
        # steps longer than a cell are cut into parts; those that lie in one cell are added up below
        n = np.maximum(np.ceil(steps / CELL_PT), 1).astype(np.int64)
        part = np.repeat(np.arange(len(n)), n)
        along = (np.arange(len(part)) - np.repeat(np.cumsum(n) - n, n) + 0.5) / n[part] - 0.5
        at = np.floor((middle[part] + along[:, None] * (points[1:] - points[:-1])[part]) / CELL_PT).astype(np.int64)
        at = np.clip(at, 0, np.array(self.map.shape[::-1]) - 1 - 2 * self.reach)
        r = self.reach
        there = self.map[at[:, 1] + r, at[:, 0] + r]
        if math.fsum(there.tolist()) > limit * len(there):
            return False
        inked = (steps / n)[part]
        change = np.flatnonzero((at[1:] != at[:-1]).any(axis=1)) + 1
        starts = np.concatenate([[0], change])
        for (x, y), ink in zip(at[starts].tolist(), np.add.reduceat(inked, starts).tolist()):
            self.map[y : y + 2 * r + 1, x : x + 2 * r + 1] += self.kernel * ink
        return True
