"""``penink compare``."""

from __future__ import annotations

import math
from typing import Any

import click

from penink_cli.ground.streams import source_name, writing
from penink_cli.options.common import Finite, output_options, processors, threads_option
from penink_cli.options.inputs import only_one_standard_input
from penink_cli.options.layers import as_printed, gain_option
from penink_cli.options.photographs import photo_options, read_image_or_strokes

PLACE_PT, PLACE_PX = 0.1, 1  # the default of --place, of strokes and of pictures


@click.command()
@click.argument("first", metavar="FILE", type=click.Path(allow_dash=True))
@click.argument("second", required=False, metavar="[FILE]", type=click.Path(allow_dash=True))
@click.option(
    "--tone",
    type=Finite(least=0, most=100),
    default=1.0,
    show_default=True,
    metavar="PERCENT",
    help="The most that tone, as the eye sees it, may differ anywhere; of pictures, the grey of a pixel.",
)
@click.option(
    "--place",
    type=Finite(least=0, most=100),
    metavar="N",
    help="The most that lines may have moved, points; of pictures, whole pixels.  [default: 0.1, of pictures 1]",
)
@gain_option
@photo_options
@threads_option
@output_options
def compare(
    first: str,
    second: str | None,
    tone: float,
    place: float | None,
    device_dpi: float | None,
    threads: int | None,
    output: str | None,
    max_pixels: int,
    **_: Any,
) -> None:
    """Say whether two drawings or pictures are the same, to a tolerance.

    FILEs are two strokes files, or two pictures (PGM, PNG …) of one size. They are compared in tone and in place. The
    figures go to standard output; the exit status is 0 where they are the same, and 1, with a line, where they differ.

    \b
    penink compare photo.strokes.jsonl hatching.strokes.jsonl
    penink to-pgm photo.strokes.jsonl -o photo.drawn.pgm
    penink to-pgm hatching.strokes.jsonl | penink compare --tone 5 --place 2 photo.drawn.pgm
    """
    from penink_cli.ground.errors import ParameterError
    from penink_cli.ground.model import Strokes
    from penink_cli.measuring import difference

    only_one_standard_input(first, second or "-")
    a, b = (read_image_or_strokes(path, max_pixels) for path in (first, second))
    names = f"{source_name(first)} and {source_name(second)}"
    if isinstance(a, Strokes) != isinstance(b, Strokes):
        raise ParameterError(f"{names}: strokes and a picture; `penink measure --against` compares their tone")
    if isinstance(a, Strokes) and isinstance(b, Strokes):
        if max(abs(a.width - b.width), abs(a.height - b.height)) > 0.01:
            raise ParameterError(f"{names} differ: sheets of {_size(a)} and {_size(b)} pt")
        allowed, unit = PLACE_PT if place is None else place, "pt"
        one, other = as_printed([a, b], device_dpi)
        found = difference.of_strokes(one, other, max_pixels, threads or processors())
    else:
        assert not isinstance(a, Strokes) and not isinstance(b, Strokes)
        if a.values.shape != b.values.shape:
            sizes = " and ".join(f"{image.values.shape[1]} x {image.values.shape[0]}" for image in (a, b))
            raise ParameterError(f"{names} differ: {sizes} pixels")
        allowed, unit = float(PLACE_PX if place is None else math.floor(place)), "px"
        found = difference.of_pictures(a, b, int(allowed))
    with writing(output, binary=False) as out:
        for what, value, digits in (
            ("tone, the largest difference, %", found.tone, 2),
            ("tone, RMS of the difference, %", found.tone_rms, 2),
            (f"place, the largest difference, {unit}", found.place, 3),
        ):
            out.write(f"{what:<36}{value:>12.{digits}f}\n".encode())
    beyond = []
    if round(found.tone, 2) > tone:
        beyond.append(f"tone by {found.tone:.2f} %, {tone:g} are allowed (--tone)")
    if round(found.place, 3) > allowed:
        beyond.append(f"place by {found.place:.3f} {unit}, {allowed:g} are allowed (--place)")
    if beyond:
        raise ParameterError(f"{names} differ: {'; '.join(beyond)}")


def _size(strokes: Any) -> str:
    return f"{strokes.width:g} x {strokes.height:g}"
