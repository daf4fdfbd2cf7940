"""``penink enlarge``."""

from __future__ import annotations

import math

import click

from penink_cli.ground.errors import LimitError
from penink_cli.ground.streams import writing
from penink_cli.options.common import POSITIVE, SIZE, WINDOW, edges_option, filter_options, threads_option
from penink_cli.options.inputs import enlarged_limit, only_one_standard_input, read_edges, read_grey

MOST = 2**31 - 1  # pixels along a side of the output


@click.command(name="enlarge")
@filter_options
@edges_option(required=False)
@click.option("--scale", type=POSITIVE, metavar="S", help="Output pixels to a sample, along each axis; any number.")
@click.option("--size", type=SIZE, help="The size of the output; the two axes may scale differently.")
@click.option(
    "--radius",
    type=POSITIVE,
    default=1.0,
    show_default=True,
    metavar="R",
    help="How long, in sample spacings, the detour around an edge may be for a sample to have an effect.",
)
@click.option(
    "--kernel",
    type=click.Choice(["cubic", "bspline"]),
    default="cubic",
    show_default=True,
    help="cubic passes through the samples; bspline never overshoots, and blurs.",
)
@click.option("--soften", is_flag=True, help="Reconstruct half the size, and double that with a slight blur at edges.")
@click.option("--window", type=WINDOW, help="Only these pixels of the output.")
@click.option("--maxval", type=click.IntRange(1, 65535), metavar="N", help="White of the output.  [default: as read]")
@threads_option
def enlarge(
    file: str | None,
    output: str | None,
    max_pixels: int,
    quiet: bool,
    edges_file: str | None,
    scale: float | None,
    size: tuple[int, int] | None,
    radius: float,
    kernel: str,
    soften: bool,
    window: tuple[int, int, int, int] | None,
    maxval: int | None,
    threads: int | None,
) -> None:
    """Reconstruct the image at any size, sharp at edges and smooth elsewhere.

    The edge list may be that of the photograph: its edges are scaled to the samples.

    \b
    penink enlarge -e photo.edges.json --scale 8 photo.reduced.pgm > photo.large.pgm
    """
    from penink_cli.formats import pgm
    from penink_cli.options.progress import progress
    from penink_cli.reconstruction.enlarge import bands, check_window

    if (scale is None) == (size is None):
        raise click.UsageError("one of --scale and --size is needed")
    only_one_standard_input(file, edges_file)
    edges = read_edges(edges_file, max_pixels)
    samples = read_grey(file, max_pixels)
    h, w = samples.values.shape
    if size is None:
        assert scale is not None
        if max(w, h) * scale > MOST:
            raise click.UsageError(f"--scale {scale:g} of {w} x {h} samples is more than {MOST} pixels along a side")
        size = max(1, math.floor(w * scale + 0.5)), max(1, math.floor(h * scale + 0.5))
    _, _, width, height = check_window(window, *size)
    if width * height > (most := enlarged_limit(max_pixels)):
        raise LimitError(f"{width} x {height} pixels are asked for; at most {most} are allowed (--max-pixels)")
    maxval = maxval or samples.maxval
    with writing(output) as out, progress(height, "enlarge", quiet) as advance:
        out.write(pgm.header(width, height, maxval))
        for rows in bands(
            samples, edges, *size,
            radius=radius, kernel=kernel, soften=soften, window=window, maxval=maxval, threads=threads,
        ):  # fmt: skip
            out.write(pgm.rows(rows, maxval))
            advance(len(rows))
