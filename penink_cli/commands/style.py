"""``penink style``."""

from __future__ import annotations

from typing import Any

import click

from penink_cli.ground.streams import source_name, writing
from penink_cli.options.common import is_file, output_options
from penink_cli.options.styles import STYLE, find_style, shipped, style_text


@click.group(name="style")
@click.help_option("-h", "--help")
def style() -> None:
    """List and show styles of drawing.

    A style is a file that tells the filters their options: how light a drawing is to be, whether it has telling
    lines, with which strokes and along what it is hatched. `penink draw --style` follows it.

    \b
    penink style list
    penink style show engraving -o mine.style.json
    penink draw --style mine.style.json photo.jpg -o photo.pdf
    """


@style.command(name="list")
@output_options
def list_styles(output: str | None, **_: Any) -> None:
    """Name the styles that come with the program, and say what each is like."""
    text = "".join(f"{name:12} {find_style(name).description}".rstrip() + "\n" for name in shipped())
    with writing(output, binary=False) as out:
        out.write(text.encode("utf-8"))


@style.command()
@click.argument("name", metavar="NAME|FILE", type=STYLE)
@output_options
def show(name: str, output: str | None, **_: Any) -> None:
    """Write a style's file, to be changed and used; a file of your own is checked first."""
    from penink_cli.chain.words import check
    from penink_cli.formats import style as style_format

    if is_file(name):
        found = find_style(name)
        check(found, source_name(name))
        text = style_format.text(found)
    else:
        text = style_text(name)
    with writing(output, binary=False) as out:
        out.write(text)


