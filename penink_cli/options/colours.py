"""A colour as an option: its code, or its name."""

from __future__ import annotations

import re
from typing import Any

import click

from penink_cli.ground.errors import in_quotes

#: The names that an ink or a layer's colour may be given by.
NAMED = {"black": "000000", "white": "ffffff", "grey": "808080", "gray": "808080", "red": "ff0000", "green": "008000",
         "blue": "0000ff", "cyan": "00ffff", "magenta": "ff00ff", "yellow": "ffff00", "brown": "a52a2a",
         "sepia": "704214", "navy": "000080", "maroon": "800000", "orange": "ffa500", "purple": "800080"}  # fmt: skip


class Colour(click.ParamType):
    """``#rrggbb``, ``#rgb`` or a name, as red, green and blue from 0 to 1."""

    name = "colour"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[float, float, float]:
        """(red, green, blue)."""
        if isinstance(value, tuple):
            return value
        code = NAMED.get(value.lower(), value.lower().removeprefix("#"))
        if re.fullmatch("[0-9a-f]{3}", code):
            code = "".join(c + c for c in code)
        if not re.fullmatch("[0-9a-f]{6}", code):
            self.fail(f"{in_quotes(value)} is not #rrggbb or one of {', '.join(NAMED)}", param, ctx)
        from penink_cli.ground.codes import of_code

        return of_code(f"#{code}")


COLOUR = Colour()
