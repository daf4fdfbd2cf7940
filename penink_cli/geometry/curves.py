"""Smooth curves through points, and few points whose curve stays near a path.

The tangent at a point is that of the parabola through it and its two neighbours; between two points lies the cubic
with their tangents.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.ground.model import Floats, Ints

#: Rounds of smoothing that take the noise out of a path before points are chosen.
_ROUNDS = 4
#: A point may be this many times as far from its place along the curve as from the curve: that is not seen.
_ALONG = 4.0


def lengths(points: Floats) -> Floats:
    """Length (k - 1,) of each leg of a path (k, 2)."""
    return _size(points[1:] - points[:-1])


def through(points: Floats, ring: bool) -> Floats:
    """Control points (3 k + 1, 2) of the smooth curve through points (k + 1, 2), k at least 1.

    ring: the curve is closed; the last point is the first again.
    """
    if len(points) == 2:
        step = (points[1] - points[0]) / 3
        return np.stack([points[0], points[0] + step, points[1] - step, points[1]])
    steps = points[1:] - points[:-1]
    size = np.maximum(lengths(points), 1e-9)[:, None]
    slope = steps / size
    if ring:
        around, sizes = np.concatenate([slope[-1:], slope]), np.concatenate([size[-1:], size])
        inner = (around[:-1] * sizes[1:] + around[1:] * sizes[:-1]) / (sizes[1:] + sizes[:-1])
        tangent = np.concatenate([inner, inner[:1]])
    else:
        inner = (slope[:-1] * size[1:] + slope[1:] * size[:-1]) / (size[1:] + size[:-1])
        tangent = np.concatenate([2 * slope[:1] - inner[:1], inner, 2 * slope[-1:] - inner[-1:]])
    leaving, arriving = points[:-1] + tangent[:-1] * size / 3, points[1:] - tangent[1:] * size / 3
    return np.concatenate([points[:1], np.stack([leaving, arriving, points[1:]], axis=1).reshape(-1, 2)])


def fewest(
    points: Floats, first: Ints, weight: Floats, near: float, weighed: float
) -> tuple[npt.NDArray[np.bool_], Floats, Floats]:
    """Choose points of open paths such that the curves through these stay near the paths.

    From the ends on, the worst point of each leg is added until none is wrong: few points, if not provably the fewest.

    Args:
        points: (n, 2) of all paths, one path after the other.
        first: (m + 1,) where each path begins; none has fewer than two points.
        weight: (n,) of each point; it is linear between the points that are chosen.
        near: how far a curve may be from its path, and how far smoothing may move a point of the path before.
        weighed: how far the weight may be off.

    Returns:
        (n,) whether a point is chosen, (n, 2) the smoothed places, those of chosen points in whole numbers, (n,) the
        smoothed weights.

    """
    count = np.diff(first)
    path = np.repeat(np.arange(len(count)), count)
    ends = np.zeros(len(points), bool)
    ends[first[:-1]] = ends[first[1:] - 1] = True
    inner = np.flatnonzero(~ends)
    smooth, given = points.copy(), weight
    for _ in range(_ROUNDS):
        smooth[inner] = (smooth[inner - 1] + 2 * smooth[inner] + smooth[inner + 1]) / 4
        smooth = np.clip(smooth, points - near, points + near)
        weight = weight.copy()
        weight[inner] = (weight[inner - 1] + 2 * weight[inner] + weight[inner + 1]) / 4
        # an end has its neighbour's weight, so that the start of a ring does not stand out
        weight[first[:-1]], weight[first[1:] - 1] = weight[first[:-1] + 1], weight[first[1:] - 2]
        weight = np.clip(weight, given - weighed, given + weighed)
    legs = np.zeros(len(points))
    legs[1:] = lengths(smooth)
    run = np.cumsum(legs)
    chosen = ends.copy()
    while True:
        here = np.flatnonzero(chosen)
        begins = np.searchsorted(path[here], np.arange(len(count) + 1))
        knots = np.floor(smooth[here] + 0.5)
        off = np.flatnonzero(~chosen)
        a = (np.cumsum(chosen) - 1)[off]
        u = (run[off] - run[here[a]]) / np.maximum(run[here[a + 1]] - run[here[a]], 1e-9)
        aside, along = _beside(knots, _tangents(knots, begins), a, u[:, None], smooth[off])
        between = weight[here[a]] * (1 - u) + weight[here[a + 1]] * u
        wrong = np.maximum(np.maximum(aside, along / _ALONG) / near, np.abs(between - weight[off]) / weighed)
        bad = wrong > 1
        if not bad.any():
            smooth[here] = knots
            return chosen, smooth, weight
        off, a = off[bad], a[bad]
        order = np.lexsort((-wrong[bad], a))  # the worst of each leg
        worst = np.ones(len(order), bool)
        worst[1:] = a[order][1:] != a[order][:-1]
        chosen[off[order][worst]] = True


def _tangents(points: Floats, first: Ints) -> Floats:
    """The curve's direction (n, 2) at each point (n, 2) of several open paths, of about length 1."""
    steps = points[1:] - points[:-1]
    size = np.maximum(_size(steps), 1e-9)[:, None]
    slope = steps / size
    ends = np.zeros(len(points), bool)
    ends[first[:-1]] = ends[first[1:] - 1] = True
    inner = np.flatnonzero(~ends)
    tangent = np.zeros((len(points), 2))
    tangent[inner] = (slope[inner - 1] * size[inner] + slope[inner] * size[inner - 1]) / (size[inner] + size[inner - 1])
    short = (np.diff(first) == 2)[:, None]
    for end, leg, next_one in ((first[:-1], first[:-1], 1), (first[1:] - 1, first[1:] - 2, -1)):
        tangent[end] = np.where(short, slope[leg], 2 * slope[leg] - tangent[end + next_one])
    return tangent


def _beside(knots: Floats, tangent: Floats, leg: Ints, u: Floats, at: Floats) -> tuple[Floats, Floats]:
    """How far places (q, 2) lie from the curve's points at u (q, 1) of legs (q,): across the curve, and in all."""
    a, d = knots[leg], knots[leg + 1]
    size = _size(d - a)[:, None]
    b, c = a + tangent[leg] * size / 3, d - tangent[leg + 1] * size / 3
    v = 1 - u
    gap = at - (v * v * v * a + 3 * v * v * u * b + 3 * v * u * u * c + u * u * u * d)
    way = v * v * (b - a) + 2 * v * u * (c - b) + u * u * (d - c)
    return np.abs(gap[:, 0] * way[:, 1] - gap[:, 1] * way[:, 0]) / np.maximum(_size(way), 1e-9), _size(gap)


def _size(vectors: Floats) -> Floats:
    return np.asarray(np.sqrt(vectors[:, 0] * vectors[:, 0] + vectors[:, 1] * vectors[:, 1]))
