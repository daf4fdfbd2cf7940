"""Direction fields (``*.directions.pgm``): cos 2θ, sin 2θ and the confidence as three raw PGM images in one stream.

Netpbm's own programs split such a stream (``pamsplit``) and show each plane as grey: for cosine and sine black is −1,
white 1, the middle 0. The three have one size; each has its own maxval.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, BinaryIO

from penink_cli.formats import pgm
from penink_cli.ground.errors import FormatError, PeninkError, in_quotes
from penink_cli.ground.model import Directions, GreyImage
from penink_cli.ground.shapes import same_shape

if TYPE_CHECKING:
    from penink_cli.ground.streams import Output

PLANES = ("cos 2θ", "sin 2θ", "confidence")
MAXVAL = 254  # as written: even, so that 0, ±½ and ±1 are levels


def read(stream: BinaryIO, source: str, max_pixels: int) -> Directions:
    """A direction field whose planes have one size and whose confidence is not 0 everywhere.

    cos 2θ and sin 2θ are as stored: a unit vector up to rounding. Bytes after the third image are ignored.

    Raises FormatError, which names the plane, and LimitError for more than max_pixels samples.
    """
    planes: list[GreyImage] = []
    for name in PLANES:
        planes.append(_plane(stream, source, max_pixels, name, first=not planes))
        height, width = planes[0].values.shape
        h, w = planes[-1].values.shape
        if (h, w) != (height, width):
            raise FormatError(f"{name}: {w} x {h} samples; {PLANES[0]} has {width} x {height}", source)
    cos2, sin2, confidence = (plane.values / float(plane.maxval) for plane in planes)
    if not confidence.any():
        raise FormatError("confidence: it is 0 everywhere; a field must know a direction somewhere", source)
    return Directions(cos2 * 2 - 1, sin2 * 2 - 1, confidence)


def _plane(stream: BinaryIO, source: str, max_pixels: int, name: str, first: bool) -> GreyImage:
    """The next image of the stream, called ``name`` in errors. Raises FormatError and LimitError."""
    magic = stream.read(2)
    if first and magic not in (b"P2", b"P5"):
        from penink_cli.formats.recognise import ENOUGH, explained

        shown = f"begins with {in_quotes(magic.decode('latin-1'))}, not P5" if magic else "it is empty"
        unknown = FormatError(f"not a direction field: {shown}", source)
        raise explained(unknown, magic + stream.read1(ENOUGH), "directions")  # type: ignore[attr-defined]
    if magic != b"P5":
        what = f"begins with {in_quotes(magic.decode('latin-1'))}, not P5" if magic else "is missing"
        raise FormatError(f"{name}: {what}; a field is three raw PGM images: {', '.join(PLANES)}", source)
    try:
        return GreyImage(*pgm.read_raster(stream, source, max_pixels, magic))
    except PeninkError as error:
        raise type(error)(f"{name}: {error.message}", source) from None


def check_shape(directions: Directions, width: int, height: int) -> None:
    """Raise FormatError where no resizing, rounded to whole samples, leads from the field to a picture of that size."""
    rows, columns = directions.cos2.shape
    if not same_shape(columns, rows, width, height):
        picture = f"the picture has {width} x {height} pixels, which is another shape"
        raise FormatError(f"a field of {columns} x {rows} samples; {picture}")


def rounded(directions: Directions, levels: int = MAXVAL) -> Directions:
    """The field as it is read after it has been written with a maxval of ``levels``."""
    cos2, sin2, confidence = (plane.values / float(plane.maxval) for plane in _images(directions, levels))
    return Directions(cos2 * 2 - 1, sin2 * 2 - 1, confidence)


def _images(directions: Directions, maxval: int) -> list[GreyImage]:
    halves = ((directions.cos2 + 1) / 2, (directions.sin2 + 1) / 2, directions.confidence)
    return [GreyImage.from_grey(plane, maxval) for plane in halves]


def write(out: Output, directions: Directions) -> None:
    """Write a field, its planes rounded to MAXVAL levels.

    Raises FormatError where the confidence is 0 everywhere once it is rounded, which is not read again.
    """
    images = _images(directions, MAXVAL)
    if not images[2].values.any():
        raise FormatError("confidence: it is 0 everywhere; a field must know a direction somewhere")
    for image in images:
        pgm.write(out, image)
