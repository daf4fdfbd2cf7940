"""Blades that grow upwards and bend."""

from __future__ import annotations

import numpy as np

from penink_cli.ground import exact
from penink_cli.ground.model import Floats, Texture
from penink_cli.textures.even import Torus
from penink_cli.textures.filling import FULL, GAIN_PT, fill, tile
from penink_cli.textures.normal import normal


def make(*, angle: float = 0.0, pen: float = 0.4, seed: int = 0) -> Texture:
    """A tile of blades; angle: degrees by which they lean from upright."""
    size = 96.0
    torus = Torus(size, size, 0.7)

    def blades(rng: np.random.Generator, n: int) -> Floats:
        lean = np.radians(-90.0 + angle + normal(rng, 16, n))
        bend = normal(rng, 0.5, n)
        length = rng.uniform(10, 26, n)
        foot = rng.uniform(0, size, (n, 2))
        out = np.empty((n, 4, 2))
        for j, (reach, turn) in enumerate(((0.0, 0.0), (0.34, 0.1), (0.7, 0.45), (1.0, 1.0))):
            a = lean + bend * turn
            out[:, j] = foot + (reach * length)[:, None] * np.column_stack(exact.cos_sin(a))
        return out

    strokes = fill(torus, blades, pen + GAIN_PT, FULL + 0.01, 0.0, 32, np.random.default_rng(seed))
    return tile("lawn", strokes, [pen] * len(strokes), size, size, seed)
