"""All members of a packed illustration in one file, ``PIp1``: an entry of a ZIP costs more than some of them hold.

Whole numbers (see `compact`): how many parts, then how many bytes each has; then the parts, one after the other. Each
is a compact member. A manifest that says ``"parts": PATH`` names them by their positions: ``"#0"``, ``"#1"``, …
"""

from __future__ import annotations

import re
from itertools import accumulate, pairwise

from penink_cli.formats.members import read_numbers, written_numbers
from penink_cli.ground.errors import FormatError, LimitError

PARTS = b"PIp1"
COMPACT = b"PI"  # how all compact members begin
MAX_PARTS = 320  # five of each of 64 layers

_NAME = re.compile(r"#(0|[1-9][0-9]{0,2})", re.ASCII)


def name(at: int) -> str:
    """What a manifest calls the part at that position, counted from 0."""
    return f"#{at}"


def parts_bytes(parts: list[bytes]) -> bytes:
    """One file of these parts, in their order."""
    return PARTS + written_numbers(len(parts), *map(len, parts)) + b"".join(parts)


def parts_from(data: bytes) -> list[bytes]:
    """The parts of such a file, each a compact member by its first bytes; what it holds is not looked at.

    Raises FormatError, also for bytes behind the last part, and LimitError for more than MAX_PARTS parts.
    """
    if data[:4] != PARTS:
        raise FormatError(f"begins with {data[:4]!r}; {PARTS!r} is expected")
    (count,), at = read_numbers(data, 4, 1)
    if count > MAX_PARTS:
        raise LimitError(f"{count} parts; {MAX_PARTS} are allowed")
    sizes, at = read_numbers(data, at, count)
    bounds = list(accumulate(sizes, initial=at))
    if bounds[-1] != len(data):
        raise FormatError(f"its parts end at byte {bounds[-1]}, the file at {len(data)}")
    found = [data[start:end] for start, end in pairwise(bounds)]
    for i, part in enumerate(found):
        if not part.startswith(COMPACT) or part.startswith(PARTS):
            raise FormatError(f"part {i} is no compact member")
    return found


def chosen(parts: list[bytes], path: str) -> bytes | None:
    """The part that ``path`` of a manifest names; None for the path of a file. Raises FormatError for no such part."""
    if not path.startswith("#"):
        return None
    at = _NAME.fullmatch(path)
    if at is None or int(at[1]) >= len(parts):
        raise FormatError(f"is not among its {len(parts)} parts")
    return parts[int(at[1])]
