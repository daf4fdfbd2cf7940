"""Photographs: every kind and depth to the colours or the grey that is seen. A damaged one is refused, or reported.

    stream ─ signatures ─┬─ netpbm                    PGM, PPM, PBM, PAM
                         ├─ png, jpeg, tiff, webp     only what carries pixels is decoded
                         └─ pillow                    GIF, BMP, AVIF; HEIC where its package is there
                               │
       decoded.Decoded: bands of stored values, a profile (icc), an orientation (exif)
                               │   decoded.seen
       profile ─► background ─► luma, or colours ─► orientation

choices: how the user wants a photograph read, and what is an error and what a line.
Pillow is asked for one of these formats and no other: left to itself it would start Ghostscript on an EPS.

Grey is Rec. 601 luma of sRGB's values, in integers. What is stored in 16 bits stays in 16 bits (of TIFF: where it is
grey). Transparency lies on a background, white by default.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import BinaryIO

from penink_cli.formats.photo import decoded, netpbm
from penink_cli.formats.photo.choices import ALPHA, Choices, Verdict
from penink_cli.formats.photo.decoded import Decoded, grey_of
from penink_cli.formats.signatures import kind_of
from penink_cli.ground.errors import FormatError, LimitError, PeninkError, in_quotes
from penink_cli.ground.model import ColourImage, GreyImage

__all__ = ["ALPHA", "Choices", "grey_of", "read_colours", "read_grey"]

BYTES_PER_PIXEL = 9  # 8 of 16-bit RGBA that does not compress, and the overhead of its format
AS_IS = Choices()
METADATA = 1 << 24  # bytes that an encoded photograph may have besides its pixels


def _silent(line: str) -> None:
    """Say nothing."""


def read_grey(
    stream: BinaryIO, source: str, max_pixels: int, choices: Choices = AS_IS, say: Callable[[str], None] = _silent
) -> GreyImage:
    """A photograph in any of the formats above as grey samples.

    say: receives a line about each thing that is read as the file has it, but perhaps not as the user means it.

    Raises FormatError for any other file or a damaged one, LimitError for one that declares more
    than max_pixels pixels, before it is decoded.
    """
    found = _read(stream, source, max_pixels, choices, say, colours=False)
    assert isinstance(found, GreyImage)
    return found


def read_colours(
    stream: BinaryIO, source: str, max_pixels: int, choices: Choices = AS_IS, say: Callable[[str], None] = _silent
) -> GreyImage | ColourImage:
    """A photograph in its colours; grey where it has none. Takes and raises what `read_grey` does."""
    return _read(stream, source, max_pixels, choices, say, colours=True)


def _read(
    stream: BinaryIO, source: str, max_pixels: int, choices: Choices, say: Callable[[str], None], colours: bool
) -> GreyImage | ColourImage:
    verdict = Verdict(choices, lambda line: say(f"{source}: {line}"))
    try:
        return decoded.seen(_picture(stream, source, max_pixels, verdict), verdict, colours)
    except PeninkError as error:
        raise error.from_source(source) from None
    except MemoryError:
        raise LimitError("does not fit into memory", source) from None


def _picture(stream: BinaryIO, source: str, max_pixels: int, verdict: Verdict) -> Decoded:
    """The picture as its file stores it, by the reader of its kind. Raises FormatError and LimitError."""
    magic = stream.read(2)
    if magic in (b"P1", b"P2", b"P3", b"P4", b"P5", b"P6", b"P7"):
        return netpbm.read(stream, source, max_pixels, magic)
    start = magic + stream.read(30)
    kind = kind_of(start)
    if kind is None:
        from penink_cli.formats.recognise import ENOUGH, explained

        shown = f"begins with {in_quotes(start[:8].decode('latin-1'))}" if start else "it is empty"
        unknown = FormatError(f"not a photograph of any kind that is read (PNG, JPEG, TIFF, WebP …): {shown}", source)
        raise explained(unknown, start + stream.read1(ENOUGH), "photo")  # type: ignore[attr-defined]
    encoded = _whole(start, stream, kind, max_pixels)
    if kind == "PNG":
        from penink_cli.formats.photo import png

        return png.read(encoded, max_pixels, verdict)
    if kind == "JPEG":
        from penink_cli.formats.photo import jpeg

        return jpeg.read(encoded, max_pixels, verdict)
    if kind == "TIFF":
        from penink_cli.formats.photo import tiff

        return tiff.read(encoded, max_pixels, verdict)
    if kind == "WEBP":
        from penink_cli.formats.photo import webp

        return webp.read(encoded, max_pixels, verdict)
    from penink_cli.formats.photo import pillow

    return pillow.read(encoded, kind, max_pixels, verdict)


def _whole(start: bytes, stream: BinaryIO, kind: str, max_pixels: int) -> bytes:
    """All bytes of the photograph.

    Raises FormatError where the beginning makes no sense, LimitError for more bytes than max_pixels pixels can need.
    """
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
    return encoded.getvalue()


def _check_beginning(encoded: bytes, kind: str, max_pixels: int) -> None:
    """Raise FormatError or LimitError where the rest of a long stream is not worth waiting for."""
    if kind == "PNG":
        from penink_cli.formats.photo import png

        png.header(encoded, max_pixels)
    elif kind == "JPEG":
        from penink_cli.formats.photo import jpeg

        jpeg.check_beginning(encoded, max_pixels)
    else:
        from penink_cli.formats.photo import pillow

        pillow.check_beginning(encoded, kind, max_pixels)
