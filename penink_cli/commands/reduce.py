"""``penink reduce``."""

from __future__ import annotations

import click

from penink_cli.commands.inputs import only_one_standard_input, read_edges, read_grey
from penink_cli.options import SIZE, edges_option, filter_options
from penink_cli.streams import writing


@click.command(name="reduce")
@filter_options
@edges_option(required=False)
@click.option("--factor", type=click.IntRange(1, 1000), metavar="N", help="Old samples a new one, along each axis.")
@click.option("--size", type=SIZE, help="The new grid.")
@click.option("--maxval", type=click.IntRange(1, 65535), help="White of the PGM written.  [default: that read]")
def reduce(
    file: str | None,
    output: str | None,
    max_pixels: int,
    quiet: bool,
    edges_file: str | None,
    factor: int | None,
    size: tuple[int, int] | None,
    maxval: int | None,
) -> None:
    """Reduce samples to a coarser grid without mixing across edges.

    \b
    penink extract-samples -e photo.edges.json photo.png \\
      | penink reduce -e photo.edges.json --factor 4 -o photo.reduced.pgm
    """
    from penink_cli.errors import ParameterError
    from penink_cli.formats import pgm
    from penink_cli.model import EdgeList, GreyImage
    from penink_cli.reconstruction import reduction

    if (factor is None) == (size is None):
        raise click.UsageError("one of --factor and --size is needed")
    only_one_standard_input(file, edges_file)
    edges = read_edges(edges_file)
    samples = read_grey(file, max_pixels)
    height, width = samples.values.shape
    if size is None:
        assert factor is not None
        size = max(1, round(width / factor)), max(1, round(height / factor))
    if size[0] > width or size[1] > height:
        raise ParameterError(f"{width} x {height} samples cannot be reduced to {size[0]} x {size[1]}")
    reduced = reduction.reduce(samples.grey, edges or EdgeList(width, height), *size)
    with writing(output) as out:
        pgm.write(out, GreyImage.from_grey(reduced, maxval or samples.maxval))
