"""Discontinuity edges."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from penink_cli.ground.model.arrays import Floats, Ints


@dataclass(frozen=True, eq=False)
class EdgeList:
    """An arrangement of discontinuity edges, in pixels of the photo it was found in.

    width, height: the image frame [0, width] × [0, height], whole photo pixels.
    vertices: (n, 2) x, y.
    edges: (m, 2) indices into vertices. Edges meet only at shared vertices.
    strength: (m,) grey step across each edge, 0 … 1, or None where not known.

    One edge list serves every resolution of its image: see `scaled`.
    """

    width: int
    height: int
    vertices: Floats = field(default_factory=lambda: np.zeros((0, 2)))
    edges: Ints = field(default_factory=lambda: np.zeros((0, 2), np.int64))
    strength: Floats | None = None

    def scaled(self, width: float, height: float) -> Floats:
        """Vertices (n, 2) in an image of width × height that fills the same frame."""
        return self.vertices * (width / self.width, height / self.height)
