"""TIFF: one of its pictures is chosen, and only the tags of that one that carry pixels are given to the decoder.

A file may hold a reduced image before the full one, several pages, or a camera's raw values, which only a raw developer
can read, beside previews. The directory of the chosen picture is written anew behind the file, without text, profiles
and whatever else has no pixels, and the header is made to point to it.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from penink_cli.formats.photo import jpeg
from penink_cli.formats.photo.choices import Verdict
from penink_cli.formats.photo.decoded import Decoded
from penink_cli.formats.photo.icc import MOST, profile_of
from penink_cli.formats.photo.pillow import PART, decoded, with_meaning
from penink_cli.ground.errors import FormatError

# Bytes of a value of each type.
SIZES = {1: 1, 2: 1, 3: 2, 4: 4, 5: 8, 6: 1, 7: 1, 8: 2, 9: 4, 10: 8, 11: 4, 12: 8, 13: 4, 16: 8, 17: 8, 18: 8}
WHOLE = {1: "B", 3: "H", 4: "I", 13: "I", 16: "Q", 18: "Q"}  # types of whole numbers, as `struct` has them
REDUCED, WIDTH, HEIGHT, BITS, COMPRESSION, PHOTOMETRIC = 254, 256, 257, 258, 259, 262
STRIPS, ORIENTATION, COUNTS, PLANES, OLD_KIND, OTHERS = 273, 274, 279, 284, 255, 330
SAMPLES, ROWS, TILE_WIDTH, TILE_HEIGHT, TILES, TILE_COUNTS = 277, 278, 322, 323, 324, 325
JPEG_AT, JPEG_BYTES, ICC, DNG = 513, 514, 34675, 50706
PIXELS = (
    {WIDTH, HEIGHT, BITS, COMPRESSION, PHOTOMETRIC, 266, STRIPS, 277, 278, COUNTS, PLANES, 292, 293, 317, 320}
    | {322, 323, 324, 325, 332, 338, 339, 347, 512, JPEG_AT, JPEG_BYTES, 515, 519, 520, 521, 529, 530, 531, 532}
)  # fmt: skip
RAW = (32803, 34892)  # a mosaic of colour filters; values before a camera's colours are made of them
MOST_DIRECTORIES, MOST_ENTRIES, MOST_VALUES = 64, 4096, 64
ALIKE = 0.02  # by no more the proportions of two pictures of one scene differ
LARGER = 1.5  # times as wide, a later page of the same scene is chosen instead of the first


@dataclass(eq=False)
class _Directory:
    """One picture's tags.

    in_chain: whether it is a page, and not a picture within another. entries: each tag's type, count and entry (bytes).
    values: of tags that hold up to MOST_VALUES whole numbers.
    """

    in_chain: bool
    entries: dict[int, tuple[int, int, bytes]] = field(default_factory=dict)
    values: dict[int, tuple[int, ...]] = field(default_factory=dict)
    width: int = 0
    height: int = 0
    jpeg: tuple[int, int] | None = None  # where a whole JPEG file in place of pixels begins and ends

    def one(self, tag: int, other: int = 0) -> int:
        """The first value of a tag."""
        found = self.values.get(tag)
        return found[0] if found else other

    @property
    def reduced(self) -> bool:
        """Whether the picture is declared a smaller version of another."""
        return bool(self.one(REDUCED) & 1) or self.one(OLD_KIND) == 2

    @property
    def mask(self) -> bool:
        """Whether the picture is a mask of another, or a map of depth."""
        return bool(self.one(REDUCED) & 4) or self.one(PHOTOMETRIC) in (4, 51177, 52527)

    @property
    def raw(self) -> bool:
        """Whether the pixels are a camera's raw values."""
        return self.one(PHOTOMETRIC) in RAW

    @property
    def area(self) -> int:
        """Pixels."""
        return self.width * self.height


def read(encoded: bytes, max_pixels: int, verdict: Verdict) -> Decoded:
    """The chosen picture of a TIFF (see `_choose`); a line says where there was a choice.

    Raises FormatError and LimitError.
    """
    order = "<" if encoded[:1] == b"I" else ">"
    big = encoded[2:4] in (b"+\0", b"\0+")
    directories = _directories(encoded, order, big)
    if not directories:
        raise FormatError("damaged TIFF photograph: it has no directory")
    chosen = _choose(directories, encoded, verdict)
    icc = chosen.entries.get(ICC) or directories[0].entries.get(ICC)
    turned = chosen.one(ORIENTATION) or directories[0].one(ORIENTATION, 1)
    if chosen.jpeg is not None:
        picture = jpeg.read(encoded[chosen.jpeg[0] : chosen.jpeg[1]], max_pixels, verdict)
        return with_meaning(picture, picture.profile, picture.orientation if picture.orientation != 1 else turned)
    bits = chosen.values.get(BITS, (1,))
    if chosen.one(PLANES) == 2 and max(bits) > 8:  # Pillow mixes such planes up
        raise FormatError("TIFF photograph of more than 8 bits in separate planes; in one plane it is read")
    _check_pixels(encoded, chosen, order, big, verdict)
    picture = decoded(
        _clean(encoded, chosen, order, big),
        "TIFF",
        max_pixels,
        verdict,
        (1 << bits[0]) - 1,
        chosen.one(PHOTOMETRIC) == 0,
    )
    profile = _content(encoded, icc, order, big) if icc else None
    return with_meaning(picture, profile_of(profile, picture.channels < 3, verdict), turned)


def _directories(encoded: bytes, order: str, big: bool) -> list[_Directory]:
    """All pictures of the file, first the pages, then the pictures within them. Raises FormatError."""
    if len(encoded) < 16:
        raise FormatError("truncated: the TIFF has no directory")
    first = _fields(f"{order}8xQ" if big else f"{order}4xI", encoded, 0)[0]
    found: list[_Directory] = []
    seen = set()
    queue = [(first, True)]
    while queue and len(found) < MOST_DIRECTORIES:
        at, in_chain = queue.pop(0)
        if not at or at in seen:
            continue
        seen.add(at)
        try:
            directory, following = _directory(encoded, at, order, big, in_chain)
        except struct.error:
            if not found:
                raise FormatError("truncated: the TIFF ends before its directory") from None
            continue
        found.append(directory)
        if in_chain:
            queue.insert(0, (following, True))
        queue += [(place, False) for place in directory.values.get(OTHERS, ())]
    return found


def _directory(encoded: bytes, at: int, order: str, big: bool, in_chain: bool) -> tuple[_Directory, int]:
    """A directory, and the place of the next one; an entry of an unknown type is left out.

    Raises FormatError for too many entries, struct.error where the file ends within them.
    """
    directory = _Directory(in_chain)
    count, size = _fields(f"{order}Q" if big else f"{order}H", encoded, at)[0], 20 if big else 12
    begin = at + (8 if big else 2)
    if count > MOST_ENTRIES:
        raise FormatError(f"damaged TIFF photograph: a directory of {count} entries")
    for i in range(count):
        entry = encoded[begin + size * i : begin + size * (i + 1)]
        tag, kind, number = _fields(f"{order}HHQ8x" if big else f"{order}HHI4x", entry, 0)  # with its value
        if kind in SIZES:
            directory.entries[tag] = kind, number, entry
            if kind in WHOLE and 0 < number <= MOST_VALUES:
                content = _content(encoded, directory.entries[tag], order, big)
                if len(content) == number * SIZES[kind]:
                    directory.values[tag] = struct.unpack(f"{order}{number}{WHOLE[kind]}", content)
    directory.width, directory.height = directory.one(WIDTH), directory.one(HEIGHT)
    _find_jpeg(directory, encoded)
    try:
        following = _fields(f"{order}Q" if big else f"{order}I", encoded, begin + size * count)[0]
    except struct.error:
        following = 0
    return directory, following


def _fields(form: str, encoded: bytes, at: int) -> tuple[Any, ...]:
    """The fields at a place that the file names. Raises struct.error where the file ends before their end.

    A place in a BigTIFF has 64 bits. For one beyond 2^63 `unpack_from` would raise OverflowError; a slice is empty.
    """
    return struct.unpack(form, encoded[at : at + struct.calcsize(form)])


def _content(encoded: bytes, entry: tuple[int, int, bytes], order: str, big: bool) -> bytes:
    """The bytes of an entry's values, which lie within the entry or elsewhere; MOST of them at the most."""
    kind, number, text = entry
    size, inline = number * SIZES[kind], text[12:] if big else text[8:]
    if size <= len(inline):
        return inline[:size]
    at = struct.unpack(f"{order}Q" if big else f"{order}I", inline)[0]
    return encoded[at : at + min(size, MOST)]


def _find_jpeg(directory: _Directory, encoded: bytes) -> None:
    """Note a whole JPEG file in the place of pixels: so cameras store previews."""
    if directory.one(COMPRESSION, 6) != 6:
        return
    at, length = directory.one(JPEG_AT), directory.one(JPEG_BYTES)
    if not (at and length) and len(directory.values.get(STRIPS, ())) == 1:
        at, length = directory.one(STRIPS), directory.one(COUNTS)
    if at and length and encoded[at : at + 3] == b"\xff\xd8\xff":
        size = jpeg.size(memoryview(encoded)[at : at + length])
        if size is not None:
            directory.width, directory.height = size
            directory.jpeg = at, at + length


def _choose(directories: list[_Directory], encoded: bytes, verdict: Verdict) -> _Directory:
    """The picture to read: of a camera raw the largest preview, else the first page, or a larger one of the same scene.

    A reduced image is chosen only where there is no other. Raises FormatError for a camera raw without a preview.
    """
    first = directories[0]
    raws = [d for d in directories if d.raw]
    readable = [d for d in directories if not d.raw and not d.mask and (d.area or d is first)]
    if raws or DNG in first.entries or encoded[8:10] == b"CR":
        largest = max((d for d in readable if d.area), key=lambda d: d.area, default=None)
        if largest is None:
            raise FormatError("a camera raw, which is not read, without a preview: save it as TIFF, PNG or JPEG")
        full = max(raws, key=lambda d: d.area, default=None)
        if full is not None or encoded[8:10] == b"CR":
            of = f" of {full.width} x {full.height}" if full is not None else ""
            verdict.scar(f"a camera raw{of}, which is not read: its preview of {largest.width} x {largest.height} is")
        return largest
    if not readable:
        return first
    full_size = [d for d in readable if not d.reduced]
    if not full_size:
        largest = max(readable, key=lambda d: d.area)
        verdict.scar(f"only reduced images are in it: that of {largest.width} x {largest.height} is read")
        return largest
    pages = [d for d in full_size if d.in_chain] or full_size
    chosen = pages[0]
    if first.reduced:
        return max(full_size, key=lambda d: d.area)
    larger = max(pages, key=lambda d: d.area)
    if larger.area >= LARGER**2 * chosen.area and _alike(larger, chosen):
        verdict.say(f"the largest of {len(pages)} pages, {larger.width} x {larger.height}, is read")
        return larger
    if len(pages) > 1:
        verdict.say(f"the first of {len(pages)} pages is read")
    return chosen


def _alike(a: _Directory, b: _Directory) -> bool:
    """Whether two pictures have the same proportions."""
    return abs(a.width * b.height - b.width * a.height) <= ALIKE * a.width * b.height


def _check_pixels(encoded: bytes, chosen: _Directory, order: str, big: bool, verdict: Verdict) -> None:
    """Raise FormatError where the file ends before its pixels do, or where strips or tiles are missing.

    Pillow decodes those that are there without a word. The verdict may let that pass, but not where less than one in
    PART is there.
    """
    tiled = TILES in chosen.entries
    places, counts = (TILES, TILE_COUNTS) if tiled else (STRIPS, COUNTS)
    if places not in chosen.entries or counts not in chosen.entries or not chosen.area:
        return
    at, length = (_numbers(encoded, chosen.entries[tag], order, big) for tag in (places, counts))
    there = min(len(at), len(length))
    rows = chosen.one(TILE_HEIGHT if tiled else ROWS) or chosen.height
    needed = jpeg.up(chosen.height, rows)
    if tiled:
        needed *= jpeg.up(chosen.width, chosen.one(TILE_WIDTH) or chosen.width)
    if chosen.one(PLANES) == 2:
        needed *= chosen.one(SAMPLES, 1)
    ends = int((at[:there] + length[:there]).max()) if there else 0
    bits = (chosen.values.get(BITS) or (1,))[0] * chosen.one(SAMPLES, 1)
    size = jpeg.up(chosen.width * bits, 8) * chosen.height if chosen.one(COMPRESSION, 1) == 1 else 0
    for found, wanted, what in (
        (there, needed, "tiles" if tiled else "strips"),
        (len(encoded), ends, "TIFF bytes"),
        (min(int(length.sum()), len(encoded)), size, "bytes of pixels"),
    ):
        if found < wanted:
            error = FormatError(f"truncated: {found} of at least {wanted} {what}")
            if PART * found < wanted:
                raise error
            verdict.damage(error)
            return


def _numbers(encoded: bytes, entry: tuple[int, int, bytes], order: str, big: bool) -> np.ndarray:
    """The whole numbers (n,) of an entry, however many, as doubles."""
    content = _content(encoded, entry, order, big)
    size = SIZES[entry[0]]
    return np.frombuffer(content[: len(content) // size * size], f"{order}u{size}").astype(np.float64)


def _clean(encoded: bytes, chosen: _Directory, order: str, big: bool) -> bytes:
    """The file with a new directory at its end, the only one: the tags of the chosen picture's pixels.

    Raises FormatError for a file of more than 4 GB.
    """
    entries = [chosen.entries[tag][2] for tag in sorted(chosen.entries) if tag in PIXELS]
    at = len(encoded) + len(encoded) % 2
    if not big and at >= 1 << 32:
        raise FormatError("a TIFF of more than 4 GB")
    count: Any = struct.pack(f"{order}Q" if big else f"{order}H", len(entries))
    place = struct.pack(f"{order}Q" if big else f"{order}I", at)
    head = encoded[:8] + place if big else encoded[:4] + place
    return b"".join(
        (head, memoryview(encoded)[len(head) :], bytes(len(encoded) % 2), count, *entries, bytes(8 if big else 4))
    )
