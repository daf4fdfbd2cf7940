"""From the colours that a file stores to the photograph as it should be seen: curve, background, luma, orientation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from penink_cli.formats.photo.choices import ALPHA, Verdict
from penink_cli.formats.photo.profile import Profile
from penink_cli.ground.errors import FormatError
from penink_cli.ground.model import ColourImage, GreyImage

BAND = 1 << 20  # pixels converted at a time
RED, GREEN, BLUE = 299, 587, 114  # Rec. 601 luma, thousandths
SIXTEEN = 65535
SHALLOW = 4  # where no value of 16 bits reaches this part of white, fewer bits were most likely stored in 16
PALE = 0.9  # grey above which a subject is hard to tell from white paper
PALE_PART = 0.95  # the part of a transparent picture's subject that is pale when the subject is lost

Values = npt.NDArray[Any]  # uint8 where maxval is below 256, else uint16


@dataclass(frozen=True, eq=False)
class Decoded:
    """A picture as its file stores it.

    maxval: the value of white, and of an opaque alpha.
    channels: 1 grey, 2 grey and alpha, 3 red, green and blue, 4 these and alpha.
    bands: (k, width, channels) of some rows each, from the top, 0 … maxval.
    profile: what the stored colours mean, None for sRGB's.
    orientation: EXIF's, 1 … 8.
    """

    width: int
    height: int
    maxval: int
    channels: int
    bands: Iterator[Values]
    profile: Profile | None = None
    orientation: int = 1


def seen(picture: Decoded, verdict: Verdict, colours: bool) -> GreyImage | ColourImage:
    """The picture as it should be seen; colours: in its colours, if it has any, and not as grey.

    Raises FormatError where the background is ALPHA and the picture has no transparency.
    """
    choices = verdict.choices
    transparent = picture.channels in (2, 4)
    if choices.background == ALPHA and not transparent:
        raise FormatError("nothing of it is transparent: --background alpha has nothing to show")
    background = choices.background if isinstance(choices.background, tuple) else (0, 0, 0)
    grey = picture.channels < 3 and (not transparent or len(set(background)) == 1)
    planes = colours and not grey and choices.background != ALPHA
    depth = np.uint8 if picture.maxval < 256 else np.uint16
    shape = (picture.height, picture.width, 3) if planes else (picture.height, picture.width)
    values = np.empty(shape, depth)
    convert = picture.profile.conversion(picture.maxval) if picture.profile and choices.profile else None
    subject = _Subject(picture.maxval)
    brightest = top = 0
    for band in _in_small_bands(picture.bands, picture.width):
        brightest = max(brightest, int(band[..., : 3 if picture.channels > 2 else 1].max()))
        values[top : top + len(band)] = _shown(band, picture.maxval, choices.background, convert, planes, subject)
        top += len(band)
    if picture.maxval == SIXTEEN and 0 < brightest < SIXTEEN // SHALLOW:
        bits = max(8, brightest.bit_length())
        verdict.say(
            f"no value is above {brightest} of 65535, as where {bits} bits are stored in 16: it is nearly black"
        )
    if transparent and choices.background == (255, 255, 255) and subject.is_pale():
        verdict.say("what is not transparent is white, or nearly, and is lost on white: see --background")
    values = _upright(values, picture.orientation)
    return ColourImage(values, picture.maxval) if planes else GreyImage(values, picture.maxval)


def grey_of(image: ColourImage) -> GreyImage:
    """The luma of a coloured image."""
    height, width = image.values.shape[:2]
    grey = np.empty((height, width), image.values.dtype)
    step = max(1, BAND // width)
    for top in range(0, height, step):
        grey[top : top + step] = luma(image.values[top : top + step])
    return GreyImage(grey, image.maxval)


def luma(colours: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Rec. 601 luma (k, w) of colours (k, w, 3), to the nearest whole number, half up."""
    grey = colours[..., 0].astype(np.int32) * RED  # 65535 · 1000 fits
    grey += colours[..., 1].astype(np.int32) * GREEN
    grey += colours[..., 2].astype(np.int32) * BLUE
    grey += 500
    grey //= 1000
    return grey


def _in_small_bands(bands: Iterator[Values], width: int) -> Iterator[Values]:
    step = max(1, BAND // width)
    for band in bands:
        for top in range(0, len(band), step):
            yield band[top : top + step]


def _shown(
    band: Values,
    maxval: int,
    background: tuple[int, int, int] | str,
    convert: Callable[[Values], Values] | None,
    planes: bool,
    subject: _Subject,
) -> npt.NDArray[Any]:
    """Grey (k, w), or with planes red, green and blue (k, w, 3), of a band of stored values.

    convert: takes the values through the profile, None for none. subject: looks at what is not transparent.
    """
    channels = band.shape[2]
    if channels in (2, 4):
        alpha = band[..., -1]
        if background == ALPHA:
            return maxval - alpha
        band = band[..., :-1]
    else:
        alpha = None
    if convert is not None:
        band = convert(band)
    if alpha is not None:
        subject.look(luma(band) if band.shape[2] == 3 else band[..., 0], alpha)
        assert isinstance(background, tuple)
        band = _over(band, alpha, background, maxval)
    if band.shape[2] == 1:
        return band[..., 0]
    return band if planes else luma(band)


def _over(band: npt.NDArray[Any], alpha: Values, background: tuple[int, int, int], maxval: int) -> npt.NDArray[Any]:
    """Grey or colours (k, w, channels) of a band of that opacity (k, w) on a background of 8-bit levels."""
    behind = [(level * maxval + 127) // 255 for level in background]
    if band.shape[2] == 1 and len(set(background)) == 1:
        behind = behind[:1]
    wide: Any = np.int64 if maxval > 255 else np.int32
    opacity = alpha[..., None].astype(wide)
    return (band * opacity + np.array(behind, wide) * (maxval - opacity) + maxval // 2) // maxval


class _Subject:
    """Measures how much of what is not transparent in a picture is pale. Sums are in units of alpha."""

    def __init__(self, maxval: int):
        self.maxval = maxval
        self.pale = self.all = self.clear = 0

    def look(self, grey: npt.NDArray[Any], alpha: Values) -> None:
        """Count a band: its grey (k, w) and its opacity (k, w)."""
        opacity = alpha.astype(np.int64)
        self.all += int(opacity.sum())
        self.pale += int(opacity[grey >= PALE * self.maxval].sum())
        self.clear += int((self.maxval - opacity).sum())

    def is_pale(self) -> bool:
        """Whether the subject is lost on white, and something around it is transparent."""
        return self.clear > 0 and self.all > 0 and self.pale >= PALE_PART * self.all


_TURNS: dict[int, Callable[[Values], Values]] = {
    2: lambda a: a[:, ::-1],
    3: lambda a: a[::-1, ::-1],
    4: lambda a: a[::-1],
    5: lambda a: a.swapaxes(0, 1),
    6: lambda a: np.rot90(a, -1),
    7: lambda a: a[::-1, ::-1].swapaxes(0, 1),
    8: lambda a: np.rot90(a, 1),
}


def _upright(values: Values, orientation: int) -> Values:
    """The picture turned as EXIF's orientation says."""
    turn = _TURNS.get(orientation)
    return values if turn is None else np.ascontiguousarray(turn(values))
