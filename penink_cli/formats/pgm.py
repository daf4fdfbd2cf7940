"""PGM, the portable grey map, by the Netpbm definition: P2 and P5 read, P5 written.

An image library would rescale an odd maxval; here every maxval from 1 to 65535 is kept. The
same reader takes the three channels of PPM (P3, P6) for the sake of photographs.

Header: magic, width, height, maxval, each followed by white space (blank, TAB, CR, LF). A comment runs from ``#`` to
the end of its line, that end included. In the header it is as if it were not there: it may stand within a number, and
does not replace the one white space character that separates maxval from the raster. After that character every byte
of P5 is raster, whatever it looks like. In the raster of P2 a comment is white space.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
import numpy.typing as npt

from penink_cli.ground.errors import FormatError, LimitError, in_quotes
from penink_cli.ground.model import ColourImage, GreyImage

if TYPE_CHECKING:
    from penink_cli.ground.streams import Output

Values = npt.NDArray[Any]  # uint8 where maxval < 256, else uint16

WHITE = b" \t\r\n"
MAX_HEADER = 1 << 17  # bytes, comments included; a plain number has no more digits either
MAX_VALUE = 10**15  # of a header number: far beyond any limit, and within every integer type
BAND = 1 << 20  # bytes read, checked and converted at a time


def read(stream: BinaryIO, source: str, max_pixels: int) -> GreyImage:
    """The first image of a PGM stream.

    Raises FormatError for anything that is not PGM or is cut short, LimitError for an image of more
    than max_pixels pixels, before anything of that size is allocated.
    """
    magic = stream.read(2)
    if magic not in (b"P2", b"P5"):
        from penink_cli.formats.recognise import ENOUGH, explained

        shown = f"begins with {_shown(magic)}, not P2 or P5" if magic else "it is empty"
        unknown = FormatError(f"not a PGM image: {shown}", source)
        raise explained(unknown, magic + stream.read1(ENOUGH), "pgm")  # type: ignore[attr-defined]
    values, maxval = read_raster(stream, source, max_pixels, magic)
    return GreyImage(values, maxval)


def read_at_most(stream: BinaryIO, source: str, max_pixels: int, most: int) -> GreyImage:
    """The first image of a PGM stream; of more than ``most`` pixels a smaller view, each pixel the mean of k × k.

    Memory grows with ``most``, not with the image. Raises FormatError as `read` does, LimitError for more than
    max_pixels pixels, and for more than ``most`` of P2, which is not read by bands.
    """
    magic = stream.read(2)
    if magic != b"P5":
        return read(_Again(magic, stream), source, most)  # type: ignore[arg-type]
    width, height, maxval = header_numbers(stream, source, 3)
    _check_maxval(maxval, source)
    check_size(width, height, max_pixels, source)
    if width * height <= most:
        return GreyImage(binary(stream, source, width * height, maxval, width).reshape(height, width), maxval)
    k = math.isqrt((width * height - 1) // most) + 1
    columns = np.arange(0, width, k)
    across = np.minimum(k, width - columns)
    values = np.empty((-(-height // k), len(columns)), np.uint8 if maxval < 256 else np.uint16)
    for i in range(len(values)):
        rows = min(k, height - i * k)
        band = binary(stream, source, rows * width, maxval, width).reshape(rows, width)
        sums = np.add.reduceat(band.sum(axis=0, dtype=np.int64), columns)
        values[i] = (2 * sums + rows * across) // (2 * rows * across)
    return GreyImage(values, maxval)


class _Again:
    """A stream of which some bytes have been read already."""

    def __init__(self, start: bytes, stream: BinaryIO):
        self._start, self._stream = start, stream

    def read(self, size: int) -> bytes:
        start, self._start = self._start[:size], self._start[size:]
        return start or self._stream.read(size)

    def read1(self, size: int) -> bytes:
        return self._stream.read1(size)  # type: ignore[attr-defined]

    def readinto(self, buffer: Any) -> int:
        return self._stream.readinto(buffer)  # type: ignore[attr-defined]


def read_raster(stream: BinaryIO, source: str, max_pixels: int, magic: bytes) -> tuple[Values, int]:
    """Values (h, w) of P2 and P5, (h, w, 3) of P3 and P6, and maxval; the magic number has been read.

    Raises FormatError, and LimitError for more than max_pixels pixels and for what does not fit into memory.
    """
    channels = 3 if magic in (b"P3", b"P6") else 1
    width, height, maxval = header_numbers(stream, source, 3)
    _check_maxval(maxval, source)
    check_size(width, height, max_pixels, source)
    count = width * height * channels
    try:
        if magic in (b"P5", b"P6"):
            flat = binary(stream, source, count, maxval, width * channels)
        else:
            flat = _plain(stream, source, count, maxval, width * channels)
    except MemoryError:
        raise LimitError(f"{width} x {height} pixels do not fit into memory", source) from None
    return flat.reshape((height, width) if channels == 1 else (height, width, 3)), maxval


def check_size(width: int, height: int, max_pixels: int, source: str | None = None) -> None:
    """Raise LimitError where an image declares more than max_pixels pixels."""
    if width * height > max_pixels:
        raise LimitError(f"declares {width} x {height} pixels; at most {max_pixels} are allowed (--max-pixels)", source)


def _shown(found: bytes) -> str:
    return in_quotes(found.decode("latin-1"))


def header_numbers(stream: BinaryIO, source: str, count: int) -> list[int]:
    """Width, height and, where three are wanted, maxval, read up to and with the one white space before the raster.

    Raises FormatError.
    """
    numbers: list[int] = []
    place = ("width", "height", "maxval")
    value: int | None = None
    comment = False
    separated = False  # white space has been seen since the last number or the magic number
    for _ in range(MAX_HEADER):
        byte = stream.read(1)
        if not byte:
            raise FormatError(f"truncated: ends before its {place[len(numbers)]}", source)
        if comment:
            comment = byte not in b"\r\n"
        elif byte == b"#":
            comment = True
        elif byte in WHITE:
            separated = True
            if value is not None:
                numbers.append(value)
                value = None
                if len(numbers) == count:
                    return _checked(numbers, source)
        elif byte.isdigit() and separated:
            value = (value or 0) * 10 + int(byte)
            if value > MAX_VALUE:
                raise FormatError(f"{place[len(numbers)]} is more than {MAX_VALUE}", source)
        else:
            found = _shown(byte + stream.read(59))
            raise FormatError(f"{place[len(numbers)]}: a decimal number is expected, found {found}", source)
    raise FormatError(f"the header is longer than {MAX_HEADER} bytes", source)


def _check_maxval(maxval: int, source: str) -> None:
    if not 1 <= maxval <= 65535:
        raise FormatError(f"maxval is {maxval}; 1 to 65535 are allowed", source)


def _checked(numbers: list[int], source: str) -> list[int]:
    for name, value in zip(("width", "height"), numbers, strict=False):
        if value < 1:
            raise FormatError(f"{name} is {value}; at least 1 is needed", source)
    return numbers


def binary(stream: BinaryIO, source: str, count: int, maxval: int, row: int) -> Values:
    """``count`` values of one byte each, or of two, the most significant first: (count,), 0 … maxval.

    row: values in a row, to say where one is too large. Raises FormatError.
    """
    stored = np.dtype(np.uint8) if maxval < 256 else np.dtype(">u2")
    flat: Values = np.empty(count, stored)
    view = flat.view(np.uint8).data
    filled = 0
    while filled < len(view):
        # By bands: the system gives memory as it is touched, so a stream that is cut short takes little.
        got = stream.readinto(view[filled : filled + BAND])  # type: ignore[attr-defined]
        if not got:
            raise FormatError(f"truncated: {filled} of {len(view)} raster bytes", source)
        filled += got
    if stored.itemsize == 2:
        flat = flat.byteswap(inplace=True).view(np.uint16) if np.little_endian else flat.view(np.uint16)
    if maxval not in (255, 65535):
        for start in range(0, count, BAND):
            _check_values(flat[start : start + BAND], start, maxval, row, source)
    return flat


def _check_values(values: npt.NDArray[np.integer], start: int, maxval: int, row: int, source: str) -> None:
    if values.max(initial=0) > maxval:
        at = int(np.argmax(values > maxval))
        i, j = divmod(start + at, row)
        raise FormatError(f"row {i + 1}, value {j + 1} is {values[at]}; maxval is {maxval}", source)


def _plain(stream: BinaryIO, source: str, count: int, maxval: int, row: int) -> Values:
    """``count`` decimal values (count,) in white space, and nothing after them. Raises FormatError.

    Comments are taken here too, as Netpbm's own programs take them: ``#`` can mean nothing else.
    """
    flat = np.empty(count, np.uint8 if maxval < 256 else np.uint16)
    filled = 0
    rest = b""  # the beginning of a number, or of a comment, whose end is yet to come
    comment = False
    while True:
        block = stream.read(BAND)
        text = rest + block
        if comment or b"#" in text:
            text, comment = _without_comments(text, comment)
        if block:
            # Keep back the last number: its digits may go on in the next block.
            cut = max(text.rfind(bytes([w])) for w in WHITE) + 1
            text, rest = text[:cut], text[cut:]
            if len(rest) > MAX_HEADER:
                raise FormatError(f"a raster value has more than {MAX_HEADER} digits", source)
        stray = text.translate(None, b"0123456789" + WHITE)
        if stray:
            raise FormatError(f"raster: decimal numbers are expected, found {_shown(stray[:61])}", source)
        # numpy reads by strtol, which saturates: a number beyond 64 bits stays above maxval.
        values = np.fromstring(text, np.int64, sep=" ") if text.strip(WHITE) else np.empty(0, np.int64)
        _check_values(values, filled, maxval, row, source)
        if filled + len(values) > count:
            raise FormatError(f"more than {count} raster values", source)
        flat[filled : filled + len(values)] = values
        filled += len(values)
        if not block:
            break
    if filled < count:
        raise FormatError(f"truncated: {filled} of {count} raster values", source)
    return flat


def _without_comments(text: bytes, comment: bool) -> tuple[bytes, bool]:
    """The text with a blank for each comment, and whether it ends within one; comment: whether it begins within one."""
    kept: list[bytes] = []
    while True:
        if comment:
            ends = [at for at in (text.find(b"\n"), text.find(b"\r")) if at >= 0]
            if not ends:
                return b" ".join(kept) + b" ", True
            text, comment = text[min(ends) :], False
        before, mark, text = text.partition(b"#")
        kept.append(before)
        if not mark:
            return b" ".join(kept), False
        comment = True


def header(width: int, height: int, maxval: int, magic: bytes = b"P5") -> bytes:
    """The header of an image of width × height pixels.

    >>> header(640, 480, 255)
    b'P5\\n640 480\\n255\\n'
    """
    return b"%s\n%d %d\n%d\n" % (magic, width, height, maxval)


def rows(values: npt.NDArray[np.integer], maxval: int) -> memoryview:
    """Raster bytes of one or more rows: (k, w) or (k, w, 3) values from 0 to maxval."""
    stored = np.ascontiguousarray(values, np.uint8 if maxval < 256 else np.dtype(">u2"))
    return stored.view(np.uint8).reshape(-1).data


def write(out: Output, image: GreyImage | ColourImage) -> None:
    """Write an image by bands: a grey one as P5, a coloured one as P6."""
    height, width = image.values.shape[:2]
    out.write(header(width, height, image.maxval, b"P5" if image.values.ndim == 2 else b"P6"))
    band = max(1, BAND // width)
    for top in range(0, height, band):
        out.write(rows(image.values[top : top + band], image.maxval))
