"""Making stroke textures: tiles of strokes whose every prefix is evenly spaced."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from penink_cli.model import Floats, Strokes, Texture
from penink_cli.textures.even import Torus, direction

TILE_PT = 144.0


def bowed_line(centre: Floats, along: Floats, length: Floats, bow: Floats) -> Floats:
    """Cubics (n, 4, 2): straight strokes of a length, with their middle pushed sideways by bow."""
    half = along * length[:, None] / 2
    across = np.column_stack([-along[:, 1], along[:, 0]]) * bow[:, None]
    ends = np.stack([centre - half, centre - half / 3, centre + half / 3, centre + half], axis=1)
    push = np.stack([-across / 3, across, across, -across / 3], axis=1)
    return ends + push


def hatching(
    name: str, layers: list[tuple[float, float]], *, pen_pt: float = 0.4, seed: int = 0, tile_pt: float = TILE_PT
) -> Texture:
    """Hatching with layers of (angle in degrees, tone that the tile has reached when the layer ends)."""
    rng = np.random.default_rng(seed)
    chosen: list[Floats] = []
    area = tile_pt * tile_pt
    painted = pen_pt + 0.15
    reached = 0.0
    for angle, until in layers:
        torus = Torus(tile_pt, tile_pt, 0.7)
        cover = 1 - (1 - until) / (1 - reached)
        reached = until
        ink = 0.0
        # lines that fall at random leave gaps as if each covered what is bare; even ones less so
        while ink < -math.log(1 - cover) * area * 0.85:
            c = 48
            turn = angle + rng.uniform(-1.5, 1.5, c)
            along = np.array([direction(a) for a in turn])
            length = rng.uniform(34, 68, c)
            lines = bowed_line(rng.uniform(0, tile_pt, (c, 2)), along, length, rng.normal(0, 0.35, c))
            t = np.linspace(0, 1, 17)[None, :, None]
            samples = lines[:, :1] * (1 - t) + lines[:, 3:] * t
            best = torus.emptiest(samples)
            torus.add(samples[best], float(length[best]))
            chosen.append(lines[best])
            ink += float(length[best]) * painted
    n = len(chosen)
    points: Floats = np.round(np.concatenate(chosen), 3).astype(np.float64)
    strokes = Strokes(tile_pt, tile_pt, points, np.arange(n + 1) * 4, np.full(n, pen_pt), texture=name, seed=seed)
    return Texture(name, strokes, np.arange(n, dtype=float))


def parallel(angle: float = -45.0, **options: Any) -> Texture:
    """Lines in one direction."""
    return hatching("parallel", [(angle, 0.99)], **options)


def crosshatch(angle: float = -45.0, **options: Any) -> Texture:
    """Lines in one direction, and across them where it is dark."""
    return hatching("crosshatch", [(angle, 0.5), (angle + 90, 0.99)], **options)
