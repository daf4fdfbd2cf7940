"""``penink pack``."""

from __future__ import annotations

from typing import Any

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import filter_options
from penink_cli.options.inputs import read_illustration


@click.command()
@filter_options
def pack(file: str | None, output: str | None, max_pixels: int, **_: Any) -> None:
    """Pack an illustration and its members in one small file.

    FILE is an illustration's manifest; the files it names are found beside it. The archive is a ZIP: unzipped, it is
    an illustration of loose files again, which draws the same strokes.

    \b
    penink pack keys.illustration.json -o keys.penink
    """
    from penink_cli.formats import archive, illustration

    packed = archive.pack(illustration.members(read_illustration(file, max_pixels)))
    with writing(output) as out:
        out.write(packed)
