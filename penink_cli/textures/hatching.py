"""Straight or wavy hatching in up to four directions, one layer after the other.

The tile is an instance of its layers (`HatchLayer`). Blasting lays the layers themselves where its rule can.
"""

from __future__ import annotations

import math

import numpy as np

from penink_cli.ground import exact
from penink_cli.ground.angles import direction
from penink_cli.ground.model import Floats, HatchLayer, Texture
from penink_cli.textures.even import Torus
from penink_cli.textures.filling import FULL, GAIN_PT, TILE_PT, along_curve, bowed_line, fill, tile
from penink_cli.textures.normal import normal

#: By the number of layers, the tones at which they end. Each begins LAP below the end of the one before.
LAYER_ENDS = {1: (0.99,), 2: (0.5, 0.99), 3: (0.42, 0.7, 0.99), 4: (0.42, 0.66, 0.83, 0.99)}
LAP = 0.04
#: Degrees by which each layer is turned from the first.
LAYER_TURNS = (0.0, 90.0, 45.0, 135.0)


def hatching(
    name: str,
    angle: float,
    count: int,
    pen: float,
    spacing: float,
    seed: int,
    wave: float = 0.0,
    wave_length: float = 0.0,
    turns: tuple[float, ...] = LAYER_TURNS,
    ends: tuple[float, ...] = (),
    lap: float = LAP,
) -> Texture:
    """Hatching of `count` layers, one to four, the first at that angle (degrees, clockwise from the right).

    pen, spacing: points; spacing 0 for no limit. wave, wave_length: how far lines wander sideways, and over what
    length, points. turns, ends, lap: as LAYER_TURNS, an entry of LAYER_ENDS and LAP, which they replace.
    """
    rng = np.random.default_rng(seed)
    ends = ends or LAYER_ENDS[count]
    layers = []
    strokes: list[Floats] = []
    reached = 0.0
    for i, until in enumerate(ends):
        turned = angle + turns[i]
        if spacing > 0:
            until = min(until, 1 - (1 - reached) * (1 - min(0.97, (pen + GAIN_PT) / spacing)))
        low = max(0.0, reached - lap)
        if until <= low:
            break
        layers.append(HatchLayer(turned, low, until, pen, spacing, wave, wave_length))
        torus = Torus(TILE_PT, TILE_PT, 0.7)

        def lines(rng: np.random.Generator, n: int, turned: float = turned) -> Floats:
            turn = turned + rng.uniform(-1.5, 1.5, n)
            length, bow = rng.uniform(34, 68, n), normal(rng, 0.3, n)
            return bowed_line(rng.uniform(0, TILE_PT, (n, 2)), turn, length, bow)

        strokes += fill(
            torus, lines, pen + GAIN_PT, until if spacing or i + 1 < count else FULL + 0.012, reached, 40, rng
        )
        reached = until
    if wave > 0:
        strokes = [wavy(s, angle, wave, wave_length) for s in strokes]
    return tile(name, strokes, [pen] * len(strokes), TILE_PT, TILE_PT, seed, layers=tuple(layers))


def wavy(stroke: Floats, angle: float, wave: float, wave_length: float) -> Floats:
    """A chain (3k + 1, 2) pushed sideways by a wave along its direction; the wave repeats with the tile."""
    c, s = direction(angle)
    across = np.array([-s, c])
    p = along_curve(stroke[None])[0]
    p = np.concatenate([p[:: max(1, round(wave_length / 4))], stroke[-1:]])
    turns = max(1, round(TILE_PT / wave_length))
    phase = 2 * math.pi * ((turns * p)[:, 0] + (turns * p)[:, 1]) / TILE_PT
    p = p + exact.cos_sin(phase)[1][:, None] * wave * across
    slope = np.gradient(p, axis=0) / 3
    inner = np.stack([p[:-1] + slope[:-1], p[1:] - slope[1:], p[1:]], axis=1).reshape(-1, 2)
    return np.concatenate([p[:1], inner])
