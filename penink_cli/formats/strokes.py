"""``*.strokes.jsonl``: pen strokes, one JSON text a line.

The first line is the header, the sheet in points::

    {"format": "penink-strokes", "version": 1, "width": 288.000, "height": 192.000, "texture": "crosshatch", "seed": 0}

and every further line a stroke, a chain of k cubic Bézier segments with 3k + 1 control
points, or a dot with one; a stroke that swells has the width at each of its k + 1 knots besides::

    {"width": 0.4000, "points": [[10.000, 20.000], [14.100, 20.300], [18.000, 20.300], [22.000, 20.000]]}
    {"width": 0.3000, "points": [[1.000, 2.000], … [9.000, 2.000]], "widths": [0.2000, 0.4000]}

x right, y down, from the sheet's top-left corner; strokes may reach over the sheet. Lines
end at ``\\n`` and nowhere else; none is empty. No number is larger than 10⁷, no line longer
than 16 MiB. See README.md beside this file and schemas/strokes.schema.json.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, BinaryIO, Protocol

import numpy as np

from penink_cli.formats import strict_json
from penink_cli.formats._compiled import plain_json as _plain_json
from penink_cli.formats._compiled import stroke_lines as _stroke_lines
from penink_cli.ground.errors import FormatError, LimitError, ParameterError
from penink_cli.ground.model import Strokes

MOST_SEED = 2**63 - 1
LIMIT = 1e7  # points; 3.5 km. Keeps thousandths exact and every format's integers within 32 bits
LEAST_DPI = 0.001  # of a printer, as written
MAX_LINE = 16 << 20  # bytes
MAX_POINTS = 50_000_000  # of all strokes: 0.8 GB
BLOCK = 1 << 20  # bytes read at a time
BATCH = 1 << 14  # strokes written at a time


def read(stream: BinaryIO, source: str) -> Strokes:
    """The strokes of a whole file. Raises FormatError and LimitError, which name the line at fault."""
    try:
        return _read(stream)
    except (FormatError, LimitError) as error:
        raise error.from_source(source) from None


def _read(stream: BinaryIO) -> Strokes:
    line_number = 0
    header: dict[str, Any] | None = None
    points: list[np.ndarray] = []
    counts: list[np.ndarray] = []
    widths: list[np.ndarray] = []
    knots: list[np.ndarray] = []
    any_swells = False
    total = 0
    for text in _blocks(stream):
        start = 0
        if header is None:
            start = text.index(b"\n") + 1
            try:
                header = _header(text[: start - 1])
            except FormatError as error:
                from penink_cli.formats.recognise import explained

                raise explained(error, text, "strokes") from None
            line_number = 1
        # A point takes at least 6 bytes and a stroke 28, so the arrays have room for all that the text can hold.
        block_points = np.empty(((len(text) - start) // 6 + 2, 2))
        block_counts = np.empty((len(text) - start) // 28 + 2, np.int64)
        block_widths = np.empty(len(block_counts))
        block_knots = np.empty(len(block_points))
        while start < len(text):
            start, strokes, used, swells = _plain_json.strokes(
                text, start, LIMIT, block_points, block_counts, block_widths, block_knots
            )
            line_number += strokes
            total += used
            if total > MAX_POINTS:
                raise LimitError(f"line {line_number}: more than {MAX_POINTS} points")
            points.append(block_points[:used].copy())
            counts.append(block_counts[:strokes].copy())
            widths.append(block_widths[:strokes].copy())
            knots.append(block_knots[: (used + 2 * strokes) // 3].copy())
            any_swells |= swells
            if start < len(text):  # a line that is not plain: json reads it, or says what is wrong
                line_number += 1
                end = text.index(b"\n", start)
                width, control, at_knots = _stroke(text[start:end], line_number)
                points.append(control)
                counts.append(np.array([len(control)], np.int64))
                widths.append(np.array([width]))
                knots.append(np.full((len(control) + 2) // 3, width) if at_knots is None else at_knots)
                any_swells |= at_knots is not None
                start = end + 1
    if header is None:
        raise FormatError("empty; the first line of a strokes file is its header")
    first = np.zeros(1 + sum(map(len, counts)), np.int64)
    if counts:
        np.cumsum(np.concatenate(counts), out=first[1:])
    return Strokes(
        points=np.concatenate(points) if points else np.zeros((0, 2)),
        first=first,
        widths=np.concatenate(widths) if widths else np.zeros(0),
        knot_widths=np.concatenate(knots) if any_swells else None,
        **header,
    )


def _blocks(stream: BinaryIO) -> Iterator[bytes]:
    """The stream in blocks of whole lines, each ended by its newline, the last one too. Raises FormatError."""
    rest: list[bytes] = []
    held = 0
    line_number = 1
    while block := stream.read(BLOCK):
        cut = block.rfind(b"\n") + 1
        if held + (block.find(b"\n") if cut else len(block)) > MAX_LINE:
            raise FormatError(f"line {line_number}: longer than {MAX_LINE} bytes")
        if cut:
            text = b"".join((*rest, block[:cut]))
            line_number += text.count(b"\n")
            yield text
            rest, held = [block[cut:]], len(block) - cut
        else:
            rest.append(block)
            held += len(block)
    if held:
        yield b"".join((*rest, b"\n"))


def _header(line: bytes) -> dict[str, Any]:
    """The header's members, by their names in Strokes. Raises FormatError."""
    value = strict_json.header(_json(line, 1), "penink-strokes", "line 1")
    header: dict[str, Any] = {}
    for side in ("width", "height"):
        header[side] = _size(value, side, 1)
    for name in ("layer", "texture"):
        header[name] = strict_json.text(value[name], f"line 1: {name}") if name in value else None
    header["seed"] = None
    if "seed" in value:
        header["seed"] = strict_json.whole(value["seed"], "line 1: seed", -MOST_SEED, MOST_SEED)
    color = header["color"] = value.get("color")
    if "color" in value:
        strict_json.colour(color, "line 1: color")
    dpi = header["device_dpi"] = value.get("device_dpi")
    if dpi is not None:
        _size(value, "device_dpi", 1)
    return header


def _stroke(line: bytes, line_number: int) -> tuple[float, np.ndarray, np.ndarray | None]:
    """Width, control points (3k + 1, 2) and, where the stroke has them, widths at the knots (k + 1,) of one line.

    Raises FormatError.
    """
    value = _json(line, line_number)
    if type(value) is not dict:
        raise FormatError(f"line {line_number}: {strict_json.quoted(value)} is not a stroke")
    width = _size(value, "width", line_number)
    points = strict_json.member(value, "points", f"line {line_number}")
    if not isinstance(points, list) or len(points) % 3 != 1:
        found = f"{len(points)} points" if isinstance(points, list) else f"points {strict_json.quoted(points)}"
        raise FormatError(f"line {line_number}: {found}; a stroke has 3k + 1 of them, a list of [x, y]")
    control = strict_json.pairs(points, f"line {line_number}: points", f"line {line_number}: point")
    for k in np.flatnonzero((np.abs(control) > LIMIT).any(axis=1)):
        raise FormatError(f"line {line_number}: point {k}: {strict_json.quoted(points[k])} is beyond ±{LIMIT:.0f}")
    return width, control, _at_knots(value, width, (len(points) + 2) // 3, line_number)


def _at_knots(value: dict[str, Any], width: float, count: int, line_number: int) -> np.ndarray | None:
    """Widths at the ``count`` knots (count,), None where the stroke has one width. Raises FormatError."""
    if "widths" not in value:
        return None
    widths = value["widths"]
    if not isinstance(widths, list) or len(widths) != count:
        found = f"{len(widths)} widths" if isinstance(widths, list) else f"widths {strict_json.quoted(widths)}"
        raise FormatError(f"line {line_number}: {found}; a stroke of {count - 1} segments has {count}, one a knot")
    for k, number in enumerate(widths):
        strict_json.number(number, f"line {line_number}: width {k} of widths", 0, LIMIT)
    mean = math.fsum(widths) / count
    if not _plain_json.agree(width, mean):
        raise FormatError(f"line {line_number}: width {width:g} is not the mean of its widths, {mean:g}")
    return np.array(widths, np.float64)


def _size(value: dict[str, Any], name: str, line_number: int) -> float:
    place = f"line {line_number}"
    number = strict_json.number(strict_json.member(value, name, place), f"{place}: {name}")
    if not 0 < number <= LIMIT:
        least = f"a number above 0, up to {LIMIT:.0f}," if number > 0 else "a number above 0"
        raise FormatError(f"{place}: {name} is {strict_json.quoted(value[name])}; {least} is needed")
    return number


def _json(line: bytes, line_number: int) -> Any:
    return strict_json.loads(line, None, f"line {line_number}")


class Sink(Protocol):
    """Whatever bytes can be written to: a file, or an `Output` of `ground.streams`."""

    def write(self, data: Any, /) -> int:
        """Take all of the bytes."""


class Writer:
    """Writes a strokes file piece by piece; the header goes out at once.

    width, height: the sheet in points. layer, texture, seed, color, device_dpi: as `Strokes` has them.

    Raises ParameterError for a sheet or a text that could not be read again.
    """

    def __init__(
        self,
        out: Sink,
        width: float,
        height: float,
        layer: str | None = None,
        texture: str | None = None,
        seed: int | None = None,
        color: str | None = None,
        device_dpi: float | None = None,
    ):
        for name, side in (("width", width), ("height", height)):
            if not (math.isfinite(side) and 0 < side <= LIMIT):
                raise ParameterError(f"a sheet {side:g} points in {name}; a strokes file holds up to {LIMIT:.0f}")
        text = f'{{"format": "penink-strokes", "version": 1, "width": {max(width, 0.001):.3f}'
        text += f', "height": {max(height, 0.001):.3f}'
        for name, value in (("layer", layer), ("texture", texture), ("seed", seed), ("color", color)):
            if value is not None:
                shown = strict_json.written(value, name) if isinstance(value, str) else str(value)
                text += f', "{name}": {shown}'
        printer = "null" if device_dpi is None else format(max(device_dpi, LEAST_DPI), ".3f")
        text += f', "device_dpi": {printer}'
        self._out = out
        self._written = 0
        out.write(text.encode("ascii") + b"}\n")

    def add(self, strokes: Strokes) -> None:
        """Append strokes; their own header members are not looked at.

        Coordinates are rounded to thousandths of a point, widths to ten-thousandths (never to 0).
        Raises ParameterError for a number that is not finite or larger than the format allows.
        """
        points = np.ascontiguousarray(strokes.points, np.float64)
        first = np.ascontiguousarray(strokes.first, np.int64)
        widths = np.ascontiguousarray(strokes.widths, np.float64)
        knots = np.zeros(0)
        if strokes.knot_widths is not None:
            knots = np.ascontiguousarray(strokes.knot_widths, np.float64)
        for start in range(0, len(widths), BATCH):
            stop = min(start + BATCH, len(widths))
            a_point = 46 if len(knots) else 32
            room = np.empty((stop - start) * 64 + int(first[stop] - first[start]) * a_point, np.uint8)
            size = _stroke_lines.put(points, first, widths, knots, start, stop, LIMIT, room)
            if size < 0:
                raise ParameterError(
                    f"stroke {self._written - 1 - size}: a number beyond ±{LIMIT:.0f} points, or a width of nothing"
                )
            self._out.write(room[:size].data)
        self._written += len(widths)


def write(out: Sink, strokes: Strokes) -> None:
    """Write a whole strokes file. Raises ParameterError as `Writer` does."""
    s = strokes
    Writer(out, s.width, s.height, s.layer, s.texture, s.seed, s.color, s.device_dpi).add(s)
