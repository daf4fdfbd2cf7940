"""Loops of a restless pen."""

from __future__ import annotations

import math

import numpy as np

from penink_cli.ground import exact
from penink_cli.ground.model import Floats, Texture
from penink_cli.textures.even import Torus
from penink_cli.textures.filling import FULL, GAIN_PT, fill, tile
from penink_cli.textures.normal import normal


def make(*, pen: float = 0.4, seed: int = 0) -> Texture:
    """A tile of loops, each a chain of eight cubics."""
    size = 96.0
    torus = Torus(size, size, 0.7)

    def loops(rng: np.random.Generator, n: int) -> Floats:
        knots = 9
        heading = np.cumsum(
            np.column_stack([rng.uniform(0, 2 * math.pi, n), 1.05 + normal(rng, 0.55, (n, knots - 1))]), 1
        )
        step = rng.uniform(3.0, 6.0, (n, knots))[..., None] * np.stack(exact.cos_sin(heading), axis=2)
        p = np.cumsum(step, axis=1)
        p = p - p.mean(axis=1, keepdims=True) + rng.uniform(0, size, (n, 1, 2))
        slope = np.gradient(p, axis=1) / 3
        inner = np.stack([p[:, :-1] + slope[:, :-1], p[:, 1:] - slope[:, 1:], p[:, 1:]], axis=2).reshape(n, -1, 2)
        return np.concatenate([p[:, :1], inner], axis=1)

    strokes = fill(torus, loops, pen + GAIN_PT, FULL + 0.01, 0.0, 24, np.random.default_rng(seed))
    return tile("scribble", strokes, [pen] * len(strokes), size, size, seed)
