"""``penink show-edges``."""

from __future__ import annotations

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import POSITIVE, Finite, edges_option, filter_options
from penink_cli.options.inputs import only_one_standard_input, read_edges, warn_of_another_shape
from penink_cli.options.photographs import photo_options, read_photo


@click.command(name="show-edges")
@filter_options
@photo_options
@edges_option(required=True)
@click.option("--margin", type=Finite(least=0, most=16), help="As of extract-samples.  [default: by the photo]")
@click.option("--scale", type=POSITIVE, default=3.0, show_default=True, help="Size of a photo pixel on the screen.")
def show_edges(
    file: str | None,
    output: str | None,
    max_pixels: int,
    quiet: bool,
    edges_file: str,
    margin: float | None,
    scale: float,
) -> None:
    """Draw a photograph with its edges, to be looked at.

    The result is SVG: the photo, pale; edges from blue (faint) to red (strong); open ends in black
    circles, junctions in green ones; pixels that extract-samples replaces in yellow.

    \b
    penink show-edges -e photo.edges.json photo.png -o photo.edges.svg
    """
    from penink_cli.outputs import edge_picture
    from penink_cli.reconstruction import extraction

    only_one_standard_input(file, edges_file)
    edges = read_edges(edges_file, max_pixels)
    assert edges is not None
    photo = read_photo(file, max_pixels)
    warn_of_another_shape(edges, photo)
    contaminated = extraction.contaminated(photo.grey, edges, margin)
    with writing(output, binary=False) as out:
        edge_picture.write(out, photo, edges, contaminated, scale)
