"""Edges on the lattice of odd 32nds of a sample, where no vertex meets a sample, a square's border or the frame.

A device computes with 32-bit reals. On this lattice coordinates, and all questions about samples
and edges, are exact, and ties (queries on an edge) are rare. Vertices on the frame's border go to
the lattice line just outside it, so that no path slips through between an edge and the border.
"""

from __future__ import annotations

import numpy as np

from penink_cli.geometry.quantisation import quantise
from penink_cli.geometry.sides import rounded_beside_samples
from penink_cli.ground.model import EdgeList, Floats, Ints

PARTS = 16  # lattice lines a sample


def on_lattice(edges: EdgeList, w: int, h: int) -> tuple[Ints, Ints, Floats | None]:
    """Edges over w × h samples as vertices (n, 2) in whole numbers, edges (m, 2) and their strengths.

    Vertex i lies at (i + ½) / 16 samples from the frame's corner: 0 … 16w - 1 within the frame,
    -1 and 16w beyond its border. The result is an arrangement again: vertices that fell together are
    one, and edges that came to cross are split or, in a tangle, left out.
    """
    scale = np.array([w, h]) * PARTS
    at = edges.scaled(float(scale[0]), float(scale[1]))
    # samples stay on their sides of the edges; in units of the lattice vertex i lies at i + ½, the first sample at 8
    beside = rounded_beside_samples(at - 0.5, edges.edges, PARTS, PARTS / 2 - 0.5)
    near = np.where(at >= scale, scale, np.clip(beside, 0, scale - 1))
    near = np.where(at <= 0, -1, near)
    grid = EdgeList(int(scale[0]) + 2, int(scale[1]) + 2, near + 1, edges.edges, edges.strength)
    moved = quantise(grid, grid.width, grid.height)
    vertices = np.rint(moved.vertices).astype(np.int64) - 1
    ends = moved.edges
    # an edge along the border or beyond it has nothing within the frame
    out = ((vertices < 0) | (vertices >= scale))[ends]
    keep = ~(out[:, 0] & out[:, 1]).any(axis=1)
    return vertices, ends[keep], None if moved.strength is None else moved.strength[keep]
