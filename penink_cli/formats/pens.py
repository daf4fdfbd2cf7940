"""``*.pens.json``: the pens that a plotter has.

    {"format": "penink-pens", "version": 1, "pens": [
      {"name": "fine", "color": "#000000", "width": 0.85, "speed": 142, "refill": 85000}]}

Lengths are numbers of points, or texts with a unit as on the command line: "0.3mm". See README.md beside this file
and schemas/pens.schema.json.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, BinaryIO

from penink_cli.formats import strict_json
from penink_cli.ground.errors import FormatError, LimitError, ParameterError
from penink_cli.ground.units import parse_length

FORMAT = "penink-pens"
MAX_BYTES = 1 << 20
MAX_PENS = 64
LEAST_LENGTH = 0.01  # points
MAX_WIDTH = 72.0  # points
MAX_LENGTH = 1e7  # points; 3.5 km


@dataclass(frozen=True)
class Pen:
    """One pen.

    width: points. color: ``#rrggbb``. speed: points a second with the pen down, None for the plotter's own. refill:
    points of line after which the pen is to be refilled or changed, None for never.
    """

    name: str
    width: float
    color: str = "#000000"
    speed: float | None = None
    refill: float | None = None


def read(stream: BinaryIO, source: str) -> tuple[Pen, ...]:
    """The pens of a file. Raises FormatError, which names pen and member, and LimitError for more than MAX_BYTES."""
    text = stream.read(MAX_BYTES + 1)
    try:
        if len(text) > MAX_BYTES:
            raise LimitError(f"more than {MAX_BYTES} bytes")
        document = strict_json.header(strict_json.loads(text), FORMAT)
        items = strict_json.array(strict_json.member(document, "pens"), "pens")
        if not 1 <= len(items) <= MAX_PENS:
            raise FormatError(f"{len(items)} pens; 1 to {MAX_PENS} are allowed")
        pens = tuple(_pen(item, f"pen {i}") for i, item in enumerate(items))
        names = [pen.name for pen in pens]
        for i, name in enumerate(names):
            if name in names[:i]:
                raise FormatError(f"pen {i}: the name {strict_json.quoted(name)} is that of another")
    except (FormatError, LimitError) as error:
        from penink_cli.formats.recognise import explained

        raise explained(error, text, "pens").from_source(source) from None
    return pens


def _pen(item: Any, place: str) -> Pen:
    item = strict_json.members(item, place)
    name = strict_json.text(strict_json.member(item, "name", place), f"{place}: name")
    if not (name and len(name) <= 60 and name.isprintable()):
        raise FormatError(f"{place}: name {strict_json.quoted(name)}; 1 to 60 printable characters are needed")
    width = _length(strict_json.member(item, "width", place), f"{place}: width", MAX_WIDTH)
    more = {
        what: _length(item[what], f"{place}: {what}", MAX_LENGTH) if what in item else None
        for what in ("speed", "refill")
    }
    color = strict_json.colour(item["color"], f"{place}: color") if "color" in item else "#000000"
    return Pen(name, width, color, more["speed"], more["refill"])


def _length(value: Any, what: str, most: float) -> float:
    if type(value) is str:
        try:
            value = parse_length(value)
        except ParameterError as error:
            raise FormatError(f"{what}: {error.message}") from None
    return strict_json.number(value, what, LEAST_LENGTH, most)
