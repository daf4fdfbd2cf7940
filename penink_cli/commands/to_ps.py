"""``penink to-ps``."""

from __future__ import annotations

from typing import Any

import click

from penink_cli.formats import postscript
from penink_cli.layer_options import files_argument, read_layers
from penink_cli.options import output_options
from penink_cli.streams import writing


@click.command(name="to-ps")
@files_argument
@output_options
def to_ps(files: tuple[str, ...], output: str | None, **_: Any) -> None:
    """Write strokes as PostScript.

    The result is an EPS file (it can be included in documents as well as printed). Several FILEs
    are layers, the first at the bottom.

    \b
    penink blast --texture crosshatch --width 4in photo.pgm | penink to-ps -o photo.ps
    """
    layers = read_layers(files)
    with writing(output, binary=False) as out:
        postscript.write(out, layers)
