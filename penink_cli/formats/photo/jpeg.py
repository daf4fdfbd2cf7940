"""JPEG (ITU-T T.81): checked code by code, then decoded by the library, from what carries pixels alone.

Where codes are damaged the library's decoder makes up pixels without a word. So all codes of all scans are read first
(`_compiled/jpeg_scans`), which finds damage. Comments, profiles, bytes between segments and whatever else carries no
pixels are left out of what is decoded, so that they cannot fail it.

What the check is worth (`python -m tests.benchmarks.worth codes`): of 2000 files that were cut or had a bit struck the
library gives other pixels for some 1480 without a word. The check refuses a quarter (baseline) to two fifths
(progressive) of these, and next to none whose pixels are the same; the others are files that somebody might have
written. It takes three quarters of the time of decoding. Nothing is decoded twice.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from penink_cli.formats._compiled import jpeg_scans
from penink_cli.formats.pgm import check_size
from penink_cli.formats.photo.choices import Verdict
from penink_cli.formats.photo.decoded import Decoded
from penink_cli.formats.photo.exif import orientation
from penink_cli.formats.photo.icc import MOST, profile_of
from penink_cli.formats.photo.pillow import decoded, with_meaning
from penink_cli.ground.errors import FormatError, PeninkError

ICC, EXIF = b"ICC_PROFILE\0", b"Exif\0\0"
FRAMES = {0xC0: False, 0xC1: False, 0xC2: True}  # marker: progressive
UNCHECKED = {0xC9, 0xCA}  # arithmetic codes, which the library may know
OTHERS = {0xC3: "lossless", 0xC5: "hierarchical", 0xC6: "hierarchical", 0xC7: "hierarchical", 0xCB: "lossless"}
SAID = {  # of each result of `jpeg_scans.scan`
    jpeg_scans.CUT: "its codes end too early",
    jpeg_scans.NO_CODE: "codes that make no sense",
    jpeg_scans.LEFT_OVER: "codes that nothing needs before a marker",
    jpeg_scans.NO_RESTART: "a restart marker out of turn",
}


@dataclass
class _Part:
    """A colour component: blocks across and down in a unit (MCU), number of its first block, its blocks in a row."""

    across: int
    down: int
    first: int = 0
    stride: int = 0
    missing: list[int] = field(default_factory=lambda: [99] * 64)  # bits still to come of each coefficient, 99 for all


@dataclass
class _File:
    """What the segments and scans read so far have said.

    lookups, known: as of `jpeg_scans.scan`. clean: the segments and scans that carry pixels.
    """

    width: int = 0
    height: int = 0
    frame: int = 0
    parts: dict[int, _Part] = field(default_factory=dict)
    lookups: np.ndarray = field(default_factory=lambda: np.zeros((8, 1 << 16), np.uint16))
    known: np.ndarray = field(default_factory=lambda: np.zeros(1, np.uint64))
    restart: int = 0
    clean: list[bytes] = field(default_factory=list)
    icc: dict[int, bytes] = field(default_factory=dict)
    icc_parts: int = 0
    exif: bytes | None = None
    lost: bool = False  # codes are missing or wrong, and have been reported

    @property
    def most(self) -> tuple[int, int]:
        """The most blocks across, and down, that any component has in a unit."""
        return max(p.across for p in self.parts.values()), max(p.down for p in self.parts.values())

    def complete(self) -> bool:
        """Whether every bit of every coefficient has come."""
        return bool(self.parts) and not any(any(p.missing) for p in self.parts.values())

    def begun(self) -> bool:
        """Whether something of every component has come."""
        return bool(self.parts) and all(p.missing[0] < 99 for p in self.parts.values())


def read(encoded: bytes, max_pixels: int, verdict: Verdict) -> Decoded:
    """The picture of a JPEG. Raises FormatError where its codes are damaged or end too early, and LimitError."""
    found = _File()
    try:
        at = _walk(encoded, found, max_pixels, verdict)
    except PeninkError:
        raise
    except (IndexError, ValueError):
        raise FormatError("damaged JPEG photograph: a segment makes no sense") from None
    if at is None:
        if found.lost:
            pass
        elif found.frame in UNCHECKED or not found.complete():
            _lost(FormatError(f"truncated: the JPEG ends after {len(encoded)} bytes"), found, verdict)
        else:
            verdict.scar("the JPEG has no end marker; all its scans are whole")
    profile = b"".join(found.icc[i] for i in sorted(found.icc)) if len(found.icc) == found.icc_parts else b""
    clean = b"\xff\xd8" + b"".join(found.clean) + b"\xff\xd9"
    found.clean.clear()
    picture = decoded(clean, "JPEG", max_pixels, verdict)
    grey = len(found.parts) == 1
    return with_meaning(picture, profile_of(profile[:MOST], grey, verdict), orientation(found.exif))


def _lost(error: FormatError, found: _File, verdict: Verdict) -> None:
    """Report once that pixels are lost; raise the error where nothing is left, or where the verdict is to."""
    if not found.begun() and not found.clean:
        raise error
    if not found.lost:
        verdict.damage(error)
        found.lost = True


def _walk(encoded: bytes, found: _File, max_pixels: int, verdict: Verdict) -> int | None:
    """Go over all segments and scans; the place of the end marker, None where there is none."""
    at, size = 2, len(encoded)
    while True:
        at = encoded.find(b"\xff", at)  # bytes between segments are passed over, as decoders do
        if at < 0 or at + 1 >= size:
            return None
        marker = encoded[at + 1]
        if marker in (0x00, 0x01, 0xFF) or 0xD0 <= marker <= 0xD8:
            at += 1 if marker == 0xFF else 2
            continue
        if marker == 0xD9:
            return at
        if at + 4 > size:
            return None
        length = int.from_bytes(encoded[at + 2 : at + 4], "big")
        end = at + 2 + length
        if length < 2:
            raise ValueError
        if end > size:
            return None
        content = encoded[at + 4 : end]
        if marker == 0xDA:
            start, at = at, _scan(encoded, end, content, found, verdict)
            found.clean.append(encoded[start : at if at >= 0 else None])
            if at < 0:
                return None
            continue
        if _segment(marker, content, found, max_pixels):
            found.clean.append(encoded[at:end])
        at = end


def _segment(marker: int, content: bytes, found: _File, max_pixels: int) -> bool:
    """Note what a segment says; whether the decoder needs it. Raises FormatError and LimitError."""
    if marker == 0xE2 and content.startswith(ICC) and len(content) > 14:
        found.icc.setdefault(content[12], content[14:])  # a profile that comes twice is the same one
        found.icc_parts = found.icc_parts or content[13]
    elif marker == 0xE1 and content.startswith(EXIF):
        found.exif = found.exif or content
    elif marker == 0xE0 and content.startswith(b"JFIF\0"):
        found.clean.append(b"\xff\xe0\0\x10JFIF\0\1\1\0\0\1\0\1\0\0")
    elif marker == 0xEE and content.startswith(b"Adobe"):
        return len(content) >= 12
    elif marker == 0xC4:
        _tables(content, found)
        return True
    elif marker == 0xDD:
        found.restart = int.from_bytes(content[:2], "big")
        return True
    elif 0xC0 <= marker <= 0xCF and marker not in (0xC8, 0xCC):
        _frame(marker, content, found, max_pixels)
        return True
    return marker in (0xDB, 0xCC, 0xDC)


def _frame(marker: int, content: bytes, found: _File, max_pixels: int) -> None:
    """Note the size and the components that a frame header declares. Raises FormatError and LimitError."""
    if found.frame:
        raise FormatError("damaged JPEG photograph: a second header")
    if marker not in FRAMES and marker not in UNCHECKED:
        raise FormatError(f"a {OTHERS.get(marker, 'hierarchical')} JPEG, which is not read: save it as PNG or JPEG")
    if content[0] != 8:
        raise FormatError(f"a JPEG of {content[0]} bits a value; 8 are read")
    height, width = int.from_bytes(content[1:3], "big"), int.from_bytes(content[3:5], "big")
    if not width or not height or content[5] not in (1, 3, 4) or len(content) < 6 + 3 * content[5]:
        raise FormatError("damaged JPEG photograph: its header makes no sense")
    check_size(width, height, max_pixels)
    found.frame, found.width, found.height = marker, width, height
    for i in range(content[5]):
        name, sampling, _ = content[6 + 3 * i : 9 + 3 * i]
        if not (1 <= sampling >> 4 <= 4 and 1 <= sampling & 15 <= 4) or name in found.parts:
            raise FormatError("damaged JPEG photograph: its header makes no sense")
        found.parts[name] = _Part(sampling >> 4, sampling & 15)
    most = found.most
    blocks = 0
    for part in found.parts.values():
        part.first = blocks
        part.stride = up(width, 8 * most[0]) * part.across
        blocks += part.stride * up(height, 8 * most[1]) * part.down
    if marker == 0xC2:
        found.known = np.zeros(blocks, np.uint64)


def _tables(content: bytes, found: _File) -> None:
    """Fill the lookups from a segment of Huffman tables. Raises ValueError and IndexError for a damaged one."""
    at = 0
    while at < len(content):
        kind, counts = content[at], content[at + 1 : at + 17]
        if kind >> 4 > 1 or kind & 15 > 3 or len(counts) < 16:
            raise ValueError
        symbols = content[at + 17 : at + 17 + sum(counts)]  # whole numbers
        table = found.lookups[4 * (kind >> 4) + (kind & 15)]
        table[:] = 0
        place = taken = 0
        for length, count in enumerate(counts, 1):
            for _ in range(count):
                span = 1 << (16 - length)
                if place + span > 1 << 16:
                    raise ValueError
                table[place : place + span] = 256 * length + symbols[taken]
                place += span
                taken += 1
        at += 17 + taken


def _scan(encoded: bytes, at: int, content: bytes, found: _File, verdict: Verdict) -> int:
    """Read a scan's codes; the place of the marker behind them, -1 where the file ends before one.

    Raises FormatError, and ValueError for a damaged header of the scan.
    """
    if not found.frame:
        raise FormatError("damaged JPEG photograph: pixels before its header")
    if found.frame in UNCHECKED:
        return _next_marker(encoded, at)
    count = content[0]
    if not 1 <= count <= 4 or len(content) < 4 + 2 * count:
        raise ValueError
    first, last, bits = content[1 + 2 * count : 4 + 2 * count]
    high, low = bits >> 4, bits & 15
    progressive = found.frame == 0xC2
    if not progressive:
        first, last, high, low = 0, 63, 0, 0
    if first > last or last > 63 or (progressive and (first == 0) != (last == 0)) or (first and count > 1):
        raise ValueError
    parts = [found.parts.get(name) for name in content[1 : 1 + 2 * count : 2]]
    tables = list(content[2 : 2 + 2 * count : 2])
    if None in parts or any(t >> 4 > 3 or t & 15 > 3 for t in tables):
        raise ValueError
    most = found.most
    across, down = up(found.width, 8 * most[0]), up(found.height, 8 * most[1])
    rows = np.empty((count, 6), np.int32)
    for i, (part, table) in enumerate(zip(parts, tables, strict=True)):
        assert part is not None
        rows[i] = (table >> 4, 4 + (table & 15), part.across, part.down, part.first, part.stride)
        if count == 1:  # only as many blocks as hold pixels, one a unit
            across = up(up(found.width * part.across, most[0]), 8)
            down = up(up(found.height * part.down, most[1]), 8)
            rows[i, 2:4] = 1
    result, at = jpeg_scans.scan(
        np.frombuffer(encoded, np.uint8), at, found.lookups, rows, found.known, (across, down, found.restart),
        (first, last, high) if progressive else None,
    )  # fmt: skip
    cut = at + 1 >= len(encoded)
    if result != jpeg_scans.WHOLE:
        if result == jpeg_scans.CUT and cut:
            error = FormatError(f"truncated: the JPEG ends after {len(encoded)} bytes")
        else:
            error = FormatError(f"damaged JPEG photograph: {SAID[result]}")
        _lost(error, found, verdict)
        at = _next_marker(encoded, at)
    for part in parts:
        assert part is not None
        part.missing[first : last + 1] = [low] * (last + 1 - first)
    return -1 if cut else at


def up(number: int, step: int) -> int:
    """How many steps reach the number."""
    return -(-number // step)


def _next_marker(encoded: bytes, at: int) -> int:
    """The place of the next marker that ends a scan."""
    while True:
        at = encoded.find(b"\xff", at)
        if at < 0 or at + 1 >= len(encoded):
            return -1
        if encoded[at + 1] not in (0x00, 0xFF) and not 0xD0 <= encoded[at + 1] <= 0xD7:
            return at
        at += 1 if encoded[at + 1] == 0xFF else 2


def size(encoded: bytes | memoryview) -> tuple[int, int] | None:
    """Width and height that a JPEG file declares; None where no frame header comes before the pixels."""
    at = 2
    while at + 9 <= len(encoded):
        if encoded[at] != 0xFF:
            at += 1
            continue
        marker = encoded[at + 1]
        if marker in (0x00, 0x01, 0xFF) or 0xD0 <= marker <= 0xD8:
            at += 1 if marker == 0xFF else 2
        elif 0xC0 <= marker <= 0xCF and marker not in (0xC4, 0xC8, 0xCC):
            return int.from_bytes(encoded[at + 7 : at + 9], "big"), int.from_bytes(encoded[at + 5 : at + 7], "big")
        elif marker in (0xD9, 0xDA):
            return None
        else:
            at += 2 + int.from_bytes(encoded[at + 2 : at + 4], "big")
    return None


def check_beginning(encoded: bytes, max_pixels: int) -> None:
    """Raise FormatError where no frame header has come, LimitError for one that declares more than max_pixels."""
    found = size(encoded)
    if found is None:
        raise FormatError("damaged JPEG photograph, or one of a rare kind: its header makes no sense")
    check_size(*found, max_pixels)
