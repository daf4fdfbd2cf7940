"""The two libraries that cut a frame into triangles; the one module that imports them.

`triangle` wraps Shewchuk's Triangle, which may not be sold or put into a commercial product; it has no release for
CPython 3.14, 64-bit ARM or musl. `pythoncdt` (MPL 2.0) is there everywhere. Both give a constrained Delaunay
triangulation. Where four vertices lie on a circle the two choose different diagonals, so nothing that is written may
depend on these. The regions are the same, and so are the bytes.

The environment variable PENINK_MESHER names the library to use; without it, `triangle` is used where it is installed.
"""

from __future__ import annotations

import importlib.util
import os
from collections.abc import Callable
from typing import Any

import numpy as np

from penink_cli.ground.errors import ArrangementError, ParameterError, in_quotes
from penink_cli.ground.model import Floats, Ints

VARIABLE = "PENINK_MESHER"
OWN = 2  # segment marker of the arrangement's edges; triangle uses 0 and 1 for its own


def by_triangle(vertices: Floats, segments: Ints) -> Ints:
    """Triangles (t, 3) by `triangle`; see `mesh`."""
    import triangle

    # "p" obeys segments, "c" fills the convex hull, which is the frame. Without "c" nothing is left of open edges, and
    # an empty array of segments is an error there.
    if len(segments):
        marks = np.full((len(segments), 1), OWN, np.int32)
        result = triangle.triangulate(
            {"vertices": vertices, "segments": segments.astype(np.int32), "segment_markers": marks}, "pc"
        )
    else:
        result = triangle.triangulate({"vertices": vertices}, "c")
    triangles = np.asarray(result["triangles"], np.int64)
    # It splits crossing segments at a new vertex, and a segment through a vertex in silence.
    if len(result["vertices"]) != len(vertices) or not _has_sides(triangles, segments, len(vertices)):
        raise _crossing()
    return triangles


def by_pythoncdt(vertices: Floats, segments: Ints) -> Ints:
    """Triangles (t, 3) by `pythoncdt`; see `mesh`."""
    import pythoncdt

    edges = np.unique(np.sort(np.concatenate([segments, *_frame(vertices)]), axis=1), axis=0)
    mesh: Any = pythoncdt.Triangulation(
        pythoncdt.VertexInsertionOrder.AUTO, pythoncdt.IntersectingConstraintEdges.NOT_ALLOWED, 0.0
    )
    mesh.insert_vertices(np.ascontiguousarray(vertices, np.float64))
    try:
        mesh.insert_edges(np.ascontiguousarray(edges, np.uintc))
    except Exception as error:  # the library does not export its classes of errors
        raise _crossing() from error
    mesh.erase_outer_triangles()
    # It splits an edge through a vertex in silence.
    if mesh.vertices_count() != len(vertices) or mesh.fixed_edges_count() != len(edges):
        raise _crossing()
    return np.asarray(mesh.triangles_array(copy=True)["vertices"], np.int64)


MESHERS: dict[str, Callable[[Floats, Ints], Ints]] = {"triangle": by_triangle, "pythoncdt": by_pythoncdt}


def mesh(vertices: Floats, segments: Ints) -> Ints:
    """Triangles (t, 3) that fill a frame and keep to the segments (m, 2) of a valid arrangement, turning either way.

    vertices: (n, 2) finite, each once, the frame's corners among them.

    Raises ArrangementError where segments cross or run through a vertex, ParameterError where no library is installed
    or PENINK_MESHER names another.
    """
    return MESHERS[_chosen()](vertices, segments)


def _has_sides(triangles: Ints, segments: Ints, n: int) -> bool:
    """Whether every segment (m, 2) between n vertices is a side of a triangle (t, 3)."""
    following = np.roll(triangles, -1, axis=1)
    sides = np.minimum(triangles, following) * n + np.maximum(triangles, following)
    return bool(np.isin(segments.min(axis=1, initial=n) * n + segments.max(axis=1, initial=0), sides).all())


def _chosen() -> str:
    """The library that the environment names, or the first that is there."""
    name = os.environ.get(VARIABLE)
    if name:
        if name not in MESHERS:
            raise ParameterError(f"{VARIABLE}={in_quotes(name)}: known are {', '.join(MESHERS)}")
        if importlib.util.find_spec(name) is None:
            raise ParameterError(f"{VARIABLE}={name}: it is not installed")
        return name
    for name in MESHERS:
        if importlib.util.find_spec(name) is not None:
            return name
    raise ParameterError("neither triangle nor pythoncdt is installed; one is needed to part the frame into regions")


def _frame(vertices: Floats) -> list[Any]:
    """The four sides of the frame, each a chain (k, 2) through the vertices on it."""
    sides = []
    for axis in (0, 1):
        for at in (vertices[:, axis].min(), vertices[:, axis].max()):
            on = np.flatnonzero(vertices[:, axis] == at)
            on = on[np.argsort(vertices[on, 1 - axis], kind="stable")]
            sides.append(np.stack([on[:-1], on[1:]], axis=1))
    return sides


def _crossing() -> ArrangementError:
    return ArrangementError("edges cross: the arrangement must be valid before it is triangulated")
