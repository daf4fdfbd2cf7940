"""Textures with finer pens, for small prints."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from penink_cli.ground.model import Strokes, Texture
from penink_cli.ground.pens import finer


def finer_texture(texture: Texture, by: float, device_dpi: float | None) -> Texture:
    """The texture with such pens, and its lines as much closer as they may be."""
    if by >= 1.0:
        return texture
    layers = []
    for layer in texture.layers:
        pen = finer(layer.pen_pt, by, device_dpi)
        layers.append(replace(layer, pen_pt=pen, spacing_pt=layer.spacing_pt * pen / layer.pen_pt))

    def thinned(strokes: Strokes) -> Strokes:
        return replace(strokes, widths=np.array([finer(width, by, device_dpi) for width in strokes.widths.tolist()]))

    scales = texture.scales and replace(texture.scales, strokes=thinned(texture.scales.strokes))
    return replace(texture, strokes=thinned(texture.strokes), layers=tuple(layers), scales=scales)
