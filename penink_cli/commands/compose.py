"""``penink compose``."""

from __future__ import annotations

from typing import Any

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import (
    LENGTH,
    Finite,
    filter_options,
    processors,
    reporter,
    threads_option,
    verbose_option,
    warn,
)
from penink_cli.options.composition import composition_options
from penink_cli.options.inputs import only_one_standard_input
from penink_cli.options.photographs import photo_options, read_colours, read_photo
from penink_cli.options.sheet import check_sheet


@click.command()
@click.option("--width", type=LENGTH, required=True, help="Width of the drawing that it is composed for: 6in, 100mm.")
@composition_options
@click.option(
    "--color",
    "--colour",
    "in_colours",
    is_flag=True,
    help="Write a PPM: the photo's colours, as light as the grey. The mix is luma unless --mix says otherwise.",
)
@click.option(
    "--dpi",
    type=Finite(1, 100_000),
    default=288.0,
    show_default=True,
    metavar="N",
    help="Make a larger photo smaller, to N pixels an inch of the drawing, which shows no more.",
)
@click.option(
    "--maxval",
    type=click.IntRange(1, 65535),
    default=255,
    metavar="N",
    help="White of the result; 65535 for 16 bits.  [default: 255]",
)
@threads_option
@verbose_option
@filter_options
@photo_options
def compose(
    file: str | None,
    output: str | None,
    max_pixels: int,
    width: float,
    strength: float,
    detail: float,
    mix: tuple[float, float, float] | None,
    target: tuple[tuple[float, float], ...],
    mask: str | None,
    vignette: float | None,
    in_colours: bool,
    dpi: float,
    maxval: int,
    threads: int | None,
    verbose: bool,
    **_: Any,
) -> None:
    """Make the grey that a drawing is to have, from a photo.

    A photo's tones drawn as they are make a dark grey drawing. So colours are mixed to a grey in which they differ,
    tones are moved towards those of an illustrator, who spends paper and black, and detail is raised until a pen can
    show it.

    With --color the result is a PPM, the photo's colours as light as that grey, for plates of several inks.

    \b
    penink compose --width 6in photo.jpg -o g.pgm
    penink detect-edges g.pgm -o e.json
    penink extract-samples -e e.json g.pgm | penink blast -e e.json --width 6in | penink to-ps -o photo.ps
    """
    from penink_cli.composition import compose as composition
    from penink_cli.formats import pgm, photo
    from penink_cli.ground.model import ColourImage, GreyImage

    only_one_standard_input(file, mask)
    picture = read_colours(file, max_pixels)
    rows, columns = picture.values.shape[:2]
    check_sheet(width, width * rows / columns, max_pixels)
    where = None if mask is None else read_photo(mask, max_pixels)
    choice = composition.Choice(width, strength, detail, mix, target, dpi / 72, vignette or 0.0)
    used = composition.narrow_range(picture)
    if used is not None and strength > 0:
        warn(f"the photo uses {used:.0%} of the range of grey; what is drawn of it may be its noise")
    told: dict[str, Any] = {
        "mask": where,
        "oval": vignette is not None and where is None,
        "threads": threads or processors(),
        "report": reporter(verbose),
    }
    composed: ColourImage | GreyImage
    if in_colours:
        composed = ColourImage.from_colours(composition.compose_colours(picture, choice, **told), maxval)
    else:
        composed = GreyImage.from_grey(composition.compose(picture, choice, photo.grey_of, **told), maxval)
    with writing(output) as out:
        pgm.write(out, composed)
