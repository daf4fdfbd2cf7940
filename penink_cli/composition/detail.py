"""A picture as a base of broad tones and the detail upon it, and detail raised until a pen can show it.

The base is a guided filter of the picture by itself (He, Sun and Tang 2013), made on a coarse grid (He and Sun 2015).
It keeps strong edges, so that raising the detail makes no halo along them. Relief belongs to the detail: in the base
the exposure would flatten it with the lights.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from penink_cli.composition._compiled import tones
from penink_cli.composition.filters import Picture, blurred, by_pixels, enlarged, looked_up, shrunk
from penink_cli.composition.relief import in_relief

_RADIUS_PT = 4.0  # σ of the Gaussian by which the guided filter averages
_GRID_PT = 0.75  # step of the coarse grid
_FLAT = 0.045  # local standard deviation of grey up to which it is detail; where it is well above there is an edge
_FLAT_IN_RELIEF = 0.085  # the same in relief, where only greater steps belong to the base
_FINE_PT = 0.5  # σ of the detail that is too fine for a pen

# Detail of the usual strength is raised by the gain asked for, fainter detail by more, stronger detail by less.
_USUAL, _OFFSET, _POWER = 0.055, 0.012, 0.4
_LESS, _MORE = 0.7, 1.5  # the least and the most, times the gain
_GAIN = np.array([round(((_USUAL) / (k / 512 + _OFFSET)) ** _POWER, 9) for k in range(257)]).clip(_LESS, _MORE)

_BROAD_PT = 1.2  # detail finer than that may be grain


def base(
    grey: Picture, ink: float, pixels_per_pt: float, threads: int, colours: Picture | None = None
) -> tuple[Picture, Picture]:  # fmt: skip
    """Broad tones (h, w) of grey (h, w), 0 … 1, sharp at strong edges; and how much each place is in relief, 0 … 1.

    ink: how much of it the picture is to take, in parts of the usual; where there is less, less of it goes to relief.
    pixels_per_pt: pixels to a point on paper.
    colours: (h, w, 3) red, green and blue, None for a grey picture; what has the colour of skin is not in relief.
    """
    height, width = grey.shape
    cell = max(1.0, _GRID_PT * pixels_per_pt)
    w, h = max(1, round(width / cell)), max(1, round(height / cell))
    small = grey if cell == 1 else shrunk(grey, w, h, threads=threads)
    sigma = _RADIUS_PT * pixels_per_pt * w / width
    mean = blurred(small, sigma, threads)
    variance: Picture = np.maximum(blurred(small * small, sigma, threads) - mean * mean, 0)
    small_colours = None if colours is None else shrunk(colours, w, h, threads=threads)
    relief = in_relief(small, small_colours, pixels_per_pt * w / width, threads)
    flat = np.float32(_FLAT) + np.float32((_FLAT_IN_RELIEF - _FLAT) * min(ink, 1.0)) * relief
    kept: Picture = variance / (variance + flat * flat)
    rest = mean - kept * mean
    slope, offset = (enlarged(blurred(v, sigma, threads), width, height, threads) for v in (kept, rest))
    return by_pixels(tones.based, grey, slope, offset, threads=threads), enlarged(relief, width, height, threads)


def raised(
    detail: Picture, lights: Picture, slope: Picture, lifted: Picture, carved: Picture, gain: float, noise: float,
    pixels_per_pt: float, threads: int,
) -> Picture:  # fmt: skip
    """The exposed base `lights` (h, w) with the detail (h, w), raised, upon it; 0 is ink, 1 paper.

    slope: (h, w) that of the exposure's curve at each pixel. lifted: (h, w) by how much the exposure has made relief
        lighter, 0 where there is none. carved: (h, w) how much each place is in relief, 0 … 1.
    gain: by which detail of usual strength is raised. noise: its standard deviation, in grey.
    """
    pt = pixels_per_pt
    middle = blurred(detail, _FINE_PT * pt, threads)
    fine = by_pixels(np.subtract, detail, middle, threads=threads)

    def variance(values: Picture, sigma_pt: float) -> Picture:
        return blurred(by_pixels(np.multiply, values, values, threads=threads), sigma_pt * pt, threads)

    def guard(values: Picture, level: float) -> Picture:
        """Detail, damped to 15 % where it is no stronger than noise of that level."""
        if level <= 0:
            return values
        guarded = partial(tones.guarded, level=level, twice=2 * level)
        return by_pixels(guarded, values, variance(values, 1.5), threads=threads)

    def gained(strong: Picture, *rest: Picture) -> None:
        """The last of the rest are the result's rows."""
        usual = np.empty_like(strong)
        tones.rooted(strong, usual)
        tones.gained(looked_up(usual, _GAIN, 0.0, 0.5), *rest, gain=gain)

    lights = by_pixels(tones.less_light, lights, lifted, carved, threads=threads)
    broad = blurred(middle, _BROAD_PT * pt, threads)
    grain = variance(by_pixels(np.subtract, middle, broad, threads=threads), 6.0)
    coarse = variance(broad, 6.0)
    del broad
    each = by_pixels(gained, variance(middle, 6.0), slope, lifted, carved, grain, coarse, threads=threads)
    del grain, coarse
    parts = guard(middle, 0.5 * noise), guard(fine, noise)
    detail = by_pixels(tones.drawn, each, *parts, threads=threads)
    return by_pixels(tones.with_room, lights, detail, variance(detail, 5.0), threads=threads)
