"""Edge points linked into chains, and the chains' loose ends joined to what they stop short of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from penink_cli.arrangement import _points
from penink_cli.arrangement.gradient import EdgePoints
from penink_cli.model import Floats

Ints32 = npt.NDArray[np.int32]

_STRETCH = 5  # points on each side of a corner that tell where it lies


@dataclass(frozen=True, eq=False)
class Chains:
    """Runs of edge points, one after the other along an edge.

    order: (p,) edge points, chain after chain; first: (c + 1,) offsets into it.
    ring: (c,) whether the last point is linked back to the first.
    """

    order: Ints32
    first: Ints32
    ring: npt.NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.ring)

    @property
    def owner(self) -> Ints32:
        """The chain (p,) of each entry of `order`."""
        return np.repeat(np.arange(len(self), dtype=np.int32), np.diff(self.first))

    def where(self, wanted: npt.NDArray[np.bool_]) -> Chains:
        """The chains for which wanted (c,) holds."""
        lengths = np.diff(self.first)[wanted]
        order = self.order[np.repeat(wanted, np.diff(self.first))]
        return Chains(order, np.concatenate([[0], np.cumsum(lengths)]).astype(np.int32), self.ring[wanted])


def link_chains(points: EdgePoints) -> Chains:
    """Link each edge point to the next along its edge (Devernay 1995); singles are left out."""
    n = len(points.pixel)
    following, preceding = np.empty(n, np.int32), np.empty(n, np.int32)
    _points.link(points.pixel, points.position, points.gradient, pixel_index(points), following, preceding)
    order, first = np.empty(n, np.int32), np.zeros(n + 1, np.int32)
    count = _points.follow(following, preceding, order, first)
    first = first[: count + 1]
    ring = preceding[order[first[:-1]]] >= 0 if count else np.zeros(0, bool)
    chains = Chains(order, first, ring)
    return chains.where(np.diff(first) > 1)


def pixel_index(points: EdgePoints) -> Ints32:
    """The point (h, w) of each pixel, -1 where there is none."""
    index = np.full(points.shape, -1, np.int32)
    index[points.pixel[:, 0], points.pixel[:, 1]] = np.arange(len(points.pixel), dtype=np.int32)
    return index


def chain_lengths(chains: Chains, position: Floats) -> Floats:
    """Length (c,) of each chain in pixels, along its points."""
    if not len(chains):
        return np.zeros(0)
    steps = np.zeros(len(chains.order))
    steps[1:] = np.hypot(*np.diff(position[chains.order], axis=0).T)
    steps[chains.first[:-1]] = 0
    return np.add.reduceat(steps, chains.first[:-1])


def unbend(points: EdgePoints, chains: Chains, blur: float) -> Floats:
    """Positions (n, 2) of all edge points with what blur has shifted on curves undone.

    Under a Gaussian of standard deviation s, the steepest place on the rim of a disc of radius R
    lies s²/2R inside the rim; so each point of a chain moves against its curvature by that much.
    At a corner, where the curvature is the blur's own, this gives back a part of its point.
    """
    position = points.position.copy()
    if not len(chains):
        return position
    p = points.position[chains.order]
    owner = chains.owner
    first, length = chains.first[:-1][owner], np.diff(chains.first)[owner]
    ring = chains.ring[owner]
    step = max(3, round(2 * blur))
    place = np.arange(len(p)) - first
    middle = np.where(ring, place, np.clip(place, step, length - 1 - step))
    here = p[first + np.clip(middle, 0, length - 1)]
    before = p[first + (middle - step) % length]
    after = p[first + (middle + step) % length]
    back, on = here - before, after - here
    far, near = np.hypot(*back.T)[:, None], np.hypot(*on.T)[:, None]
    bend = 2 * (on / np.maximum(near, 1e-9) - back / np.maximum(far, 1e-9)) / np.maximum(far + near, 1e-9)
    bend[length < 2 * step + 1] = 0
    shift = -0.5 * blur * blur * bend
    size = np.hypot(*shift.T)[:, None]
    position[chains.order] += shift * np.minimum(1, 0.5 * blur / np.maximum(size, 1e-9))
    return position


def sharpen(points: EdgePoints, chains: Chains, blur: float) -> tuple[Floats, Chains]:
    """Give corners that blur has rounded their points back.

    Where a chain turns sharply between two straight stretches, the stretches are prolonged to where
    they cross; the points between, which blur has pulled inward, are left out.

    Returns:
        positions (n, 2) of all edge points, and the chains without the points left out.

    """
    position = points.position.copy()
    skip = round(1.5 * blur) + 1
    far = skip + _STRETCH
    owner = chains.owner
    first, length, ring = chains.first[:-1][owner], np.diff(chains.first)[owner], chains.ring[owner]
    place = np.arange(len(chains.order)) - first
    fits = (length > 2 * far) & (ring | ((place >= far) & (place < length - far)))
    at = np.flatnonzero(fits)
    p = position[chains.order]

    def neighbour(step: int) -> npt.NDArray[np.intp]:
        return first[at] + (place[at] + step) % length[at]

    before, after = p[neighbour(-skip)], p[neighbour(skip)]
    back, on = before - p[neighbour(-far)], p[neighbour(far)] - after
    back /= np.maximum(1e-9, np.hypot(*back.T))[:, None]
    on /= np.maximum(1e-9, np.hypot(*on.T))[:, None]
    turn = np.arccos(np.clip((back * on).sum(axis=1), -1, 1))
    middle = skip + _STRETCH // 2
    way = np.sign(_cross(back, on))
    bow_back = way * _cross(p[neighbour(-middle)] - before, back)
    bow_on = way * _cross(p[neighbour(middle)] - after, on)
    # What a circle that bends as the stretches do would turn in between.
    steady = 4 * (bow_back + bow_on) / _STRETCH**2 * (2 * skip + _STRETCH)
    corner, s, t = _crossing(before, back, after, -on)
    shift = np.hypot(*(corner - p[at]).T)
    inside = ((corner > 0) & (corner < points.shape[::-1])).all(axis=1)
    good = (turn - np.maximum(0, steady) > 0.7) & (turn < 2.6) & inside
    good &= np.maximum(np.abs(bow_back), np.abs(bow_on)) < 0.3
    good &= (s > 0) & (t > 0) & (np.maximum(s, t) < 2 * skip) & (shift < 1.2 * blur)
    uneven = np.abs(np.where(good, s, 0) - np.where(good, t, 0))

    left_out = np.zeros(len(p), bool)
    taken = np.zeros(len(p), bool)
    # The middle of a corner is where both stretches are equally far from it.
    for k in np.flatnonzero(good)[np.lexsort((at[good], uneven[good]))]:
        span = first[at[k]] + (place[at[k]] + np.arange(-skip + 1, skip)) % length[at[k]]
        if taken[span].any():
            continue
        taken[span] = left_out[span] = True
        left_out[at[k]] = False
        position[chains.order[at[k]]] = corner[k]
    counts = np.add.reduceat(~left_out, chains.first[:-1]) if len(chains) else np.zeros(0, int)
    kept = Chains(chains.order[~left_out], np.concatenate([[0], np.cumsum(counts)]).astype(np.int32), chains.ring)
    return position, kept


def _cross(a: Floats, b: Floats) -> Floats:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


@dataclass(frozen=True, eq=False)
class Joints:
    """What closes the gaps at loose ends.

    trimmed: (p,) whether an entry of `Chains.order` is left out: near a junction the gradient is
        that of the other edge, and the end bends.
    places: (f, 2) x, y of new vertices, on the frame or at corners.
    links: (j, 2) edge points, or places (numbered from the number of points on), cheapest first.
    """

    trimmed: npt.NDArray[np.bool_]
    places: Floats
    links: Ints32


def join_ends(points: EdgePoints, chains: Chains, blur: float) -> Joints:
    """Join loose ends that stop short of another chain, of another end, or of the frame.

    An end is cut back by what the other edge's gradient has bent, and goes on straight from there.

    Args:
        points: edge points.
        chains: runs of them.
        blur: standard deviation (pixels) of the whole blur, the photo's and the detector's, which
            is how far junctions reach.

    """
    count = len(points.pixel)
    order, first = chains.order, chains.first
    loose = np.flatnonzero(~chains.ring)
    length = np.tile(np.diff(first)[loose], 2)
    at = np.concatenate([first[loose], first[loose + 1] - 1])
    inward = np.repeat([1, -1], len(loose))
    trim = np.minimum(round(1.2 * blur), np.maximum(0, (length - 6) // 2))
    third = np.clip((length - 1 - trim) // 2, 1, 4)
    position = points.position[order]
    p0, p1 = position[at + inward * trim], position[at + inward * np.minimum(trim + third, length - 1)]
    p2 = position[at + inward * np.minimum(trim + 2 * third, length - 1)]
    direction = np.where((length - 1 - trim < 4)[:, None], p0 - p1, 3 * p0 - 4 * p1 + p2)
    direction /= np.maximum(1e-9, np.hypot(*direction.T))[:, None]

    chain, place = np.full(count, -1, np.int32), np.zeros(count, np.int32)
    chain[order], place[order] = chains.owner, np.arange(len(order), dtype=np.int32)
    target, cost = np.empty(len(at), np.int32), np.empty(len(at))
    radius = 3.0 * blur + 2.0
    _points.reach(
        order[at], p0, direction, points.position, points.pixel, pixel_index(points), chain, place, radius, target, cost
    )

    on_frame, travel = _frame_ahead(p0, direction, points.shape)
    to_frame = (travel < radius) & (travel < cost)
    meets = (target >= 0) & ~to_frame

    # Two ends that meet each other at an angle make a corner, where their lines cross.
    end_of = np.full(count, -1, np.int32)
    end_of[order[at]] = np.arange(len(at))
    near_end = np.full(count, -1, np.int32)
    for back in range(round(2 * blur) + 1, -1, -1):
        reachable = back < length
        near_end[order[(at + inward * back)[reachable]]] = np.flatnonzero(reachable)
    partner = np.where(meets, near_end[target], -1)
    mutual = (partner >= 0) & (partner[partner] == np.arange(len(at))) & (partner != np.arange(len(at)))
    pairs = np.flatnonzero(mutual & (np.arange(len(at)) < partner))
    other = partner[pairs]
    crossing, s, t = _crossing(p0[pairs], direction[pairs], p0[other], direction[other])
    corner = (s > -0.5) & (t > -0.5) & (s < radius) & (t < radius)
    inside = ((crossing > 0) & (crossing < points.shape[::-1])).all(axis=1)
    corner &= inside

    trimmed = np.zeros(len(order), bool)
    joined = meets | to_frame
    for back in range(int(trim.max(initial=0))):
        cut = joined & (back < trim)
        trimmed[(at + inward * back)[cut]] = True
    starts = order[at + inward * np.where(joined, trim, 0)]
    corners = crossing[corner]
    frame_places = on_frame[to_frame]
    corner_number = count + len(frame_places) + np.arange(len(corners))
    a, b = pairs[corner], other[corner]
    single = meets.copy()
    single[pairs] = single[other] = False
    plain, plain_other = pairs[~corner], other[~corner]
    links = np.concatenate([
        np.column_stack([starts[a], corner_number]),
        np.column_stack([starts[b], corner_number]),
        np.column_stack([starts[plain], starts[plain_other]]),
        np.column_stack([starts[to_frame], count + np.arange(len(frame_places))]),
        np.column_stack([starts[single], target[single]]),
    ])  # fmt: skip
    price = np.concatenate([cost[a], cost[b], cost[plain], travel[to_frame], cost[single]])
    # A point that was cut away stands for the end of its chain.
    kept = np.ones(count, bool)
    kept[order[trimmed]] = False
    instead = np.arange(count + len(frame_places) + len(corners))
    for back in range(int(trim.max(initial=0))):
        cut = joined & (back < trim)
        instead[order[(at + inward * back)[cut]]] = starts[cut]
    links = instead[links[np.argsort(price, kind="stable")]].astype(np.int32)
    links = links[links[:, 0] != links[:, 1]]
    return Joints(trimmed, np.concatenate([frame_places, corners]), links)


def _frame_ahead(start: Floats, direction: Floats, shape: tuple[int, int]) -> tuple[Floats, Floats]:
    """Where (n, 2) lines from inside meet the frame, and how far (n,) they travel; inf where they graze it."""
    height, width = shape
    gap = np.stack([start[:, 0], width - start[:, 0], start[:, 1], height - start[:, 1]])
    outward = np.stack([-direction[:, 0], direction[:, 0], -direction[:, 1], direction[:, 1]])
    travel = np.where(outward > 0.25, gap / np.maximum(outward, 0.25), np.inf)
    side = np.argmin(travel, axis=0)
    nearest = travel[side, np.arange(len(start))]
    places = np.clip(start + direction * np.where(np.isfinite(nearest), nearest, 0)[:, None], 0, (width, height))
    for k, (axis, value) in enumerate([(0, 0), (0, width), (1, 0), (1, height)]):
        places[np.isfinite(nearest) & (side == k), axis] = value
    return places, nearest


def _crossing(p: Floats, d: Floats, q: Floats, e: Floats) -> tuple[Floats, Floats, Floats]:
    """Where lines p + s d and q + t e cross, with s and t; infinite where they are within 20 degrees of parallel."""
    cross = d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]
    parallel = np.abs(cross) < 0.35
    cross = np.where(parallel, 1.0, cross)
    between = q - p
    s = (between[:, 0] * e[:, 1] - between[:, 1] * e[:, 0]) / cross
    t = (between[:, 0] * d[:, 1] - between[:, 1] * d[:, 0]) / cross
    s, t = np.where(parallel, np.inf, s), np.where(parallel, np.inf, t)
    return p + d * np.where(parallel, 0, s)[:, None], s, t
