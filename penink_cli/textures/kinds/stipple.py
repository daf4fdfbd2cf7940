"""Dots, drawn whole or not at all."""

from __future__ import annotations

import math

import numpy as np

from penink_cli.ground.device import disc
from penink_cli.ground.model import Floats, Texture
from penink_cli.textures.even import Torus
from penink_cli.textures.filling import FULL, PIXEL_PT, fill, tile


def make(*, pen: float = 1.0, seed: int = 0) -> Texture:
    """A tile of dots; pen: their diameter."""
    size = 72.0
    torus = Torus(size, size, 0.5, grid=0.75)
    rng = np.random.default_rng(seed)

    def dots(rng: np.random.Generator, n: int) -> Floats:
        return rng.uniform(0, size, (n, 1, 2))

    # `fill` counts a dot as a line, .8 times as long as it is wide: the width is what it takes for a dot's.
    area = math.pi / 4 * float(disc(np.array(pen), PIXEL_PT)) ** 2
    strokes = fill(torus, dots, area / (pen * 0.8), FULL, 0.0, 60, rng)
    return tile("stipple", strokes, [pen] * len(strokes), size, size, seed, whole=True)
