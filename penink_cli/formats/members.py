"""What all compact members have in common: four bytes that say what each is, whole numbers, one stretch of code."""

from __future__ import annotations

from penink_cli.formats._compiled.coder import Coder
from penink_cli.ground.errors import FormatError, LimitError

MAX_CODE = 1 << 20  # bytes of code: decoding takes up to 3 µs a byte
MAX_GRID = 1 << 24  # points along a side


def written_numbers(*values: int) -> bytes:
    """Whole numbers from 0, seven bits a byte."""
    out = bytearray()
    for value in values:
        while value > 127:
            out.append(value & 127 | 128)
            value >>= 7
        out.append(value)
    return bytes(out)


def read_numbers(data: bytes, at: int, count: int) -> tuple[list[int], int]:
    """``count`` whole numbers from byte ``at`` on, and where the next byte is. Raises FormatError."""
    values = []
    for _ in range(count):
        value = shift = 0
        while True:
            if at >= len(data) or shift > 35:
                raise FormatError("truncated in its header" if at >= len(data) else "a header number is too large")
            value |= (data[at] & 127) << shift
            shift += 7
            at += 1
            if data[at - 1] < 128:
                break
        values.append(value)
    return values, at


def is_compact(data: bytes, known: tuple[bytes, ...]) -> bool:
    """Whether a member begins as one of these does. Raises FormatError if it is the same kind, of another version."""
    if data[:4] in known:
        return True
    if data[:3] in {magic[:3] for magic in known}:
        raise FormatError(f"is {data[:4]!r}, which this penink does not know; known are {', '.join(map(repr, known))}")
    return False


def size_class(value: int) -> int:
    """The class of a number's size, 0 … 11, finer for small sizes: a context of other numbers."""
    size = abs(value)
    return size if size < 6 else min(11, 6 + (size - 6) // 4)


def within(value: int, most: int) -> int:
    """The value, held within ±most and counted from 0: 0 … 2 · most, a context of other numbers."""
    return max(-most, min(most, value)) + most


def header(data: bytes, magic: bytes, count: int) -> tuple[list[int], bytes]:
    """The whole numbers after the magic bytes, and the code that follows them.

    Raises FormatError, and LimitError for more code than MAX_CODE bytes.
    """
    if data[:4] != magic:
        raise FormatError(f"begins with {data[:4]!r}; {magic!r} is expected")
    values, at = read_numbers(data, 4, count)
    _check_size(len(data) - at)
    return values, data[at:]


def finished(coder: Coder) -> bytes:
    """The code of all that was written to the coder. Raises LimitError for more than MAX_CODE bytes."""
    code: bytes = coder.finish()
    _check_size(len(code))
    return code


def _check_size(size: int) -> None:
    if size > MAX_CODE:
        raise LimitError(f"{size} bytes of code; {MAX_CODE} are allowed")


def check_end(coder: Coder) -> None:
    """Raise FormatError unless the end mark comes next, and no byte after it."""
    if not coder.end() or coder.overrun:
        raise FormatError("truncated or damaged")
    if coder.rest:
        raise FormatError(f"{coder.rest} bytes after its end")
