"""A picture as a base of broad tones and the detail upon it, and detail raised until a pen can show it.

The base is a guided filter of the picture by itself (He, Sun and Tang 2013), made at a coarse grid (He and Sun 2015):
it keeps strong edges, so that raising what is left makes no halo along them.
"""

from __future__ import annotations

import numpy as np

from penink_cli.composition.filters import Picture, blurred, by_rows, enlarged, looked_up, shrunk
from penink_cli.composition.relief import in_relief

_RADIUS_PT = 4.0  # of the Gaussian that the guided filter gathers with
_GRID_PT = 0.75  # of the base
_FLAT = 0.045  # a local standard deviation of grey that is detail; what is well above is an edge
_FLAT_IN_RELIEF = 0.085  # the same in relief, where only greater steps belong to the base
_FINE_PT, _FINE_SHARE = 0.5, 0.4  # what is finer a pen cannot show; this share of it is kept
_LIMIT = 0.4  # detail is not raised beyond that

# Detail of the usual strength is raised by the gain asked for, faint detail by more, strong by less.
_USUAL, _OFFSET, _POWER = 0.055, 0.012, 0.4
_LESS, _MORE = 0.7, 1.5  # times the gain, at the least and at the most
_GAIN = np.array([round(((_USUAL) / (k / 512 + _OFFSET)) ** _POWER, 9) for k in range(257)]).clip(_LESS, _MORE)

# Relief in light tones is lost on the pen. So of what the exposure has lifted it by, more than LIFT is taken back in
# part. Detail is raised by CARVED more where it was lifted by LIFTED or more.
_LIFT, _TAKEN_BACK = 0.12, 0.6
_LIFTED, _CARVED = 0.25, 0.35
_DOWN_TO, _DOWN = 0.6, 0.4  # lights in relief that are lighter come down by this part of what they exceed it by
_DEEPER = 0.5  # detail in relief is raised by so much more

# Detail finer than BROAD is grain, as grass has it, where its strength is GRAIN of that of the broader detail or more;
# at ALL_GRAIN, GRAIN_LEFT of it is raised.
_BROAD_PT, _GRAIN, _ALL_GRAIN, _GRAIN_LEFT = 1.2, 0.6, 0.95, 0.4

# Where detail is as strong as STRONG lights above LIGHT begin to come down; RANGE more, and they do so by SUNK of it.
_STRONG, _RANGE, _SUNK, _LIGHT = 0.045, 0.05, 0.6, 0.60


def base(
    grey: Picture, ink: float, pixels_per_pt: float, threads: int, colours: Picture | None = None
) -> tuple[Picture, Picture]:  # fmt: skip
    """Broad tones (h, w) of grey (h, w), sharp at strong edges, and how much each place is in relief, 0 … 1.

    colours: (h, w, 3) red, green and blue, if there are any: what may be skin by its colour is in no relief.

    ink: how much the picture is to take, in parts of the usual; with less of it there is less for relief.
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
    """The base `lights` (h, w) with the detail upon it.

    slope: that of the exposure's curve at each pixel, which has raised or flattened the base.
    lifted: by how much relief is lighter for it, 0 elsewhere. carved: how much each place is in relief, 0 … 1.
    gain: of detail of usual strength. noise: its standard deviation, grey.
    """
    pt = pixels_per_pt
    middle = blurred(detail, _FINE_PT * pt, threads)
    fine = detail - middle

    def variance(values: Picture, sigma_pt: float) -> Picture:
        return blurred(values * values, sigma_pt * pt, threads)

    def guard(values: Picture, level: float) -> Picture:
        """Values without what is no more than noise."""
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
    """The square root of what a low-pass, which may be wrong by a rounding, leaves of squares."""
    return np.sqrt(np.maximum(squares, 0))


def _with_room(lights: Picture, drawn: Picture, pt: float, threads: int) -> Picture:
    """Relief needs ink: where there is much detail the lights come down to carry it, and darks rise a little."""

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
    """Values that grow ever slower towards ±0.4."""
    part = values * np.float32(1 / _LIMIT)
    return values / np.sqrt(1 + part * part)
