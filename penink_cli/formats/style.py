"""``*.style.json``: options of the filters under one name.

One JSON text::

    {"format": "penink-style", "version": 1, "description": "one layer of hatching on much paper",
     "compose": {"strength": 0.9, "target": "high-key"}, "blast": {"texture": "parallel", "pen": "0.5pt"}}

Each member holds the options of one stage, by their names on the command line. See README.md beside this file and
schemas/style.schema.json.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import BinaryIO

from penink_cli.formats import strict_json
from penink_cli.ground.errors import FormatError

MAX_BYTES = 1 << 20
#: The stages that a style may have options for.
STAGES = ("compose", "edges", "lines", "directions", "outline", "blast")

Value = str | float | bool


@dataclass(frozen=True)
class Style:
    """description: a line of text. stages: the values of options, by their names, of each stage that the style has."""

    description: str = ""
    stages: dict[str, dict[str, Value]] = field(default_factory=dict)


def read(stream: BinaryIO, source: str) -> Style:
    """Read a style; raises FormatError that names the member at fault. Names of options are not looked at."""
    text = stream.read(MAX_BYTES + 1)
    try:
        if len(text) > MAX_BYTES:
            raise FormatError(f"larger than {MAX_BYTES} bytes")
        document = strict_json.header(strict_json.loads(text), "penink-style")
        description = strict_json.text(document.get("description", ""), "description")
        stages = {}
        for stage in STAGES:
            if stage in document:
                options = strict_json.members(document[stage], stage)
                for name, value in options.items():
                    if type(value) not in (str, int, float, bool):
                        place = f"{stage}: {strict_json.quoted(name)}"
                        raise FormatError(f"{place} is {strict_json.quoted(value)}; a number, text or true is needed")
                stages[stage] = options
        return Style(description, stages)
    except FormatError as error:
        from penink_cli.formats.recognise import explained

        raise explained(error, text, "style").from_source(source) from None


def text(style: Style) -> bytes:
    """The file of a style, a line for each stage."""
    members = {"format": "penink-style", "version": 1, "description": style.description, **style.stages}
    lines = (f"{json.dumps(name)}: {json.dumps(value, ensure_ascii=False)}" for name, value in members.items())
    return ("{" + ",\n ".join(lines) + "}\n").encode()
