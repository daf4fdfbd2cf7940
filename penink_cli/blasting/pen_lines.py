"""Pen strokes from lines: evened, smoothed, cut to a hand's length, drawn as cubics with a hand's waver.

This module alone imports the compiled kernel `lines`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import curves
from penink_cli.blasting._compiled import lines as _lines
from penink_cli.blasting.level_lines import LevelLines
from penink_cli.blasting.phase import Nodes, Plane
from penink_cli.ground.model import Floats, Ints

#: Distance of a line's points, points on paper.
STEP_PT = 1.0
#: Lines are smoothed over so much of their distance: rounds of a binomial mean of σ² ½ each, two at the least.
SMOOTHING, FEWEST_ROUNDS, MOST_ROUNDS = 0.5, 2, 40
#: A stroke follows its line within this.
TOLERANCE_PT = 0.2
#: Cells of the lists in which ends are looked for when a line is cut.
ENDS_CELL_PT = 10.0


@dataclass(frozen=True, eq=False)
class Parts:
    """Parts of lines that are to be strokes.

    line: (n,) of which; span: (n, 2) from where to where along it, points; joined: (n, 2) whether another goes on from
    its start, its end.
    """

    line: Ints
    span: Floats
    joined: npt.NDArray[np.bool_]


def lengths(lines: LevelLines) -> Floats:
    """(n,) length of each line, points."""
    out = np.empty(len(lines.ring))
    _lines.lengths(lines.points, lines.first, out)
    return out


def evened(lines: LevelLines, shortest_pt: float) -> LevelLines:
    """The lines that are not shorter than that, in equal steps of about `STEP_PT`."""
    length = lengths(lines)
    keep = np.flatnonzero(length >= max(shortest_pt, 1e-6))
    steps = np.maximum(1, np.floor(length[keep] / STEP_PT + 0.5)).astype(np.int64)
    begin = curves.starts(steps + 1)
    out = np.empty((begin[-1], 2))
    _lines.even(lines.points, lines.first, length, keep, begin, out)
    return LevelLines(out, begin, lines.ring[keep])


def look_up(values: Plane, nodes: Nodes, points: npt.NDArray[np.floating]) -> Plane:
    """Values (rows, columns of the nodes) at the nodes nearest to points (n, 2)."""
    out = np.empty(len(points), np.float32)
    _lines.look_up(values, np.ascontiguousarray(points, np.float64), nodes.left, nodes.top, nodes.dx, nodes.dy, out)
    return out


def smooth(lines: LevelLines, spacing: npt.NDArray[np.floating]) -> None:
    """Take from lines, in place, the corners that the grid gave them, the more the further (p,) they are apart."""
    rounds = np.clip(SMOOTHING * spacing * spacing, FEWEST_ROUNDS, MOST_ROUNDS).astype(np.uint8)
    _lines.smooth(lines.points, lines.first, rounds, lines.ring.astype(np.uint8))


def live(lines: LevelLines, wanted: npt.NDArray[np.bool_], fewest: int = 3) -> tuple[LevelLines, npt.NDArray[np.bool_]]:
    """The runs of points that are wanted (p,), at least so many in a row, and whether (n, 2) they are cut there.

    A ring of which some is not wanted falls into runs that begin and end where it did.
    """
    n = len(lines.ring)
    who = np.repeat(np.arange(n), np.diff(lines.first))
    key = np.concatenate([[-1], np.where(wanted, who, -1), [-1]])
    change = np.flatnonzero(key[1:] != key[:-1])
    start = change[key[change + 1] >= 0]
    end = change[np.searchsorted(change, start) + 1]
    long = end - start >= fewest
    start, end = start[long], end[long]
    line = who[start] if len(start) else np.zeros(0, np.int64)
    size = end - start
    first = curves.starts(size)
    points = lines.points[np.repeat(start, size) + curves.ramp(size)]
    cut = np.column_stack([start > lines.first[line], end < lines.first[line + 1]])
    return LevelLines(points, first, lines.ring[line] & ~cut.any(axis=1)), cut


def turn_rings(lines: LevelLines, seed: int) -> None:
    """Let rings, in place, begin anywhere: where they were found first they would all begin along one line."""
    rng = np.random.default_rng([seed & 0xFFFFFFFF, 9])
    for i, at in zip(np.flatnonzero(lines.ring).tolist(), rng.random(int(lines.ring.sum())).tolist()):
        ring = lines.points[lines.first[i] : lines.first[i + 1]]
        ring[:-1] = np.roll(ring[:-1], -int(at * (len(ring) - 1)), axis=0)
        ring[-1] = ring[0]


def cut(lines: LevelLines, spacing: Floats, stroke_pt: tuple[float, float], shortest_pt: float, seed: int) -> Parts:
    """Strokes of a hand's length, whose ends keep clear of others' ends.

    lines: in equal steps. spacing: (n,) about how far from its neighbours each line is.
    """
    length = lengths(lines)
    room = int((length / stroke_pt[0]).sum()) + len(length) + 16
    goes_on = np.repeat(lines.ring[:, None], 2, axis=1).astype(np.uint8)
    low = lines.points.min(axis=0) if len(lines.points) else np.zeros(2)
    high = lines.points.max(axis=0) if len(lines.points) else np.zeros(2)
    columns, rows = (int(side / ENDS_CELL_PT) + 1 for side in high - low)
    line, span, joined = np.empty(room, np.int64), np.empty((room, 2)), np.empty((room, 2), np.uint8)
    head, link, tips = np.full((rows, columns), -1, np.int32), np.empty(room, np.int32), np.empty((room, 2))
    ends = _lines.Ends(head, link, tips, ENDS_CELL_PT, float(low[0]), float(low[1]))
    n = _lines.chop(
        _lines.Lines(lines.points, lines.first, length), ends, goes_on, np.ascontiguousarray(spacing), shortest_pt,
        *stroke_pt, seed, line, span, joined,
    )  # fmt: skip
    return Parts(line[:n], span[:n], joined[:n] > 0)


def drawn(lines: LevelLines, parts: Parts, hand: Floats) -> tuple[Floats, Ints]:
    """Control points and where each stroke's begin: the parts as chains of cubics, which may reach beyond their lines.

    hand: (n, 3) how far each stroke is off its line: all of it, the same more at its end and less at its start, and its
    bow, points.
    """
    along = _lines.Lines(lines.points, lines.first, lengths(lines))
    span, hand = np.ascontiguousarray(parts.span), np.ascontiguousarray(hand)
    count = np.empty(len(parts.line), np.int64)
    _lines.cubics(along, parts.line, span, hand, TOLERANCE_PT, count)
    first = curves.starts(3 * count + 1)
    points = np.empty((first[-1], 2))
    _lines.draw(along, parts.line, span, hand, count, first, points)
    return points, first
