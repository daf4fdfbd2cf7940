"""Shortest unobstructed paths around discontinuity edges (section 2.2): the public face of the compiled search."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from penink_cli.ground import threads as threading
from penink_cli.ground.model import EdgeList, Floats
from penink_cli.reconstruction._compiled import cells as _cells
from penink_cli.reconstruction._compiled import nodes as _nodes
from penink_cli.reconstruction._compiled import scene as _scene
from penink_cli.reconstruction._compiled import search as _search

BLOCK = 2.0 * math.sqrt(2.0)  # how far a point can be from a sample under its 4 × 4 kernel


def reach(radius: float, widening: float = 1.0) -> float:
    """How long a path from a sample to a bend can be and still matter: farthest tap and ellipse (equation 6)."""
    return BLOCK * widening + radius * widening


def spill(radius: float) -> int:
    """Cells by which the ellipse of any pixel and any of its 16 samples can reach beyond their 3 × 3 cells, rounded up.

    An ellipse with foci d apart, δ of it along an axis, ends ½ √(δ² + 2 d r + r²) − δ/2 beyond the farther focus
    along that axis; here δ is 1 … 2 and d at most √(δ² + 4). For r = 1 that is 0.78.
    """
    across = max(
        0.5 * math.sqrt(delta * delta + 2.0 * radius * math.sqrt(delta * delta + 4.0) + radius * radius) - 0.5 * delta
        for delta in (1.0, 1.25, 1.5, 1.75, 2.0)
    )
    return math.ceil(across + 0.1)


def sample_units(points: Floats, width: int, height: int, frame: tuple[float, float]) -> Floats:
    """Points (n, 2) of an image frame in sample units of width × height samples: samples are at the integers."""
    return np.ascontiguousarray(points * (float(width), float(height)) / frame - 0.5)


class Paths:
    """The edges of an image of width × height samples, made ready for questions of visibility and distance.

    The edges must be an arrangement (`geometry.validity.check`). Points are in sample units throughout.
    A point asked about stands for p + (ε, ε²): it is on neither edge nor vertex, whatever its coordinates.

    limit: no path longer than this will be asked for.
    """

    def __init__(self, edges: EdgeList | None, width: int, height: int, limit: float | None = None):
        self.width, self.height = width, height
        self.limit = reach(1.0) if limit is None else limit
        if edges is None:
            edges = EdgeList(width, height)
        vertices = sample_units(edges.vertices, width, height, (edges.width, edges.height))
        self.scene = _scene.Scene(vertices, edges.edges, width, height, self.limit)
        if not self.empty:
            _cells.sort_edges(self.scene)
            _nodes.find(self.scene)

    @property
    def empty(self) -> bool:
        """Whether there is no edge at all."""
        return self.scene.n_edges == 0

    def finder(self, *, closed: bool = False, rows: tuple[int, int] | None = None) -> _search.Finder:
        """A search for one thread; see `search.Finder`."""
        first, last = rows or (0, self.height)
        return _search.Finder(self.scene, first, last, self.limit, closed)

    def visible(self, p: Floats, q: Floats) -> npt.NDArray[np.bool_]:
        """(n,) whether p[k] sees q[k] across no edge; p, q: (n, 2)."""
        p, q = np.ascontiguousarray(p, np.float64), np.ascontiguousarray(q, np.float64)
        out = np.empty(len(p), np.intc)
        _scene.visible(self.scene, p, q, 0, len(p), out)
        return out.astype(bool)

    def lengths(self, p: Floats, q: Floats, limit: float | None = None, threads: int | None = None) -> Floats:
        """(n,) length of the shortest unobstructed path from p[k] to q[k], infinite beyond the limit; p, q: (n, 2)."""
        p, q = np.ascontiguousarray(p, np.float64), np.ascontiguousarray(q, np.float64)
        limit = self.limit if limit is None else min(limit, self.limit)
        out = np.empty(len(p))

        def run(begin: int, end: int) -> None:
            _search.path_lengths(self.finder(rows=(0, 0)), p, q, limit, begin, end, out)

        threading.share(threading.ranges(run, len(p), 4096), threading.count(threads))
        return out
