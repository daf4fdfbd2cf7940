"""Order strokes for a pen: short ways between them, and ends that meet joined.

From the sheet's top-left corner a tour goes always to the nearest end (kernel `tree`). It is then
shortened by 2-opt and Or-opt (kernel `improve`). Every stroke may be drawn from either end.

This module alone imports the compiled kernels.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from penink_cli.ground import exact
from penink_cli.ground.median import distinct
from penink_cli.ground.model import Floats, Ints, Strokes
from penink_cli.travel._compiled import improve as _improve
from penink_cli.travel._compiled import tree as _tree

NEIGHBOURS = 10  # ends near each end that exchanges try
STEPS = 4000  # of exchanges, a stroke: some ten times what usual drawings take, so it bounds hostile ones alone
_FEW = _tree.LEAF // 2  # strokes whose ends fit into one leaf: they are ordered without a tree
SLICE = 20  # steps a stroke between two reports of progress


def ordered(
    strokes: Strokes, improve: bool = True, advance: Callable[[int], None] = lambda done: None
) -> Strokes:
    """The same strokes in an order, and each in a direction, that a pen can follow quickly.

    improve: without it the nearest stroke always comes next, which is some 15 to 25 % longer and takes
    a tenth of the time. advance: is told of progress in strokes, to twice their number. The time grows
    as n log n, and the result is deterministic.
    """
    n = len(strokes)
    if n == 0:
        return strokes
    if n == 1:  # from the end that is nearer to the corner
        nearer = exact.length(strokes.points[-1]) < exact.length(strokes.points[0])
        advance(2)
        return strokes.taken(np.zeros(1, np.int64), np.ones(1, bool)) if nearer else strokes
    ends = np.empty((2 * n, 2))
    ends[0::2] = strokes.points[strokes.first[:-1]]
    ends[1::2] = strokes.points[strokes.first[1:] - 1]
    tour, flips = _tour(ends, improve, advance)
    return strokes.taken(tour, flips[tour])


def ordered_each(strokes: Strokes, first: Ints) -> Strokes:
    """The same strokes, each run first[g] … first[g + 1] - 1 ordered by itself as `ordered` does without `improve`.

    A drawing has a thousand runs, most of them of one or two strokes, so short runs are ordered together.
    """
    n = len(strokes)
    count = np.diff(first)
    ends = np.empty((2 * n, 2))
    ends[0::2] = strokes.points[strokes.first[:-1]]
    ends[1::2] = strokes.points[strokes.first[1:] - 1]
    tour, flips = np.arange(n, dtype=np.int32), np.zeros(n, np.uint8)
    alone = first[:-1][count == 1]
    flips[alone] = exact.length(ends[2 * alone + 1]) < exact.length(ends[2 * alone])
    few = (count > 1) & (count <= _FEW)
    run = np.repeat(np.arange(len(count)), count)
    which = np.flatnonzero(few[run])  # strokes
    if len(which):
        begins = np.concatenate([[0], np.cumsum(count[few])])
        own = np.stack([2 * which, 2 * which + 1], axis=1).ravel()
        side = np.repeat(run[which], 2)
        points = ends[own]
        starts = 2 * begins[:-1]
        low = np.repeat(np.minimum.reduceat(points, starts), 2 * count[few], axis=0)
        wide = np.repeat(np.maximum.reduceat((points - low).max(axis=1), starts), 2 * count[few])
        scale = np.where(wide > 0, (2**26 - 1) / np.where(wide > 0, wide, 1.0), 0.0)
        codes = _interleaved(((points - low) * scale[:, None]).astype(np.int64))
        by_place = np.lexsort((codes, side))
        order, side = own[by_place].astype(np.int32), side[by_place]
        dots = (ends[0::2] == ends[1::2]).all(axis=1)
        kept = ~((order & 1 == 1) & dots[order // 2])
        order = order[kept]
        where = np.searchsorted(side[kept], np.append(np.flatnonzero(few), len(count)))
        where[-1] = len(order)
        some = np.empty(len(which), np.int32)
        _tree.greedy_few(ends, order, where, begins, some, flips, np.zeros(n, np.uint8))
        tour[which] = some
    for begin, end in zip(first[:-1][count > _FEW].tolist(), first[1:][count > _FEW].tolist()):
        own_tour, turned = _tour(ends[2 * begin : 2 * end], False, lambda done: None)
        tour[begin:end] = begin + own_tour
        flips[begin:end] = turned
    return strokes.taken(tour.astype(np.int64), flips[tour] > 0)


def _tour(ends: Floats, improve: bool, advance: Callable[[int], None]) -> tuple[Ints, np.ndarray]:
    """Strokes in order (n,) and, by stroke, whether it is drawn from its end (n,)."""
    n = len(ends) // 2
    order = np.argsort(_morton(ends), kind="stable").astype(np.int32)
    dots = (ends[0::2] == ends[1::2]).all(axis=1)
    order = order[~((order & 1 == 1) & dots[order // 2])]  # both ends of a dot are one
    used = np.zeros(n, np.uint8)
    near = np.empty((2 * n, NEIGHBOURS), np.int32)
    if improve:
        _tree.neighbours(*_planted(ends, order), used, near)
        near[1::2][dots] = near[0::2][dots]
    tour, flips = np.empty(n + 1, np.int32), np.zeros(n + 1, np.uint8)
    pen = np.zeros(2)
    place = np.full(2 * n, -1, np.int32)
    done = 0
    while done < n:  # a tree half empty is slow to search, so a smaller one is planted
        order = order[used[order // 2] == 0]
        place[order] = np.arange(len(order), dtype=np.int32)
        upto = done + max((n - done) // 2, min(n - done, 64))
        _tree.greedy(ends, *(tree := _planted(ends, order))[:2], place, *tree[2:], pen, tour[done:upto], flips, used)
        advance(upto - done)
        done = upto
    if not improve:
        advance(n)
        return tour[:n].astype(np.int64), flips[:n].astype(bool)
    tour[n] = n
    whereabouts = np.empty(n + 1, np.int32)
    whereabouts[tour] = np.arange(n + 1, dtype=np.int32)
    queue, waiting, state = tour.copy(), np.ones(n + 1, np.uint8), np.zeros(3, np.int64)
    budget, left, seen = STEPS * n, STEPS * n + 1, 0
    while 0 < budget < left:
        left = budget
        budget = _improve.improve(
            ends, near, tour, whereabouts, flips, queue, waiting, state, budget, max(0, budget - SLICE * n)
        )
        advance(min(n, int(state[2])) - seen)  # most of the work is the first look at each stroke
        seen = min(n, int(state[2]))
    advance(n - seen)
    opened = np.roll(tour, -1 - int(whereabouts[n]))[:n].astype(np.int64)
    turned = flips[:n].astype(bool)
    beginning = ends[2 * opened[0] + turned[opened[0]]]
    finish = ends[2 * opened[-1] + 1 - turned[opened[-1]]]
    if exact.length(finish) < exact.length(beginning):
        return opened[::-1], ~turned
    return opened, turned


def _planted(ends: Floats, order: np.ndarray) -> tuple[Floats, np.ndarray, Floats, np.ndarray]:
    """A tree over these ends of all `ends` (2n, 2), as of the kernel: sorted points, order, boxes, alive."""
    leaves = 1 << max(0, (-(-len(order) // _tree.LEAF) - 1).bit_length())
    tree = ends[order], order, np.empty((2 * leaves, 4)), np.empty(2 * leaves, np.int32)
    _tree.build(tree[0], *tree[2:])
    return tree


def _morton(points: Floats) -> Ints:
    """The place (n,) of each point (n, 2) along a Morton curve, over 2^26 × 2^26 cells of their box or over ranks."""
    low = points.min(axis=0)
    side = float((points - low).max())
    codes = _interleaved(((points - low) * ((2**26 - 1) / side if side > 0 else 0.0)).astype(np.int64))
    if len(points) > 1000 and len(distinct(codes[::97])) < len(codes[::97]) / 2:
        # Most points share cells, as they do where one point lies far off. Ranks are spread evenly wherever points lie.
        ranks = np.argsort(np.argsort(points, axis=0, kind="stable"), axis=0, kind="stable")
        codes = _interleaved(ranks)
    return codes


def _interleaved(cells: Ints) -> Ints:
    """Numbers (n,) whose bits are those of x and y (n, 2), below 2^32, by turns."""
    for shift, mask in ((16, 0x0000FFFF0000FFFF), (8, 0x00FF00FF00FF00FF), (4, 0x0F0F0F0F0F0F0F0F),
                        (2, 0x3333333333333333), (1, 0x5555555555555555)):  # fmt: skip
        cells = (cells | (cells << shift)) & mask
    return cells[:, 0] | (cells[:, 1] << 1)


def joined(strokes: Strokes, tolerance: float) -> Strokes:
    """The strokes, each joined to the next where its end is within ``tolerance`` points of the next one's beginning.

    Strokes are joined only where both have the same width there, and dots never. The later stroke's beginning
    moves to the earlier one's end, so the ink changes by no more than the tolerance.
    """
    n = len(strokes)
    if n < 2:
        return strokes
    ends, starts = strokes.points[strokes.first[1:-1] - 1], strokes.points[strokes.first[1:-1]]
    drawn = np.diff(strokes.first) > 1
    meet = exact.length(ends - starts) <= tolerance
    widths, knots = strokes.at_knots, strokes.knots
    meet &= (widths[knots[1:-1] - 1] == widths[knots[1:-1]]) & drawn[1:] & drawn[:-1]
    keep = np.ones(len(strokes.points), bool)
    keep[strokes.first[1:-1][meet]] = False
    begins = np.concatenate([[True], ~meet])
    kept_before = np.concatenate([[0], np.cumsum(keep)])
    first = np.append(kept_before[strokes.first[:-1][begins]], kept_before[-1])
    result = replace(strokes, points=strokes.points[keep], first=first, widths=strokes.widths[begins], knot_widths=None)
    return result if strokes.knot_widths is None else result.swelling(np.delete(widths, knots[1:-1][meet]))


def travel_length(strokes: Strokes) -> float:
    """Points from each stroke's end to the next one's beginning, all together."""
    ends, starts = strokes.points[strokes.first[1:-1] - 1], strokes.points[strokes.first[1:-1]]
    return float(exact.length(starts - ends).sum())


def drawn_length(strokes: Strokes) -> float:
    """Length of all strokes in points, to within a few parts in a million.

    The speed along each segment is integrated by Gauss and Legendre's quadrature at eight places.
    """
    counts = np.diff(strokes.first)
    inner = np.arange(len(strokes.points)) - np.repeat(strokes.first[:-1], counts)
    begins = np.flatnonzero((inner % 3 == 0) & (inner < np.repeat(counts, counts) - 1))
    a, b, c = (strokes.points[begins + k + 1] - strokes.points[begins + k] for k in range(3))
    nodes, weights = np.polynomial.legendre.leggauss(8)
    total = np.zeros(len(begins))
    for t, weight in zip((nodes + 1) / 2, weights / 2):
        speed = 3 * ((1 - t) ** 2 * a + 2 * t * (1 - t) * b + t * t * c)
        total += weight * exact.length(speed)
    return float(total.sum())
