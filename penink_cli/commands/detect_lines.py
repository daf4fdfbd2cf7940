"""``penink detect-lines``."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import (
    LENGTH,
    POSITIVE,
    Finite,
    filter_options,
    processors,
    reporter,
    threads_option,
    verbose_option,
)
from penink_cli.options.inputs import only_one_standard_input, read_directions
from penink_cli.options.photographs import photo_options, read_photo

if TYPE_CHECKING:
    from penink_cli.ground.model import Directions


@click.command(name="detect-lines")
@filter_options
@photo_options
@click.option("--black/--white", "black", default=None, help="Only dark lines, or only light ones.  [default: both]")
@click.option("--min-length", type=Finite(least=0), metavar="N", help="Shortest line, pixels.  [default: by the size]")
@click.option("--seen-at", type=LENGTH, help="Only lines that a drawing of this width, or a smaller one, has room for.")
@click.option(
    "--density",
    type=POSITIVE,
    metavar="D",
    help="With --seen-at: points of line in a square point that there is room for, as of `penink lines`.  "
    "[default: 0.13]",
)
@click.option(
    "--per-inch2",
    type=POSITIVE,
    metavar="L",
    help="With --seen-at: inches of line in a square inch that there is room for, as of `penink lines`.  [default: 6]",
)
@click.option(
    "--directions",
    "directions_file",
    type=click.Path(allow_dash=True),
    metavar="FILE",
    help="The direction field: faint lines across it are left out.  [default: by the photo]",
)
@threads_option
@verbose_option
def detect_lines(
    file: str | None,
    output: str | None,
    max_pixels: int,
    black: bool | None,
    min_length: float | None,
    seen_at: float | None,
    density: float | None,
    per_inch2: float | None,
    directions_file: str | None,
    threads: int | None,
    verbose: bool,
    **_: Any,
) -> None:
    """Find the telling lines of a photograph.

    These are what a pen would draw of it besides its tone: contours, folds, whiskers, pupils, and light lines on dark
    ground. The result is a list in pixels of the photo, each line with a rank, that serves every size on paper.

    \b
    penink detect-lines photo.png -o photo.lines.json
    penink lines --width 6in photo.lines.json | penink to-ps -o lines.ps
    """
    from penink_cli.formats import lines
    from penink_cli.lines import detection

    if seen_at is None and (density is not None or per_inch2 is not None):
        raise click.UsageError(f"--{'density' if density is not None else 'per-inch2'} goes with --seen-at")
    only_one_standard_input(file, directions_file)
    photo = read_photo(file, max_pixels)
    rows, columns = photo.values.shape
    field = read_directions(directions_file, columns, rows, max_pixels)

    def at_size(height: int, width: int) -> Directions:
        from penink_cli.directions.reading import at_size

        assert field is not None
        return at_size(field, None, height, width, threads)

    found = detection.detect_lines(
        photo.values,
        maxval=photo.maxval,
        black=black is not False,
        white=black is not True,
        min_length=min_length,
        directions=at_size if field is not None else None,
        threads=threads or processors(),
    )
    if seen_at is not None:
        from penink_cli.blasting import telling
        from penink_cli.ground.model import LineChoice

        usual = LineChoice()
        choice = replace(usual, density=density or usual.density, per_inch2=per_inch2 or usual.per_inch2)
        height = seen_at * rows / columns
        room = telling.with_room(found, seen_at, height, 1 - photo.grey, choice, threads or processors())
        found = found.chosen(room)
    spots = int((found.breadth > 0).sum())
    reporter(verbose)(f"{len(found)} lines, {int(found.white.sum())} of them light, {spots} spots")
    with writing(output, binary=False) as out:
        lines.write(out, found)
