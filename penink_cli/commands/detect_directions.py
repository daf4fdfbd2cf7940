"""``penink detect-directions``."""

from __future__ import annotations

from typing import Any

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import Finite, edges_option, filter_options
from penink_cli.options.inputs import (
    only_one_standard_input,
    read_edges,
    read_lines,
    read_strokes_or_svg,
    warn_of_another_shape,
)
from penink_cli.options.photographs import photo_options, read_colours


@click.command(name="detect-directions")
@filter_options
@photo_options
@edges_option(required=False)
@click.option(
    "--angle",
    type=Finite(-360, 360),
    help="The direction where the photo shows none, degrees clockwise from the right.  [default: -45]",
)
@click.option(
    "--follow", type=Finite(0, 1), help="0: the angle everywhere … 1: the form wherever it leads.  [default: 0.5]"
)
@click.option("--across", is_flag=True, help="From dark to light instead of along one tone: for folds, noses.")
@click.option(
    "--noise",
    type=Finite(0, 1),
    help="Change of grey from pixel to pixel that is hardly more than grain: more calms flat places.  [default: 0.006]",
)
@click.option("--size", type=click.IntRange(1, 1024), help="Samples of the field along its longer side.  [default: 96]")
@click.option(
    "--strokes",
    "strokes_file",
    type=click.Path(allow_dash=True),
    metavar="FILE",
    help="Your own strokes over the photo, a strokes file or SVG: the field follows them.",
)
@click.option(
    "--lines",
    "lines_file",
    type=click.Path(allow_dash=True),
    metavar="FILE",
    help="The photo's telling lines, which the field follows too.",
)
def detect_directions(
    file: str | None,
    output: str | None,
    max_pixels: int,
    quiet: bool,
    edges_file: str | None,
    strokes_file: str | None,
    lines_file: str | None,
    **choices: Any,
) -> None:
    """Find the directions that strokes follow in a photograph.

    The result is a field of angles, three PGM images in one stream, for drawings of any size. Colours tell of the form
    too: give the photo itself and not its grey.

    \b
    penink detect-directions -e photo.edges.json photo.png -o photo.directions.pgm
    """
    from penink_cli.directions import detection
    from penink_cli.formats import directions

    only_one_standard_input(file, edges_file, strokes_file, lines_file)
    edges = read_edges(edges_file, max_pixels)
    strokes = read_strokes_or_svg(strokes_file)
    photo = read_colours(file, max_pixels)
    lines = read_lines(lines_file, photo)
    if edges is not None:
        warn_of_another_shape(edges, photo)
    chosen = {name: value for name, value in choices.items() if value is not None}
    field = detection.detect_directions(photo, edges, strokes=strokes, lines=lines, **chosen)
    with writing(output) as out:
        directions.write(out, field)
