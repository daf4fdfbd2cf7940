"""PNG (ISO/IEC 15948): every kind at the depth it is stored with. Chunks that carry no pixels cannot fail the reading.

No image library is used. Pillow refuses a picture for its comments, shows damage as black rows, cuts 16 bits of colour
to 8, and compares the one transparent value only after it has changed the depth.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from penink_cli.formats._compiled import png_rows
from penink_cli.formats.pgm import check_size
from penink_cli.formats.photo.choices import Verdict
from penink_cli.formats.photo.decoded import Decoded
from penink_cli.formats.photo.exif import orientation
from penink_cli.formats.photo.icc import MOST, profile_of
from penink_cli.formats.photo.profile import Profile, of_gamma
from penink_cli.ground.errors import FormatError, printable

BAND = 1 << 20  # bytes of rows inflated at a time
PIXELS = (b"PLTE", b"tRNS", b"IDAT")  # chunks without which other pixels are seen
MEANING = (b"gAMA", b"cHRM", b"sRGB", b"iCCP", b"cICP", b"eXIf", b"acTL")
CHANNELS = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}
DEPTHS = {0: (1, 2, 4, 8, 16), 2: (8, 16), 3: (1, 2, 4, 8), 4: (8, 16), 6: (8, 16)}
# Adam7: first column, first row, step in x and step in y of each pass.
PASSES = ((0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2))
PLAIN = ((0, 0, 1, 1),)


@dataclass
class _Chunks:
    """The chunks of a PNG: pixels, where the content of each IDAT begins and ends; others, their content by name."""

    pixels: list[tuple[int, int]] = field(default_factory=list)
    others: dict[bytes, bytes] = field(default_factory=dict)
    trouble: str = ""  # what is wrong with the file behind its pixels


@dataclass(frozen=True)
class _Header:
    width: int
    height: int
    bits: int
    colour: int
    interlaced: bool

    @property
    def bits_per_pixel(self) -> int:
        return self.bits * CHANNELS[self.colour]

    def passes(self) -> Iterator[tuple[tuple[int, int, int, int], int, int]]:
        """Of each pass that has pixels: its entry of PASSES, its columns, its rows."""
        for step in PASSES if self.interlaced else PLAIN:
            columns, rows = -(-(self.width - step[0]) // step[2]), -(-(self.height - step[1]) // step[3])
            if columns > 0 and rows > 0:
                yield step, columns, rows

    def bytes(self) -> int:
        """How many bytes all rows have, each with the byte that names its filter."""
        lengths = [rows * (1 + (columns * self.bits_per_pixel + 7) // 8) for _, columns, rows in self.passes()]
        return sum(lengths)  # whole numbers


def read(encoded: bytes, max_pixels: int, verdict: Verdict) -> Decoded:
    """The picture of a PNG. Raises FormatError where its pixels are damaged or missing."""
    head = header(encoded, max_pixels)
    chunks = _chunks(encoded)
    if not chunks.pixels:
        raise FormatError("truncated: the PNG has no pixels")
    if chunks.trouble:
        verdict.scar(chunks.trouble)
    found = chunks.others
    if b"acTL" in found:
        verdict.say("an animation: its still picture is read")
    clear, palette = found.get(b"tRNS"), found.get(b"PLTE", b"")
    if head.colour in (4, 6) or (clear is not None and len(clear) < {0: 2, 2: 6}.get(head.colour, 0)):
        clear = None
    if head.colour == 3 and (not palette or len(palette) % 3):
        raise FormatError("damaged PNG photograph: a palette of no colours")
    channels = {0: 1, 2: 3, 3: 3, 4: 1, 6: 3}[head.colour] + (clear is not None or head.colour in (4, 6))
    look = _look(head, palette, clear)
    rows = _Rows(encoded, chunks.pixels, head.bytes(), verdict)
    bands = (
        (look(values) for values in _interlaced(head, rows) if len(values))
        if head.interlaced
        else _plain(head, rows, look)
    )
    return Decoded(
        head.width,
        head.height,
        65535 if head.bits == 16 else 255,
        channels,
        bands,
        _meaning(found, head.colour in (0, 4), verdict),
        orientation(found.get(b"eXIf")),
    )


def header(encoded: bytes, max_pixels: int) -> _Header:
    """What the first chunk says. Raises FormatError where it makes no sense, LimitError for more than max_pixels."""
    name = encoded[12:16]
    if name == b"CgBI":
        raise FormatError("a PNG as Apple's devices keep it (CgBI), which is not read: save it as PNG or JPEG")
    if len(encoded) < 33:
        raise FormatError("truncated: the PNG has no header")
    if name != b"IHDR" or encoded[8:12] != b"\0\0\0\x0d":
        raise FormatError("damaged PNG photograph: its header makes no sense")
    if zlib.crc32(encoded[12:29]) != int.from_bytes(encoded[29:33], "big"):
        raise FormatError("damaged PNG photograph: checksum of its chunk IHDR")
    width, height, bits, colour, compression, filtering, interlace = struct.unpack(">IIBBBBB", encoded[16:29])
    if not width or not height or bits not in DEPTHS.get(colour, ()) or compression or filtering or interlace > 1:
        raise FormatError("damaged PNG photograph: its header makes no sense")
    check_size(width, height, max_pixels)
    return _Header(width, height, bits, colour, bool(interlace))


def _chunks(encoded: bytes) -> _Chunks:
    """Walk over the chunks behind the header.

    Raises FormatError for a chunk that carries pixels and is cut or has a wrong checksum. Any other damaged chunk is
    passed over; where its length cannot be right either, the next chunk that is whole is looked for.
    """
    chunks, at, size = _Chunks(), 33, len(encoded)
    while True:
        if at + 12 > size:
            chunks.trouble = "the PNG has no end; all its rows are there"
            return chunks
        length, name = struct.unpack_from(">I4s", encoded, at)
        end = at + 8 + length
        if name == b"IEND":
            return chunks
        whole = end + 4 <= size and zlib.crc32(memoryview(encoded)[at + 4 : end]) == int.from_bytes(
            encoded[end : end + 4], "big"
        )
        if whole:
            if name == b"IDAT":
                chunks.pixels.append((at + 8, end))
            elif name in PIXELS or name in MEANING:
                chunks.others.setdefault(name, encoded[at + 8 : end])
            at = end + 4
            continue
        if name in PIXELS:
            if end + 4 <= size:
                raise FormatError(f"damaged PNG photograph: checksum of its chunk {name.decode()}")
            raise FormatError(f"truncated: {size} of at least {end + 4} PNG bytes")
        if end + 4 <= size and _begins_chunk(encoded, end + 4):
            at = end + 4
            continue
        found = _next_whole(encoded, at + 8)
        if found is None:
            if not chunks.pixels:
                raise FormatError(f"damaged PNG photograph: its chunk {printable(name.decode('latin-1'))}")
            chunks.trouble = f"the PNG is cut in its chunk {printable(name.decode('latin-1'))}; all its rows are there"
            return chunks
        at = found


def _begins_chunk(encoded: bytes, at: int) -> bool:
    """Whether a chunk may begin at that place: it would lie within the file, and its name is made of letters."""
    length, name = struct.unpack_from(">I4s", encoded, at) if at + 12 <= len(encoded) else (0, b"")
    return name.isalpha() and at + 12 + length <= len(encoded)


def _next_whole(encoded: bytes, at: int) -> int | None:
    """The place of the next whole chunk that carries pixels or is IEND; None for no such chunk."""
    places = []
    for name in (*PIXELS, b"IEND"):
        place = encoded.find(name, at)
        tries = 0
        while place >= 4 and tries < 16:
            end = place + 4 + int.from_bytes(encoded[place - 4 : place], "big")
            if end + 4 <= len(encoded) and zlib.crc32(memoryview(encoded)[place:end]) == int.from_bytes(
                encoded[end : end + 4], "big"
            ):
                places.append(place - 4)
                break
            place = encoded.find(name, place + 1)
            tries += 1
    return min(places, default=None)


class _Rows:
    """Inflates the rows, as many bytes at a time as are asked for. needed: bytes of all rows."""

    def __init__(self, encoded: bytes, spans: list[tuple[int, int]], needed: int, verdict: Verdict):
        self._pieces = (encoded[at : min(at + BAND, end)] for first, end in spans for at in range(first, end, BAND))
        self._inflate = zlib.decompressobj()
        self._needed, self._found = needed, 0
        self._verdict, self._lost = verdict, False

    def read(self, size: int) -> bytearray:
        """The next bytes, fewer where the rest is lost; the verdict is told that once, and may raise FormatError."""
        filled = bytearray()
        try:
            while len(filled) < size and not self._lost:
                piece = self._inflate.unconsumed_tail or next(self._pieces, b"")
                if not piece or self._inflate.eof:
                    break
                filled += self._inflate.decompress(piece, size - len(filled))
            self._found += len(filled)
            if self._found == self._needed and not self._lost:
                self._check_end()
        except zlib.error as error:
            self._lose(FormatError(f"damaged PNG photograph: {printable(str(error), 60)}"))
        if len(filled) < size and not self._lost:
            self._lose(FormatError(f"truncated: {self._found} of {self._needed} bytes of PNG rows"))
        return filled

    def _check_end(self) -> None:
        """Read on to the checksum. Rows beyond those needed are not read: there may be no end of them."""
        while not self._inflate.eof:
            piece = self._inflate.unconsumed_tail or next(self._pieces, b"")
            if not piece:
                self._lose(FormatError(f"truncated: {self._found} of {self._needed} bytes of PNG rows and no checksum"))
                return
            if self._inflate.decompress(piece, 1):
                return

    def bad_filter(self) -> None:
        """Tell the verdict that a row's filter does not exist; it may raise FormatError."""
        self._lose(FormatError("damaged PNG photograph: a row's filter makes no sense"))

    def _lose(self, error: FormatError) -> None:
        if not self._lost:
            self._lost = True
            self._verdict.damage(error)


def _unpacked(packed: npt.NDArray[np.uint8], columns: int, header: _Header) -> npt.NDArray[Any]:
    """The stored values (k, columns, channels) of unfiltered rows of bytes (k, s)."""
    if header.bits == 16:
        values: npt.NDArray[Any] = packed.view(">u2").astype(np.uint16)
    elif header.bits == 8:
        values = packed
    else:
        places = np.arange(8 - header.bits, -1, -header.bits, dtype=np.uint8)
        values = ((packed[..., None] >> places) & ((1 << header.bits) - 1)).reshape(len(packed), -1)[:, :columns]
    return values.reshape(len(packed), columns, CHANNELS[header.colour])


def _raw_bands(columns: int, rows: int, header: _Header, source: _Rows) -> Iterator[npt.NDArray[Any] | int]:
    """Bands of stored values of one pass; the last item is the number of rows that are lost, if any are."""
    stride = (columns * header.bits_per_pixel + 7) // 8
    above = np.zeros(stride, np.uint8)
    step = max(1, BAND // (stride + 1))
    for top in range(0, rows, step):
        wanted = min(step, rows - top)
        got = source.read(wanted * (1 + stride))
        whole = len(got) // (1 + stride)
        packed = np.frombuffer(got, np.uint8, whole * (1 + stride)).reshape(whole, 1 + stride)
        bad = png_rows.unfilter(packed, above, max(1, header.bits_per_pixel // 8)) if whole else -1
        if bad >= 0:
            source.bad_filter()
            whole = bad
        yield _unpacked(np.ascontiguousarray(packed[:whole, 1:]), columns, header)
        if whole < wanted:
            yield rows - top - whole
            return


def _plain(header: _Header, source: _Rows, look: Any) -> Iterator[Any]:
    """Bands of the picture of a file that is not interlaced. Rows that are lost are white."""
    for band in _raw_bands(header.width, header.height, header, source):
        if isinstance(band, int):  # lost
            blank = look(np.zeros((1, 1, CHANNELS[header.colour]), np.uint16 if header.bits == 16 else np.uint8))
            white = np.full_like(blank, 65535 if header.bits == 16 else 255)
            for _ in range(band):
                yield np.broadcast_to(white, (1, header.width, white.shape[2]))
        else:
            yield look(band)


def _interlaced(header: _Header, source: _Rows) -> Iterator[Any]:
    """The stored values (h, w, channels) of all passes, in one band. Those that are lost are 0."""
    depth = np.uint16 if header.bits == 16 else np.uint8
    values: npt.NDArray[Any] = np.zeros((header.height, header.width, CHANNELS[header.colour]), depth)
    for (x, y, step_x, step_y), columns, rows in header.passes():
        top = 0
        for band in _raw_bands(columns, rows, header, source):
            if not isinstance(band, int):
                first = y + top * step_y
                values[first : first + len(band) * step_y : step_y, x::step_x] = band
                top += len(band)
    yield values


def _look(header: _Header, palette: bytes, clear: bytes | None) -> Any:
    """A function from stored values to values of 8 or 16 bits, with alpha if the file has a tRNS chunk.

    palette, clear: the contents of PLTE and tRNS.
    """
    white = 65535 if header.bits == 16 else 255
    if header.colour == 3:
        table = np.zeros((256, 4 if clear is not None else 3), np.uint8)
        colours = np.frombuffer(palette[: 3 * 256], np.uint8).reshape(-1, 3)
        table[: len(colours), :3] = colours
        if clear is not None:
            table[:, 3] = 255
            table[: min(len(clear), 256), 3] = np.frombuffer(clear[:256], np.uint8)
        return lambda values: table[values[..., 0]]
    factor = white // ((1 << header.bits) - 1)
    wanted = 1 if header.colour == 0 else 3
    if clear is None:
        if factor == 1:
            return lambda values: values
        return lambda values: values * np.uint8(factor)
    one = np.array(struct.unpack_from(f">{wanted}H", clear)) & ((1 << header.bits) - 1)

    def with_alpha(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        opaque = np.where((values == one).all(axis=2, keepdims=True), 0, white).astype(values.dtype)
        return np.concatenate([values * values.dtype.type(factor), opaque], axis=2)

    return with_alpha


def _meaning(found: dict[bytes, bytes], grey: bool, verdict: Verdict) -> Profile | None:
    """The profile of the colours, None for sRGB's: by cICP, iCCP, sRGB or gAMA, of which the first present decides."""
    if b"iCCP" in found and b"cICP" not in found:
        content = found[b"iCCP"]
        packed = content[content.find(b"\0") + 2 :] if b"\0" in content[:80] else b""
        try:
            icc = zlib.decompressobj().decompress(packed, MOST)
        except zlib.error:
            icc = b""
        return profile_of(icc, grey, verdict)
    if b"cICP" in found or b"sRGB" in found or len(found.get(b"gAMA", b"")) != 4:
        return None
    gamma = int.from_bytes(found[b"gAMA"], "big") / 100_000
    if not 0.01 <= gamma <= 10:
        return None
    primaries = None
    if len(found.get(b"cHRM", b"")) == 32 and not grey:
        primaries = tuple(v / 100_000 for v in struct.unpack(">8I", found[b"cHRM"]))
    return of_gamma(gamma, primaries)
