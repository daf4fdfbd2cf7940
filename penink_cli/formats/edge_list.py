"""Edge lists (``*.edges.json``): the discontinuity edges of a photograph, in its pixels.

`read` checks each vertex and each edge by itself, and that no two are equal. That edges meet at shared vertices only
is checked by `geometry.validity`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, BinaryIO

import numpy as np

from penink_cli.formats import strict_json
from penink_cli.ground.errors import FormatError, LimitError
from penink_cli.ground.model import EdgeList, Floats, Ints

if TYPE_CHECKING:
    from penink_cli.ground.streams import Output

FORMAT = "penink-edges"
DECIMALS = 4  # of coordinates and strengths, as written: a ten-thousandth of a pixel
MAX_SIDE = 2**31 - 1  # of a frame, pixels
BAND = 1 << 15  # vertices or edges written at a time

# 12 megapixels of grass have a million edges in 63 MB; ordinary photographs have a thirtieth of that.
BYTES_PER_PIXEL = 0.8
LEAST_BYTES = 80_000_000


def _spaced(*parts: bytes) -> re.Pattern[bytes]:
    """The parts with what JSON calls white space around each; ``\\s`` would take form feeds too."""
    gap = rb"[ \t\r\n]*"
    return re.compile(gap + gap.join(parts) + gap)


# The text that `write` writes, whatever its white space and digits; json reads every other.
_SIDE = rb"([1-9][0-9]{0,9})"
_HEAD = _spaced(
    rb"\{", rb'"format"', b":", rb'"penink-edges"', b",", rb'"version"', b":", b"1", b",",
    rb'"width"', b":", _SIDE, b",", rb'"height"', b":", _SIDE, b",", rb'"vertices"', b":", rb"\[",
)  # fmt: skip
_EDGES = _spaced(b",", rb'"edges"', b":", rb"\[")
_STRENGTH = _spaced(b",", rb'"strength"', b":", rb"\[")
_END = _spaced(rb"\}")


def read(stream: BinaryIO, source: str, max_pixels: int = 0) -> EdgeList:
    """An edge list in which every vertex and edge is sound by itself.

    Vertices are within the frame and different from one another; an edge joins two different vertices
    of the list and is there once; strengths, if there are any, are one for each edge, 0 to 1.

    Raises FormatError, which names the vertex or edge, and LimitError for a list of more bytes than
    the larger of LEAST_BYTES and BYTES_PER_PIXEL · max_pixels.
    """
    most = max(LEAST_BYTES, int(BYTES_PER_PIXEL * max_pixels))
    text = b"".join(_pieces(stream, source, most))
    try:
        found = _plain(text)
        if found is None:
            found = _edge_list(strict_json.loads(text, source))
        text = text[:0]  # room for what follows
        check(found)
    except FormatError as error:
        from penink_cli.formats.recognise import explained

        raise explained(error, text, "edges").from_source(source) from None
    return found


def _pieces(stream: BinaryIO, source: str, most: int) -> Iterator[bytes]:
    """The stream by the megabyte, up to ``most`` bytes."""
    size = 0
    while piece := stream.read(1 << 20):
        size += len(piece)
        if size > most:
            raise LimitError(f"edge list of more than {most} bytes (--max-pixels raises this limit)", source)
        yield piece


def _plain(text: bytes) -> EdgeList | None:
    """The edge list of a text as `write` writes it, unchecked; None for any other text."""
    head = _HEAD.match(text)
    if not head or int(head[1]) > MAX_SIDE or int(head[2]) > MAX_SIDE:
        return None
    vertices, at = _numbers(text, head.end(), 2, False)
    mark = _EDGES.match(text, at) if at >= 0 else None
    if not mark:
        return None
    edges, at = _numbers(text, mark.end(), 2, True)
    strength = None
    mark = _STRENGTH.match(text, at) if at >= 0 else None
    if mark:
        strength, at = _numbers(text, mark.end(), 1, False)
    if at < 0 or not _END.fullmatch(text, at):
        return None
    return EdgeList(
        int(head[1]), int(head[2]), vertices.reshape(-1, 2), edges.astype(np.int64).reshape(-1, 2), strength
    )


def _numbers(text: bytes, at: int, group: int, whole: bool) -> tuple[Floats, int]:
    """Numbers (n,) of the array whose bracket stands before ``at``, and the place after it; -1 for one not plain."""
    from penink_cli.formats._compiled import plain_json as _plain_json

    end = text.find(b'"', at)  # of the next member, or none
    out = np.empty(1 + text.count(b",", at, end if end >= 0 else len(text)))
    after, count = _plain_json.numbers(text, at, group, whole, out)
    out.resize(count, refcheck=False)  # no copy
    return out, after


def _edge_list(document: object) -> EdgeList:
    members = strict_json.header(document, FORMAT)
    width = strict_json.whole(strict_json.member(members, "width"), "width", 1, MAX_SIDE)
    height = strict_json.whole(strict_json.member(members, "height"), "height", 1, MAX_SIDE)
    vertices = strict_json.pairs(strict_json.member(members, "vertices"), "vertices", "vertex")
    edges = strict_json.whole_pairs(strict_json.member(members, "edges"), "edges", "edge")
    strength = None
    if "strength" in members:
        strength = strict_json.numbers(members["strength"], "strength", "strength")
    return EdgeList(width, height, vertices + 0.0, edges, strength)  # + 0.0: -0 is 0


def check(edges: EdgeList) -> None:
    """Raise FormatError for the first vertex, edge or strength that the format does not allow."""
    _check_vertices(edges.vertices, edges.width, edges.height)
    _check_edges(edges.edges, len(edges.vertices))
    if edges.strength is not None:
        if len(edges.strength) != len(edges.edges):
            raise FormatError(f"{len(edges.strength)} strengths for {len(edges.edges)} edges")
        wrong = np.flatnonzero(~((edges.strength >= 0) & (edges.strength <= 1)))
        if len(wrong):
            raise FormatError(f"edge {wrong[0]}: strength {edges.strength[wrong[0]]:g} is not in 0..1")


def _check_vertices(vertices: Floats, width: int, height: int) -> None:
    inside = (vertices >= 0) & (vertices <= (width, height))  # false for NaN
    wrong = np.flatnonzero(~inside.all(axis=1))
    if len(wrong):
        x, y = vertices[wrong[0]]
        raise FormatError(f"vertex {wrong[0]}: ({x:.10g}, {y:.10g}) is outside the frame {width} x {height}")
    pair = _first_equal(vertices)
    if pair:
        raise FormatError(f"vertices {pair[0]} and {pair[1]} are the same point")


def _check_edges(edges: Ints, count: int) -> None:
    wrong = np.flatnonzero(((edges < 0) | (edges >= count)).any(axis=1))
    if len(wrong):
        a, b = edges[wrong[0]]
        known = f"0..{count - 1}" if count else "an empty list"
        raise FormatError(f"edge {wrong[0]}: vertex {a if not 0 <= a < count else b} is not in {known}")
    wrong = np.flatnonzero(edges[:, 0] == edges[:, 1])
    if len(wrong):
        raise FormatError(f"edge {wrong[0]} joins vertex {edges[wrong[0], 0]} to itself")
    pair = _first_equal(np.sort(edges, axis=1))
    if pair:
        raise FormatError(f"edges {pair[0]} and {pair[1]} join the same vertices")


def _first_equal(rows: Floats | Ints) -> tuple[int, int] | None:
    """The first pair of equal rows of (n, 2), by the place of the second; None where all differ."""
    # A million edges have two million ends: sorting one whole number for each takes a tenth of sorting pairs.
    words = np.ascontiguousarray(rows).view(np.uint64)
    mixed = np.sort(words[:, 0] * np.uint64(0x9E3779B97F4A7C15) ^ words[:, 1])
    if not (mixed[1:] == mixed[:-1]).any():
        return None
    order = np.lexsort((rows[:, 1], rows[:, 0]))  # stable: equal rows stay in their order
    same = np.flatnonzero((rows[order[1:]] == rows[order[:-1]]).all(axis=1))
    if not len(same):
        return None
    k = same[np.argmin(order[same + 1])]
    return int(order[k]), int(order[k + 1])


def rounded(edges: EdgeList) -> EdgeList:
    """The edge list as `write` writes it: coordinates and strengths rounded to DECIMALS decimals."""
    strength = None if edges.strength is None else np.round(edges.strength, DECIMALS) + 0.0
    return EdgeList(edges.width, edges.height, np.round(edges.vertices, DECIMALS) + 0.0, edges.edges, strength)


def write(out: Output, edges: EdgeList) -> None:
    """Write an edge list, one vertex and one edge a line.

    Raises FormatError for an edge list that, rounded, could not be read again.
    """
    edges = rounded(edges)
    check(edges)
    head = f'{{"format": "{FORMAT}", "version": 1, "width": {edges.width}, "height": {edges.height},\n "vertices": ['
    out.write(head.encode("ascii"))
    _write_rows(out, f"[%.{DECIMALS}f, %.{DECIMALS}f]", edges.vertices)
    out.write(b'],\n "edges": [')
    _write_rows(out, "[%d, %d]", edges.edges)
    out.write(b"]")
    if edges.strength is not None:
        out.write(b',\n "strength": [')
        _write_rows(out, f"%.{DECIMALS}f", edges.strength)
        out.write(b"]")
    out.write(b"}\n")


def _write_rows(out: Output, pattern: str, values: Floats | Ints) -> None:
    """One item a line: a formatting call for each band, 8 times as fast as one for each item."""
    for start in range(0, len(values), BAND):
        band = values[start : start + BAND]
        text = ("," if start else "") + "\n  " + ",\n  ".join([pattern] * len(band)) % tuple(band.ravel().tolist())
        out.write(text.encode("ascii"))
