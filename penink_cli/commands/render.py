"""``penink render``."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import click

from penink_cli.ground.errors import ParameterError, printable
from penink_cli.ground.streams import writing
from penink_cli.options.common import LENGTH, POSITIVE, filter_options, printer_option, processors, threads_option
from penink_cli.options.illustrations import read_illustration
from penink_cli.options.sheet import check_sheet

if TYPE_CHECKING:
    from penink_cli.ground.model import Illustration


@click.command()
@filter_options
@click.option("--width", type=LENGTH, help="Width of the picture on paper: 4in, 100mm, 288 (points).")
@click.option("--scale", type=POSITIVE, metavar="S", help="Size relative to the natural one, instead of --width.")
@click.option(
    "--pen",
    type=LENGTH,
    help="Draw everything with one pen of this width.  [default: the layers', finer on prints under 4 in]",
)
@printer_option()
@click.option(
    "--seed",
    type=click.IntRange(0, 2**62),
    default=0,
    show_default=True,
    metavar="N",
    help="Each number is another hand; layers with the rule threshold have only one.",
)
@click.option(
    "--layer",
    "chosen",
    metavar="NAME|N",
    help="Write that layer only, by its name or its place from 1; the others of its colour are drawn, "
    "and their ink counted.",
)
@threads_option
def render(
    file: str | None,
    output: str | None,
    max_pixels: int,
    quiet: bool,
    width: float | None,
    scale: float | None,
    pen: float | None,
    device_dpi: float | None,
    seed: int,
    chosen: str | None,
    threads: int | None,
) -> None:
    """Draw an illustration anew for one size and one device.

    FILE is an illustration, packed (*.penink) or loose. Every layer is enlarged, outlined and blasted. A strokes file
    has one colour: render each --layer of an illustration in several colours by itself.

    \b
    penink render keys.penink --width 24in --device-dpi 1200 | penink to-ps -o poster.eps
    """
    from penink_cli.formats import strokes
    from penink_cli.ground.model import Strokes
    from penink_cli.illustration.layering import layer_strokes, steps
    from penink_cli.options.progress import progress

    if width is not None and scale is not None:
        raise click.UsageError("give one of --width and --scale")
    illustration = read_illustration(file, max_pixels)
    width_pt = width if width is not None else illustration.width * (scale or 1.0)
    height_pt = width_pt * illustration.height / illustration.width
    check_sheet(width_pt, height_pt, max_pixels)
    which = range(len(illustration.layers)) if chosen is None else [_number(illustration, chosen)]
    inks = {(illustration.layers[i].color or "#000000").lower() for i in which}
    if len(inks) > 1:
        raise ParameterError(f"layers of {len(inks)} colours, and a strokes file has one; draw each with --layer")
    with progress(steps(illustration, which), "render", quiet) as advance:
        layers = layer_strokes(
            illustration, width_pt, device_dpi=device_dpi, seed=seed, threads=threads or processors(), pen_pt=pen,
            chosen=which, advance=advance,
        )  # fmt: skip
    drawn = Strokes.joined([part for layer in layers for part in layer])
    name = illustration.layers[which[0]].name if len(which) == 1 else None
    texture = illustration.layers[which[0]].texture.name if len(which) == 1 else None
    with writing(output, binary=False) as out:
        strokes.write(out, replace(drawn, layer=name, texture=texture, seed=seed))


def _number(illustration: Illustration, chosen: str) -> int:
    """The place, from 0, of the layer of that name or of that number from 1. Raises ParameterError."""
    names = [layer.name for layer in illustration.layers]
    if chosen in names:
        return names.index(chosen)
    if chosen.isascii() and chosen.isdigit() and 1 <= int(chosen[:9]) <= len(names):
        return int(chosen) - 1
    known = ", ".join(f"{i + 1} {printable(name, 60)}" if name else str(i + 1) for i, name in enumerate(names))
    raise ParameterError(f"no layer {printable(chosen, 60)}; there are {known}")
