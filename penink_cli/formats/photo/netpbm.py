"""Netpbm's kinds besides PGM: PBM (P1, P4), PPM (P3, P6) and PAM (P7), by their definitions."""

from __future__ import annotations

from typing import Any, BinaryIO

import numpy as np
import numpy.typing as npt

from penink_cli.formats import pgm
from penink_cli.formats.photo.decoded import Decoded
from penink_cli.ground.errors import FormatError, in_quotes

MAX_LINES, MAX_LINE = 1000, 4096  # of the header of a PAM
# The depth, which is the number of channels, of each type of tuples.
TUPLES = {
    "BLACKANDWHITE": 1, "GRAYSCALE": 1, "RGB": 3, "BLACKANDWHITE_ALPHA": 2, "GRAYSCALE_ALPHA": 2, "RGB_ALPHA": 4,
}  # fmt: skip


def read(stream: BinaryIO, source: str, max_pixels: int, magic: bytes) -> Decoded:
    """The picture that follows the magic number of any of P1 … P7. Raises FormatError and LimitError."""
    if magic in (b"P1", b"P4"):
        return _bitmap(stream, source, max_pixels, magic)
    if magic == b"P7":
        return _arbitrary(stream, source, max_pixels)
    values, maxval = pgm.read_raster(stream, source, max_pixels, magic)
    return _decoded(values, maxval)


def _decoded(values: npt.NDArray[Any], maxval: int) -> Decoded:
    height, width = values.shape[:2]
    values = values.reshape(height, width, -1)
    return Decoded(width, height, maxval, values.shape[2], iter([values]))


def _bitmap(stream: BinaryIO, source: str, max_pixels: int, magic: bytes) -> Decoded:
    """A PBM: bits, 1 for black. Raises FormatError and LimitError."""
    width, height = pgm.header_numbers(stream, source, 2)
    pgm.check_size(width, height, max_pixels, source)
    if magic == b"P4":
        row = (width + 7) // 8
        packed = pgm.binary(stream, source, row * height, 255, row).reshape(height, row)
        bits: npt.NDArray[Any] = np.unpackbits(packed, axis=1)[:, :width]
    else:
        bits = _plain_bits(stream, source, width * height).reshape(height, width)
    return _decoded(255 * (1 - bits), 255)


def _plain_bits(stream: BinaryIO, source: str, count: int) -> npt.NDArray[np.uint8]:
    """``count`` digits 0 and 1 (count,), between which there may be white space and comments. Raises FormatError."""
    found: list[npt.NDArray[np.uint8]] = []
    have, comment = 0, False
    while have < count:
        piece = stream.read(pgm.BAND)
        if not piece:
            raise FormatError(f"truncated: {have} of {count} bits", source)
        if comment or b"#" in piece:
            lines = piece.replace(b"\r", b"\n").split(b"\n")
            kept = []
            for i, line in enumerate(lines):
                comment = comment and i == 0
                before, sign, _ = line.partition(b"#") if not comment else (b"", b"#", b"")
                kept.append(before)
                comment = bool(sign)
            piece = b"\n".join(kept)
        digits = np.frombuffer(piece.translate(None, pgm.WHITE + b"\v\f"), np.uint8)
        if len(digits) and not ((digits == 48) | (digits == 49)).all():
            wrong = bytes(digits[(digits != 48) & (digits != 49)][:1]).decode("latin-1")
            raise FormatError(f"a bit, 0 or 1, is expected, found {in_quotes(wrong)}", source)
        found.append(digits[: count - have] - 48)
        have += len(found[-1])
    return np.concatenate(found)


def _arbitrary(stream: BinaryIO, source: str, max_pixels: int) -> Decoded:
    """A PAM: lines of a name and a value, then tuples. Raises FormatError and LimitError."""
    numbers = dict.fromkeys(("WIDTH", "HEIGHT", "DEPTH", "MAXVAL"), 0)
    kind, first = "", stream.readline(MAX_LINE)
    if first.strip():
        raise FormatError(
            f"a PAM begins with P7 on a line of its own, found {in_quotes(first.decode('latin-1'))}", source
        )
    for _ in range(MAX_LINES):
        line = stream.readline(MAX_LINE)
        words = line.decode("latin-1").split()
        if not line:
            raise FormatError("truncated: ends before ENDHDR", source)
        if not words or words[0].startswith("#"):
            continue
        if words[0] == "ENDHDR":
            break
        if words[0] == "TUPLTYPE":
            kind = " ".join([kind, *words[1:]]).strip()
        elif (
            words[0] in numbers and len(words) == 2 and words[1].isascii() and words[1].isdigit() and len(words[1]) < 16
        ):
            numbers[words[0]] = int(words[1])
        else:
            raise FormatError(
                f"a line of a PAM's header is expected, found {in_quotes(line.decode('latin-1'))}", source
            )
    else:
        raise FormatError(f"the header has more than {MAX_LINES} lines", source)
    width, height, depth, maxval = numbers.values()
    for name, value, most in (
        ("WIDTH", width, pgm.MAX_VALUE),
        ("HEIGHT", height, pgm.MAX_VALUE),
        ("MAXVAL", maxval, 65535),
    ):
        if not 1 <= value <= most:
            raise FormatError(f"{name} is {value}; 1 to {most} are allowed", source)
    if TUPLES.get(kind, depth) != depth or (kind and kind not in TUPLES) or not 1 <= depth <= 4:
        raise FormatError(f"tuples {in_quotes(kind)} of {depth} are no grey and no colours", source)
    pgm.check_size(width, height, max_pixels, source)
    values = pgm.binary(stream, source, width * height * depth, maxval, width * depth)
    return _decoded(values.reshape(height, width, depth), maxval)
