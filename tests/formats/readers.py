"""Every reader of the project as a function from bytes to a value, for the tests that feed all of them anything."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any

MAX_PIXELS = 100_000
SOURCE = "given.file"


def _pgm(data: bytes) -> Any:
    from penink_cli.formats import pgm

    return pgm.read(io.BytesIO(data), SOURCE, MAX_PIXELS)


def _photo(data: bytes) -> Any:
    from penink_cli.formats import photo

    return photo.read_grey(io.BytesIO(data), SOURCE, MAX_PIXELS)


def _edges(data: bytes) -> Any:
    from penink_cli.formats import edge_list

    return edge_list.read(io.BytesIO(data), SOURCE)


def _strokes(data: bytes) -> Any:
    from penink_cli.formats import strokes

    return strokes.read(io.BytesIO(data), SOURCE)


READERS: dict[str, Callable[[bytes], Any]] = {
    "pgm": _pgm,
    "photo": _photo,
    "edges": _edges,
    "strokes": _strokes,
}


def written(write: Callable[..., Any], value: Any) -> bytes:
    """The bytes that a writer writes."""
    out = io.BytesIO()
    write(out, value)
    return out.getvalue()
