"""``penink to-html``."""

from __future__ import annotations

from typing import Any

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import TEXT, filter_options
from penink_cli.options.illustrations import read_illustration


@click.command(name="to-html")
@filter_options
@click.option("--title", type=TEXT, default="Illustration", show_default=True, help="Of the page.")
@click.option("--reload", is_flag=True, help="The page loads itself anew whenever its file has changed.")
@click.option("--readable", is_flag=True, help="Keep the program's comments and layout.")
def to_html(
    file: str | None, output: str | None, max_pixels: int, title: str, readable: bool, reload: bool, **_: Any
) -> None:
    """Write an illustration as one web page that draws itself.

    FILE is an illustration, packed (*.penink) or loose. The page holds its small representation and a program that
    draws it with fresh strokes at every magnification; it needs no server and fetches nothing. The wheel, two fingers
    or + and - zoom, the arrows move. The strokes are those of blast's rule "threshold", or they follow the layer's
    directions, or swell as those of an engraving; telling lines are drawn where there is room. Rules and seeds do not
    matter.

    \b
    penink to-html keys.penink -o keys.html
    """
    from penink_cli.selfdrawing import html

    illustration = read_illustration(file, max_pixels)
    page = html.write(illustration, title, readable, reload)
    with writing(output) as out:
        out.write(page)
