"""A photograph's colours at the lightness of its composed grey.

In CIE Lab lightness is replaced and hue is kept. Where a colour is made lighter, chroma grows by the root of the growth
in lightness: if it grew as much as lightness, colours would be gaudy; if it stayed, pale. Where no colour has so much
chroma at that lightness, as near white, chroma is the most that there is.
"""

from __future__ import annotations

import numpy as np

from penink_cli.composition.filters import Picture
from penink_cli.ground.colour import encoded, lab_of_light, light_of_lab, linear
from penink_cli.ground.model import Floats

LUMA = (0.299, 0.587, 0.114)  # the mix of the grey: colours need no other, they show their differences themselves
ROWS = 64  # rows at a time
LEAST = 1.0  # lightness below which colours are noise
HALVINGS = 10  # bisections in the search for the chroma that exists
_SLACK = 2e-4  # of light, by which a colour may lie outside 0 … 1 and be taken to exist


def recoloured(colours: Picture, grey: Picture, part: float = 1.0) -> Picture:
    """Colours (h, w, 3) with the lightness of grey (h, w); both are sRGB's values, 0 … 1.

    part: 0 … 1, how far lightness goes from the colours' own to the grey's.
    """
    result = np.empty(colours.shape, np.float32)
    for top in range(0, len(colours), ROWS):
        some = slice(top, top + ROWS)
        result[some] = _recoloured(colours[some], grey[some], part)
    return result


def _recoloured(colours: Picture, grey: Picture, part: float) -> Floats:
    """As `recoloured`, for a few rows."""
    own = lab_of_light(linear(colours))
    wanted = lab_of_light(np.repeat(linear(np.clip(grey, 0.0, 1.0))[..., None], 3, axis=2))[..., 0]
    lightness = own[..., 0] + part * (wanted - own[..., 0])
    growth = np.sqrt(np.maximum(lightness, LEAST) / np.maximum(own[..., 0], LEAST))
    chroma = own[..., 1:] * growth[..., None]

    def light(share: Floats) -> Floats:
        return light_of_lab(np.concatenate([lightness[..., None], chroma * share[..., None]], axis=-1))

    low, high = np.zeros(grey.shape), np.full(grey.shape, 2.0)  # so the first share that is tried is 1
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        tried = light(middle)
        exists = ((tried >= -_SLACK) & (tried <= 1.0 + _SLACK)).all(axis=-1)
        low, high = np.where(exists, middle, low), np.where(exists, np.minimum(high, 1.0), middle)
    return encoded(np.clip(light(low), 0.0, 1.0))
