"""``penink pack``."""

from __future__ import annotations

from typing import Any

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import LENGTH, filter_options, threads_option
from penink_cli.options.illustrations import read_illustration, settled


@click.command()
@filter_options
@click.option(
    "--max-bytes",
    type=click.IntRange(1),
    metavar="N",
    help="The best file of at most N bytes: a coarser grid, fewer edges, lines and directions.",
)
@click.option(
    "--seen-at",
    type=LENGTH,
    help="Leave out what no drawing up to this width would show.  [default: nothing]",
)
@threads_option
def pack(
    file: str | None, output: str | None, max_pixels: int, max_bytes: int | None, seen_at: float | None,
    threads: int | None, **_: Any,
) -> None:  # fmt: skip
    """Pack an illustration and its members in one small file.

    FILE is an illustration's manifest; the files it names are found beside it. The archive is a ZIP: unzipped, it is
    an illustration of loose files again, which draws the same strokes. With --seen-at the archive is made for one size;
    `penink draw -o NAME.penink` makes one for the size that it draws.

    \b
    penink pack keys.illustration.json -o keys.penink
    """
    from penink_cli.formats import archive, illustration

    whole = read_illustration(file, max_pixels)
    if max_bytes is None and seen_at is None:
        packed = archive.pack(illustration.members(whole))
    else:
        from penink_cli.illustration.fitting import packed_within

        packed = packed_within(whole, max_bytes, settled, threads, seen_at)
    with writing(output) as out:
        out.write(packed)
