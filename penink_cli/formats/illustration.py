"""``*.illustration.json``: the manifest of an illustration, its layers and what each is made of.

    {"format": "penink-illustration", "version": 1, "width": 288, "height": 288,
     "layers": [{"name": "keys", "samples": "keys.pgm", "edges": "keys.edges.json",
                 "texture": "crosshatch", "outline": {"pen": 0.7, "min_strength": 0.1}}]}

Each member of a layer is a file of its own format (PGM samples, an edge list, telling lines, a direction field, a
texture) or a compact one; the first bytes say which. Paths are relative to the manifest. A ``*.penink`` archive holds
such a manifest and one file of compact members, its ``"parts"``. See README.md beside this file and
schemas/illustration.schema.json.
"""

from __future__ import annotations

import io
import json
import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from penink_cli.formats import compact, compact_edges, compact_lines, directions, edge_list, parts, pgm, strict_json
from penink_cli.formats import lines as lines_format
from penink_cli.formats import texture as texture_format
from penink_cli.formats.members import is_compact
from penink_cli.ground.errors import FormatError, LimitError, PeninkError
from penink_cli.ground.model import (
    Directions,
    EdgeList,
    GreyImage,
    Illustration,
    Layer,
    LineChoice,
    Lines,
    OutlineChoice,
    Texture,
    turned,
)
from penink_cli.ground.rules import RULES

FORMAT = "penink-illustration"
MANIFEST = "illustration.json"  # its name within an archive
PARTS = "parts"  # the name of the file of all compact members within an archive
MAX_BYTES = 1 << 20  # of the manifest
MAX_LAYERS = 64
MAX_SIZE = 144_000.0  # of the picture, points
MAX_PEN = 72.0  # points
MAX_STRAY = 144.0  # of lines, points
LEAST_LENGTH = 0.01  # of sizes and pens, points
COMPACT = parts.COMPACT
LEVELS = 16  # of grey, unless a layer says another number: ink shows no more

_SHIPPED = re.compile(r"[a-z0-9_-]{1,60}", re.ASCII)

#: The bytes of a member, by its path in the manifest.
Fetch = Callable[[str], bytes]
#: The shipped texture of that name.
Shipped = Callable[[str], Texture]


def read(text: bytes, source: str, fetch: Fetch, shipped: Shipped, max_pixels: int) -> Illustration:
    """The illustration whose manifest is ``text``.

    source: names the manifest in errors. fetch, shipped: see `Fetch` and `Shipped`. max_pixels: of the samples of all
    layers together.

    Each edge is sound by itself; that edges meet at shared vertices only is for `geometry.validity` to check. Raises
    FormatError, which names the layer and member, and LimitError.
    """
    try:
        if len(text) > MAX_BYTES:
            raise LimitError(f"a manifest of more than {MAX_BYTES} bytes")
        document = strict_json.header(strict_json.loads(text), FORMAT)
        width, height = (_length(document, side, MAX_SIZE) for side in ("width", "height"))
        items = strict_json.array(strict_json.member(document, "layers"), "layers")
        if not 1 <= len(items) <= MAX_LAYERS:
            raise FormatError(f"{len(items)} layers; 1 to {MAX_LAYERS} are allowed")
        fetch_part = _with_parts(document, fetch)
        layers: list[Layer] = []
        left = min(max_pixels, compact.MAX_SAMPLES)
        for i, item in enumerate(items):
            item = strict_json.members(item, f"layer {i}")
            layers.append(_layer(item, f"layer {i}", fetch_part, shipped, left))
            left -= layers[-1].samples.values.size
    except PeninkError as error:
        from penink_cli.formats.recognise import explained

        raise explained(error, text, "illustration").from_source(source) from None
    return Illustration(width, height, tuple(layers))


def _with_parts(document: dict[str, Any], fetch: Fetch) -> Fetch:
    """``fetch``, which also knows the parts by their names if the manifest has a file of parts."""
    if "parts" not in document:
        return fetch
    held: list[bytes] = _fetched(document, "parts", "", fetch, parts.parts_from)

    def fetch_part(path: str) -> bytes:
        found = parts.chosen(held, path)
        return fetch(path) if found is None else found

    return fetch_part


def _fetched(item: dict[str, Any], name: str, place: str, fetch: Fetch, take: Callable[[bytes], Any]) -> Any:
    """What ``take`` makes of the file whose path is the member ``name``. Raises FormatError, which names both."""
    shown = f"{place}: {name}" if place else name
    path = strict_json.text(strict_json.member(item, name, place), shown)
    what = f"{shown} {strict_json.quoted(path)}"
    if not path or path.startswith("/") or "\0" in path:
        raise FormatError(f"{what}; a path relative to the manifest is needed")
    try:
        return take(fetch(path))
    except PeninkError as error:
        raise type(error)(f"{what}: {error.message}") from None


def _layer(item: dict[str, Any], place: str, fetch: Fetch, shipped: Shipped, max_pixels: int) -> Layer:
    """The layer that an object of the manifest says; place: names the layer in errors. Raises FormatError."""

    def member(name: str, take: Callable[[bytes], Any]) -> Any:
        return _fetched(item, name, place, fetch, take)

    def number(name: str, default: float, least: float, most: float) -> float:
        return strict_json.number(item[name], f"{place}: {name}", least, most) if name in item else default

    texture_name = strict_json.text(item.get("texture", "crosshatch"), f"{place}: texture")
    if _SHIPPED.fullmatch(texture_name):
        try:
            texture = shipped(texture_name)
        except PeninkError as error:
            raise type(error)(f"{place}: {error.message}") from None
        own = False
    else:
        texture, own = member("texture", _texture), True
    turn = number("turn", 0.0, -360.0, 360.0)
    rule = strict_json.text(item.get("rule", "best"), f"{place}: rule")
    if rule not in RULES:
        raise FormatError(f"{place}: rule {strict_json.quoted(rule)}; known are {', '.join(RULES)}")
    edges = member("edges", lambda data: _edges(data, max_pixels)) if "edges" in item else None
    samples, compactly = member("samples", lambda data: _samples(data, max_pixels, edges))
    field = member("directions", lambda data: _directions(data, samples, max_pixels)) if "directions" in item else None
    return Layer(
        samples=samples,
        edges=edges,
        texture=turned(texture, turn),
        texture_name=None if own else texture_name,
        name=strict_json.text(item["name"], f"{place}: name") if "name" in item else None,
        levels=strict_json.whole(
            item.get("levels", samples.maxval + 1 if compactly else LEVELS), f"{place}: levels", 2, 65536
        ),
        pen_pt=_length(item, "pen", MAX_PEN, place) if "pen" in item else None,
        gamma=number("gamma", 1.0, 0.05, 20.0),
        swell=number("swell", 0.0, 0.0, 2.0),
        rule=rule,
        seed=strict_json.whole(item.get("seed", 0), f"{place}: seed", 0, 2**63 - 1),
        outline=_outline(item["outline"], f"{place}: outline") if "outline" in item else None,
        directions=field,
        lines=member("lines", _lines) if "lines" in item else None,
        line=_line(item["line"], f"{place}: line") if "line" in item else LineChoice(),
        color=strict_json.colour(item["color"], f"{place}: color") if "color" in item else None,
        turn=turn,
    )


def _line(item: Any, place: str) -> LineChoice:
    """How telling lines are drawn. Raises FormatError."""
    item = strict_json.members(item, place)
    default = LineChoice()

    def number(name: str, default: Any, least: float, most: float) -> Any:
        return strict_json.number(item[name], f"{place}: {name}", least, most) if name in item else default

    return LineChoice(
        pen_pt=_length(item, "pen", MAX_PEN, place) if "pen" in item else default.pen_pt,
        even=strict_json.flag(item.get("even", default.even), f"{place}: even"),
        density=number("density", default.density, 0.0001, 1e4),
        per_inch2=number("per_inch2", default.per_inch2, 0.0001, 1e4),
        min_rank=number("min_rank", default.min_rank, 0, lines_format.MAX_RANK),
        ruled_pt=number("ruled", default.ruled_pt, 0, MAX_STRAY),
        loose_pt=number("loose", default.loose_pt, 0, MAX_STRAY),
    )


def _outline(item: Any, place: str) -> OutlineChoice:
    """How outlines are drawn. Raises FormatError."""
    item = strict_json.members(item, place)
    default = OutlineChoice()
    regions = strict_json.pairs(item.get("regions", []), f"{place}: regions", f"{place}: region").tolist()
    return OutlineChoice(
        pen_pt=_length(item, "pen", MAX_PEN, place) if "pen" in item else default.pen_pt,
        even=strict_json.flag(item.get("even", default.even), f"{place}: even"),
        min_strength=strict_json.number(item.get("min_strength", 0), f"{place}: min_strength", 0, 1),
        min_length=strict_json.number(item.get("min_length", 0), f"{place}: min_length", 0, edge_list.MAX_SIDE),
        regions=tuple((x, y) for x, y in regions),
    )


def _length(item: dict[str, Any], name: str, most: float, place: str = "") -> float:
    """A length on paper, points. Raises FormatError."""
    what = f"{place}: {name}" if place else name
    return strict_json.number(strict_json.member(item, name, place), what, LEAST_LENGTH, most)


def _samples(data: bytes, max_pixels: int, edges: EdgeList | None) -> tuple[GreyImage, bool]:
    """Samples, and whether they are compact: then they have as many levels already as they are kept at."""
    if is_compact(data, compact.ALL_SAMPLES):
        return compact.samples_from(data, max_pixels, edges), True
    return pgm.read(io.BytesIO(data), "", max_pixels), False


def _edges(data: bytes, max_pixels: int) -> EdgeList:
    if is_compact(data, (compact_edges.EDGES, compact_edges.EDGES_1)):
        return compact_edges.edges_from(data)
    return edge_list.read(io.BytesIO(data), "", max_pixels)


def _directions(data: bytes, samples: GreyImage, max_pixels: int) -> Directions:
    if is_compact(data, (compact.DIRECTIONS, compact.DIRECTIONS_1)):
        found = compact.directions_from(data)
    else:
        found = directions.read(io.BytesIO(data), "", max_pixels)
    rows, columns = samples.values.shape
    directions.check_shape(found, columns, rows)
    return found


def _lines(data: bytes) -> Lines:
    if is_compact(data, compact_lines.ALL_LINES):
        return compact_lines.lines_from(data)
    return lines_format.read(io.BytesIO(data), "")


def _texture(data: bytes) -> Texture:
    if is_compact(data, (compact.TEXT,)):
        data = compact.text_from(data)
    return texture_format.read(io.BytesIO(data), "")


# ------------------------------------------------------------------------------ writing


def members(illustration: Illustration) -> dict[str, bytes]:
    """The manifest and the file of compact members, by their names in an archive; defaults are not written.

    A member that several layers share, as the plates of one picture share its edges, is one part.

    Raises LimitError for a member that is too large, ParameterError for a text that is not UTF-8.
    """
    places: dict[bytes, int] = {}  # of the parts, in their order

    def put(item: dict[str, Any], kind: str, content: bytes) -> None:
        item[kind] = parts.name(places.setdefault(content, len(places)))

    layers = []
    for layer in illustration.layers:
        rows, columns = layer.samples.values.shape
        item: dict[str, Any] = {}
        if layer.name is not None:
            strict_json.written(layer.name, "a layer's name")  # refuses a name that could not be read again
            item["name"] = layer.name
        put(item, "samples", compact.samples_bytes(layer.samples, layer.edges))
        if layer.edges is not None:
            put(item, "edges", _edges_bytes(layer.edges, columns, rows))
        if layer.directions is not None:
            put(item, "directions", compact.directions_bytes(layer.directions))
        if layer.lines is not None:
            put(item, "lines", compact_lines.lines_bytes(layer.lines))
            if chosen := _line_item(layer.line):
                item["line"] = chosen
        if layer.texture_name is None:
            put(item, "texture", compact.text_bytes(_texture_bytes(turned(layer.texture, -layer.turn))))
        elif layer.texture_name != "crosshatch":
            item["texture"] = layer.texture_name
        for name, value, default in (
            ("levels", layer.levels, layer.samples.maxval + 1),
            ("pen", layer.pen_pt, None),
            ("gamma", layer.gamma, 1.0),
            ("swell", layer.swell, 0.0),
            ("rule", layer.rule, "best"),
            ("seed", layer.seed, 0),
            ("color", layer.color, None),
            ("turn", layer.turn, 0.0),
        ):
            if value != default:
                item[name] = _plain(value)
        if layer.outline is not None:
            item["outline"] = _outline_item(layer.outline)
        layers.append(item)
    manifest = {
        "format": FORMAT, "version": 1, "width": _plain(illustration.width), "height": _plain(illustration.height),
        "parts": PARTS, "layers": layers,
    }  # fmt: skip
    return {
        MANIFEST: json.dumps(manifest, separators=(",", ":")).encode("ascii"),
        PARTS: parts.parts_bytes(list(places)),
    }


def _line_item(line: LineChoice) -> dict[str, Any]:
    """How telling lines are drawn, for the manifest."""
    default = LineChoice()
    item = {}
    for name, value, usual in (
        ("pen", line.pen_pt, default.pen_pt),
        ("even", line.even, default.even),
        ("density", line.density, default.density),
        ("per_inch2", line.per_inch2, default.per_inch2),
        ("min_rank", line.min_rank, default.min_rank),
        ("ruled", line.ruled_pt, default.ruled_pt),
        ("loose", line.loose_pt, default.loose_pt),
    ):
        if value != usual:
            item[name] = _plain(value)
    return item


def _outline_item(outline: OutlineChoice) -> dict[str, Any]:
    """How outlines are drawn, for the manifest."""
    default = OutlineChoice()
    item = {}
    for name, value, usual in (
        ("pen", outline.pen_pt, default.pen_pt),
        ("even", outline.even, default.even),
        ("min_strength", outline.min_strength, default.min_strength),
        ("min_length", outline.min_length, default.min_length),
        ("regions", [[_plain(x), _plain(y)] for x, y in outline.regions], []),
    ):
        if value != usual:
            item[name] = _plain(value)
    return item


def _plain(value: Any) -> Any:
    """A number to four decimals, without a point where it is whole; anything else as it is."""
    if not isinstance(value, float):
        return value
    value = round(value, 4)
    return int(value) if value.is_integer() else value


def rounded(illustration: Illustration) -> Illustration:
    """What `read` gives back of what `members` writes: samples at their levels, edges and numbers as written.

    Whatever draws an illustration is given this form, so that the same strokes come of loose files and of an archive.
    The edges must lie on the grid already (`geometry.quantisation`).
    """
    layers = []
    for layer in illustration.layers:
        rows, columns = layer.samples.values.shape
        edges, texture, outline, field = layer.edges, layer.texture, layer.outline, layer.directions
        if edges is not None:
            edges = compact_edges.edges_from(_edges_bytes(edges, columns, rows))
        if layer.texture_name is None:
            texture = turned(_texture(_texture_bytes(turned(texture, -layer.turn))), layer.turn)
        if field is not None:
            field = compact.directions_from(compact.directions_bytes(field))
        lines, line = layer.lines, LineChoice()
        if lines is not None:
            lines = compact_lines.lines_from(compact_lines.lines_bytes(lines))
            line = _line(_line_item(layer.line), "line")
        if outline is not None:
            outline = _outline(_outline_item(outline), "outline")
        samples = compact.requantised(layer.samples, layer.levels)
        layers.append(
            replace(
                layer,
                samples=samples,
                levels=samples.maxval + 1,
                edges=edges,
                texture=texture,
                pen_pt=_plain(layer.pen_pt),
                gamma=float(_plain(layer.gamma)),
                swell=float(_plain(layer.swell)),
                outline=outline,
                directions=field,
                lines=lines,
                line=line,
            )
        )
    return Illustration(_plain(illustration.width), _plain(illustration.height), tuple(layers))


def _edges_bytes(edges: EdgeList, columns: int, rows: int) -> bytes:
    """Compact edges on the coarsest grid that holds them, beside samples of columns × rows."""
    points = compact_edges.on_grid(edges, columns, rows) or compact_edges.GRIDS[-1]
    return compact_edges.edges_bytes(edges, points * columns, points * rows)


def _texture_bytes(texture: Texture) -> bytes:
    out = io.BytesIO()
    texture_format.write(out, texture)
    return out.getvalue()
