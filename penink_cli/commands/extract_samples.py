"""``penink extract-samples``."""

from __future__ import annotations

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import Finite, edges_option, filter_options, reporter, verbose_option
from penink_cli.options.inputs import only_one_standard_input, read_edges, warn_of_another_shape
from penink_cli.options.photographs import photo_options, read_photo


@click.command(name="extract-samples")
@filter_options
@photo_options
@edges_option(required=True)
@click.option(
    "--margin",
    type=Finite(least=0, most=16),
    help="How far from an edge the photo's blur reaches, pixels.  [default: by the photo]",
)
@click.option("--maxval", type=click.IntRange(1, 65535), default=255, help="White of the PGM.  [default: 255]")
@verbose_option
def extract_samples(
    file: str | None,
    output: str | None,
    max_pixels: int,
    quiet: bool,
    edges_file: str,
    margin: float | None,
    maxval: int,
    verbose: bool,
) -> None:
    """Take grey samples that no edge has contaminated.

    A pixel on an edge, or so near that the photo's blur reaches it, is a mixture of both sides. It is
    replaced by an extrapolation from pixels that can be reached without crossing an edge.

    \b
    penink extract-samples -e photo.edges.json photo.png -o photo.samples.pgm
    """
    from penink_cli.formats import pgm
    from penink_cli.ground.model import GreyImage
    from penink_cli.reconstruction import extraction

    only_one_standard_input(file, edges_file)
    edges = read_edges(edges_file, max_pixels)
    assert edges is not None
    photo = read_photo(file, max_pixels)
    warn_of_another_shape(edges, photo)
    samples = extraction.extract_samples(photo.grey, edges, margin, reporter(verbose))
    with writing(output) as out:
        pgm.write(out, GreyImage.from_grey(samples, maxval))
