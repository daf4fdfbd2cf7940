"""``penink to-pgm``, which is ``to-png`` too."""

from __future__ import annotations

from typing import Any

import click

from penink_cli.ground.errors import ParameterError
from penink_cli.ground.streams import writing
from penink_cli.options.common import Finite, output_options, processors, threads_option
from penink_cli.options.layers import (
    as_printed,
    colour_option,
    colours_of,
    files_argument,
    gain_option,
    page_options,
    read_layers,
)
from penink_cli.options.progress import progress


def _pixels(
    files: tuple[str, ...],
    paper: str | None,
    margin: float,
    landscape: bool,
    at: tuple[float, float] | None,
    dpi: float,
    bits: int,
    device_dpi: float | None,
    threads: int | None,
    output: str | None,
    max_pixels: int,
    quiet: bool,
    png: bool,
    colours: tuple[tuple[float, float, float], ...] = (),
) -> None:
    from functools import partial

    from penink_cli.formats.pgm import check_size
    from penink_cli.outputs import inks
    from penink_cli.outputs.page import lay_out
    from penink_cli.outputs.raster import cover

    if device_dpi is None and not png:  # a PGM goes to other programs: it has what the strokes themselves cover
        device_dpi = 0.0
    layers = as_printed(read_layers(files), device_dpi)
    page = lay_out(layers, paper, margin, landscape, at)
    width, height = cover.size(page, dpi)
    check_size(width, height, max_pixels)
    if png and max(width, height) >= 2**31:
        raise ParameterError(f"{width} x {height} pixels; a PNG file has less than 2147483648 a side")
    maxval = 2**bits - 1
    paints = colours_of(layers, colours)
    coloured = png and any(paint != inks.BLACK for paint in paints)
    if coloured:
        bits = 8
    with writing(output) as out, progress(height, "drawing", quiet) as done:

        def bands() -> Any:
            whole = partial(cover.bands, page=page, dpi=dpi, maxval=maxval, threads=threads or processors())
            if coloured:
                each = [whole([s for s, own in zip(layers, paints) if own == paint]) for paint in dict.fromkeys(paints)]
                drawn = inks.pixels(each, list(dict.fromkeys(paints)), maxval)
            else:
                drawn = whole(layers)
            for band in drawn:
                yield band
                done(len(band))

        if png:
            from penink_cli.outputs.raster import png as png_file

            png_file.write(out, (width, height), dpi, bits, bands(), coloured)
        else:
            out.write(b"P5\n%d %d\n%d\n" % (width, height, maxval))
            for band in bands():
                out.write(band.data)


def _options(function: Any) -> Any:
    for decorate in (
        files_argument,
        click.option(
            "--dpi", type=Finite(above=0, most=1e6), default=150.0, metavar="N", help="Pixels an inch.  [default: 150]"
        ),
        click.option(
            "--bits",
            type=click.IntRange(1, 8),
            default=8,
            metavar="1…8",
            help="Bits a pixel; with 1 a pixel is black if ink covers half of it.  [default: 8]",
        ),
        page_options,
        gain_option,
        threads_option,
        output_options,
    ):
        function = decorate(function)
    return function


@click.command(name="to-pgm")
@_options
def to_pgm(output: str | None, **options: Any) -> None:
    """Draw strokes into a grey image, by the area that ink covers.

    The image is PGM, or PNG where the name of -o ends in .png; to-png always writes PNG. Several FILEs are drawn over
    one another.

    \b
    penink to-pgm --dpi 300 photo.strokes.jsonl | penink enlarge --scale 0.5 -o small.pgm
    penink to-pgm photo.strokes.jsonl -o preview.png
    """
    _pixels(output=output, png=bool(output and output.lower().endswith(".png")), **options)


@click.command(name="to-png")
@colour_option
@_options
def to_png(output: str | None, **options: Any) -> None:
    """Draw strokes into a PNG image, by the area that ink covers.

    Several FILEs are drawn over one another; coloured ones are transparent inks. Strokes are as wide as on the printer
    that their file names, unless --device-dpi says otherwise; those of to-pgm are not.

    \b
    penink to-png --dpi 300 photo.strokes.jsonl -o photo.png
    """
    _pixels(output=output, png=True, **options)
