"""``penink reduce``."""

from __future__ import annotations

import click

from penink_cli.commands.inputs import only_one_standard_input, read_edges, read_grey, read_photo
from penink_cli.options import SIZE, edges_option, filter_options
from penink_cli.streams import writing


@click.command(name="reduce")
@filter_options
@edges_option(required=False)
@click.option("--factor", type=click.IntRange(1, 1000), metavar="N", help="Old samples a new one, along each axis.")
@click.option("--size", type=SIZE, help="The new grid.")
@click.option(
    "--fit",
    type=click.Choice(["none", "lsq"]),
    default="lsq",
    help="Least squares near edges, or none.  [default: lsq]",
)
@click.option(
    "--photo", "photo_file", type=click.Path(), metavar="FILE", help="Fit to this photo, seen through its own blur."
)
@click.option("--maxval", type=click.IntRange(1, 65535), help="White of the PGM written.  [default: that read]")
def reduce(
    file: str | None,
    output: str | None,
    max_pixels: int,
    quiet: bool,
    edges_file: str | None,
    factor: int | None,
    size: tuple[int, int] | None,
    fit: str,
    photo_file: str | None,
    maxval: int | None,
) -> None:
    """Reduce samples to a coarser grid without mixing across edges.

    Each new sample speaks only for what it can reach. Near edges the samples are fitted so that their
    enlargement, seen through a camera, comes as near as can be to the photo, or to the samples read.

    \b
    penink extract-samples -e photo.edges.json photo.png \\
      | penink reduce -e photo.edges.json --photo photo.png --factor 4 -o photo.reduced.pgm
    """
    from penink_cli.errors import ParameterError
    from penink_cli.formats import pgm
    from penink_cli.model import EdgeList, GreyImage
    from penink_cli.reconstruction import reduction

    if (factor is None) == (size is None):
        raise click.UsageError("one of --factor and --size is needed")
    only_one_standard_input(file, edges_file, *([photo_file] if photo_file else []))
    edges = read_edges(edges_file)
    samples = read_grey(file, max_pixels)
    height, width = samples.values.shape
    if size is None:
        assert factor is not None
        size = max(1, round(width / factor)), max(1, round(height / factor))
    if size[0] > width or size[1] > height:
        raise ParameterError(f"{width} x {height} samples cannot be reduced to {size[0]} x {size[1]}")
    photo = read_photo(photo_file, max_pixels).grey if photo_file else None
    if photo is not None and (photo.shape[0] < size[1] or photo.shape[1] < size[0]):
        raise ParameterError(f"the photo has fewer pixels than {size[0]} x {size[1]}")
    reduced = reduction.reduce(samples.grey, edges or EdgeList(width, height), *size, photo=photo, fit=fit)
    with writing(output) as out:
        pgm.write(out, GreyImage.from_grey(reduced, maxval or samples.maxval))
