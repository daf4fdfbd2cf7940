"""A picture as a base of broad tones and the detail upon it, and detail raised until a pen can show it.

The base is a guided filter of the picture by itself (He, Sun and Tang 2013), made on a coarse grid (He and Sun 2015).
It keeps strong edges, so that raising the detail makes no halo along them. Relief belongs to the detail: in the base
the exposure would flatten it with the lights.
"""

from __future__ import annotations

import numpy as np

from penink_cli.composition.filters import Picture, blurred, by_rows, enlarged, looked_up, shrunk
from penink_cli.composition.relief import in_relief

_RADIUS_PT = 4.0  # σ of the Gaussian by which the guided filter averages
_GRID_PT = 0.75  # step of the coarse grid
_FLAT = 0.045  # local standard deviation of grey up to which it is detail; where it is well above there is an edge
_FLAT_IN_RELIEF = 0.085  # the same in relief, where only greater steps belong to the base
_FINE_PT, _FINE_SHARE = 0.5, 0.4  # σ of the detail that is too fine for a pen, and the share of it that is kept
_LIMIT = 0.4  # of grey, towards which raised detail grows ever slower

# Detail of the usual strength is raised by the gain asked for, fainter detail by more, stronger detail by less.
_USUAL, _OFFSET, _POWER = 0.055, 0.012, 0.4
_LESS, _MORE = 0.7, 1.5  # the least and the most, times the gain
_GAIN = np.array([round(((_USUAL) / (k / 512 + _OFFSET)) ** _POWER, 9) for k in range(257)]).clip(_LESS, _MORE)

# A pen cannot show relief in light tones. So where the exposure has made relief lighter by more than _LIFT, _TAKEN_BACK
# of the excess is taken back. Where it has made relief lighter by _LIFTED or more, detail is raised by _CARVED more.
_LIFT, _TAKEN_BACK = 0.12, 0.6
_LIFTED, _CARVED = 0.25, 0.35
_DOWN_TO, _DOWN = 0.6, 0.4  # greys in relief above the first come down by this part of what they are above it
_DEEPER = 0.5  # detail in relief is raised by this part more

# Detail finer than _BROAD_PT is grain, as of grass, if it is at least _GRAIN times as strong as broader detail. At
# _ALL_GRAIN times only _GRAIN_LEFT of the detail is raised.
_BROAD_PT, _GRAIN, _ALL_GRAIN, _GRAIN_LEFT = 1.2, 0.6, 0.95, 0.4

# Where detail is stronger than _STRONG, greys above _LIGHT come down; where it is stronger by _RANGE, they come down by
# _SUNK of what they are above it.
_STRONG, _RANGE, _SUNK, _LIGHT = 0.045, 0.05, 0.6, 0.60


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
    broad = by_rows(
        lambda grey, slope, offset: np.clip(slope * grey + offset, 0, 1), grey, slope, offset, threads=threads
    )
    return broad, enlarged(relief, width, height, threads)


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
    fine = detail - middle

    def variance(values: Picture, sigma_pt: float) -> Picture:
        return blurred(values * values, sigma_pt * pt, threads)

    def guard(values: Picture, level: float) -> Picture:
        """Detail, damped to 15 % where it is no stronger than noise of that level."""
        if level <= 0:
            return values

        def guarded(values: Picture, variance: Picture) -> Picture:
            return values * np.clip((_root(variance) - np.float32(level)) / np.float32(2 * level), 0.15, 1)

        return by_rows(guarded, values, variance(values, 1.5), threads=threads)

    def less_light(lights: Picture, lifted: Picture, carved: Picture) -> Picture:
        lights = lights - np.float32(_TAKEN_BACK) * np.maximum(0, lifted - np.float32(_LIFT))
        return lights - np.float32(_DOWN) * carved * np.maximum(0, lights - np.float32(_DOWN_TO))

    def gained(
        strong: Picture, slope: Picture, lifted: Picture, carved: Picture, grain: Picture, coarse: Picture
    ) -> Picture:
        each = looked_up(_root(strong), _GAIN, 0.0, 0.5) * (np.float32(gain) * np.clip(slope, 0.8, 1.4))
        each *= 1 + np.float32(_CARVED / _LIFTED) * np.clip(lifted, 0, _LIFTED)
        each *= 1 + np.float32(_DEEPER) * carved
        grain = _root(grain) / (_root(coarse) + np.float32(0.004))
        share = np.clip((grain - np.float32(_GRAIN)) * np.float32(1 / (_ALL_GRAIN - _GRAIN)), 0, 1)
        each *= 1 - np.float32(1 - _GRAIN_LEFT) * share
        return each

    def drawn(each: Picture, middle: Picture, fine: Picture) -> Picture:
        return _limited(each * middle) + np.float32(_FINE_SHARE) * each * fine

    lights = by_rows(less_light, lights, lifted, carved, threads=threads)
    broad = blurred(middle, _BROAD_PT * pt, threads)
    grain, coarse = variance(middle - broad, 6.0), variance(broad, 6.0)
    del broad
    each = by_rows(gained, variance(middle, 6.0), slope, lifted, carved, grain, coarse, threads=threads)
    del grain, coarse
    parts = guard(middle, 0.5 * noise), guard(fine, noise)
    return _with_room(lights, by_rows(drawn, each, *parts, threads=threads), pt, threads)


def _root(squares: Picture) -> Picture:
    """The square root of blurred squares, which rounding may leave a little below 0."""
    return np.sqrt(np.maximum(squares, 0))


def _with_room(lights: Picture, drawn: Picture, pt: float, threads: int) -> Picture:
    """The lights with the raised detail upon them.

    Detail needs room on both sides: where it is strong, lights come down to carry it, and darks rise a little.
    """

    def with_room(lights: Picture, drawn: Picture, squares: Picture) -> Picture:
        strong = _root(squares)
        share = np.clip((strong - np.float32(_STRONG)) / np.float32(_RANGE), 0, 1)
        more = 1 + np.float32(0.7) * share * np.clip((lights - np.float32(0.5)) / np.float32(0.3), 0, 1)
        result = lights - np.float32(_SUNK) * share * np.maximum(0, lights - np.float32(_LIGHT))
        strong = strong * more
        above = np.maximum(0, result + np.float32(1.6) * strong - 1)
        result -= above * np.clip((strong - np.float32(0.02)) / np.float32(0.05), 0, 1)
        below = np.maximum(0, np.float32(0.06) - (result - strong))
        result += below * np.clip(strong / np.float32(0.05), 0, 1)
        return result + _limited(drawn * more)

    return by_rows(with_room, lights, drawn, blurred(drawn * drawn, 5.0 * pt, threads), threads=threads)


def _limited(values: Picture) -> Picture:
    """Values that grow ever slower towards ±_LIMIT."""
    part = values * np.float32(1 / _LIMIT)
    return values / np.sqrt(1 + part * part)
