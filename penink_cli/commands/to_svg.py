"""``penink to-svg``."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import LENGTH, output_options, verbose_option
from penink_cli.options.layers import (
    as_printed,
    colour_option,
    colours_of,
    files_argument,
    for_a_pen,
    gain_option,
    page_options,
    read_layers,
    report_travel,
    travel_options,
)


@click.command(name="to-svg")
@files_argument
@page_options
@colour_option
@gain_option
@click.option(
    "--centre-lines",
    "--center-lines",
    is_flag=True,
    help="For a plotter: of strokes that swell their middle, not their outline.",
)
@click.option(
    "--passes",
    type=LENGTH,
    metavar="PEN",
    help="For a plotter: strokes that swell as parallel lines that make their width with a pen of this one.",
)
@travel_options
@verbose_option
@output_options
def to_svg(
    files: tuple[str, ...],
    paper: str | None,
    margin: float,
    landscape: bool,
    colours: tuple[tuple[float, float, float], ...],
    device_dpi: float | None,
    centre_lines: bool,
    passes: float | None,
    order: bool,
    join: float,
    speed: float | None,
    verbose: bool,
    output: str | None,
    quiet: bool,
    **_: Any,
) -> None:
    """Write strokes as SVG, for drawing programs, the web, plotters.

    Each stroke is a path of its real width, in millimetres; of one that swells it is the outline,
    filled. Several FILEs are layers, the first at the bottom, and Inkscape and vpype see them as
    layers. With --order a plotter draws them with little travel between them.

    \b
    penink to-svg photo.strokes.jsonl -o photo.svg
    penink to-svg --order --speed 50mm --paper a4 --margin 1cm photo.strokes.jsonl -o photo.svg
    """
    if centre_lines and passes is not None:
        raise click.UsageError("give one of --centre-lines and --passes")
    from penink_cli.outputs import svg, swelling
    from penink_cli.outputs.page import lay_out

    layers = as_printed(read_layers(files), device_dpi)
    if centre_lines:
        layers = [replace(layer, knot_widths=None) for layer in layers]
    elif passes is not None:
        layers = [swelling.passes(layer, passes) for layer in layers]
    page = lay_out(layers, paper, margin, landscape)
    if order:
        layers = for_a_pen(layers, join, speed, verbose, quiet)
    else:
        report_travel(layers, layers, speed, verbose)
    with writing(output, binary=False) as out:
        svg.write(out, layers, page, colours_of(layers, colours))
