"""``penink outline``."""

from __future__ import annotations

from typing import Any

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import LENGTH, POINT, Finite, filter_options, is_given, printer_option
from penink_cli.options.inputs import read_edges


@click.command(name="outline")
@filter_options
@click.option("--width", type=LENGTH, required=True, help="Width of the picture on paper: 4in, 100mm, 288 (points).")
@click.option("--pen", type=LENGTH, help="Draw with a technical pen: strokes of this width from end to end.")
@click.option(
    "--weight",
    type=LENGTH,
    default="0.7pt",
    show_default=True,
    help="Width of a hand's strokes, which swell and thin a little.",
)
@printer_option("Resolution of the printer that the hatching beside them is for, as blast has it.")
@click.option(
    "--min-strength",
    type=Finite(0, 1),
    default=0.0,
    metavar="S",
    help="Only chains whose mean strength, the grey step across them, is at least S; 0 to 1.",
)
@click.option("--min-length", type=Finite(0), default=0.0, metavar="N", help="Only chains at least N pixels long.")
@click.option(
    "--region",
    "regions",
    type=POINT,
    multiple=True,
    help="Only edges around the region that holds this point, in pixels of the photo; may be repeated.",
)
def outline(
    file: str | None,
    output: str | None,
    width: float,
    pen: float | None,
    weight: float,
    device_dpi: float | None,
    min_strength: float,
    min_length: float,
    regions: tuple[tuple[float, float], ...],
    max_pixels: int,
    **_: Any,
) -> None:
    """Turn discontinuity edges into smooth outline strokes.

    Chains of edges become curves, the strongest first; each keeps clear of those before it.

    \b
    penink outline --width 4in --min-strength 0.2 photo.edges.json > outlines.strokes.jsonl
    penink to-ps hatching.strokes.jsonl outlines.strokes.jsonl -o photo.ps
    """
    from penink_cli.formats import strokes
    from penink_cli.ground.model import OutlineChoice
    from penink_cli.illustration.drawing import outline_strokes
    from penink_cli.options.sheet import check_sheet

    if pen is not None and is_given("weight"):
        raise click.UsageError("give one of --pen and --weight")
    edges = read_edges(file or "-", max_pixels)
    assert edges is not None
    height = width * edges.height / edges.width
    check_sheet(width, height)
    choice = OutlineChoice(
        pen_pt=weight if pen is None else pen,
        even=pen is not None,
        min_strength=min_strength,
        min_length=min_length,
        regions=regions,
    )
    drawn = outline_strokes(edges, width, height, choice, device_dpi=device_dpi)
    with writing(output, binary=False) as out:
        strokes.write(out, drawn)
