"""A photograph to the grey that a drawing of it is made from: the stages of composition in their order.

    colours -> rim left out -> grey by a mix -> black and white points -> base and detail
            -> base exposed -> detail raised -> relief given ink -> ends -> small darks as dark as they were
            -> deep shades black, smooth lights bare
            -> faded out where a mask says

Lengths are points on paper, at the size that the picture is composed for; grey 0 is ink and 1 is paper.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from penink_cli.arrangement.gradient import noise_level
from penink_cli.composition import detail as raising
from penink_cli.composition import exposure, mixing, recolouring
from penink_cli.composition._compiled import tones
from penink_cli.composition.filters import Picture, blurred, by_pixels, looked_up, shrunk
from penink_cli.composition.small import with_small_darks
from penink_cli.ground.errors import ParameterError
from penink_cli.ground.model import ColourImage, GreyImage

STRENGTH, DETAIL = 0.6, 1.8
PIXELS_PER_PT = 4.0  # as many as a drawing can show: a larger photo is made smaller

_WHOLE_FROM = 0.3  # the strength from which on the picture is composed; below, the result is mixed with the stored luma
# The shares of the picture that lie beyond the black and the white point, at each end; the σ of the blur before these
# are found; the least grey from one point to the other.
_POINTS, _POINTS_BLUR_PT, _LEAST_RANGE = 0.003, 0.35, 0.25
_EYE_PT, _BROAD_PT, _AROUND_PT = 0.7, 4.0, 9.0  # σ of the two Gaussians between which activity lies, σ of its average
_BUSY = 0.8  # the quantile of activity that is usual
_PAGE, _PAGE_PAPER = 0.5, 0.985  # a picture of which more than the first share is lighter than the second is a page
_INK, _PAPER = 0.05, 0.95  # greys up to the first become solid ink, from the second on bare paper
# Where a Gaussian of σ _DEEP_PT is dark, tones go down. What is lighter than _STAYS counts in it as no lighter.
_DEEP_PT, _STAYS = 3.0, 0.3
# Broad lights from _BLANK_FROM on rise, so that those from _BLANK on are bare paper: skin and skies are not combed with
# single lines.
_BLANK_FROM, _BLANK = 0.74, 0.90
# All lights from _LIGHT_FROM to _BARE rise too, but less steeply: a steeper curve makes haloes.
_LIGHT_FROM, _BARE = 0.68, 0.92
_TELLING = 1_500_000  # about as many values are looked at to find the range of a photo
_NARROW = 0.35  # of the range of grey: a photograph that uses less is reported


@dataclass(frozen=True)
class Choice:
    """How a picture is composed.

    width_pt: of the drawing on paper, points.
    strength: 0 … 1, how far tones are moved; 0 is the luma as stored.
    detail: by how much detail is raised; 1 leaves it as it is.
    mix: weights of red, green and blue, None for those that keep most contrast.
    target: the tone distribution.
    pixels_per_pt: the most pixels of the grey to a point on paper.
    fade_pt: the length, points, over which the drawing fades out within the mask's border.
    """

    width_pt: float
    strength: float = STRENGTH
    detail: float = DETAIL
    mix: mixing.Weights | None = None
    target: exposure.Quantiles = exposure.TARGETS["house"]
    pixels_per_pt: float = PIXELS_PER_PT
    fade_pt: float = 0.0


def working_size(shape: tuple[int, ...], width_pt: float, pixels_per_pt: float = PIXELS_PER_PT) -> tuple[int, int]:
    """Width and height of the grey: the photo's own, or pixels_per_pt where the photo has more."""
    height, width = shape[:2]
    most = max(2, math.floor(width_pt * pixels_per_pt + 0.5))
    if width <= most:
        return width, height
    return most, max(1, math.floor(height * most / width + 0.5))


def compose(
    photo: GreyImage | ColourImage,
    choice: Choice,
    luma: Callable[[ColourImage], GreyImage],
    mask: GreyImage | None = None,
    *,
    oval: bool = False,
    threads: int = 1,
    report: Callable[[str], None] = lambda line: None,
) -> Picture:
    """Grey (h, w), 0 ink … 1 paper, of `working_size`.

    luma: makes grey of colours where nothing is composed.
    mask: of the photo's size, white where the picture is drawn. oval: whether, without a mask, the oval in the frame is
        the mask.
    report: receives a line for each thing that was chosen.

    Raises ParameterError for a mask of another size.
    """
    width, height = working_size(photo.values.shape, choice.width_pt, choice.pixels_per_pt)
    pt = width / choice.width_pt
    fade = _checked_fade(photo, mask, width, height, choice.fade_pt * pt, oval, threads)
    stored: Picture | None = None
    if choice.strength < _WHOLE_FROM:
        plain = luma(photo) if isinstance(photo, ColourImage) else photo
        stored = _sized(plain, width, height, threads)
    result = stored
    if choice.strength > 0:
        composed = _composed(_framed(photo, width, height, threads, report), choice, pt, fade, threads, report)
        part = min(1.0, choice.strength / _WHOLE_FROM)
        result = composed if stored is None else stored + np.float32(part) * (composed - stored)
    assert result is not None
    return result if fade is None else 1 - (1 - result) * fade


def compose_colours(
    photo: GreyImage | ColourImage,
    choice: Choice,
    mask: GreyImage | None = None,
    *,
    oval: bool = False,
    threads: int = 1,
    report: Callable[[str], None] = lambda line: None,
) -> Picture:
    """Colours (h, w, 3), 0 … 1, of `working_size`: the photo's, as light as the composed grey.

    mask, oval, report: as `compose` has them. Where the choice has no mix, the grey is luma. Raises as `compose` does.
    """
    width, height = working_size(photo.values.shape, choice.width_pt, choice.pixels_per_pt)
    pt = width / choice.width_pt
    fade = _checked_fade(photo, mask, width, height, choice.fade_pt * pt, oval, threads)
    if choice.strength > 0:
        colours = _framed(photo, width, height, threads, report)
        by = choice if choice.mix is not None else replace(choice, mix=recolouring.LUMA)
        grey = _composed(colours, by, pt, fade, threads, report)
        colours = recolouring.recoloured(_in_three(colours), grey, min(1.0, choice.strength / _WHOLE_FROM))
    else:
        colours = _in_three(_scaled(photo.values, photo.maxval, width, height, threads))
    return colours if fade is None else 1 - (1 - colours) * fade[..., None]


def _in_three(picture: Picture) -> Picture:
    """Grey (h, w) as red, green and blue (h, w, 3); colours as they are."""
    return picture if picture.ndim == 3 else np.repeat(picture[..., None], 3, axis=2)


def _framed(
    photo: GreyImage | ColourImage, width: int, height: int, threads: int, report: Callable[[str], None]
) -> Picture:
    """Values 0 … 1 at the working size, without a rim."""
    values = mixing.without_rim(photo.values, photo.maxval)
    if values is not photo.values:
        report("a rim along the frame is left out")
    return _scaled(values, photo.maxval, width, height, threads)


def _checked_fade(
    photo: GreyImage | ColourImage, mask: GreyImage | None, width: int, height: int, soft: float, oval: bool,
    threads: int,
) -> Picture | None:  # fmt: skip
    """As `_fade`. Raises ParameterError for a mask of another size than the photo's."""
    if mask is not None and mask.values.shape != photo.values.shape[:2]:
        (h, w), (rows, columns) = photo.values.shape[:2], mask.values.shape
        raise ParameterError(f"the mask has {columns} x {rows} pixels; the photo has {w} x {h}")
    return _fade(mask, width, height, soft, oval, threads)


def _composed(
    colours: Picture, choice: Choice, pt: float, fade: Picture | None, threads: int, report: Callable[[str], None]
) -> Picture:
    """The composed grey (h, w) of grey (h, w) or colours (h, w, 3), 0 … 1; pt: pixels a point. fade: see `_fade`.

    A plane of a large drawing has eight megabytes, so each is given up as soon as it is not needed any more.
    """
    strength = max(choice.strength, _WHOLE_FROM)
    if colours.ndim == 3:
        mix = choice.mix or mixing.chosen_mix(colours, pt)
        grey = mixing.mixed(colours, mix)
        report(f"mix {mix[0]:g},{mix[1]:g},{mix[2]:g}")
    else:
        grey = colours
    black, white = points(grey, pt, fade, threads)
    report(f"black point {black:.3f}, white point {white:.3f}")
    grey = _stretched(grey, black, white, threads)
    noise = noise_level(grey)
    key = exposure.inks(choice.target)
    key *= key
    broad, carved = raising.base(grey, key, pt, threads, colours if colours.ndim == 3 else None)
    del colours
    detail = by_pixels(np.subtract, grey, broad, threads=threads)
    weight = _weight(grey, noise, pt, threads)
    upto = exposure.histogram(broad, weight if fade is None else weight * fade)
    del weight
    table, slope = exposure.curve(upto, choice.target, strength)
    exposed = looked_up(broad, table)
    # A slope belongs to the middle of its step.
    slopes = looked_up(broad, slope, 0.5 / exposure.STEPS, 1 - 0.5 / exposure.STEPS)
    lifted = by_pixels(partial(tones.lifted_by, key=key), carved, exposed, broad, threads=threads)
    carved = by_pixels(tones.without_shine, carved, broad, threads=threads)
    del broad
    exposed = _blank(exposed, carved, _BLANK_FROM, _BLANK, _PAPER, threads=threads)
    carved *= np.float32(min(key, 1.0))
    result = raising.raised(detail, exposed, slopes, lifted, carved, choice.detail, noise, pt, threads)
    del detail, exposed, slopes, lifted
    result = with_small_darks(_stretched(result, _INK, _PAPER, threads), grey, pt, threads)
    result = _blank(_sunk(result, pt, threads), carved, _LIGHT_FROM, _BARE, threads=threads)
    paper = int((grey > _PAGE_PAPER).sum()) / grey.size
    if paper > _PAGE:
        report(f"a page: {paper:.0%} of it is paper, and stays so")
        result = np.maximum(result, np.clip((grey - np.float32(0.9)) * np.float32(12.5), 0, 1))
    return result


def _stretched(grey: Picture, black: float, white: float, threads: int) -> Picture:
    """Grey (h, w) with these two as 0 and 1."""
    return by_pixels(partial(tones.stretched, low=black, by=1 / (white - black)), grey, threads=threads)


def _sunk(grey: Picture, pt: float, threads: int) -> Picture:
    """Grey (h, w) with its deep shades darkened to black; lighter places within them stay."""
    around = blurred(np.minimum(grey, np.float32(_STAYS)), _DEEP_PT * pt, threads)
    return by_pixels(tones.sunk, grey, around, threads=threads)


def _blank(grey: Picture, carved: Picture, light: float, bare: float, paper: float = 1.0, threads: int = 1) -> Picture:
    """Grey (h, w) with lights raised: `light` stays, `bare` becomes `paper`, linear in between; less so in relief."""
    more = (paper - light) / (bare - light) - 1
    return by_pixels(partial(tones.blanked, light=light, more=more, paper=paper), grey, carved, threads=threads)


def points(grey: Picture, pt: float, fade: Picture | None, threads: int) -> tuple[float, float]:
    """The greys that become black and white."""
    upto = exposure.histogram(blurred(grey, _POINTS_BLUR_PT * pt, threads), fade, 4096)
    black, white = exposure.quantile(upto, _POINTS), exposure.quantile(upto, 1 - _POINTS)
    if white - black < _LEAST_RANGE:  # the contrast of a picture of nearly one grey is not raised without limit
        middle = min(max((black + white) / 2, _LEAST_RANGE / 2), 1 - _LEAST_RANGE / 2)
        black, white = min(black, middle - _LEAST_RANGE / 2), max(white, middle + _LEAST_RANGE / 2)
    return black, white


def narrow_range(photo: GreyImage | ColourImage) -> float | None:
    """The share of the range of values that a photo uses, if it is below _NARROW; else, or for one single value, None.

    Of a large photo some rows are looked at.
    """
    values = photo.values[:: max(1, photo.values.size // _TELLING)]
    counts = np.bincount(values.ravel(), minlength=photo.maxval + 1)
    upto = np.cumsum(counts) / values.size
    used = int(np.searchsorted(upto, 1 - _POINTS)) - int(np.searchsorted(upto, _POINTS))
    return used / photo.maxval if 0 < used < _NARROW * photo.maxval else None


def _weight(grey: Picture, noise: float, pt: float, threads: int) -> Picture:
    """How much each place (h, w) counts for the exposure: a busy subject more than an empty background."""
    fine, broad = (blurred(grey, sigma * pt, threads) for sigma in (_EYE_PT, _BROAD_PT))
    busy = by_pixels(partial(tones.stirred, noise=0.3 * noise * noise), fine, broad, threads=threads)
    activity = by_pixels(tones.rooted, blurred(busy, _AROUND_PT * pt, threads), threads=threads)
    usual = max(0.01, exposure.quantile(exposure.histogram(activity, None, 4096), _BUSY))
    return by_pixels(partial(tones.weighed, by=1 / usual), activity, threads=threads)


def _scaled(values: np.ndarray, maxval: int, width: int, height: int, threads: int) -> Picture:
    """Values 0 … 1 at the working size."""
    if values.shape[:2] == (height, width):
        return np.divide(values, maxval, dtype=np.float32)
    return shrunk(values, width, height, 1 / maxval, threads)


def _sized(photo: GreyImage, width: int, height: int, threads: int) -> Picture:
    """Grey 0 … 1 at the working size."""
    return _scaled(photo.values, photo.maxval, width, height, threads)


def _fade(
    mask: GreyImage | None, width: int, height: int, soft: float, oval: bool, threads: int
) -> Picture | None:
    """How much of the picture is drawn, (h, w), 0 … 1: nothing outside the mask, None for no mask.

    soft: pixels within the mask's border over which it rises to 1.
    """
    if mask is None and not oval:
        return None
    if mask is not None:
        drawn = _sized(mask, width, height, threads)
    else:
        y, x = np.ogrid[:height, :width]
        a, b = (2 * x + 1 - width) / width, (2 * y + 1 - height) / height
        drawn = (a * a + b * b <= 1).astype(np.float32)
    if soft <= 0:
        return drawn
    return np.clip(2 * blurred(drawn, soft / 2, threads) - 1, 0, 1)
