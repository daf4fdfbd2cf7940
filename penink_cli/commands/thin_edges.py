"""``penink thin-edges``."""

from __future__ import annotations

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import (
    LENGTH,
    POINT,
    Finite,
    filter_options,
    is_given,
    reporter,
    threads_option,
    verbose_option,
)
from penink_cli.options.inputs import only_one_standard_input, read_edges, warn_of_another_shape
from penink_cli.options.photographs import photo_options, read_photo


@click.command(name="thin-edges")
@filter_options
@photo_options
@click.option(
    "-e", "--edges", "edges_file", type=click.Path(allow_dash=True), metavar="FILE", help="The edge list, as of FILE."
)
@click.option(
    "--photo",
    "photo_file",
    type=click.Path(allow_dash=True),
    metavar="FILE",
    help="The photo of the edges: a chain is worth the error against it that the chain saves.",
)
@click.option(
    "--worth",
    type=Finite(0),
    metavar="L",
    help="Squared grey levels that a chain must save for each bit it takes.  [default: 80]",
)
@click.option("--seen-at", type=LENGTH, help="Count what a drawing of this width can show.  [default: 6in]")
@click.option(
    "--keep-strength", type=Finite(0, 1), metavar="S", help="Keep chains that outline --min-strength would draw."
)
@click.option(
    "--keep-length", type=Finite(0), default=0.0, metavar="N", help="With --keep-strength: chains of N pixels or more."
)
@click.option(
    "--keep-region",
    "regions",
    type=POINT,
    multiple=True,
    help="Keep edges around the region that holds this point, in pixels of the photo; may be repeated.",
)
@threads_option
@verbose_option
def thin_edges(
    file: str | None,
    output: str | None,
    max_pixels: int,
    quiet: bool,
    edges_file: str | None,
    photo_file: str | None,
    worth: float | None,
    seen_at: float | None,
    keep_strength: float | None,
    keep_length: float,
    regions: tuple[tuple[float, float], ...],
    threads: int | None,
    verbose: bool,
) -> None:
    """Leave out the edges that are not worth their bytes.

    FILE, or that of -e, is an edge list. With --photo each chain is judged by the error that it saves. Without it the
    strongest and longest chains stay, up to six tenths of the edges. Extract and reduce the samples afterwards: they
    make up for what is gone.

    \b
    penink detect-edges photo.png \\
      | penink thin-edges --photo photo.png --worth 80 --seen-at 4in -o photo.edges.json
    """
    import numpy as np

    from penink_cli.formats import edge_list
    from penink_cli.ground.model import OutlineChoice
    from penink_cli.reconstruction import thinning

    if edges_file is not None and file is not None:
        raise click.UsageError("give the edges as FILE or by -e")
    if photo_file is None and (worth is not None or seen_at is not None):
        raise click.UsageError(f"{'--seen-at' if worth is None else '--worth'} goes with --photo")
    if keep_strength is None and is_given("keep_length"):
        raise click.UsageError("--keep-length goes with --keep-strength")
    path = file if edges_file is None else edges_file
    only_one_standard_input(path, photo_file or "")
    edges = read_edges("-" if path is None else path, max_pixels)
    assert edges is not None
    photo = None
    if photo_file:
        picture = read_photo(photo_file, max_pixels)
        warn_of_another_shape(edges, picture, "the photo")
        photo = picture.grey
    kept = np.zeros(len(edges.edges), bool)
    if keep_strength is not None:
        from penink_cli.blasting import outlines

        choice = OutlineChoice(min_strength=keep_strength, min_length=keep_length)
        for run in outlines.runs(edges, choice, None):
            kept[run.edges] = True
    if regions:
        from penink_cli.geometry.regions import edges_around

        kept |= edges_around(edges, np.array(regions, np.float64))
    thinned = thinning.thin_edges(
        edges,
        photo,
        worth=thinning.WORTH if worth is None else worth,
        seen_at=432.0 if seen_at is None else seen_at,
        kept=kept,
        threads=threads,
    )
    reporter(verbose)(f"{len(thinned.edges)} of {len(edges.edges)} edges")
    with writing(output, binary=False) as out:
        edge_list.write(out, thinned)
