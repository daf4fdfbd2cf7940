"""Photographs to grey: PGM and PPM by the Netpbm reader, PNG, JPEG, TIFF and WebP by Pillow.

Pillow is given these formats and no other: left to itself it would start Ghostscript on an EPS.
Its leniencies are made up for here and in `damage`: it only warns of images between 89 and 179
megapixels, shows what is left of damaged PNG and JPEG files, and forgets that white is zero in some TIFFs.

Grey is Rec. 601 luma of the values as stored, in integers; transparency lies on white; the EXIF
orientation is applied. What was stored in 16 bits of grey stays in 16 bits.
"""

from __future__ import annotations

import contextlib
import io
import os
import struct
import warnings
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
import numpy.typing as npt

from penink_cli.formats import damage, pgm
from penink_cli.formats.signatures import SIGNATURES
from penink_cli.ground.errors import FormatError, LimitError, PeninkError, in_quotes, printable
from penink_cli.ground.model import ColourImage, GreyImage

if TYPE_CHECKING:
    from PIL import Image

BAND = 1 << 20  # pixels converted at a time
BYTES_PER_PIXEL = 9  # of 16-bit RGBA that does not compress, and some
METADATA = 1 << 24  # bytes that an encoded photograph may have besides
RED, GREEN, BLUE = 299, 587, 114  # Rec. 601 luma, thousandths


def read_grey(stream: BinaryIO, source: str, max_pixels: int) -> GreyImage:
    """A photograph in any of the formats above as grey samples.

    Raises FormatError for any other file or a damaged one, LimitError for one that declares more
    than max_pixels pixels, before it is decoded.
    """
    found = _read(stream, source, max_pixels, colours=False)
    assert isinstance(found, GreyImage)
    return found


def read_colours(stream: BinaryIO, source: str, max_pixels: int) -> GreyImage | ColourImage:
    """The same in its colours, on white where it is transparent; grey where it has none. Raises as `read_grey` does."""
    return _read(stream, source, max_pixels, colours=True)


def grey_of(colours: ColourImage) -> GreyImage:
    """What `read_grey` would have read."""
    values = colours.values
    return _by_bands(values.shape[1], values.shape[0], colours.maxval, lambda top, bottom: values[top:bottom])


def _read(stream: BinaryIO, source: str, max_pixels: int, colours: bool) -> GreyImage | ColourImage:
    magic = stream.read(2)
    if magic in (b"P2", b"P5"):
        return GreyImage(*pgm.read_raster(stream, source, max_pixels, magic))
    if magic in (b"P3", b"P6"):
        values, maxval = pgm.read_raster(stream, source, max_pixels, magic)
        found = ColourImage(values, maxval)
        return found if colours else grey_of(found)
    start = magic + stream.read(14)
    kind = next((name for signature, name in SIGNATURES if start.startswith(signature)), None)
    if kind is None or (kind == "WEBP" and start[8:12] != b"WEBP"):
        from penink_cli.formats.recognise import ENOUGH, explained

        shown = f"begins with {in_quotes(start[:8].decode('latin-1'))}" if start else "it is empty"
        unknown = FormatError(f"not a PGM, PPM, PNG, JPEG, TIFF or WebP photograph: {shown}", source)
        raise explained(unknown, start + stream.read1(ENOUGH), "photo")  # type: ignore[attr-defined]
    try:
        return _decoded(_whole(start, stream, kind, max_pixels), kind, max_pixels, colours)
    except PeninkError as error:
        raise error.from_source(source) from None


def _whole(start: bytes, stream: BinaryIO, kind: str, max_pixels: int) -> io.BytesIO:
    """All bytes of the photograph, as long as its beginning makes sense and the pixels allowed can need them."""
    encoded = io.BytesIO(start)
    encoded.seek(len(start))
    most = METADATA + BYTES_PER_PIXEL * max_pixels
    looked = False
    while piece := stream.read(1 << 20):
        encoded.write(piece)
        if encoded.tell() > METADATA and not looked:
            looked = True
            _check_beginning(encoded.getvalue(), kind, max_pixels)
        if encoded.tell() > most:
            raise LimitError(f"photograph of more than {most} bytes (--max-pixels raises this limit)")
    return encoded


def _check_beginning(encoded: bytes, kind: str, max_pixels: int) -> None:
    """Raise FormatError or LimitError where the rest of a long stream is not worth waiting for."""
    from PIL import Image

    order = "<" if encoded[:1] == b"I" else ">"
    if kind == "TIFF" and struct.unpack_from(f"{order}4xI", encoded)[0] >= len(encoded) - 1024:
        return  # its header comes last
    with _pillow_errors(kind), Image.open(io.BytesIO(encoded), formats=(kind,)) as image:
        pgm.check_size(*image.size, max_pixels)


@contextlib.contextmanager
def _pillow_errors(kind: str) -> Iterator[None]:
    """Turn what Pillow raises, which may be nearly anything on damaged files, into errors of ours."""
    from PIL import Image, UnidentifiedImageError

    Image.MAX_IMAGE_PIXELS = None  # our own limit stands in its place, and is an error
    try:
        with warnings.catch_warnings(), _silence() if kind == "TIFF" else contextlib.nullcontext():
            warnings.simplefilter("ignore")  # of damaged metadata, which are of no use here
            yield
    except PeninkError:
        raise
    except MemoryError:
        raise LimitError("does not fit into memory") from None
    except UnidentifiedImageError:
        raise FormatError(f"damaged {kind} photograph, or one of a rare kind: its header makes no sense") from None
    except Exception as error:
        why = str(error) or type(error).__name__
        raise FormatError(f"damaged {kind} photograph: {printable(why, 60)}") from error


@contextlib.contextmanager
def _silence() -> Iterator[None]:
    """Keep libtiff from writing to standard error; what it has found comes back as an exception as well."""
    try:
        kept, null = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    except OSError:  # standard error is closed: nothing can be written
        yield
        return
    try:
        os.dup2(null, 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(null)


def _decoded(encoded: io.BytesIO, kind: str, max_pixels: int, colours: bool) -> GreyImage | ColourImage:
    from PIL import Image

    with _pillow_errors(kind), Image.open(encoded, formats=(kind,)) as image:
        pgm.check_size(*image.size, max_pixels)
        tags: Any = getattr(image, "tag_v2", {})
        if tags.get(284) == 2 and max(tags.get(258, (8,))) > 8:
            raise FormatError("TIFF photograph of more than 8 bits in separate planes")  # which Pillow mixes up
        if kind == "PNG":
            damage.check_png(encoded.getvalue(), *image.size)
        image.load()
        if kind == "JPEG":
            damage.check_jpeg(encoded.getvalue(), image.mode)
        _turn_upright(image)
        return _colours(image) if colours else _grey(image)


def _turn_upright(image: Image.Image) -> None:
    """Turn as EXIF says; a photograph whose EXIF cannot be read stays as it is stored."""
    from PIL import ImageOps

    with contextlib.suppress(Exception):
        ImageOps.exif_transpose(image, in_place=True)


def _colours(image: Image.Image) -> GreyImage | ColourImage:
    """Colours of a decoded image, on white where it is transparent."""
    if image.mode in ("1", "L", "I", "F", "LAB", "HSV") or image.mode.startswith("I;16"):
        return _grey(image)  # or its complaint
    if not image.has_transparency_data:
        return ColourImage(np.array(image if image.mode == "RGB" else image.convert("RGB")), 255)
    image = image.convert("RGBA")
    width, height = image.size
    values = np.empty((height, width, 3), np.uint8)
    step = max(1, BAND // width)
    for top in range(0, height, step):
        bottom = min(height, top + step)
        values[top:bottom] = _on_white(np.asarray(image.crop((0, top, width, bottom))).astype(np.int64))
    return ColourImage(values, 255)


def _grey(image: Image.Image) -> GreyImage:
    """Luma of a decoded image, on white where it is transparent."""
    if image.mode.startswith("I;16"):
        return _grey_16(image)
    if image.mode in ("1", "L") and "transparency" not in image.info:
        return GreyImage(np.array(image.convert("L")))
    if image.mode in ("I", "F", "LAB", "HSV"):
        raise FormatError(f"photograph of kind {image.mode}; grey or colour of 8 or 16 bits is needed")
    transparent = image.has_transparency_data
    if transparent and image.mode != "RGBA":
        image = image.convert("RGBA")
    elif not transparent and image.mode != "RGB":
        image = image.convert("RGB")
    width, height = image.size
    return _by_bands(width, height, 255, lambda top, bottom: np.asarray(image.crop((0, top, width, bottom))))


def _grey_16(image: Image.Image) -> GreyImage:
    tags: Any = getattr(image, "tag_v2", {})
    values = np.array(image).astype(np.uint16)
    bits = tags.get(258, (16,))
    maxval = (1 << (bits[0] if isinstance(bits, tuple) else bits)) - 1
    clear = image.info.get("transparency")
    if isinstance(clear, int):
        values[values == clear] = maxval
    if tags.get(262) == 0:  # WhiteIsZero, which Pillow heeds in 8 bits only
        values = (maxval - values).astype(np.uint16)
    return GreyImage(values.astype(np.uint8) if maxval < 256 else values, maxval)


def _by_bands(width: int, height: int, maxval: int, band: Callable[[int, int], npt.NDArray[np.integer]]) -> GreyImage:
    """Luma of the colours that ``band(top, bottom)`` gives, a band at a time: the integers in between are 8 bytes."""
    grey = np.empty((height, width), np.uint8 if maxval < 256 else np.uint16)
    step = max(1, BAND // width)
    for top in range(0, height, step):
        bottom = min(height, top + step)
        grey[top:bottom] = _luma(band(top, bottom).astype(np.int64))
    return GreyImage(grey, maxval)


def _luma(colours: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Grey (k, w) of RGB (k, w, 3), or of 8-bit RGBA (k, w, 4) on white."""
    if colours.shape[2] == 4:
        colours = _on_white(colours)
    return (colours[..., 0] * RED + colours[..., 1] * GREEN + colours[..., 2] * BLUE + 500) // 1000


def _on_white(colours: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """RGB (k, w, 3) of 8-bit RGBA (k, w, 4)."""
    alpha = colours[..., 3:]
    return (colours[..., :3] * alpha + 255 * (255 - alpha) + 127) // 255
