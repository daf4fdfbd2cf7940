"""Regions of an arrangement, which its edges part from one another, chosen by points inside."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.geometry.triangulation import Triangulation, triangulate
from penink_cli.ground.model import EdgeList, Floats

_NUDGE = (1e-7, 1e-8)  # pixels by which centres are shifted, so that none lies on an edge: the tie rule of `predicates`


def edges_around(edges: EdgeList, points: Floats) -> npt.NDArray[np.bool_]:
    """Which edges (m,) bound the regions that hold the points (p, 2), edges that only reach into them included.

    Raises ArrangementError for a point outside the frame.
    """
    mesh = triangulate(edges)
    sides = mesh.fixed & _chosen(mesh, points)[:, None]
    triangle, side = np.nonzero(sides)
    ends = mesh.triangles[triangle[:, None], (side[:, None] + np.array([0, 1])) % 3]
    bounding = np.sort(mesh.source[ends], axis=1)
    n = len(edges.vertices)
    own = np.sort(edges.edges, axis=1)
    return np.isin(own[:, 0] * n + own[:, 1], bounding[:, 0] * n + bounding[:, 1])


def region_mask(edges: EdgeList, points: Floats, columns: int, rows: int) -> npt.NDArray[np.bool_]:
    """Which pixels (rows, columns) of a picture that fills the frame have their centres in the points' regions.

    points: (p, 2). Raises ArrangementError for a point outside the frame.
    """
    mesh = triangulate(edges)
    inside = np.zeros((rows, columns), bool)
    scale = np.array([columns / edges.width, rows / edges.height])
    corners = mesh.vertices[mesh.triangles[_chosen(mesh, points)]] * scale
    low = np.clip(np.ceil(corners.min(axis=1) - 0.5 - _NUDGE[0]), 0, None).astype(np.int64)
    high = np.floor(corners.max(axis=1) - 0.5).astype(np.int64)
    for triangle, (x0, y0), (x1, y1) in zip(corners, low.tolist(), high.tolist()):
        x = np.arange(x0, min(x1, columns - 1) + 1) + 0.5 + _NUDGE[0]
        y = (np.arange(y0, min(y1, rows - 1) + 1) + 0.5 + _NUDGE[1])[:, None]
        held = np.ones((y.shape[0], x.shape[0]), bool)
        for a, b in zip(triangle, np.roll(triangle, -1, axis=0)):
            held &= (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) > 0
        inside[y0 : y0 + y.shape[0], x0 : x0 + x.shape[0]] |= held
    return inside


def _chosen(mesh: Triangulation, points: Floats) -> npt.NDArray[np.bool_]:
    """The triangles (t,) of the regions that hold the points."""
    return np.isin(mesh.regions, mesh.regions_of(points))
