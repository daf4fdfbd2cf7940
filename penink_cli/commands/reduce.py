"""``penink reduce``."""

from __future__ import annotations

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import (
    LENGTH,
    SIZE,
    Finite,
    edges_option,
    filter_options,
    reporter,
    threads_option,
    verbose_option,
)
from penink_cli.options.inputs import only_one_standard_input, read_edges, read_grey, warn_of_another_shape
from penink_cli.options.photographs import photo_limit, photo_options, read_photo


@click.command(name="reduce")
@filter_options
@photo_options
@edges_option(required=False)
@click.option("--factor", type=click.IntRange(1, 1000), metavar="N", help="Old samples to a new one, along each axis.")
@click.option("--size", type=SIZE, help="The new grid.")
@click.option("--auto", is_flag=True, help="The smallest grid within --max-error, with a sample in every region.")
@click.option(
    "--max-error",
    type=Finite(above=0, most=255),
    metavar="E",
    help="RMS difference from the photo, grey levels of 255.  [default: 8, with --seen-at 4.3]",
)
@click.option(
    "--seen-at",
    type=LENGTH,
    help="Count what a drawing of this width can show: the difference blurred by a point on paper.",
)
@click.option(
    "--relative", is_flag=True, help="With --seen-at: allow faint photos as much less error, it hides more of them."
)
@click.option(
    "--fit",
    type=click.Choice(["none", "lsq"]),
    default="lsq",
    show_default=True,
    help="Fit the samples near edges by least squares, or take them as they are.",
)
@click.option(
    "--photo",
    "photo_file",
    type=click.Path(allow_dash=True),
    metavar="FILE",
    help="Fit to this photo, and measure the error against it, with its camera's blur; not to the samples read.",
)
@click.option("--maxval", type=click.IntRange(1, 65535), metavar="N", help="White of the PGM.  [default: as read]")
@threads_option
@verbose_option
def reduce(
    file: str | None,
    output: str | None,
    max_pixels: int,
    quiet: bool,
    edges_file: str | None,
    factor: int | None,
    size: tuple[int, int] | None,
    auto: bool,
    max_error: float | None,
    seen_at: float | None,
    relative: bool,
    fit: str,
    photo_file: str | None,
    maxval: int | None,
    threads: int | None,
    verbose: bool,
) -> None:
    """Reduce samples to a coarser grid without mixing across edges.

    Each new sample is made of the old ones that it can reach without crossing an edge. Near edges samples are fitted,
    so that their enlargement, blurred as the camera blurs, is as near to the photo as can be.

    \b
    penink extract-samples -e photo.edges.json photo.png \\
      | penink reduce -e photo.edges.json --photo photo.png --factor 4 -o photo.reduced.pgm
    """
    from penink_cli.formats import pgm
    from penink_cli.ground.errors import ParameterError
    from penink_cli.ground.model import EdgeList, GreyImage
    from penink_cli.reconstruction import grid, reduction

    if (factor is not None) + (size is not None) + auto != 1:
        raise click.UsageError("one of --factor, --size and --auto is needed")
    if not auto:
        for name, told in (("max-error", max_error), ("seen-at", seen_at), ("relative", relative or None)):
            if told is not None:
                raise click.UsageError(f"--{name} goes with --auto")
    elif relative and seen_at is None:
        raise click.UsageError("--relative goes with --seen-at: faint is what a drawing of that width shows little of")
    only_one_standard_input(file, edges_file, photo_file or "")
    edges = read_edges(edges_file, max_pixels)
    samples = read_grey(file, photo_limit(max_pixels))
    height, width = samples.values.shape
    edges = edges or EdgeList(width, height)
    photo = None
    if photo_file:
        picture = read_photo(photo_file, max_pixels)
        warn_of_another_shape(edges, picture, "the photo")
        photo = picture.grey
    if factor is not None:
        size = max(1, round(width / factor)), max(1, round(height / factor))
    if size is not None and (size[0] > width or size[1] > height):
        raise ParameterError(f"{width} x {height} samples cannot be reduced to {size[0]} x {size[1]}")
    least = size or (width, height)
    if photo is not None and (photo.shape[1] < least[0] or photo.shape[0] < least[1]):
        raise ParameterError(
            f"the photo has {photo.shape[1]} x {photo.shape[0]} pixels, fewer than {least[0]} x {least[1]} samples"
        )
    say = reporter(verbose)
    if size is None:
        limit = None if max_error is None else max_error / 255
        chosen = grid.choose_grid(
            samples.grey,
            edges,
            limit,
            seen_at=seen_at,
            relative=relative,
            photo=photo,
            fit=fit,
            threads=threads,
            report=say,
        )
        reduced = chosen.samples
        say(f"chosen: {reduced.shape[1]} x {reduced.shape[0]}, error {255 * chosen.error:.2f} of 255")
    else:
        reduced = reduction.reduce(samples.grey, edges, *size, photo=photo, fit=fit, threads=threads)
    with writing(output) as out:
        pgm.write(out, GreyImage.from_grey(reduced, maxval or samples.maxval))
