"""Chains to few long segments, and never two that cross."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import numpy.typing as npt

from penink_cli.arrangement._compiled import points as _points
from penink_cli.arrangement._compiled import shorten as _shorten
from penink_cli.arrangement._compiled.planar import Planar
from penink_cli.arrangement.planar import UNIT, to_units

_SWEEPS = 6

Ints32 = npt.NDArray[np.int32]


def paths(ends: Ints32, live: npt.NDArray[np.bool_], vertex_count: int) -> tuple[Ints32, Ints32, Ints32]:
    """Cut the live segments of a graph into paths between nodes, the vertices not of degree 2.

    Args:
        ends: (m, 2) vertices of each segment.
        live: (m,).
        vertex_count: number of vertices.

    Returns:
        vertices and segments path after path, and the offsets of the paths (one more than paths).
        The last entry of each path's segments is -1. A ring comes back to its first vertex.

    """
    segments = np.flatnonzero(live).astype(np.int32)
    a, b = ends[segments, 0], ends[segments, 1]
    tail = np.concatenate([a, b])
    by_vertex = np.argsort(tail, kind="stable")
    neighbour = np.concatenate([b, a])[by_vertex].astype(np.int32)
    via = np.concatenate([segments, segments])[by_vertex].astype(np.int32)
    degree = np.bincount(tail, minlength=vertex_count).astype(np.int32)
    first = np.concatenate([[0], np.cumsum(degree)]).astype(np.int32)
    present = np.flatnonzero(degree)
    start = np.concatenate([present[degree[present] != 2], present[degree[present] == 2]]).astype(np.int32)
    room = 2 * len(segments) + 1
    path, segment, offset = np.empty(room, np.int32), np.empty(room, np.int32), np.zeros(room, np.int32)
    used = np.zeros(len(ends), np.uint8)
    count = _points.trace(start, degree, first, neighbour, via, used, path, segment, offset)
    return path[: offset[count]], segment[: offset[count]], offset[: count + 1]


def simplify(planar: Planar, tolerance: float, width: int, height: int) -> None:
    """Replace the arrangement's paths by segments within tolerance (pixels) of them.

    Nodes stay where they are while paths are divided. A shortcut that would touch another edge is
    not taken. The path is then divided further, at worst down to its own segments. In the end
    vertices move to between the points that their segments stand for, but for open ends and those on
    the frame: on a curve, segments through its points would all lie on its inner side.
    """
    vertices, ends = np.asarray(planar.vertices), np.asarray(planar.ends)
    path, segment, offset = paths(ends, np.asarray(planar.live)[: len(ends)].astype(bool), len(vertices))
    places = vertices[path].astype(float)
    kept = np.zeros(len(path), np.uint8)
    stack = np.zeros((len(path) + 2, 2), np.int32)
    for first, last in pairwise(offset.tolist()):
        _shorten.shorten(planar, path[first:last], segment[first : last - 1], tolerance / UNIT, stack, kept[first:last])

    run_first, run_last = np.zeros(len(ends), np.int32), np.full(len(ends), -1, np.int32)
    stops = np.flatnonzero(kept)
    follows = segment[stops] >= 0
    run_first[segment[stops[follows]]] = stops[follows]
    run_last[segment[stops[follows]]] = stops[np.flatnonzero(follows) + 1]
    live = np.flatnonzero(np.asarray(planar.live)[: len(ends)])
    tail = np.concatenate([ends[live, 0], ends[live, 1]])
    around = np.concatenate([live, live])[np.argsort(tail, kind="stable")].astype(np.int32)
    degree = np.bincount(tail, minlength=len(vertices))
    around_first = np.concatenate([[0], np.cumsum(degree)]).astype(np.int32)
    limit = to_units(np.array([width, height], float))
    inner = ((vertices > 0) & (vertices < limit)).all(axis=1)
    movable = np.flatnonzero((degree > 1) & inner).astype(np.int32)
    furthest = tolerance / UNIT
    right, bottom = limit.tolist()
    _shorten.settle(
        planar, movable, around_first, around, run_first, run_last, places, furthest, right, bottom, _SWEEPS
    )
