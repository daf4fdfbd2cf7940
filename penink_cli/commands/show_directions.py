"""``penink show-directions``."""

from __future__ import annotations

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import POSITIVE, edges_option, filter_options
from penink_cli.options.inputs import only_one_standard_input, read_directions, read_edges, warn_of_another_shape
from penink_cli.options.photographs import photo_options, read_photo


@click.command(name="show-directions")
@filter_options
@photo_options
@edges_option(required=False)
@click.option(
    "--directions",
    "directions_file",
    required=True,
    type=click.Path(allow_dash=True),
    metavar="FILE",
    help="The direction field of the image.",
)
@click.option("--lines", type=click.IntRange(1, 1000), default=72, show_default=True, help="Along the longer side.")
@click.option("--scale", type=POSITIVE, default=3.0, show_default=True, help="Size of a photo pixel on the screen.")
def show_directions(
    file: str | None,
    output: str | None,
    max_pixels: int,
    quiet: bool,
    edges_file: str | None,
    directions_file: str,
    lines: int,
    scale: float,
) -> None:
    """Draw a photograph with its directions, to be looked at.

    The result is SVG: the photo, pale, and short lines as strokes would lie, from blue (the form is clear) to orange
    (nothing is known, and hatching keeps its own angle).

    \b
    penink show-directions -e photo.edges.json --directions photo.directions.pgm photo.png -o photo.directions.svg
    """
    from penink_cli.directions import reading
    from penink_cli.outputs import direction_picture

    only_one_standard_input(file, edges_file, directions_file)
    edges = read_edges(edges_file, max_pixels)
    photo = read_photo(file, max_pixels)
    if edges is not None:
        warn_of_another_shape(edges, photo)
    height, width = photo.values.shape
    field = read_directions(directions_file, width, height, max_pixels)
    assert field is not None
    spacing = max(width, height) / lines
    rows, columns = max(1, round(height / spacing)), max(1, round(width / spacing))
    field = reading.at_size(field, edges, rows, columns)
    with writing(output, binary=False) as out:
        direction_picture.write(out, photo, field, scale)
