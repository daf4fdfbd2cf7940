"""Finding a texture by the value of ``--texture``: one of the shipped ones by name, or a file."""

from __future__ import annotations

import gzip
import io
import os
from collections.abc import Callable
from functools import lru_cache
from typing import TYPE_CHECKING, Any, TypeVar

import click

from penink_cli import textures
from penink_cli.ground.errors import ParameterError, printable
from penink_cli.ground.streams import reading, source_name
from penink_cli.options.common import NameOrFile, is_file
from penink_cli.textures.registry import KINDS

if TYPE_CHECKING:
    from penink_cli.ground.model import Texture

F = TypeVar("F", bound=Callable[..., Any])

ENDING = ".texture.json.gz"


def shipped() -> list[str]:
    """Names of the textures that come with the program."""
    return sorted(KINDS)


TEXTURE = NameOrFile(shipped)

texture_option = click.option(
    "-t",
    "--texture",
    "texture_name",
    type=TEXTURE,
    default="crosshatch",
    show_default=True,
    metavar="NAME|FILE",
    help="A shipped texture (see penink texture list) or a texture file.",
)


def find_texture(name: str) -> Texture:
    """The shipped texture of that name, or the one in that file (see `is_file`).

    Raises ParameterError for an unknown name and FormatError for a file.
    """
    from penink_cli.formats import texture as texture_format

    if is_file(name):
        with reading(name) as stream:
            return texture_format.read(stream, source_name(name))
    return shipped_texture(name)


def shipped_texture(name: str) -> Texture:
    """The texture of that name that comes with the program. Raises ParameterError, which names those that there are."""
    if name not in shipped():
        raise ParameterError(f"no texture {printable(name, 60)}; known are {', '.join(shipped())}, or give a file")
    return _shipped(name)


@lru_cache(maxsize=2)
def _shipped(name: str) -> Texture:
    """A shipped texture. `draw` asks for the same one several times, and its file never changes."""
    from penink_cli.formats import texture as texture_format

    try:
        with open(os.path.join(os.path.dirname(textures.__file__), "tiles", name + ENDING), "rb") as file:
            packed = file.read()
    except FileNotFoundError:
        return texture_format.read(io.BytesIO(made(name)), name)  # `make manual` has not packed it: some seconds
    return texture_format.read(io.BytesIO(gzip.decompress(packed)), name + ENDING)


def made(name: str) -> bytes:
    """The file of the shipped texture of that name, made anew."""
    from penink_cli.formats import texture as texture_format
    from penink_cli.textures.make import make

    out = io.BytesIO()
    texture_format.write(out, make(name))
    return out.getvalue()
