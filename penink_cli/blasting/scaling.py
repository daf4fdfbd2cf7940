"""Textures that grow with the picture, so that a wall stays that wall on a stamp and on a poster."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from penink_cli.ground.model import HatchLayer, Texture

#: The hatchings that bring on the tone which a tile that has grown does not reach.
FILLS = {
    "parallel": (HatchLayer(-45.0, 0.0, 1.0),),
    "crosshatch": (HatchLayer(-45.0, 0.0, 0.5), HatchLayer(45.0, 0.5, 1.0)),
}


def at_size(texture: Texture, width_pt: float, natural_pt: float | None) -> Texture:
    """The tile for a picture so wide: its strokes that grow, so many times as large, with pens as they are.

    natural_pt: the picture's width at which the tile has its own size; what the texture says unless given.
    """
    scales = texture.scales
    assert scales is not None
    strokes = texture.strokes
    scale = width_pt / (natural_pt or scales.natural_pt)
    scale = max(scale, scales.least_pt / min(strokes.width, strokes.height))
    low, high = scales.spans.T
    there = np.flatnonzero((low <= scale) & (scale < high))
    chosen = scales.strokes.taken(there)
    grown = replace(
        chosen, points=chosen.points * scale, width=strokes.width * scale, height=strokes.height * scale
    )
    return Texture(texture.name, grown, scales.priorities[there], texture.whole)
