"""``penink measure``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import Finite, output_options, processors, threads_option
from penink_cli.options.inputs import only_one_standard_input
from penink_cli.options.layers import as_printed, files_argument, gain_option, read_layers
from penink_cli.options.photographs import photo_options, read_image_or_strokes

if TYPE_CHECKING:
    from penink_cli.measuring.lines import LineFigures
    from penink_cli.measuring.tone import ToneFigures

PERCENT = Finite(least=0, most=100)


@click.command()
@files_argument
@click.option(
    "--against",
    type=click.Path(allow_dash=True),
    metavar="FILE",
    help="What the drawing is to show: a PGM image, a photograph, or strokes.",
)
@click.option("--max-rms", type=PERCENT, metavar="PERCENT", help="Exit 1 where the RMS of the tone's error is more.")
@click.option("--max-bias", type=PERCENT, metavar="PERCENT", help="Exit 1 where the tone is lighter or darker by more.")
@click.option("--max-stray", type=PERCENT, metavar="PERCENT", help="Exit 1 where ink covers more of what is white.")
@click.option("--json", "as_json", is_flag=True, help="Figures as JSON.")
@gain_option
@photo_options
@threads_option
@output_options
def measure(
    files: tuple[str, ...],
    against: str | None,
    max_rms: float | None,
    max_bias: float | None,
    max_stray: float | None,
    as_json: bool,
    device_dpi: float | None,
    threads: int | None,
    output: str | None,
    max_pixels: int,
    **_: Any,
) -> None:
    """Measure a drawing: its tone against what it shows, how its strokes lie.

    Tone is what the eye sees, a Gaussian of 1/16 inch, in percent of solid ink. Several FILEs are layers.

    \b
    penink measure --against photo.pgm photo.strokes.jsonl
    penink measure --against photo.pgm --max-rms 2 --max-stray 0.1 --json photo.strokes.jsonl
    """
    from penink_cli.ground.errors import FormatError
    from penink_cli.ground.model import Strokes
    from penink_cli.measuring import lines, tone

    if against is None and (max_rms, max_bias, max_stray) != (None, None, None):
        raise click.UsageError("--max-rms, --max-bias and --max-stray go with --against")
    only_one_standard_input(*(files or ("-",)), against or "")
    layers = read_layers(files)
    threads = threads or processors()
    drawn = as_printed(layers, device_dpi)
    have = tone.printed(drawn, max_pixels, threads)
    found = None
    if against is not None:
        other = read_image_or_strokes(against, max_pixels)
        if isinstance(other, Strokes):
            want = tone.printed(as_printed([other], device_dpi), max_pixels, threads)
            if want.shape != have.shape:
                raise FormatError(
                    f"its sheet is {other.width:g} x {other.height:g} pt; the drawing's is another", against
                )
        else:
            want = tone.wanted(other, have.shape[1], have.shape[0], threads)
        found = tone.figures(want, have, threads)
    ink = 100 * float(have.mean(dtype="float64"))
    with writing(output, binary=False) as out:
        out.write(_text(found, lines.figures(layers), ink, as_json).encode())
    if found is not None:
        _hold(found, max_rms, max_bias, max_stray)


def _text(tone: ToneFigures | None, lines: LineFigures, ink: float, as_json: bool) -> str:
    """The figures, rounded, so that they are the same on every machine."""
    import json

    values: dict[str, float | int | None] = {
        "tone_rms": None if tone is None else round(tone.rms, 2),
        "tone_bias": None if tone is None else round(tone.bias, 2) + 0.0,
        "tone_worst": None if tone is None else round(tone.worst, 1),
        "stray": None if tone is None else round(tone.stray, 2),
        "ink": round(ink, 2),
        "evenness": None if lines.evenness is None else round(lines.evenness, 2),
        "strokes": lines.strokes,
        "length_pt": round(lines.length_pt, 1),
        "mean_length_pt": round(lines.mean_length_pt, 2),
        "lifts": lines.lifts,
        "travel_pt": round(lines.travel_pt, 1),
    }
    if as_json:
        return json.dumps(values) + "\n"
    shown = {
        "tone_rms": "tone, RMS of its error, %",
        "tone_bias": "tone, too light by, %",
        "tone_worst": "tone, worst, %",
        "stray": "ink on paper white, %",
        "ink": "ink on all paper, %",
        "evenness": "evenness, 0 to 1",
        "strokes": "strokes",
        "length_pt": "length of all, pt",
        "mean_length_pt": "length of one, pt",
        "lifts": "lifts of the pen",
        "travel_pt": "travel between, pt",
    }
    lines_of = [f"{shown[name]:<28}{value:>12}" for name, value in values.items() if value is not None]
    return "\n".join(lines_of) + "\n"


def _hold(found: ToneFigures, max_rms: float | None, max_bias: float | None, max_stray: float | None) -> None:
    """Raise ParameterError, which names them all, where figures are beyond their limits, percent."""
    from penink_cli.ground.errors import ParameterError

    limits = (
        ("the tone's RMS error", found.rms, max_rms, "--max-rms"),
        ("the tone's bias", abs(found.bias), max_bias, "--max-bias"),
        ("ink on paper white", found.stray, max_stray, "--max-stray"),
    )
    beyond = [
        f"{name} is {value:.2f} %, more than {limit:g} ({option})"
        for name, value, limit, option in limits
        if limit is not None and round(value, 2) > limit
    ]
    if beyond:
        raise ParameterError("; ".join(beyond))
