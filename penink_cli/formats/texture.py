"""``*.texture.json``: a tile of prioritized pen strokes that repeats.

One JSON text::

    {"format": "penink-texture", "version": 1, "name": "dashes", "width": 144, "height": 144,
     "strokes": [{"priority": 0, "width": 0.4, "points": [[0, 8], [12, 8], [24, 9], [36, 9]]}]}

Strokes of lower priority are drawn first. ``"whole": true`` says that strokes are never shortened;
``"layers"`` says that the tile is an instance of plain hatching, which can then be laid without a tile;
``"oriented": true`` that it is no tile but a set of examples, which are bent along a field of directions.
See README.md beside this file and schemas/texture.schema.json.
"""

from __future__ import annotations

import json
import re
from itertools import chain
from typing import Any, BinaryIO

import numpy as np

from penink_cli.formats import strict_json
from penink_cli.formats.strokes import LIMIT, Sink
from penink_cli.ground.decimals import plain
from penink_cli.ground.errors import FormatError
from penink_cli.ground.model import Engraving, Floats, HatchLayer, Ints, Scales, Strokes, Texture

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
LEAST_WIDTH = 0.0001

# The strokes as `write` writes them, at the end of the text.
_STROKES = re.compile(rb',[ \t\r\n]*"strokes"[ \t\r\n]*:[ \t\r\n]*\[')
_END = re.compile(rb"[ \t\r\n]*\}[ \t\r\n]*")
#: Priorities, widths, numbers of points and the points of all strokes.
Listed = tuple[Floats, Floats, Ints, Floats]


def read(stream: BinaryIO, source: str) -> Texture:
    """Read a texture; raises FormatError that names the stroke or layer at fault."""
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
    """The text with empty lines for its strokes, and these; the text itself and None where they are not plain.

    Thousands of strokes are read in a twentieth of the time and of the memory that json needs for them.
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
    lines = b"\n" * text.count(b"\n", mark.end(), after)  # so that what else is wrong is found in its line
    return text[: mark.end()] + lines + text[after - 1 :], (priorities[:n], widths[:n], counts[:n], points[:used])


def _texture(document: dict[str, Any], listed: Listed | None) -> Texture:
    """The texture of a file; listed: its strokes, where they have been read already."""
    name = strict_json.text(strict_json.member(document, "name"), "name")
    width, height = (_size(strict_json.member(document, side), side) for side in ("width", "height"))
    whole = document.get("whole", False)
    if type(whole) is not bool:
        raise FormatError(f"whole is {strict_json.quoted(whole)}; true or false is needed")
    oriented = document.get("oriented", False)
    if type(oriented) is not bool:
        raise FormatError(f"oriented is {strict_json.quoted(oriented)}; true or false is needed")
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
    """(s, 2) from which scale to which each stroke is there; NaN for those that do not grow."""
    spans = np.full((len(items), 2), np.nan)
    for i, item in enumerate(items):
        if "scale" not in item:
            continue
        place = f"stroke {i}: scale"
        pair = strict_json.array(item["scale"], place)
        if len(pair) != 2:
            raise FormatError(f"{place} has {len(pair)} numbers; from and to are needed")
        low, high = (strict_json.number(value, place, 0.0, MOST_SCALE) for value in pair)
        if not low < high:
            raise FormatError(f"{place} is from {low:g} to {high:g}; the first must be less")
        spans[i] = low, high
    return spans


def _scaling(laid: Texture, scales: Any, spans: Floats) -> Texture:
    """The texture that grows: `laid` holds all its strokes."""
    if not isinstance(scales, dict):
        raise FormatError(f"scales is {strict_json.quoted(scales)}; an object is needed")
    if laid.layers or laid.engraving is not None or laid.oriented:
        raise FormatError("scales go with a plain tile: no layers, no engraving, not oriented")
    natural = _size(strict_json.member(scales, "natural", "scales"), "scales: natural")
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
        x = strokes[i][:, 0]
        if not LEAST_EXAMPLE <= x[-1] - x[0] <= MOST_EXAMPLE:
            on = f"{x[-1] - x[0]:g} pt on; from {LEAST_EXAMPLE:g} to {MOST_EXAMPLE:g} along x are needed"
            raise FormatError(f"oriented stroke {i}, by priority, leads {on}")


def _strokes(items: list[Any]) -> Listed:
    """The strokes of a file that is not plain.

    Values are looked at all at once; only where something is wrong one by one, to say which. 15 000 strokes of
    ten points take 90 ms so, and half a second otherwise.
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
        if not isinstance(item, dict):
            raise FormatError(f"{place} is {strict_json.quoted(item)}; an object is needed")
        strict_json.number(strict_json.member(item, "priority", place), f"{place}: priority")
        _size(strict_json.member(item, "width", place), f"{place}: width")
        control = strict_json.pairs(strict_json.member(item, "points", place), f"{place}: points", f"{place}: point")
        if len(control) % 3 != 1:
            raise FormatError(f"{place}: {len(control)} points; a chain of k cubics has 3k + 1 of them, and a dot one")
        if not (np.abs(control) <= LIMIT).all():
            raise FormatError(f"{place}: a point beyond ±{LIMIT:.0f}")
    raise AssertionError("unreachable: one of the strokes is wrong")


def _size(value: Any, what: str) -> float:
    size = strict_json.number(value, what, 0.0, LIMIT)
    if size < LEAST_WIDTH:
        raise FormatError(f"{what} is {strict_json.quoted(value)}; a number from {LEAST_WIDTH} is needed")
    return size


def _layer(value: Any, i: int) -> HatchLayer:
    place = f"layer {i}"
    if not isinstance(value, dict):
        raise FormatError(f"{place} is {strict_json.quoted(value)}; an object is needed")
    for name in _NEEDED:
        strict_json.member(value, name, place)
    layer = HatchLayer(
        **{
            field: strict_json.number(value[name], f"{place}: {name}", least, most)
            for name, (field, least, most) in _LAYER.items()
            if name in value
        }
    )
    if not layer.low < layer.high:
        raise FormatError(f'{place}: "from" is {layer.low:g} and "to" {layer.high:g}; "from" must be less')
    if layer.wave_pt > 0 and layer.wave_length_pt < 4 * layer.wave_pt:
        raise FormatError(f"{place}: a wave of {layer.wave_pt:g} pt needs a wave_length of at least four times that")
    return layer


def _engraving(value: Any) -> Engraving | None:
    """The lines that swell, where the texture has them."""
    if value is None:
        return None
    if not isinstance(value, dict):
        raise FormatError(f"engraving is {strict_json.quoted(value)}; an object is needed")
    found: dict[str, Any] = {
        field: strict_json.number(value[name], f"engraving: {name}", least, most)
        for name, (field, least, most) in _ENGRAVING.items()
        if name in value
    }
    for name in ("along", "blunt"):
        if name in value:
            if type(value[name]) is not bool:
                raise FormatError(f"engraving: {name} is {strict_json.quoted(value[name])}; true or false is needed")
            found[name] = value[name]
    if "centre" in value:
        ((x, y),) = strict_json.pairs([value["centre"]], "engraving: centre", "engraving: centre").tolist()
        if not max(abs(x), abs(y)) <= 100:
            raise FormatError("engraving: centre is beyond 100 times the sheet")
        found["centre"] = (x, y)
    if "lines" in value:
        lines = value["lines"]
        if type(lines) is not int or not 1 <= lines <= MOST_LINES:
            raise FormatError(
                f"engraving: lines is {strict_json.quoted(lines)}; a whole number from 1 to {MOST_LINES} is needed"
            )
        found["lines"] = lines
    engraving = Engraving(**found)
    if not engraving.finest_pt < engraving.spacing_pt:
        raise FormatError(
            f"engraving: finest is {engraving.finest_pt:g} and spacing {engraving.spacing_pt:g}; finest must be less"
        )
    return engraving


def _engraving_text(engraving: Engraving) -> str:
    """The member of the file."""
    members = [(name, plain(getattr(engraving, field), 4)) for name, (field, _, _) in _ENGRAVING.items()]
    if engraving.crosses == 1:
        members.pop()
    members += [(name, json.dumps(getattr(engraving, name))) for name in ("along", "blunt")]
    if engraving.centre is not None:
        members.append(("centre", "[{}, {}]".format(*(plain(v, 4) for v in engraving.centre))))
    if engraving.lines is not None:
        members.append(("lines", str(engraving.lines)))
    return "{" + ", ".join(f'"{name}": {text}' for name, text in members) + "}"


def write(out: Sink, texture: Texture) -> None:
    """Write a texture, one stroke a line; coordinates in thousandths of a point."""
    s = texture.strokes
    head = f'{{"format": "penink-texture", "version": 1, "name": {json.dumps(texture.name)}'
    head += f', "width": {plain(s.width, 3)}, "height": {plain(s.height, 3)}'
    if texture.whole:
        head += ', "whole": true'
    if texture.oriented:
        head += ', "oriented": true'
    if texture.layers:

        def members(layer: HatchLayer) -> list[tuple[str, float]]:
            values = [(name, getattr(layer, field)) for name, (field, _, _) in _LAYER.items()]
            return [(name, value) for name, value in values if value is not None]

        layers = ",\n  ".join(
            "{" + ", ".join(f'"{name}": {plain(value, 4)}' for name, value in members(layer)) + "}"
            for layer in texture.layers
        )
        head += f', "layers": [\n  {layers}]'
    if texture.engraving is not None:
        head += f', "engraving": {_engraving_text(texture.engraving)}'
    if texture.scales is not None:
        scales = texture.scales
        head += f', "scales": {{"natural": {plain(scales.natural_pt, 3)}, "least": {plain(scales.least_pt, 3)}'
        head += f', "fill": {json.dumps(scales.fill)}}}'
    out.write((head + ', "strokes": [\n').encode("ascii"))
    lines = _stroke_lines(s, texture.priorities)
    if texture.scales is not None:
        fixed = [(float(p), line) for p, line, f in zip(texture.priorities, lines, texture.scales.fixed) if f]
        grown = _stroke_lines(texture.scales.strokes, texture.scales.priorities, texture.scales.spans)
        both = [*fixed, *zip(texture.scales.priorities.tolist(), grown, strict=True)]
        lines = [line for _, line in sorted(both, key=lambda item: item[0])]
    out.write((",\n".join(lines) + "\n]}\n").encode("ascii"))


def _stroke_lines(strokes: Strokes, priorities: Floats, spans: Floats | None = None) -> list[str]:
    lines = []
    for i in range(len(strokes)):
        control = ", ".join(f"[{plain(x, 3)}, {plain(y, 3)}]" for x, y in strokes[i].tolist())
        line = f' {{"priority": {plain(float(priorities[i]), 4)}, "width": {plain(float(strokes.widths[i]), 4)}'
        if spans is not None:
            line += ', "scale": [{}, {}]'.format(*(plain(float(v), 4) for v in spans[i]))
        lines.append(line + f', "points": [{control}]}}')
    return lines
