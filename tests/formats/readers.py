"""Every reader of the project as a function from bytes to a value, for the tests that feed all of them anything."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any

from penink_cli.ground.errors import PeninkError

MAX_PIXELS = 100_000
SOURCE = "given.file"


def _pgm(data: bytes) -> Any:
    from penink_cli.formats import pgm

    return pgm.read(io.BytesIO(data), SOURCE, MAX_PIXELS)


def _photo(data: bytes) -> Any:
    from penink_cli.formats import photo

    return photo.read_grey(io.BytesIO(data), SOURCE, MAX_PIXELS)


def _directions(data: bytes) -> Any:
    from penink_cli.formats import directions

    return directions.read(io.BytesIO(data), SOURCE, MAX_PIXELS)


def _edges(data: bytes) -> Any:
    from penink_cli.formats import edge_list

    found = edge_list.read(io.BytesIO(data), SOURCE)
    _json(data)
    return found


def _lines(data: bytes) -> Any:
    from penink_cli.formats import lines

    return lines.read(io.BytesIO(data), SOURCE)


def _strokes(data: bytes) -> Any:
    from penink_cli.formats import strokes

    found = strokes.read(io.BytesIO(data), SOURCE)
    for line in data.removesuffix(b"\n").split(b"\n"):
        _json(line)
    return found


def _json(text: bytes) -> None:
    """What is read in bulk, past the JSON reader, must be JSON all the same."""
    import json

    try:
        json.loads(text.decode("utf-8"))
    except ValueError as error:
        raise AssertionError(f"read, and no JSON: {error}") from error


def _texture(data: bytes) -> Any:
    from penink_cli.formats import texture

    return texture.read(io.BytesIO(data), SOURCE)


def _pens(data: bytes) -> Any:
    from penink_cli.formats import pens

    return pens.read(io.BytesIO(data), SOURCE)


def _archive(data: bytes) -> Any:
    from penink_cli.formats import archive

    return archive.read(data, SOURCE)


def _illustration(data: bytes) -> Any:
    """A manifest whose every member is the small image, or the edge list, that fits."""
    from penink_cli.formats import illustration
    from penink_cli.options.textures import find_texture

    def fetch(name: str) -> bytes:
        if "edge" in name:
            return b'{"format": "penink-edges", "version": 1, "width": 2, "height": 2, "vertices": [], "edges": []}'
        return b"P5 2 2 255\n1234"

    return illustration.read(data, SOURCE, fetch, find_texture, MAX_PIXELS)


def _compact(data: bytes) -> Any:
    """A member of a packed illustration, by its first bytes."""
    from penink_cli.formats import compact, compact_edges, compact_lines, parts
    from tests.fuzz.seeds import EDGES

    try:
        if data.startswith(compact.ALL_SAMPLES):
            return compact.samples_from(data, MAX_PIXELS, EDGES)
        if data.startswith(compact_lines.ALL_LINES):
            return compact_lines.lines_from(data)
        if data.startswith((compact_edges.EDGES, compact_edges.EDGES_1)):
            return compact_edges.edges_from(data)
        if data.startswith(parts.PARTS):
            return parts.parts_from(data)
        return compact.text_from(data)
    except PeninkError as error:
        raise error.from_source(SOURCE) from None


READERS: dict[str, Callable[[bytes], Any]] = {
    "pgm": _pgm,
    "photo": _photo,
    "edges": _edges,
    "lines": _lines,
    "directions": _directions,
    "strokes": _strokes,
    "texture": _texture,
    "illustration": _illustration,
    "archive": _archive,
    "pens": _pens,
    "compact": _compact,
}


def judge(reader: str, data: bytes) -> None:
    """Any bytes are a value, or one error of ours: short, printable, and of this file. Anything else is raised."""
    try:
        READERS[reader](data)
    except PeninkError as error:
        text = str(error)
        assert text.startswith(f"{SOURCE}: ") and text.isprintable() and len(text) < 400, text


def written(write: Callable[..., Any], value: Any) -> bytes:
    """The bytes that a writer writes."""
    out = io.BytesIO()
    write(out, value)
    return out.getvalue()
