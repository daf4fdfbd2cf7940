"""Finding a style by the value of ``--style``: one of the shipped ones by name, or a file."""

from __future__ import annotations

import io
import os
from typing import TYPE_CHECKING

from penink_cli import styles
from penink_cli.ground.errors import ParameterError, printable
from penink_cli.ground.streams import reading, source_name
from penink_cli.options.common import NameOrFile, is_file

if TYPE_CHECKING:
    from penink_cli.formats.style import Style

ENDING = ".style.json"
_FOLDER = os.path.dirname(styles.__file__)  # `importlib.resources` takes longer to load than all else here


def shipped() -> list[str]:
    """Names of the styles that come with the program."""
    return sorted(name.removesuffix(ENDING) for name in os.listdir(_FOLDER) if name.endswith(ENDING))


STYLE = NameOrFile(shipped)


def style_text(name: str) -> bytes:
    """The file of a shipped style. Raises ParameterError, which names those that there are."""
    if name not in shipped():
        raise ParameterError(f"no style {printable(name, 60)}; known are {', '.join(shipped())}, or give a file")
    with open(os.path.join(_FOLDER, name + ENDING), "rb") as file:
        return file.read()


def find_style(name: str) -> Style:
    """The shipped style of that name, or the one in that file (see `is_file`).

    Raises ParameterError for an unknown name and FormatError for a file.
    """
    from penink_cli.formats import style

    if is_file(name):
        with reading(name) as stream:
            return style.read(stream, source_name(name))
    return style.read(io.BytesIO(style_text(name)), name + ENDING)
