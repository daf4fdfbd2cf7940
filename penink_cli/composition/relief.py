"""Which places of a picture are in relief: coins, fur, leaves. Skin and faces are not, for relief ages them.

Three things tell relief. There is structure all around, and not on one edge alone. The band between two Gaussians is
skewed to the light, as on surfaces that shine. And colours, where there are any, are not those of skin.
"""

from __future__ import annotations

import numpy as np

from penink_cli.composition.filters import Picture, blurred

_STRUCTURE_PT = 1.0, 3.0  # σ of the two Gaussians between which structure lies
_AROUND_PT = 8.0  # σ over which it is averaged
_MOST = 0.06  # contrast of structure, which counts as this where it is more
_LEAST, _FULL = 0.010, 0.030  # mean contrast at which a place begins to be in relief, and at which it wholly is
_FINEST_PT = 0.7  # σ of the narrower Gaussian of the skewed band; the broader one is that of structure
_SKEW_AROUND_PT = 10.0  # σ over which the skew is averaged
_BAND = 0.15  # contrast in the skew, which counts as this where it is more
_SKIN, _METAL = -0.25, 0.15  # the skew up to which nothing is in relief, and from which on all may be
_NONE = 0.003  # contrast below which a skew tells nothing
_SKIN_PT = 2.0  # σ over which the colour of skin is averaged
# A colour may be skin if (red - blue) / red is within _DULL, (green - blue) / (red - blue) within _ORANGE, and red is
# above _SHADE.
_DULL, _ORANGE, _SHADE = (0.15, 0.65), (0.15, 0.6), 0.2


def in_relief(grey: Picture, colours: Picture | None, pt: float, threads: int) -> Picture:
    """How much each place of grey (h, w) is in relief, (h, w), 0 … 1.

    colours: (h, w, 3) red, green and blue, 0 … 1, None for a grey picture. pt: pixels a point.

    Fourth roots of contrast are averaged: one strong edge fills little of its surroundings, so it hardly counts,
    however strong it is.
    """
    fine, broad = _STRUCTURE_PT
    there = np.abs(blurred(grey, fine * pt, threads) - blurred(grey, broad * pt, threads))
    root = blurred(np.sqrt(np.sqrt(np.minimum(there, np.float32(_MOST)))), _AROUND_PT * pt, threads)
    root *= root
    share: Picture = np.clip((root * root - np.float32(_LEAST)) / np.float32(_FULL - _LEAST), 0, 1)
    share = share * np.clip((_skew(grey, pt, threads) - np.float32(_SKIN)) * np.float32(1 / (_METAL - _SKIN)), 0, 1)
    if colours is not None:
        share *= 1 - blurred(_skin(colours), _SKIN_PT * pt, threads)
    return share


def _skin(colours: Picture) -> Picture:
    """Which places (h, w) of colours (h, w, 3) may be skin, 1 or 0: skin of whatever shade is a dull orange."""
    red, green, blue = (colours[..., k] for k in range(3))
    chroma = red - blue
    dull = (chroma > np.float32(_DULL[0]) * red) & (chroma < np.float32(_DULL[1]) * red)
    hue = green - blue
    orange = (hue > np.float32(_ORANGE[0]) * chroma) & (hue < np.float32(_ORANGE[1]) * chroma)
    return (dull & orange & (red > np.float32(_SHADE))).astype(np.float32)


def _skew(grey: Picture, pt: float, threads: int) -> Picture:
    """The skewness (h, w), around each place of grey (h, w), of the band between two Gaussians; pt: pixels a point.

    A surface that shines has highlights, which skew it to the light (Motoyoshi et al., Image statistics and the
    perception of surface qualities, Nature 447, 2007). Eyes, brows and lips skew a face to the dark.
    """
    band = blurred(grey, _FINEST_PT * pt, threads) - blurred(grey, _STRUCTURE_PT[1] * pt, threads)
    band = np.clip(band, -_BAND, _BAND)
    square = band * band
    two, three = (blurred(v, _SKEW_AROUND_PT * pt, threads) for v in (square, square * band))
    two = np.maximum(two, 0) + np.float32(_NONE * _NONE)
    return three / (two * np.sqrt(two))
