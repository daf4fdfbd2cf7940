"""``penink to-ps``."""

from __future__ import annotations

from typing import Any

import click

from penink_cli.layer_options import colour_option, files_argument, page_options, read_layers
from penink_cli.options import Finite, output_options
from penink_cli.streams import writing


@click.command(name="to-ps")
@files_argument
@page_options
@colour_option
@click.option(
    "--device-dpi",
    type=Finite(10, 100_000),
    metavar="N",
    help="Narrow the strokes by what a printer of N dots an inch adds; for strokes blasted with --device-dpi none.",
)
@click.option("--compress", is_flag=True, help="Deflate the strokes: half the size, for PostScript Level 3.")
@output_options
def to_ps(
    files: tuple[str, ...],
    paper: str | None,
    margin: float,
    landscape: bool,
    colours: tuple[tuple[float, float, float], ...],
    device_dpi: float | None,
    compress: bool,
    output: str | None,
    **_: Any,
) -> None:
    """Write strokes as PostScript.

    The result is an EPS file, to be included in documents or converted; with --paper it is a page
    to be printed. Several FILEs are layers, the first at the bottom. Strokes are written in the
    order that makes the file small.

    \b
    penink blast --texture crosshatch --width 4in photo.pgm | penink to-ps -o photo.eps
    penink to-ps --paper a4 --margin 15mm photo.strokes.jsonl | lpr
    """
    from functools import partial

    from penink_cli.formats import postscript
    from penink_cli.formats.page import lay_out
    from penink_cli.travel.order import ordered

    layers = read_layers(files)
    if device_dpi is not None:
        from penink_cli.formats.gain import narrowed

        layers = [narrowed(layer, device_dpi) for layer in layers]
    page = lay_out(layers, paper, margin, landscape)
    with writing(output, binary=False) as out:
        postscript.write(out, layers, page, colours, compress, order=partial(ordered, improve=False))
