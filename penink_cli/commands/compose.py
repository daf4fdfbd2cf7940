"""``penink compose``."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, TypeVar

import click

from penink_cli.ground.errors import ParameterError, in_quotes
from penink_cli.ground.streams import writing
from penink_cli.options.common import (
    LENGTH,
    Finite,
    Length,
    filter_options,
    plain_number,
    processors,
    reporter,
    threads_option,
    verbose_option,
    warn,
)
from penink_cli.options.inputs import only_one_standard_input, photo_options, read_colours, read_photo
from penink_cli.options.sheet import check_sheet

F = TypeVar("F", bound=Callable[..., Any])


class Mix(click.ParamType):
    """``R,G,B``, weights that sum to 1, or ``auto``."""

    name = "R,G,B"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[float, float, float] | None:
        """The weights, None for ``auto``."""
        if value == "auto" or isinstance(value, tuple):
            return None if value == "auto" else value
        weights = [plain_number(part) for part in value.split(",")]
        if len(weights) != 3 or not all(-2 <= w <= 2 for w in weights) or abs(math.fsum(weights) - 1) > 0.005:
            self.fail(f"{in_quotes(value)} is neither auto nor weights that sum to 1, such as 0.3,0.6,0.1", param, ctx)
        return weights[0], weights[1], weights[2]


class Target(click.ParamType):
    """The name of a tone distribution, or its quantiles ``SHARE:GREY,…``."""

    name = "target"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[tuple[float, float], ...]:
        """The quantiles."""
        from penink_cli.composition.exposure import TARGETS, check_quantiles

        if isinstance(value, tuple):
            return value
        if value in TARGETS:
            return TARGETS[value]
        pairs = [tuple(map(plain_number, part.split(":"))) for part in value.split(",")]
        if not all(len(pair) == 2 and all(0 <= v <= 1 for v in pair) for pair in pairs):
            known = ", ".join(TARGETS)
            self.fail(f"{in_quotes(value)} is none of {known}, nor SHARE:GREY,… from 0:0 to 1:1", param, ctx)
        found = tuple((pair[0], pair[1]) for pair in pairs)
        try:
            check_quantiles(found)
        except ParameterError as error:
            self.fail(error.message, param, ctx)
        return found


def composition_options(function: F) -> F:
    """--strength, --detail, --mix, --target, --mask, --vignette: `draw` has them too."""
    for decorate in (
        click.option(
            "--vignette",
            type=Length(zero=True),
            metavar="LENGTH",
            help="Fade out over that length within the border of the mask, or of an oval where there is none.",
        ),
        click.option(
            "--mask",
            type=click.Path(allow_dash=True),
            metavar="FILE",
            help="A picture of the photo's size, white where it is drawn; elsewhere paper stays white.",
        ),
        click.option(
            "--target",
            type=Target(),
            default="house",
            show_default=True,
            metavar="NAME|S:G,…",
            help="How light the drawing is to be: house, high-key or spot, or quantiles SHARE:GREY,… from 0:0 to 1:1.",
        ),
        click.option(
            "--mix",
            type=Mix(),
            default="auto",
            show_default=True,
            metavar="R,G,B",
            help="Weights of red, green and blue in the grey; auto keeps most contrast.",
        ),
        click.option(
            "--detail",
            type=Finite(0, 10),
            default=1.8,
            show_default=True,
            metavar="G",
            help="How much detail is raised; 1 leaves it as it is.",
        ),
        click.option(
            "--strength",
            type=Finite(0, 1),
            default=0.6,
            show_default=True,
            metavar="0…1",
            help="How far tones are moved from the photo's; 0 is its luma as stored.",
        ),
    ):
        function = decorate(function)
    return function


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
    help="Make a large photo smaller, to that many pixels an inch of the drawing, which shows no more.",
)
@click.option("--maxval", type=click.IntRange(1, 65535), default=255, metavar="N", help="65535 for 16 bits.")
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

    A photo's tones drawn as they are make a dark grey drawing. Here colours are mixed so that they differ, tones
    are moved towards an illustrator's, who spends paper and black, and detail is raised until a pen can show it.

    With --color they are colours, for plates of several inks.

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
