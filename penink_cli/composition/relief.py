"""A picture as a base of broad tones and the detail upon it, and detail raised until a pen can show it.

The base is a guided filter of the picture by itself (He, Sun and Tang 2013), made at a coarse grid (He and Sun 2015):
it keeps strong edges, so that raising what is left makes no halo along them.
"""

from __future__ import annotations

import numpy as np

from penink_cli.composition.filters import Picture, blurred, by_rows, enlarged, looked_up, shrunk

_RADIUS_PT = 4.0  # of the Gaussian that the guided filter gathers with
_FLAT = 0.045  # a local standard deviation of grey that is detail; what is well above is an edge
_GRID_PT = 0.75  # of the base
# Relief: structure between these Gaussians' σ that is all around and not on one edge, as on coins, in fur, in leaves.
# Where it has LEAST contrast and more, only greater steps belong to the base, up to a deviation of EDGES from FULL on.
# A face has more of it than a coin, and relief ages faces. What is skewed to the dark within SKEW_AROUND_PT, as skin
# with eyes and brows is (SKIN), is none; from METAL on all is. Where contrast is less than NONE, nothing is told.
_STRUCTURE_PT, _AROUND_PT, _MOST, _LEAST, _FULL, _EDGES = (1.0, 3.0), 8.0, 0.06, 0.010, 0.030, 0.085
_FINEST_PT, _SKEW_AROUND_PT, _BAND, _SKIN, _METAL, _NONE = 0.7, 10.0, 0.15, -0.25, 0.15, 0.003
_FINE_PT, _FINE_SHARE = 0.5, 0.4  # what is finer a pen cannot show, and so much of it is kept
_LIMIT = 0.4  # detail is not raised beyond that
_USUAL, _OFFSET, _POWER, _LESS, _MORE = 0.055, 0.012, 0.4, 0.7, 1.5  # faint detail is raised more than strong
_GAIN = np.array([round(((_USUAL) / (k / 512 + _OFFSET)) ** _POWER, 9) for k in range(257)]).clip(_LESS, _MORE)
# What the exposure has lifted there beyond so much is taken back by so much, for relief in light tones is lost on the
# pen, and detail is raised by so much more where so much was lifted.
_LIFT, _TAKEN_BACK, _CARVED, _LIFTED = 0.12, 0.6, 0.35, 0.25
# Skin by colour: red less blue in parts of red, green less blue in parts of red less blue, the least red; and the σ
# over which it counts.
_DULL, _ORANGE, _SHADE, _SKIN_PT = (0.15, 0.65), (0.15, 0.6), 0.2, 2.0
# In relief lights above DOWN_TO come down by so much of what they exceed it by, and detail is so much deeper.
_DOWN, _DOWN_TO, _DEEPER = 0.4, 0.6, 0.5
# Where so much of the detail is finer than BROAD, in parts of what is not, it is grain, as grass is, and raised less.
_BROAD_PT, _GRAIN, _ALL_GRAIN, _GRAIN_LEFT = 1.2, 0.6, 0.95, 0.4
_RELIEF, _RELIEF_RANGE, _RELIEF_INK, _LIGHT = 0.045, 0.05, 0.6, 0.60  # where detail is that strong, lights come down


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
    relief = _in_relief(small, pixels_per_pt * w / width, threads)
    if colours is not None:
        skin = _skin(shrunk(colours, w, h, threads=threads))
        relief *= 1 - blurred(skin, _SKIN_PT * pixels_per_pt * w / width, threads)
    flat = np.float32(_FLAT) + np.float32((_EDGES - _FLAT) * min(ink, 1.0)) * relief
    kept: Picture = variance / (variance + flat * flat)
    rest = mean - kept * mean
    slope, offset = (enlarged(blurred(v, sigma, threads), width, height, threads) for v in (kept, rest))
    broad = by_rows(
        lambda grey, slope, offset: np.clip(slope * grey + offset, 0, 1), grey, slope, offset, threads=threads
    )
    return broad, enlarged(relief, width, height, threads)


def _in_relief(grey: Picture, pt: float, threads: int) -> Picture:
    """How much each place of grey (h, w) is in relief, 0 … 1; pt: pixels a point.

    Were relief left in the base, the exposure would flatten it with the lights. Fourth roots are averaged: one strong
    edge fills little of its surroundings and so counts for next to nothing, however strong it is.
    """
    fine, broad = _STRUCTURE_PT
    there = np.abs(blurred(grey, fine * pt, threads) - blurred(grey, broad * pt, threads))
    root = blurred(np.sqrt(np.sqrt(np.minimum(there, np.float32(_MOST)))), _AROUND_PT * pt, threads)
    root *= root
    share: Picture = np.clip((root * root - np.float32(_LEAST)) / np.float32(_FULL - _LEAST), 0, 1)
    return share * np.clip((_skew(grey, pt, threads) - np.float32(_SKIN)) * np.float32(1 / (_METAL - _SKIN)), 0, 1)


def _skin(colours: Picture) -> Picture:
    """Which places of colours (h, w, 3) may be skin, 1 or 0: of whatever shade, it is a dull orange."""
    red, green, blue = (colours[..., k] for k in range(3))
    chroma = red - blue
    dull = (chroma > np.float32(_DULL[0]) * red) & (chroma < np.float32(_DULL[1]) * red)
    hue = green - blue
    orange = (hue > np.float32(_ORANGE[0]) * chroma) & (hue < np.float32(_ORANGE[1]) * chroma)
    return (dull & orange & (red > np.float32(_SHADE))).astype(np.float32)


def _skew(grey: Picture, pt: float, threads: int) -> Picture:
    """The skewness, around each place of grey (h, w), of what lies between two Gaussians; pt: pixels a point.

    What shines has highlights and is skewed to the light (Motoyoshi et al., Image statistics and the perception of
    surface qualities, Nature 447, 2007). A face is skewed to the dark: eyes, brows and lips.
    """
    band = blurred(grey, _FINEST_PT * pt, threads) - blurred(grey, _STRUCTURE_PT[1] * pt, threads)
    band = np.clip(band, -_BAND, _BAND)
    square = band * band
    two, three = (blurred(v, _SKEW_AROUND_PT * pt, threads) for v in (square, square * band))
    two = np.maximum(two, 0) + np.float32(_NONE * _NONE)
    return three / (two * np.sqrt(two))


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
    strong, grain, coarse = (variance(values, 6.0) for values in (middle, middle - broad, broad))
    each = by_rows(gained, strong, slope, lifted, carved, grain, coarse, threads=threads)
    parts = guard(middle, 0.5 * noise), guard(fine, noise)
    return _with_room(lights, by_rows(drawn, each, *parts, threads=threads), pt, threads)


def _root(squares: Picture) -> Picture:
    """The square root of what a low-pass, which may be wrong by a rounding, leaves of squares."""
    return np.sqrt(np.maximum(squares, 0))


def _with_room(lights: Picture, drawn: Picture, pt: float, threads: int) -> Picture:
    """Relief needs ink: where there is much detail the lights come down to carry it, and darks rise a little."""

    def with_room(lights: Picture, drawn: Picture, squares: Picture) -> Picture:
        strong = _root(squares)
        share = np.clip((strong - np.float32(_RELIEF)) / np.float32(_RELIEF_RANGE), 0, 1)
        more = 1 + np.float32(0.7) * share * np.clip((lights - np.float32(0.5)) / np.float32(0.3), 0, 1)
        result = lights - np.float32(_RELIEF_INK) * share * np.maximum(0, lights - np.float32(_LIGHT))
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
