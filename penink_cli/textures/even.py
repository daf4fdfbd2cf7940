"""Placing things on a torus so that every prefix of them is evenly spread.

Greedy: of many random candidates the next is the one that lies in the emptiest place. How empty a
place is, a potential tells: the sum over all ink so far of a kernel that falls off with distance,
1/r, softened. It does so on all scales at once: the first ten and the first thousand are both even.
"""

from __future__ import annotations

import numpy as np

from penink_cli.ground.model import Floats


class Torus:
    """The potential on a width × height torus, kept on a grid of about one point."""

    def __init__(self, width: float, height: float, soft: float, grid: float = 1.0):
        self.columns = max(8, round(width / grid))
        self.rows = max(8, round(height / grid))
        self.scale = np.array([self.columns / width, self.rows / height])
        self.field = np.zeros((self.rows, self.columns))
        dy = np.minimum(np.arange(self.rows), self.rows - np.arange(self.rows)) / self.scale[1]
        dx = np.minimum(np.arange(self.columns), self.columns - np.arange(self.columns)) / self.scale[0]
        r2 = dy[:, None] ** 2 + dx[None, :] ** 2
        kernel = 1.0 / np.sqrt(r2 + soft * soft)
        # nothing is felt from half a tile away on: there the torus would pull towards itself
        far = min(width, height) / 2
        kernel = np.maximum(kernel - 1.0 / far, 0.0)
        # doubled both ways, so that a kernel moved round the torus is a plain window of it
        self.kernel = np.tile(kernel, (2, 2))

    def cells(self, points: Floats) -> tuple[np.ndarray, np.ndarray]:
        """Row and column of the cell of each point (…, 2), round the torus."""
        at = np.floor(points * self.scale).astype(np.int64)
        return at[..., 1] % self.rows, at[..., 0] % self.columns

    def emptiest(self, candidates: Floats) -> int:
        """Which of candidates (c, p, 2), p points each, lies where there is least."""
        rows, columns = self.cells(candidates)
        felt = self.field[rows, columns]
        return int(np.argmin(felt.sum(axis=1)))

    def add(self, points: Floats, weight: float) -> None:
        """Put weight of ink on points (p, 2), in equal shares."""
        rows, columns = self.cells(points)
        share = weight / len(points)
        for r, c in zip(rows.tolist(), columns.tolist(), strict=True):
            top, left = (self.rows - r) % self.rows, (self.columns - c) % self.columns
            self.field += share * self.kernel[top : top + self.rows, left : left + self.columns]
