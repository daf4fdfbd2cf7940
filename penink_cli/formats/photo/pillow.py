"""Photographs decoded by Pillow, which is told the format: by itself it would start Ghostscript on an EPS."""

from __future__ import annotations

import contextlib
import io
import os
import struct
import warnings
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from penink_cli.formats.pgm import check_size
from penink_cli.formats.photo.choices import Verdict
from penink_cli.formats.photo.decoded import BAND, SIXTEEN, Decoded, Values
from penink_cli.formats.photo.exif import orientation
from penink_cli.formats.photo.icc import profile_of
from penink_cli.formats.photo.profile import Profile
from penink_cli.ground.errors import FormatError, LimitError, PeninkError, printable

if TYPE_CHECKING:
    from PIL import Image

SHOWN = {"WEBP": "WebP"}
RUN = 1 << 12  # more pixels than one byte of a run-length coded BMP can make
PART = 16  # what is left of a damaged picture is read only if one in so many of its bytes is there


@contextlib.contextmanager
def errors(kind: str) -> Iterator[None]:
    """While the block runs, turn whatever Pillow raises, nearly anything on damaged files, into a PeninkError.

    Raises FormatError, and LimitError where memory ends.
    """
    from PIL import Image, UnidentifiedImageError

    name = SHOWN.get(kind, kind)
    Image.MAX_IMAGE_PIXELS = None  # `check_size` has the limit, and raises an error where Pillow warns
    try:
        with warnings.catch_warnings(), _silence() if kind == "TIFF" else contextlib.nullcontext():
            warnings.simplefilter("ignore")  # Pillow warns of damaged metadata, which decide nothing here
            yield
    except PeninkError:
        raise
    except MemoryError:
        raise LimitError("does not fit into memory") from None
    except UnidentifiedImageError:
        raise FormatError(f"damaged {name} photograph, or one of a rare kind: its header makes no sense") from None
    except Exception as error:
        why = str(error) or type(error).__name__
        raise FormatError(f"damaged {name} photograph: {printable(why, 60)}") from error


@contextlib.contextmanager
def _silence() -> Iterator[None]:
    """While the block runs, keep libtiff from writing to standard error; Pillow raises what libtiff finds."""
    try:
        kept, null = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    except OSError:  # standard error is closed, so libtiff cannot write either
        yield
        return
    try:
        os.dup2(null, 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(null)


def check_beginning(encoded: bytes, kind: str, max_pixels: int) -> None:
    """Raise FormatError or LimitError where the rest of a long stream is not worth waiting for."""
    order = "<" if encoded[:1] == b"I" else ">"
    if kind == "TIFF" and struct.unpack_from(f"{order}4xI", encoded)[0] >= len(encoded) - 1024:
        return  # the directory of this TIFF comes at its end
    with errors(kind), _opened(encoded, kind) as image:
        check_size(*image.size, max_pixels)


def read(encoded: bytes, kind: str, max_pixels: int, verdict: Verdict) -> Decoded:
    """A photograph of a kind that Pillow alone reads: GIF, BMP, AVIF, HEIC. Raises FormatError and LimitError."""
    with errors(kind):
        image = _opened(encoded, kind)
        check_size(*image.size, max_pixels)
        if kind == "BMP":
            _check_bitmap(encoded, *image.size, verdict)
        _load(image, kind, verdict)
        picture = of_image(image)
        if _has_more(image):
            verdict.say("the first of several pictures is read")
    return with_meaning(
        picture,
        profile_of(image.info.get("icc_profile"), picture.channels < 3, verdict),
        orientation(image.info.get("exif")),
    )


def _check_bitmap(encoded: bytes, width: int, height: int, verdict: Verdict) -> None:
    """Raise FormatError where a BMP has fewer bytes than its rows need, before room is made for these."""
    old = encoded[14] == 12
    bits = int.from_bytes(encoded[24:26] if old else encoded[28:30], "little")
    in_runs = not old and int.from_bytes(encoded[30:34], "little") in (1, 2)
    needed = width * height // RUN if in_runs else (width * bits + 31) // 32 * 4 * height
    if len(encoded) < needed:
        error = FormatError(f"truncated: {len(encoded)} of at least {needed} BMP bytes")
        if in_runs or PART * len(encoded) < needed:
            raise error
        verdict.damage(error)


def _has_more(image: Image.Image) -> bool:
    """Whether a file holds more pictures than the one that has been decoded."""
    return getattr(image, "is_animated", False)


def _opened(encoded: bytes, kind: str) -> Image.Image:
    """The photograph, not decoded yet. Raises FormatError for a kind that this Pillow cannot decode."""
    from PIL import Image, features

    if kind == "HEIF":
        try:
            from pillow_heif import register_heif_opener
        except ImportError:
            raise FormatError("a HEIC photograph: its reader is an extra (pip install 'penink-cli[heic]')") from None
        register_heif_opener(thumbnails=False)
    elif kind == "AVIF" and not features.check("avif"):
        raise FormatError("an AVIF photograph, which this Pillow cannot decode: save it as PNG or JPEG")
    return Image.open(io.BytesIO(encoded), formats=(kind,))


def decoded(
    encoded: bytes, kind: str, max_pixels: int, verdict: Verdict, maxval: int = SIXTEEN, inverted: bool = False
) -> Decoded:
    """The first picture of a file of one kind. Raises FormatError and LimitError.

    maxval: white of a picture of 16 bits. inverted: whether 0 is white there (see `of_image`).
    """
    with errors(kind):
        image = _opened(encoded, kind)
        check_size(*image.size, max_pixels)
        _load(image, kind, verdict)
        return of_image(image, maxval, inverted)


def _load(image: Image.Image, kind: str, verdict: Verdict) -> None:
    """Decode the pixels. Raises FormatError for damaged ones, unless the user has asked for what is left of them."""
    from PIL import ImageFile

    try:
        with errors(kind):
            image.load()
    except FormatError as error:
        verdict.damage(error)
        ImageFile.LOAD_TRUNCATED_IMAGES = True
        try:
            image.load()
        finally:
            ImageFile.LOAD_TRUNCATED_IMAGES = False


def of_image(image: Image.Image, sixteen: int = SIXTEEN, inverted: bool = False) -> Decoded:
    """A decoded image as bands of stored values; inks and palettes become colours.

    sixteen: white of an image of 16 bits. inverted: whether 0 is white there; in 8 bits Pillow has obeyed that already.

    Raises FormatError for other kinds than grey and colour of 8 or 16 bits.
    """
    if image.mode in ("I", "F", "LAB", "HSV"):
        raise FormatError(f"photograph of kind {image.mode}; grey or colour of 8 or 16 bits is needed")
    width, height = image.size
    maxval = 255
    if image.mode.startswith("I;16"):
        channels, mode, maxval = 1, image.mode, sixteen
    elif image.mode in ("1", "L") and "transparency" not in image.info:
        channels, mode = 1, "L"
    elif image.mode == "LA":
        channels, mode = 2, "LA"
    elif image.has_transparency_data:
        channels, mode = 4, "RGBA"
    else:
        channels, mode = 3, "RGB"

    def bands() -> Iterator[Values]:
        step = max(1, BAND // width)
        if image.mode != mode and "transparency" in image.info:
            whole = image.convert(mode)
        else:
            whole = image
        for top in range(0, height, step):
            part = whole.crop((0, top, width, min(height, top + step)))
            values: Any = np.asarray(part if part.mode == mode else part.convert(mode))
            if mode.startswith("I;16"):
                values = values.astype(np.uint16 if maxval > 255 else np.uint8)
                if inverted:
                    values = maxval - values
            yield values.reshape(-1, width, channels)

    return Decoded(width, height, maxval, channels, bands())


def with_meaning(picture: Decoded, profile: Profile | None, orientation: int) -> Decoded:
    """The picture with the profile and the orientation that its file declares."""
    return replace(picture, profile=profile, orientation=orientation)
