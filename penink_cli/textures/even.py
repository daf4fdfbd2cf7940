"""Placing things on a torus so that every prefix of them is evenly spread.

Greedy: of many random candidates the one in the emptiest place is next. How empty a place is, is measured by a
potential: the sum over all ink so far of a kernel that falls off with distance as 1/r, softened. It works on all scales
at once: the first ten and the first thousand are both even.
"""

from __future__ import annotations

import numpy as np

from penink_cli.ground.model import Floats


class Torus:
    """The potential on a torus of width × height points.

    soft: the distance, points, below which the kernel hardly rises. grid: step, points, of the grid that holds it.
    """

    def __init__(self, width: float, height: float, soft: float, grid: float = 1.0):
        self.columns = max(8, round(width / grid))
        self.rows = max(8, round(height / grid))
        self.scale = np.array([self.columns / width, self.rows / height])
        self.field = np.zeros((self.rows, self.columns))
        dy = np.minimum(np.arange(self.rows), self.rows - np.arange(self.rows)) / self.scale[1]
        dx = np.minimum(np.arange(self.columns), self.columns - np.arange(self.columns)) / self.scale[0]
        r2 = dy[:, None] ** 2 + dx[None, :] ** 2
        kernel = 1.0 / np.sqrt(r2 + soft * soft)
        # The kernel ends half a tile away: beyond, ink would count twice, once from each side of the torus.
        far = min(width, height) / 2
        kernel = np.maximum(kernel - 1.0 / far, 0.0)
        # Doubled both ways, so that the kernel moved round the torus is a window of it.
        self.kernel = np.tile(kernel, (2, 2))

    def cells(self, points: Floats) -> tuple[np.ndarray, np.ndarray]:
        """Rows and columns (…,) of the cells of points (…, 2), which may lie anywhere: the torus closes."""
        at = np.floor(points * self.scale).astype(np.int64)
        return at[..., 1] % self.rows, at[..., 0] % self.columns

    def emptiest(self, candidates: Floats) -> int:
        """The number of the candidate where the potential is least; candidates: (c, p, 2), p points each."""
        rows, columns = self.cells(candidates)
        felt = self.field[rows, columns]
        return int(np.argmin(felt.sum(axis=1)))

    def add(self, points: Floats, weight: float) -> None:
        """Put ink on points (p, 2), an equal share of the weight on each."""
        rows, columns = self.cells(points)
        share = weight / len(points)
        for r, c in zip(rows.tolist(), columns.tolist(), strict=True):
            top, left = (self.rows - r) % self.rows, (self.columns - c) % self.columns
            self.field += share * self.kernel[top : top + self.rows, left : left + self.columns]
