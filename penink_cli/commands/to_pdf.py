"""``penink to-pdf``."""

from __future__ import annotations

from typing import Any

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import output_options
from penink_cli.options.layers import (
    as_printed,
    colour_option,
    colours_of,
    files_argument,
    gain_option,
    page_options,
    read_layers,
)


@click.command(name="to-pdf")
@files_argument
@page_options
@colour_option
@gain_option
@output_options
def to_pdf(
    files: tuple[str, ...],
    paper: str | None,
    margin: float,
    landscape: bool,
    colours: tuple[tuple[float, float, float], ...],
    device_dpi: float | None,
    output: str | None,
    **_: Any,
) -> None:
    """Write strokes as a PDF page of vector paths.

    The page has the picture's size, or is the --paper. Several FILEs are layers, the first at the
    bottom, which viewers can switch on and off.

    \b
    penink to-pdf photo.strokes.jsonl -o photo.pdf
    penink to-pdf --paper letter --margin 0.5in photo.strokes.jsonl -o photo.pdf
    """
    from penink_cli.outputs import pdf
    from penink_cli.outputs.page import lay_out

    layers = as_printed(read_layers(files), device_dpi)
    page = lay_out(layers, paper, margin, landscape)
    with writing(output) as out:
        pdf.write(out, layers, page, colours_of(layers, colours))
