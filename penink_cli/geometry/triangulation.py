"""The topology of an arrangement: its constrained Delaunay triangulation, the regions that edges enclose, walking.

`meshers` asks a library for the triangles. Nothing that is written may depend on more than the regions that these form.
Triangles turn positively, (b − a) × (c − a) > 0, which with y down is clockwise on the page:

        c            side k of a triangle runs from its corner k to its corner k + 1;
       / \\           neighbours[t, k] is the triangle beyond side k, −1 beyond the frame;
      2   1          fixed[t, k] says that side k is an edge of the arrangement.
     /     \\
    a---0---b

A query point stands for p + (ε, ε²), the tie rule of `_compiled/predicates.pyx`, so it is always inside one triangle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from penink_cli.geometry._compiled.sweep import orientation
from penink_cli.geometry.meshers import mesh
from penink_cli.ground.errors import ArrangementError
from penink_cli.ground.model import EdgeList, Floats, Ints


@dataclass(frozen=True, eq=False)
class Triangulation:
    """A frame cut into triangles along the edges of an arrangement.

    vertices: (n, 2) those of the arrangement that have an edge, then corners of the frame that are not among these.
    source: (n,) each vertex's number in the edge list, −1 for a corner of the frame.
    triangles: (t, 3). neighbours: (t, 3) triangles, −1 for none. fixed: (t, 3).
    regions: (t,) the number of each triangle's region; triangles are joined across sides that are not fixed.
    """

    vertices: Floats
    source: Ints
    triangles: Ints
    neighbours: Ints
    fixed: npt.NDArray[np.bool_]
    regions: Ints

    def side(self, a: int, b: int, x: float, y: float) -> int:
        """Side of the line of vertices a → b on which the query (x, y) lies: 1 or −1."""
        (ax, ay), (bx, by) = self.vertices[a].tolist(), self.vertices[b].tolist()
        s = orientation(ax, ay, bx, by, x, y)
        if s == 0:
            s = (by < ay) - (by > ay) or (bx > ax) - (bx < ax)
        return s

    def locate(self, x: float, y: float, start: int = 0) -> int:
        """The triangle that a point inside the frame is in, found by walking from triangle `start`.

        Raises ArrangementError for a point outside the frame.
        """
        t, came = start, -1
        # A Delaunay triangulation has no cycle for a walk to fall into, a constrained one may: the side to begin with
        # then changes from step to step, and a walk that is too long anyhow gives way to looking everywhere.
        for step in range(4 * len(self.triangles) + 4):
            for k in ((step + i) % 3 for i in range(3)):
                a, b = self.triangles[t, k], self.triangles[t, (k + 1) % 3]
                beyond = int(self.neighbours[t, k])
                if (beyond != came or came < 0) and self.side(a, b, x, y) < 0:
                    if beyond < 0:
                        raise ArrangementError(f"point {x:.6g},{y:.6g} is outside the frame")
                    t, came = beyond, t
                    break
            else:
                return t
        for t, corners in enumerate(self.triangles):
            if all(self.side(corners[k], corners[(k + 1) % 3], x, y) > 0 for k in range(3)):
                return t
        raise ArrangementError(f"point {x:.6g},{y:.6g} is outside the frame")

    def regions_of(self, points: Floats) -> Ints:
        """(n,) the region that each point (n, 2) is in; fastest where each point is near the one before.

        Raises ArrangementError for a point outside the frame.
        """
        out = np.empty(len(points), np.int64)
        t = 0
        for i, (x, y) in enumerate(points.tolist()):
            t = self.locate(x, y, t)
            out[i] = self.regions[t]
        return out


def triangulate(edges: EdgeList) -> Triangulation:
    """The constrained Delaunay triangulation of a valid arrangement within its frame.

    Raises ArrangementError where edges cross or pass through a vertex, ParameterError where no mesher is installed.
    """
    used = np.unique(edges.edges)
    place = np.full(len(edges.vertices), -1, np.int64)
    place[used] = np.arange(len(used))
    vertices = edges.vertices[used]
    w, h = float(edges.width), float(edges.height)
    corners = np.array([c for c in ((0.0, 0.0), (w, 0.0), (w, h), (0.0, h)) if not (vertices == c).all(axis=1).any()])
    corners = corners.reshape(-1, 2)
    vertices = np.concatenate([vertices, corners])
    source = np.concatenate([used, np.full(len(corners), -1)]).astype(np.int64)
    segments = place[edges.edges]
    triangles = _turned(vertices, mesh(vertices, segments))
    neighbours = _neighbours(triangles)
    fixed = _fixed(triangles, segments, len(vertices))
    return Triangulation(vertices, source, triangles, neighbours, fixed, _regions(neighbours, fixed))


def _turned(vertices: Floats, triangles: Ints) -> Ints:
    """All triangles turning positively. The few slivers whose turn rounding could hide are asked exactly."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    left, right = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]), (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    turn = np.sign(left - right)
    for t in np.flatnonzero(np.abs(left - right) <= 1e-15 * (np.abs(left) + np.abs(right))):
        turn[t] = orientation(*a[t], *b[t], *c[t])
    return np.where((turn < 0)[:, None], triangles[:, ::-1], triangles)


def _neighbours(triangles: Ints) -> Ints:
    """The triangle beyond each side, −1 for none. Sorted by their ends, the two halves of a side stand side by side."""
    sides = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    low, high = sides.min(axis=1), sides.max(axis=1)
    order = np.lexsort((high, low))
    twin = np.flatnonzero((low[order[1:]] == low[order[:-1]]) & (high[order[1:]] == high[order[:-1]]))
    out = np.full(len(sides), -1, np.int64)
    one, other = order[twin], order[twin + 1]
    out[one], out[other] = other // 3, one // 3
    return out.reshape(-1, 3)


def _fixed(triangles: Ints, segments: Ints, n: int) -> npt.NDArray[np.bool_]:
    """Which sides are edges of the arrangement."""
    following = np.roll(triangles, -1, axis=1)
    keys = np.minimum(triangles, following) * n + np.maximum(triangles, following)
    return (
        np.isin(keys, segments.min(axis=1) * n + segments.max(axis=1)) if len(segments) else np.zeros_like(keys, bool)
    )


def _regions(neighbours: Ints, fixed: npt.NDArray[np.bool_]) -> Ints:
    """The region (t,) of each triangle: triangles joined across free sides. Regions are numbered by first triangles."""
    region = np.full(len(neighbours), -1, np.int64)
    count = 0
    free = np.where(fixed, -1, neighbours).tolist()
    for seed in range(len(neighbours)):
        if region[seed] >= 0:
            continue
        region[seed] = count
        stack = [seed]
        while stack:
            for beyond in free[stack.pop()]:
                if beyond >= 0 and region[beyond] < 0:
                    region[beyond] = count
                    stack.append(beyond)
        count += 1
    return region
