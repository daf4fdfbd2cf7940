"""``penink to-ps``."""

from __future__ import annotations

from typing import Any

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import Finite, is_given, output_options
from penink_cli.options.layers import colour_option, colours_of, files_argument, page_options, read_layers

OF_STROKES = ("paper", "margin", "landscape", "at", "colours", "device_dpi", "compress", "separations", "preview")
OF_SELF = ("level", "readable")


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
@click.option("--separations", is_flag=True, help="For a press: a plate a page, each layer by itself and in black.")
@click.option(
    "--preview", is_flag=True, help="In an EPS, a small grey picture for programs that run no PostScript (EPSI)."
)
@click.option("--compress", is_flag=True, help="Deflate the strokes: half the size, for PostScript Level 3.")
@click.option(
    "--self", "self_drawing", is_flag=True, help="FILE is an illustration: write an EPS that draws itself at any size."
)
@click.option("--level", type=click.Choice(["2", "3"]), default="3", help="With --self: PostScript level to keep to.")
@click.option("--readable", is_flag=True, help="With --self: the program with its comments, not packed.")
@output_options
def to_ps(
    files: tuple[str, ...],
    paper: str | None,
    margin: float,
    landscape: bool,
    at: tuple[float, float] | None,
    colours: tuple[tuple[float, float, float], ...],
    device_dpi: float | None,
    compress: bool,
    preview: bool,
    separations: bool,
    self_drawing: bool,
    level: str,
    readable: bool,
    output: str | None,
    max_pixels: int,
    **_: Any,
) -> None:
    """Write strokes as PostScript.

    The result is an EPS file, to be included in documents or converted; with --paper it is a page
    to be printed. Several FILEs are layers, the first at the bottom. Strokes are written in the
    order that makes the file small, and coloured ones cover what lies below; to-pdf has transparent inks.

    With --self the printer does the work: the small representation itself is written, and a program that draws it with
    fresh strokes for the size at which it is placed and the device's resolution. The strokes are those of blast's rule
    "threshold", or lines that swell, straight or in rings, and the telling lines that there is room for; the layers'
    directions, rules and seeds do not matter. Print shops, and programs that convert PostScript to something else, are
    better given strokes.

    \b
    penink blast --texture crosshatch --width 4in photo.pgm | penink to-ps -o photo.eps
    penink to-ps --paper a4 --margin 15mm photo.strokes.jsonl | lpr
    """
    _refuse_what_is_ignored(self_drawing)
    if self_drawing:
        write_self_drawing(files, output, "readable" if readable else "flate" if level == "3" else "lzw", max_pixels)
        return
    if preview and (paper is not None or separations):
        raise click.UsageError(f"--preview is of an EPS; with {'--paper' if paper else '--separations'} it is a page")
    from dataclasses import replace

    from penink_cli.outputs import postscript
    from penink_cli.outputs.page import lay_out
    from penink_cli.travel.order import ordered_each

    layers = read_layers(files)
    if device_dpi is not None:
        from penink_cli.ground.device import narrowed

        layers = [narrowed(layer, device_dpi) for layer in layers]
    page, inks = lay_out(layers, paper, margin, landscape, at), colours_of(layers, colours)
    if separations and page.paper is None:
        page = replace(page, paper="plate")
    with writing(output, binary=False) as out:
        postscript.write(out, layers, page, inks, compress, ordered_each, separations, preview)


def _refuse_what_is_ignored(self_drawing: bool) -> None:
    """Raise UsageError for an option that says nothing with --self, or nothing without it."""
    context = click.get_current_context()
    for option in context.command.params:
        if option.name in (OF_STROKES if self_drawing else OF_SELF) and is_given(option.name):
            why = "is of strokes, and does not go with --self" if self_drawing else "goes with --self"
            raise click.UsageError(f"{option.opts[0]} {why}")


def write_self_drawing(files: tuple[str, ...], output: str | None, packing: str, max_pixels: int) -> None:
    """Write the illustration in the one file given as an EPS that draws itself. Raises UsageError for several files.

    packing: as of `selfdrawing.postscript.write`.
    """
    from penink_cli.options.common import warn
    from penink_cli.options.illustrations import read_illustration
    from penink_cli.selfdrawing import postscript as selfdrawing
    from penink_cli.selfdrawing.data import follows

    if len(files) > 1:
        raise click.UsageError("--self takes one illustration")
    illustration = read_illustration(files[0] if files else None, max_pixels)
    program = selfdrawing.write(illustration, packing)
    straight = [str(i) for i, layer in enumerate(illustration.layers, 1) if follows(layer)]
    if straight:
        which = f"layer {straight[0]} is" if len(straight) == 1 else f"layers {', '.join(straight)} are"
        warn(f"{which} drawn straight: a printer has no time to follow directions")
    with writing(output) as out:
        out.write(program)
