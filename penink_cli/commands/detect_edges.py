"""``penink detect-edges``."""

from __future__ import annotations

from typing import Any

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import LENGTH, POSITIVE, Finite, filter_options, reporter, verbose_option
from penink_cli.options.photographs import photo_options, read_photo

STEP = Finite(most=1, above=0)


@click.command(name="detect-edges")
@filter_options
@photo_options
@click.option("--sigma", type=Finite(least=0.5, most=20), help="Smoothing, pixels.  [default: by the photo's noise]")
@click.option(
    "--low", type=STEP, metavar="GREY", help="Least grey step of an edge, up to 1.  [default: half of --high]"
)
@click.option("--high", type=STEP, metavar="GREY", help="Grey step an edge reaches somewhere.  [default: by the photo]")
@click.option("--tolerance", type=POSITIVE, help="How far segments may stray from the edge, pixels.  [default: 0.3]")
@click.option("--min-length", type=Finite(least=0), help="Shortest edge that is kept, pixels.  [default: 6]")
@click.option(
    "--seen-at", type=LENGTH, help="Settle corners and junctions only where a drawing of this width shows them."
)
@verbose_option
def detect_edges(
    file: str | None, output: str | None, max_pixels: int, quiet: bool, verbose: bool, **choices: Any
) -> None:
    """Find the discontinuity edges of a photograph.

    The result is an edge list in pixels of the photo. It serves every resolution of the image.

    \b
    penink detect-edges photo.png -o photo.edges.json
    """
    from penink_cli.arrangement import detection
    from penink_cli.formats import edge_list

    photo = read_photo(file, max_pixels)
    chosen = {name: value for name, value in choices.items() if value is not None}
    report = reporter(verbose)
    edges = detection.detect_edges(photo.grey, report=report, **chosen)
    report(f"{len(edges.edges)} edges, {len(edges.vertices)} vertices")
    with writing(output, binary=False) as out:
        edge_list.write(out, edges)
