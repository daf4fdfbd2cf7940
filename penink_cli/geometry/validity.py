"""Whether an edge list is an arrangement: edges that meet only at shared vertices, each once, within the frame.

Everything is decided exactly, on the coordinates as they are. The first fault found is raised and names its edges.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.geometry._compiled import sweep as _sweep
from penink_cli.ground.errors import ArrangementError
from penink_cli.ground.model import EdgeList, Floats, Ints


def check(edges: EdgeList) -> None:
    """Raise ArrangementError unless the edges are an arrangement.

    Refused are coordinates that are not finite, vertices outside the frame or repeated, edges to vertices that do not
    exist, of no length, repeated, overlapping or crossing, and vertices in the middle of an edge. The search takes
    n log n steps and memory in proportion to n, however many edges cross.
    """
    x = np.ascontiguousarray(edges.vertices[:, 0])
    y = np.ascontiguousarray(edges.vertices[:, 1])
    order = _by_x_then_y(x, y)
    _check_vertices(edges, order)
    _check_ends(edges)
    if len(edges.edges) == 0:
        return
    rank = np.zeros(len(order), np.intc)
    rank[order] = np.arange(len(order), dtype=np.intc)
    swap = rank[edges.edges[:, 0]] > rank[edges.edges[:, 1]]
    start = np.where(swap, edges.edges[:, 1], edges.edges[:, 0]).astype(np.intc)
    end = np.where(swap, edges.edges[:, 0], edges.edges[:, 1]).astype(np.intc)
    down, across = y[end] - y[start], x[end] - x[start]  # across from 0 on, down above 0 where it is 0
    slope = np.where(across > 0, down / np.where(across > 0, across, 1.0), np.inf)
    leaving = np.lexsort((slope, start)).astype(np.intc)
    first = np.zeros(len(x) + 1, np.intc)
    np.cumsum(np.bincount(start, minlength=len(x)), out=first[1:])
    used = np.zeros(len(x), bool)
    used[edges.edges] = True  # a vertex without an edge may lie on an edge
    order = order[used[order]]
    fault = _sweep.find(x, y, order, start, end, leaving, first)
    if fault is None:
        return
    kind, one, two = fault
    if kind == "touch":
        raise ArrangementError(_touch(edges, one, two))
    raise ArrangementError(f"edges {min(one, two)} and {max(one, two)} {kind}; edges may meet only at a shared vertex")


def _by_x_then_y(x: Floats, y: Floats) -> npt.NDArray[np.intc]:
    """The order of the vertices. A sort by x and another of those with equal x take a third of a lexsort's time."""
    order = np.argsort(x, kind="stable")
    same = np.diff(x[order]) == 0
    tied = np.zeros(len(x), bool)
    tied[1:] = same
    tied[:-1] |= same
    few = order[tied]
    order[tied] = few[np.lexsort((y[few], x[few]))]
    return order.astype(np.intc)


def _check_vertices(edges: EdgeList, order: npt.NDArray[np.intc]) -> None:
    vertices = edges.vertices
    bad = ~np.isfinite(vertices).all(axis=1)
    if bad.any():
        v = int(bad.argmax())
        raise ArrangementError(f"{_where(edges, v)}vertex {v} is not finite: {_point(edges, v)}")
    bad = ((vertices < 0) | (vertices > (edges.width, edges.height))).any(axis=1)
    if bad.any():
        v = int(bad.argmax())
        raise ArrangementError(
            f"{_where(edges, v)}vertex {v} at {_point(edges, v)} is outside the frame of {edges.width} x {edges.height}"
        )
    same = (vertices[order[1:]] == vertices[order[:-1]]).all(axis=1)
    if same.any():
        k = int(same.argmax())
        u, v = sorted((int(order[k]), int(order[k + 1])))
        raise ArrangementError(f"{_where(edges, v)}vertex {v} repeats vertex {u} at {_point(edges, v)}")


def _check_ends(edges: EdgeList) -> None:
    ends = edges.edges
    bad = ((ends < 0) | (ends >= len(edges.vertices))).any(axis=1)
    if bad.any():
        e = int(bad.argmax())
        v = next(int(k) for k in ends[e] if not 0 <= k < len(edges.vertices))
        known = f"0..{len(edges.vertices) - 1}" if len(edges.vertices) else "an empty list"
        raise ArrangementError(f"edge {e}: vertex {v} is not in {known}")
    bad = ends[:, 0] == ends[:, 1]
    if bad.any():
        e = int(bad.argmax())
        raise ArrangementError(f"edge {e} has no length: both its ends are vertex {ends[e, 0]}")
    pair: Ints = np.sort(ends, axis=1)
    order = np.lexsort((pair[:, 1], pair[:, 0]))
    same = (pair[order[1:]] == pair[order[:-1]]).all(axis=1)
    if same.any():
        k = int(same.argmax())
        e, f = sorted((int(order[k]), int(order[k + 1])))
        raise ArrangementError(f"edge {f} repeats edge {e}")


def _touch(edges: EdgeList, e: int, v: int) -> str:
    """The report of vertex v in the middle of edge e: as an overlap if an edge at the vertex lies along e."""
    a, b = edges.vertices[edges.edges[e]]
    here = edges.vertices[v]
    touching = np.flatnonzero((edges.edges == v).any(axis=1))
    for f in touching:
        far = edges.vertices[edges.edges[f].sum() - v]
        if _sweep.orientation(*a, *b, *far) == 0:
            return f"edges {min(e, f)} and {max(e, f)} overlap; edges may meet only at a shared vertex"
    at = f", an end of edge {touching[0]}," if len(touching) else ""
    place = ",".join(_number(c) for c in here)
    return f"edge {e}: vertex {v}{at} at {place} lies on it; edges may meet only at a shared vertex"


def _where(edges: EdgeList, v: int) -> str:
    """The beginning of a message about a vertex, which names the first edge at it."""
    at = (edges.edges == v).any(axis=1)
    return f"edge {int(at.argmax())}: " if at.any() else ""


def _point(edges: EdgeList, v: int) -> str:
    return ",".join(_number(c) for c in edges.vertices[v])


def _number(value: float) -> str:
    return f"{value:.6g}"
