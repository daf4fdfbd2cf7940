"""What the to-* subcommands share: strokes files, each a layer."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import click

from penink_cli.errors import ParameterError
from penink_cli.formats import strokes
from penink_cli.model import Strokes
from penink_cli.streams import reading, source_name

F = TypeVar("F", bound=Callable[..., Any])

files_argument = click.argument("files", nargs=-1, metavar="[FILE]...", type=click.Path(allow_dash=True))


def read_layers(files: Sequence[str]) -> list[Strokes]:
    """The layers, the first at the bottom; no file is standard input."""
    paths = list(files) or ["-"]
    if paths.count("-") > 1:
        raise ParameterError("standard input can be one layer only")
    layers = []
    for path in paths:
        with reading(path) as stream:
            layers.append(strokes.read(stream, source_name(path)))
    return layers
