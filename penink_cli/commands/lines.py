"""``penink lines``."""

from __future__ import annotations

from typing import Any

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import LENGTH, POSITIVE, Finite, filter_options, printer_option, reporter, verbose_option
from penink_cli.options.inputs import read_lines


@click.command()
@filter_options
@click.option("--width", type=LENGTH, required=True, help="Width of the picture on paper: 4in, 100mm, 288 (points).")
@click.option("--pen", type=LENGTH, default="1.3pt", show_default=True, help="Width of the broadest strokes.")
@click.option("--even", is_flag=True, help="Draw all strokes as wide as the pen, from end to end.")
@click.option(
    "--density",
    type=POSITIVE,
    default=0.13,
    show_default=True,
    metavar="D",
    help="How close lines may be: points of line in a square point around each place.",
)
@click.option(
    "--per-inch2",
    type=POSITIVE,
    default=6.0,
    show_default=True,
    metavar="L",
    help="Inches of line in a square inch, on average over the picture, that there is room for.",
)
@click.option("--min-rank", type=Finite(least=0), metavar="R", help="Least rank of a line.  [default: by the size]")
@click.option(
    "--ruled",
    type=LENGTH,
    metavar="LENGTH",
    help="Straight from corner to corner, as along a ruler, and this far beyond: 4pt.",
)
@click.option(
    "--loose", type=LENGTH, metavar="LENGTH", help="Each line twice, straying by this, as in a sketch: 0.8pt."
)
@printer_option("Resolution of the printer: screens draw the lines as wide as it paints them.")
@verbose_option
def lines(
    file: str | None,
    output: str | None,
    width: float,
    pen: float,
    even: bool,
    density: float,
    per_inch2: float,
    min_rank: float | None,
    ruled: float | None,
    loose: float | None,
    device_dpi: float | None,
    verbose: bool,
    **_: Any,
) -> None:
    """Turn telling lines into pen strokes for one size on paper.

    The most telling lines come first, as long as there is room around each: a stamp gets few, a poster many. Strokes
    swell with the line and taper. With --ruled they are drawn as an architect draws, with --loose as in a sketch.
    Light lines are not drawn: `blast --lines` leaves them out of the hatching.

    \b
    penink lines --width 6in photo.lines.json -o lines.strokes.jsonl
    penink blast --width 6in --ink lines.strokes.jsonl --lines photo.lines.json photo.pgm -o hatching.strokes.jsonl
    penink to-ps hatching.strokes.jsonl lines.strokes.jsonl -o photo.ps
    """
    from penink_cli.formats import strokes
    from penink_cli.ground.model import LineChoice
    from penink_cli.lines.choice import least_rank
    from penink_cli.lines.strokes import line_strokes
    from penink_cli.options.sheet import check_sheet

    found = read_lines(file or "-")
    assert found is not None
    height = width * found.height / found.width
    check_sheet(width, height)
    choice = LineChoice(pen, even, density, per_inch2, min_rank, ruled or 0.0, loose or 0.0)
    drawn = line_strokes(found, width, height, choice, device_dpi=device_dpi)
    least = least_rank(width, height) if min_rank is None else min_rank
    reporter(verbose)(f"{len(drawn)} of {len(found)} lines; --min-rank {least:.2f}")
    with writing(output, binary=False) as out:
        strokes.write(out, drawn)
