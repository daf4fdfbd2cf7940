"""``*.texture.json``: a tile of prioritized pen strokes that repeats.

One JSON text::

    {"format": "penink-texture", "version": 1, "name": "dashes", "width": 144, "height": 144,
     "strokes": [{"priority": 0, "width": 0.4, "points": [[0, 8], [12, 8], [24, 9], [36, 9]]}]}

Strokes of lower priority are drawn first. ``"whole": true`` says that strokes are never shortened.
``"layers"`` says that the tile is an instance of plain hatching, which can also be laid without it.
``"oriented": true`` says that there is no tile but a set of examples, which are bent along a field of directions.
See README.md beside this file and schemas/texture.schema.json.

Numbers are written with DECIMALS or COORDINATES decimals. What has to hold between two of them is checked of the
rounded ones, so that a texture that was read can be written and read again.
"""

from __future__ import annotations

import io
import json
import re
from itertools import chain
from typing import Any, BinaryIO

import numpy as np

from penink_cli.formats import strict_json
from penink_cli.formats.strokes import LIMIT, Sink
from penink_cli.ground.decimals import plain
from penink_cli.ground.errors import FormatError, ParameterError
from penink_cli.ground.model import Engraving, Floats, HatchLayer, Ints, Scales, Strokes, Texture

DECIMALS, COORDINATES = 4, 3  # decimals as written: of numbers, of coordinates and sides
MAX_BYTES = 64 << 20
MAX_EXAMPLES = 1000  # of a set of oriented strokes
LEAST_EXAMPLE, MOST_EXAMPLE = 1.0, 250.0  # how far they lead along x, points

# Name in the file -> name in HatchLayer, least and most value.
_LAYER = {
    "angle": ("angle", -360.0, 360.0),
    "from": ("low", 0.0, 1.0),
    "to": ("high", 0.0, 1.0),
    "pen": ("pen_pt", 0.0001, LIMIT),
    "spacing": ("spacing_pt", 0.0, LIMIT),
    "wave": ("wave_pt", 0.0, 144.0),
    "wave_length": ("wave_length_pt", 0.0, LIMIT),
    "turn": ("turn", -360.0, 360.0),
}
# The same for Engraving.
_ENGRAVING = {
    "spacing": ("spacing_pt", 0.1, LIMIT),
    "finest": ("finest_pt", 0.001, LIMIT),
    "angle": ("angle", -360.0, 360.0),
    "waver": ("waver", 0.0, 10.0),
    "crosses": ("crosses", 0.01, 1.0),
}
MOST_LINES = 100_000
MOST_SCALE = 1000.0
#: The hatchings that may fill a texture that grows.
FILLS = ("parallel", "crosshatch")
_NEEDED = ("angle", "from", "to", "pen")
LEAST_WIDTH = 0.0001  # of strokes, points
LEAST_SIDE = 0.01  # of a tile, points

# Where the strokes begin and end in the text that `write` writes: they are its last member.
_STROKES = re.compile(rb',[ \t\r\n]*"strokes"[ \t\r\n]*:[ \t\r\n]*\[')
_END = re.compile(rb"[ \t\r\n]*\}[ \t\r\n]*")
#: Priorities, widths, numbers of points and the points of all strokes.
Listed = tuple[Floats, Floats, Ints, Floats]


def read(stream: BinaryIO, source: str) -> Texture:
    """The texture of a file. Raises FormatError, which names the stroke or layer at fault."""
    text = stream.read(MAX_BYTES + 1)
    try:
        if len(text) > MAX_BYTES:
            raise FormatError(f"larger than {MAX_BYTES} bytes")
        rest, strokes = _plain(text)
        return _texture(strict_json.header(strict_json.loads(rest), "penink-texture"), strokes)
    except FormatError as error:
        from penink_cli.formats.recognise import explained

        raise explained(error, text, "texture").from_source(source) from None


def _plain(text: bytes) -> tuple[bytes, Listed | None]:
    """The text without its strokes, whose lines stay as empty ones, and the strokes; None for strokes not plain.

    Where they are not plain, the text is returned as it is, for json. Plain strokes are read in a twentieth of the time
    and of the memory that json needs.
    """
    from penink_cli.formats._compiled import plain_json as _plain_json

    mark = _STROKES.search(text)
    if not mark or b'"scales"' in text[: mark.start()]:
        return text, None
    most = text.count(b"{", mark.end())
    points = np.empty((text.count(b"[", mark.end()) + 1, 2))
    counts, priorities, widths = np.empty(most + 1, np.int64), np.empty(most + 1), np.empty(most + 1)
    after, n, used = _plain_json.prioritized(text, mark.end(), LIMIT, LEAST_WIDTH, points, counts, priorities, widths)
    if after < 0 or not _END.fullmatch(text, after):
        return text, None
    lines = b"\n" * text.count(b"\n", mark.end(), after)  # an error elsewhere then has the right line number
    return text[: mark.end()] + lines + text[after - 1 :], (priorities[:n], widths[:n], counts[:n], points[:used])


def _texture(document: dict[str, Any], listed: Listed | None) -> Texture:
    """The texture of a file; listed: its strokes, None where they are still in the document. Raises FormatError."""
    name = strict_json.text(strict_json.member(document, "name"), "name")
    width, height = (_size(strict_json.member(document, side), side, LEAST_SIDE) for side in ("width", "height"))
    whole = strict_json.flag(document.get("whole", False), "whole")
    oriented = strict_json.flag(document.get("oriented", False), "oriented")
    items = strict_json.array(strict_json.member(document, "strokes"), "strokes")
    if not items and listed is None:
        raise FormatError("strokes is empty; a texture has at least one")
    priorities, widths, sizes, points = _strokes(items) if listed is None else listed
    scales, spans = document.get("scales"), None
    if scales is not None:
        spans = _spans(items)
    order = np.argsort(priorities, kind="stable")
    first = np.zeros(len(sizes) + 1, np.int64)
    np.cumsum(sizes[order], out=first[1:])
    begin = np.cumsum(sizes) - sizes
    points = points[np.repeat(begin[order] - first[:-1], sizes[order]) + np.arange(len(points))]
    strokes = Strokes(width, height, points, first, widths[order], texture=name)
    layers = strict_json.array(document.get("layers", []), "layers")
    found = tuple(_layer(layer, i) for i, layer in enumerate(layers))
    if oriented:
        _check_set(strokes, found)
    laid = Texture(name, strokes, priorities[order], whole, found, _engraving(document.get("engraving")), oriented)
    return laid if spans is None else _scaling(laid, scales, spans[order])


def _spans(items: list[Any]) -> Floats:
    """(s, 2) the scales from and to which each stroke is there, NaN for one that does not grow. Raises FormatError."""
    spans = np.full((len(items), 2), np.nan)
    for i, item in enumerate(items):
        if "scale" not in item:
            continue
        place = f"stroke {i}: scale"
        pair = strict_json.array(item["scale"], place)
        if len(pair) != 2:
            raise FormatError(f"{place} has {len(pair)} numbers; from and to are needed")
        low, high = (strict_json.number(value, place, 0.0, MOST_SCALE) for value in pair)
        if not _less(low, high):
            raise FormatError(f"{place} is from {low:g} to {high:g}; to {DECIMALS} decimals the first must be less")
        spans[i] = low, high
    return spans


def _scaling(laid: Texture, scales: Any, spans: Floats) -> Texture:
    """The texture that grows. laid: all its strokes; spans: (s, 2), as of `_spans`. Raises FormatError."""
    scales = strict_json.members(scales, "scales")
    if laid.layers or laid.engraving is not None or laid.oriented:
        raise FormatError("scales go with a plain tile: no layers, no engraving, not oriented")
    natural = _size(strict_json.member(scales, "natural", "scales"), "scales: natural", LEAST_SIDE)
    least = strict_json.number(scales.get("least", 0.0), "scales: least", 0.0, LIMIT)
    fill = strict_json.text(scales.get("fill", FILLS[0]), "scales: fill")
    if fill not in FILLS:
        raise FormatError(f"scales: fill {strict_json.quoted(fill)}; known are {', '.join(FILLS)}")
    grows = ~np.isnan(spans[:, 0])
    there = ~grows | ((spans[:, 0] <= 1) & (spans[:, 1] > 1))
    if not grows.any() or not there.any():
        raise FormatError("scales, and no stroke that grows" if not grows.any() else "no stroke at the natural size")
    growing = Scales(
        natural, least, fill, laid.strokes.taken(np.flatnonzero(grows)), laid.priorities[grows], spans[grows],
        ~grows[there],
    )  # fmt: skip
    strokes = laid.strokes.taken(np.flatnonzero(there))
    return Texture(laid.name, strokes, laid.priorities[there], laid.whole, scales=growing)


def _check_set(strokes: Strokes, layers: tuple[HatchLayer, ...]) -> None:
    """Raise FormatError for a set of oriented strokes that cannot be laid along a field."""
    if layers:
        raise FormatError("oriented and with layers; a set of strokes has none")
    if len(strokes) > MAX_EXAMPLES:
        raise FormatError(f"{len(strokes)} oriented strokes; {MAX_EXAMPLES} are allowed")
    for i in range(len(strokes)):
        first, last = (round(float(x), COORDINATES) for x in strokes[i][[0, -1], 0])
        if not LEAST_EXAMPLE <= round(last - first, COORDINATES) <= MOST_EXAMPLE:
            on = f"{last - first:g} pt on; from {LEAST_EXAMPLE:g} to {MOST_EXAMPLE:g} along x are needed"
            raise FormatError(f"oriented stroke {i}, by priority, leads {on}")


def _strokes(items: list[Any]) -> Listed:
    """The strokes of a file that is not plain. Raises FormatError.

    All values are checked at once, and one by one only to name the one that is wrong. 15 000 strokes of ten points take
    90 ms so, and half a second one by one.
    """
    try:
        priorities = strict_json.numbers([item["priority"] for item in items], "", "")
        widths = strict_json.numbers([item["width"] for item in items], "", "")
        controls = [item["points"] for item in items]
        points = strict_json.pairs(list(chain.from_iterable(controls)), "", "") + 0.0  # -0 is 0
        sizes = np.array([len(control) for control in controls])
        right = set(map(type, controls)) <= {list} and (sizes % 3 == 1).all() and (np.abs(points) <= LIMIT).all()
        if right and ((widths >= LEAST_WIDTH) & (widths <= LIMIT)).all():
            return priorities, widths, sizes, points
    except (FormatError, TypeError, KeyError):
        pass
    for i, item in enumerate(items):
        place = f"stroke {i}"
        item = strict_json.members(item, place)
        strict_json.number(strict_json.member(item, "priority", place), f"{place}: priority")
        _size(strict_json.member(item, "width", place), f"{place}: width")
        control = strict_json.pairs(strict_json.member(item, "points", place), f"{place}: points", f"{place}: point")
        if len(control) % 3 != 1:
            raise FormatError(f"{place}: {len(control)} points; a chain of k cubics has 3k + 1 of them, and a dot one")
        if not (np.abs(control) <= LIMIT).all():
            raise FormatError(f"{place}: a point beyond ±{LIMIT:.0f}")
    raise AssertionError("unreachable: one of the strokes is wrong")


def _size(value: Any, what: str, least: float = LEAST_WIDTH) -> float:
    """A length from ``least`` to LIMIT. Raises FormatError, in which ``what`` names it."""
    return strict_json.number(value, what, least, LIMIT)


def _less(one: float, other: float) -> bool:
    """Whether one number is less than another as they are written."""
    return round(one, DECIMALS) < round(other, DECIMALS)


def _layer(value: Any, i: int) -> HatchLayer:
    """The layer at that place of the list. Raises FormatError."""
    place = f"layer {i}"
    value = strict_json.members(value, place)
    for name in _NEEDED:
        strict_json.member(value, name, place)
    layer = HatchLayer(
        **{
            field: strict_json.number(value[name], f"{place}: {name}", least, most)
            for name, (field, least, most) in _LAYER.items()
            if name in value
        }
    )
    if not _less(layer.low, layer.high):
        found = f'"from" is {layer.low:g} and "to" {layer.high:g}'
        raise FormatError(f'{place}: {found}; to {DECIMALS} decimals "from" must be less')
    if round(layer.wave_length_pt, DECIMALS) < 4 * round(layer.wave_pt, DECIMALS):
        raise FormatError(f"{place}: a wave of {layer.wave_pt:g} pt needs a wave_length of at least four times that")
    return layer


def _engraving(value: Any) -> Engraving | None:
    """What the texture says of lines that swell; None where it says nothing. Raises FormatError."""
    if value is None:
        return None
    value = strict_json.members(value, "engraving")
    found: dict[str, Any] = {
        field: strict_json.number(value[name], f"engraving: {name}", least, most)
        for name, (field, least, most) in _ENGRAVING.items()
        if name in value
    }
    for name in ("along", "blunt"):
        if name in value:
            found[name] = strict_json.flag(value[name], f"engraving: {name}")
    if "centre" in value:
        ((x, y),) = strict_json.pairs([value["centre"]], "engraving: centre", "engraving: centre").tolist()
        if not max(abs(x), abs(y)) <= 100:
            raise FormatError("engraving: centre is beyond 100 times the sheet")
        found["centre"] = (x, y)
    if "lines" in value:
        found["lines"] = strict_json.whole(value["lines"], "engraving: lines", 1, MOST_LINES)
    engraving = Engraving(**found)
    if not _less(engraving.finest_pt, engraving.spacing_pt):
        sizes = f"finest is {engraving.finest_pt:g} and spacing {engraving.spacing_pt:g}"
        raise FormatError(f"engraving: {sizes}; to {DECIMALS} decimals finest must be less")
    return engraving


def _engraving_text(engraving: Engraving) -> str:
    """The engraving as JSON. ``crosses`` is written only where it says that lines cross."""
    members = [
        (name, plain(getattr(engraving, field), DECIMALS))
        for name, (field, _, _) in _ENGRAVING.items()
        if name != "crosses" or engraving.crosses < 1
    ]
    members += [(name, json.dumps(getattr(engraving, name))) for name in ("along", "blunt")]
    if engraving.centre is not None:
        members.append(("centre", "[{}, {}]".format(*(plain(v, DECIMALS) for v in engraving.centre))))
    if engraving.lines is not None:
        members.append(("lines", str(engraving.lines)))
    return "{" + ", ".join(f'"{name}": {text}' for name, text in members) + "}"


def write(out: Sink, texture: Texture) -> None:
    """Write a texture, one stroke a line.

    Raises ParameterError for a texture that, rounded, could not be read again.
    """
    text = _text(texture)
    try:
        read(io.BytesIO(text), texture.name)
    except FormatError as error:
        raise ParameterError(f"a texture that no file can hold: {error.message}") from None
    out.write(text)


def _text(texture: Texture) -> bytes:
    """The file of a texture. Raises ParameterError for a name that is not UTF-8."""
    s = texture.strokes
    head = f'{{"format": "penink-texture", "version": 1, "name": {strict_json.written(texture.name, "name")}'
    head += f', "width": {plain(s.width, COORDINATES)}, "height": {plain(s.height, COORDINATES)}'
    if texture.whole:
        head += ', "whole": true'
    if texture.oriented:
        head += ', "oriented": true'
    if texture.layers:

        def members(layer: HatchLayer) -> list[tuple[str, float]]:
            values = [(name, getattr(layer, field)) for name, (field, _, _) in _LAYER.items()]
            return [(name, value) for name, value in values if value is not None]

        layers = ",\n  ".join(
            "{" + ", ".join(f'"{name}": {plain(value, DECIMALS)}' for name, value in members(layer)) + "}"
            for layer in texture.layers
        )
        head += f', "layers": [\n  {layers}]'
    if texture.engraving is not None:
        head += f', "engraving": {_engraving_text(texture.engraving)}'
    if texture.scales is not None:
        scales = texture.scales
        natural, least = (plain(size, COORDINATES) for size in (scales.natural_pt, scales.least_pt))
        head += f', "scales": {{"natural": {natural}, "least": {least}, "fill": {json.dumps(scales.fill)}}}'
    lines = _stroke_lines(s, texture.priorities)
    if texture.scales is not None:
        fixed = [(float(p), line) for p, line, f in zip(texture.priorities, lines, texture.scales.fixed) if f]
        grown = _stroke_lines(texture.scales.strokes, texture.scales.priorities, texture.scales.spans)
        both = [*fixed, *zip(texture.scales.priorities.tolist(), grown, strict=True)]
        lines = [line for _, line in sorted(both, key=lambda item: item[0])]
    return (head + ', "strokes": [\n' + ",\n".join(lines) + "\n]}\n").encode("ascii")


def _stroke_lines(strokes: Strokes, priorities: Floats, spans: Floats | None = None) -> list[str]:
    """Strokes as JSON, one text each; spans: (s, 2), as of `_spans`, for strokes that grow."""
    lines = []
    for i in range(len(strokes)):
        control = ", ".join(f"[{plain(x, COORDINATES)}, {plain(y, COORDINATES)}]" for x, y in strokes[i].tolist())
        priority, width = (plain(float(v), DECIMALS) for v in (priorities[i], strokes.widths[i]))
        line = f' {{"priority": {priority}, "width": {width}'
        if spans is not None:
            line += ', "scale": [{}, {}]'.format(*(plain(float(v), DECIMALS) for v in spans[i]))
        lines.append(line + f', "points": [{control}]}}')
    return lines
