"""Loose ends of chains, joined to the edges before which they stop."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from penink_cli.arrangement._compiled import points as _points
from penink_cli.arrangement.chains import Chains
from penink_cli.arrangement.corners import crossing
from penink_cli.arrangement.gradient import EdgePoints
from penink_cli.ground import exact
from penink_cli.ground.model import Floats

Ints32 = npt.NDArray[np.int32]

_TRIM = 1.2  # in parts of the blur: so near to a junction the other edge bends an end noticeably


@dataclass(frozen=True, eq=False)
class Ends:
    """The loose ends of chains, and what each would meet if it went on straight.

    at: (n,) places in `Chains.order`. inward: (n,) 1 or -1, the way from the end into the chain. length: (n,) points of
    the chain. trim: (n,) points next to the end that are bent by another edge.
    start, direction: (n, 2) where the straight line leaves the chain, and its unit vector.
    target: (n,) edge point ahead, -1 for none. cost: (n,) of going there: pixels ahead, and twice those aside.
    on_frame: (n, 2) where the line meets the frame. travel: (n,) how far that is, pixels. radius: how far ends may go.
    """

    at: npt.NDArray[np.intp]
    inward: npt.NDArray[np.intp]
    length: npt.NDArray[np.intp]
    trim: npt.NDArray[np.intp]
    start: Floats
    direction: Floats
    target: Ints32
    cost: Floats
    on_frame: Floats
    travel: Floats
    radius: float

    @property
    def to_frame(self) -> npt.NDArray[np.bool_]:
        """Which ends (n,) go to the frame."""
        return (self.travel < self.radius) & (self.travel < self.cost)

    @property
    def meets(self) -> npt.NDArray[np.bool_]:
        """Which ends (n,) go to an edge point."""
        return (self.target >= 0) & ~self.to_frame


def loose_ends(points: EdgePoints, chains: Chains, blur: float, hosts: npt.NDArray[np.bool_] | None = None) -> Ends:
    """Look ahead from each end of an open chain.

    Args:
        points: edge points.
        chains: chains of edge points.
        blur: standard deviation (pixels) of the whole blur, the photo's and the detector's, which
            is how far junctions reach.
        hosts: (c,) whether each chain may be met; None for all.

    """
    count = len(points.pixel)
    order, first = chains.order, chains.first
    loose = np.flatnonzero(~chains.ring)
    length = np.tile(np.diff(first)[loose], 2)
    at = np.concatenate([first[loose], first[loose + 1] - 1])
    inward = np.repeat([1, -1], len(loose))
    trim = np.minimum(round(_TRIM * blur), np.maximum(0, (length - 6) // 2))
    third = np.clip((length - 1 - trim) // 2, 1, 6)
    position = points.position[order]
    p0, p1 = position[at + inward * trim], position[at + inward * np.minimum(trim + third, length - 1)]
    p2 = position[at + inward * np.minimum(trim + 2 * third, length - 1)]
    direction = np.where((length - 1 - trim < 4)[:, None], p0 - p1, 3 * p0 - 4 * p1 + p2)
    direction /= np.maximum(1e-9, exact.length(direction))[:, None]

    chain, place = np.full(count, -1, np.int32), np.zeros(count, np.int32)
    owner = chains.owner
    chain[order] = owner if hosts is None else np.where(hosts[owner], owner, -1)
    place[order] = np.arange(len(order), dtype=np.int32)
    target, cost = np.empty(len(at), np.int32), np.empty(len(at))
    radius = 3.0 * blur + 2.0
    _points.reach(
        order[at], p0, direction, points.position, points.pixel, points.index, chain, place, radius, target, cost
    )
    on_frame, travel = _frame_ahead(p0, direction, points.shape)
    return Ends(at, inward, length, trim, p0, direction, target, cost, on_frame, travel, radius)


@dataclass(frozen=True, eq=False)
class Joints:
    """Vertices and links that close the gaps at loose ends.

    trimmed: (p,) whether an entry of `Chains.order` is left out: near a junction the gradient is
        that of the other edge, and bends the end.
    places: (f, 2) x, y of new vertices, on the frame or at corners.
    links: (j, 2) pairs of edge points and places, cheapest first; the numbers of places go on after those of points.
    """

    trimmed: npt.NDArray[np.bool_]
    places: Floats
    links: Ints32


def join_ends(points: EdgePoints, chains: Chains, blur: float) -> Joints:
    """Join loose ends that stop short of another chain, of another end, or of the frame.

    The points of an end that the other edge's gradient has bent are cut off, and the end goes on straight from there.

    Args:
        points: edge points.
        chains: chains of edge points.
        blur: standard deviation (pixels) of the whole blur, the photo's and the detector's, which
            is how far junctions reach.

    """
    count = len(points.pixel)
    order = chains.order
    ends = loose_ends(points, chains, blur)
    at, inward, length, trim, target, cost = ends.at, ends.inward, ends.length, ends.trim, ends.target, ends.cost
    p0, direction, on_frame, travel, radius = ends.start, ends.direction, ends.on_frame, ends.travel, ends.radius
    to_frame, meets = ends.to_frame, ends.meets

    # Two ends that meet each other at an angle make a corner, where their lines cross.
    near_end = np.full(count, -1, np.int32)
    for back in range(round(2 * blur) + 1, -1, -1):
        reachable = back < length
        near_end[order[(at + inward * back)[reachable]]] = np.flatnonzero(reachable)
    partner = np.where(meets, near_end[target], -1)
    mutual = (partner >= 0) & (partner[partner] == np.arange(len(at))) & (partner != np.arange(len(at)))
    pairs = np.flatnonzero(mutual & (np.arange(len(at)) < partner))
    other = partner[pairs]
    meeting, s, t = crossing(p0[pairs], direction[pairs], p0[other], direction[other])
    corner = (s > -0.5) & (t > -0.5) & (s < radius) & (t < radius)
    inside = ((meeting > 0) & (meeting < points.shape[::-1])).all(axis=1)
    corner &= inside

    trimmed = np.zeros(len(order), bool)
    joined = meets | to_frame
    for back in range(int(trim.max(initial=0))):
        cut = joined & (back < trim)
        trimmed[(at + inward * back)[cut]] = True
    starts = order[at + inward * np.where(joined, trim, 0)]
    corners = meeting[corner]
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
    """Where lines from points inside meet the frame (n, 2), and how far that is (n,); inf where they only graze it."""
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
