"""``penink to-svg``."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import click

from penink_cli.ground.codes import code_of
from penink_cli.ground.streams import reading, source_name, writing
from penink_cli.options.common import LENGTH, is_given, output_options, verbose_option
from penink_cli.options.inputs import only_one_standard_input
from penink_cli.options.layers import (
    as_printed,
    colour_option,
    colours_of,
    files_argument,
    for_a_pen,
    gain_option,
    page_options,
    plotter_of,
    read_layers,
    travel_options,
    travel_report,
)

if TYPE_CHECKING:
    from penink_cli.formats.pens import Pen


@click.command(name="to-svg")
@files_argument
@page_options
@colour_option
@gain_option
@click.option(
    "--centre-lines",
    "--center-lines",
    is_flag=True,
    help="For a plotter: draw the middle line of a stroke that swells, not its outline.",
)
@click.option(
    "--passes",
    type=LENGTH,
    metavar="PEN",
    help="For a plotter: draw a stroke that swells as parallel lines of a pen of this width, which make its own.",
)
@click.option("--merge", is_flag=True, help="One path a width: a smaller file, which drawing programs open faster.")
@click.option(
    "--pens",
    "pens_file",
    type=click.Path(allow_dash=True),
    metavar="FILE",
    help="The plotter's pens (*.pens.json): a layer a pen, of the nearest colour and width, as an AxiDraw reads them.",
)
@click.option(
    "--split-length",
    type=LENGTH,
    metavar="LENGTH",
    help="After so much line of a pen begin a new layer, before which an AxiDraw waits.  [default: as --pens says]",
)
@travel_options
@verbose_option
@output_options
def to_svg(
    files: tuple[str, ...],
    paper: str | None,
    margin: float,
    landscape: bool,
    at: tuple[float, float] | None,
    colours: tuple[tuple[float, float, float], ...],
    device_dpi: float | None,
    centre_lines: bool,
    passes: float | None,
    merge: bool,
    pens_file: str | None,
    split_length: float | None,
    order: bool,
    join: float,
    pen: float | None,
    speed: float | None,
    travel_speed: float | None,
    accel: float | None,
    lift: float | None,
    verbose: bool,
    output: str | None,
    quiet: bool,
    **_: Any,
) -> None:
    """Write strokes as SVG, for drawing programs, the web, plotters.

    Each stroke is a path of its real width, in millimetres; a stroke that swells is its outline, filled. Several FILEs
    are layers, the first at the bottom, and Inkscape and vpype see them as layers. With --order strokes follow one
    another so that a plotter travels little.

    With --speed, --lift, --accel, --travel-speed or --verbose the time that a plotter takes is told: one that speeds
    up, slows down for corners and lifts its pen, as an AxiDraw does, unless these options say otherwise.

    \b
    penink to-svg photo.strokes.jsonl -o photo.svg
    penink to-svg --order --speed 50mm --paper a4 --margin 1cm photo.strokes.jsonl -o photo.svg
    """
    if centre_lines and passes is not None:
        raise click.UsageError("give one of --centre-lines and --passes")
    if not order and is_given("join"):
        raise click.UsageError("--join goes with --order")
    if pens_file is not None and pen is not None:
        raise click.UsageError("--pens says what --pen says")
    only_one_standard_input(*(files or ("-",)), pens_file)
    from penink_cli.outputs import penwork, svg, swelling
    from penink_cli.outputs.page import lay_out
    from penink_cli.travel import clock

    pens = None if pens_file is None else _pens(pens_file)
    layers = as_printed(read_layers(files), device_dpi)
    if centre_lines:
        layers = [replace(layer, knot_widths=None) for layer in layers]
    elif passes is not None:
        layers = [swelling.passes(layer, passes) for layer in layers]
    if pen is not None:
        layers = [clock.with_one_pen(layer, pen) for layer in layers]
    page = lay_out(layers, paper, margin, landscape, at)
    inks = colours_of(layers, colours)
    by: list[Pen | None] = [None] * len(layers)
    if pens is not None:
        layers = [replace(layer, color=code_of(ink)) for layer, ink in zip(layers, inks, strict=True)]
        found = penwork.by_pen(layers, pens)
        if found:
            layers, by = [strokes for strokes, _ in found], [own for _, own in found]
        inks = colours_of(layers, ())
    before = layers
    if order:
        layers = for_a_pen(layers, join, quiet, merge)
    elif merge:
        layers = [penwork.merged(layer) for layer in layers]
    loads = [
        (load, i)
        for i, layer in enumerate(layers)
        for load in penwork.loads(layer, by[i], split_length, first=i == 0)
    ]
    labels = [load.label(number, load.strokes.layer) for number, (load, _) in enumerate(loads, 1)]
    drawn = [load.strokes for load, _ in loads]
    if verbose or any(value is not None for value in (speed, travel_speed, accel, lift)):
        plotter = plotter_of(speed, travel_speed, accel, lift)
        seconds = clock.seconds_by_speeds(
            [(load.strokes, None if load.pen is None else load.pen.speed) for load, _ in loads], plotter, page.x, page.y
        )
        line = travel_report(before, before if layers is before else layers, seconds)
        waits = len([load for load, _ in loads if load.waits])
        click.echo(line + f" and {waits} pauses" * (waits > 0), err=True)
    with writing(output, binary=False) as out:
        svg.write(out, drawn, page, [inks[i] for _, i in loads], labels, merge)


def _pens(path: str) -> tuple[Pen, ...]:
    from penink_cli.formats import pens

    with reading(path) as stream:
        return pens.read(stream, source_name(path))
