"""``penink separate``."""

from __future__ import annotations

from typing import Any

import click

from penink_cli.ground.errors import in_quotes
from penink_cli.ground.streams import writing
from penink_cli.options.common import POINT, edges_option, filter_options, plain_number
from penink_cli.options.inks import CMYK, Inks, inks_options, inverted, refuse_without_plate, separated
from penink_cli.options.inputs import only_one_standard_input, read_edges, warn_of_another_shape
from penink_cli.options.photographs import photo_options, read_photo
from penink_cli.options.plates import names_of, plates_option


class Range(click.ParamType):
    """``LOW,HIGH``, two greys from 0 (black) to 1 (white)."""

    name = "LOW,HIGH"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, float]:
        """(low, high)."""
        if isinstance(value, tuple):
            return value
        greys = [plain_number(part) for part in value.split(",")]
        if len(greys) != 2 or not 0 <= greys[0] < greys[1] <= 1:
            self.fail(f"{in_quotes(value)} is not a range of grey such as 0,0.5", param, ctx)
        return greys[0], greys[1]


@click.command()
@filter_options
@photo_options
@click.option(
    "--mask",
    type=click.Path(allow_dash=True),
    metavar="FILE",
    help="A picture of the same size, white where the layer is.",
)
@click.option("--grey", type=Range(), help="Where the photo's grey is from LOW up to HIGH; 0 is black, 1 is white.")
@click.option(
    "--point",
    "points",
    type=POINT,
    multiple=True,
    help="The region of the edge list that holds this point, in pixels of the photo; may be repeated.",
)
@edges_option(required=False, says="Its regions are those of --point.")
@click.option(
    "--plate",
    metavar="NAME|N|COLOUR",
    help="The plate of one ink: cyan, magenta, yellow or black; with --inks the ink's colour or its place, from 1.",
)
@plates_option
@inks_options
@click.option("--invert", is_flag=True, help="All but the layer: the tones of the two overlays add up to the photo's.")
def separate(
    file: str | None,
    output: str | None,
    max_pixels: int,
    mask: str | None,
    grey: tuple[float, float] | None,
    points: tuple[tuple[float, float], ...],
    edges_file: str | None,
    plate: str | None,
    pattern: str | None,
    inks: Inks | None,
    paper_colour: tuple[float, float, float],
    black: float,
    invert: bool,
    **_: Any,
) -> None:
    """Make the overlay of one layer: grey where it is, white elsewhere.

    A mask, a range of grey or regions of an edge list say what belongs to the layer. Overlays go through the same
    filters as photos.

    A plate is the layer of one ink: as much of it as, printed over the others, comes nearest to the photo's colours.
    The edges of the photo serve all plates; blast each with its --color and another --turn.

    \b
    penink separate keys.png --plate cyan -o cyan.pgm
    penink separate keys.png --inks '#1b4f9c,#d2232a,#f2c300' --plates 'plate-{}.pgm'
    penink separate keys.png --mask keys-mask.png -o keys.pgm
    penink separate keys.png --mask keys-mask.png --invert -o shadow.pgm
    """
    from penink_cli.formats import pgm
    from penink_cli.illustration import overlays

    of_inks = (plate is not None) + (pattern is not None)
    if (mask is not None) + (grey is not None) + bool(points) + of_inks != 1:
        raise click.UsageError("give one of --mask, --grey, --point, --plate and --plates")
    if not of_inks:
        refuse_without_plate()
    if bool(points) != (edges_file is not None):
        raise click.UsageError("--point and --edges go together")
    only_one_standard_input(file, mask, edges_file)
    if of_inks:
        chosen = inks or CMYK
        if pattern is not None:
            targets: list[str | None] = [*names_of(pattern, len(chosen.names), output, [file])]
            numbers = list(range(len(targets)))
        else:
            targets, numbers = [output], [chosen.number(plate or "")]
        overlays_of = separated(file, max_pixels, chosen, paper_colour, black)
        for number, target in zip(numbers, targets, strict=True):
            with writing(target) as out:
                pgm.write(out, inverted(overlays_of[number]) if invert else overlays_of[number])
        return
    photo = read_photo(file, max_pixels)
    if mask is not None:
        share = overlays.by_mask(photo, read_photo(mask, max_pixels))
    elif grey is not None:
        share = overlays.by_grey(photo, *grey)
    else:
        edges = read_edges(edges_file, max_pixels)
        assert edges is not None
        warn_of_another_shape(edges, photo)
        share = overlays.by_region(photo, edges, points)
    with writing(output) as out:
        pgm.write(out, overlays.overlay(photo, share, invert))
