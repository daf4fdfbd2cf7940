"""``penink draw``."""

from __future__ import annotations

import math
import os
import shlex
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from penink_cli.commands.blast import warnings
from penink_cli.ground.errors import in_quotes
from penink_cli.ground.streams import writing
from penink_cli.options.common import (
    LENGTH,
    DeviceDpi,
    Finite,
    filter_options,
    processors,
    threads_option,
    verbose_option,
    warn,
)
from penink_cli.options.inputs import photo_options, read_photo
from penink_cli.options.layers import as_printed
from penink_cli.options.sheet import check_sheet
from penink_cli.options.textures import find_texture, texture_option

if TYPE_CHECKING:
    from penink_cli.ground.model import Illustration, OutlineChoice, Strokes

OUTLINE_PEN_PT = 0.7
OUTLINE_STRENGTH = 0.2  # the grey step that is worth an outline
OUTLINE_LENGTH = 0.04  # of the photo's longer side: shorter chains are texture, and the hatching's to show
PNG_DPI = 150.0
PRINTER_DPI = 600.0
ON_SCREEN = (".png", ".svg")  # these are looked at as they are, mostly; a printer would darken them


@click.command()
@filter_options
@photo_options
@texture_option
@click.option("--width", type=LENGTH, default="6in", show_default=True, help="Width on paper: 4in, 100mm.")
@click.option("--pen", type=LENGTH, help="Draw everything with one pen of this width.  [default: the texture's]")
@click.option("--gamma", type=Finite(0.05, 20), default=1.0, metavar="G", help="Tone curve: grey is raised to it.")
@click.option("--seed", type=click.IntRange(0, 2**62), default=0, show_default=True, metavar="N", help="Another hand.")
@click.option(
    "--device-dpi",
    type=DeviceDpi(),
    metavar="N|none",
    help="Resolution of the printer, which paints every dot that a stroke touches; none for plotters and screens."
    "  [default: 600, for .png and .svg none]",
)
@click.option("--outlines/--no-outlines", default=True, help="Outline strokes along strong edges.  [default: yes]")
@threads_option
@verbose_option
def draw(
    file: str | None,
    output: str | None,
    max_pixels: int,
    quiet: bool,
    texture_name: str,
    width: float,
    pen: float | None,
    gamma: float,
    seed: int,
    device_dpi: float | None,
    outlines: bool,
    threads: int | None,
    verbose: bool,
) -> None:
    """Turn a photo into a pen-and-ink drawing, the whole chain in one call.

    The result is PostScript, or what the ending of -o says: .ps, .eps, .svg, .pdf, .png, .jsonl (strokes) or
    .penink, the illustration itself, which `penink render` draws at any size. --verbose prints the chain of
    filters that gives the same bytes.

    \b
    penink draw photo.jpg -o photo.pdf
    penink draw photo.jpg --width 24in --device-dpi 1200 | lpr
    """
    from penink_cli.ground.model import Illustration, Layer, OutlineChoice
    from penink_cli.illustration import drawing
    from penink_cli.options.progress import progress

    ending = os.path.splitext(output or "-")[1].lower() or ".ps"  # a FIFO or device has no ending
    if ending not in WRITERS:
        raise click.UsageError(f"-o {in_quotes(output or '')}: known endings are {', '.join(WRITERS)}")
    threads = threads or processors()
    texture = find_texture(texture_name)
    photo = read_photo(file, max_pixels)
    rows, columns = photo.values.shape
    height = width * rows / columns
    check_sheet(width, height, max_pixels)
    if click.get_current_context().get_parameter_source("device_dpi") is ParameterSource.DEFAULT:
        device_dpi = None if ending in ON_SCREEN else PRINTER_DPI
    choice = None
    if outlines:
        least = math.floor(OUTLINE_LENGTH * max(rows, columns) + 0.5)
        choice = OutlineChoice(pen or OUTLINE_PEN_PT, pen is not None, OUTLINE_STRENGTH, least)
    with progress(5, "draw", quiet) as advance:
        edges, reduced, grid = drawing.represented(photo, threads, advance)
        if verbose:
            options = click.get_current_context().params | {"device_dpi": device_dpi}
            for line in _chain(file, output, ending, options, grid, choice, (rows, columns)):
                click.echo(line, err=True)
        if ending == ".penink":
            own = "." in texture_name or "/" in texture_name
            layer = Layer(
                reduced, edges, texture, None if own else texture_name,
                pen_pt=pen, gamma=gamma, seed=seed, outline=choice,
            )  # fmt: skip
            _write_illustration(output, Illustration(width, height, (layer,)))
            return
        for line in warnings(drawing.tone_curve(reduced, gamma), texture, pen, device_dpi):
            warn(line)
        outlined = drawing.outlined(edges, width, height, choice, device_dpi=device_dpi) if choice else None
        grey = drawing.enlarged(reduced, edges, drawing.grey_size(width, rows / columns), threads)
        advance(1)
        hatched = drawing.blasted(
            grey, width, edges, texture, seed=seed, pen_pt=pen, gamma=gamma, device_dpi=device_dpi, ink=outlined,
            threads=threads,
        )  # fmt: skip
        advance(1)
    WRITERS[ending](output, [hatched] if outlined is None else [hatched, outlined])


# ------------------------------------------------------------------- the picture, by its ending


def _write_ps(output: str | None, layers: Sequence[Strokes]) -> None:
    from penink_cli.outputs import postscript
    from penink_cli.outputs.page import lay_out
    from penink_cli.travel.order import ordered

    with writing(output, binary=False) as out:
        postscript.write(out, layers, lay_out(layers), order=partial(ordered, improve=False))


def _write_svg(output: str | None, layers: Sequence[Strokes]) -> None:
    from penink_cli.outputs import svg
    from penink_cli.outputs.page import lay_out

    layers = as_printed(layers, None)
    with writing(output, binary=False) as out:
        svg.write(out, layers, lay_out(layers))


def _write_pdf(output: str | None, layers: Sequence[Strokes]) -> None:
    from penink_cli.outputs import pdf
    from penink_cli.outputs.page import lay_out

    layers = as_printed(layers, None)
    with writing(output) as out:
        pdf.write(out, layers, lay_out(layers))


def _write_png(output: str | None, layers: Sequence[Strokes]) -> None:
    from penink_cli.outputs.page import lay_out
    from penink_cli.outputs.raster import cover, png

    layers = as_printed(layers, None)
    page = lay_out(layers)
    with writing(output) as out:
        png.write(out, cover.size(page, PNG_DPI), PNG_DPI, 8, cover.bands(layers, page, PNG_DPI, 255, processors()))


def _write_strokes(output: str | None, layers: Sequence[Strokes]) -> None:
    from penink_cli.formats import strokes
    from penink_cli.ground.model import Strokes

    with writing(output, binary=False) as out:
        strokes.write(out, Strokes.joined(layers))


def _write_illustration(output: str | None, illustration: Illustration) -> None:
    from penink_cli.formats import archive
    from penink_cli.formats import illustration as illustration_format
    from penink_cli.options.inputs import settled

    with writing(output) as out:
        out.write(archive.pack(illustration_format.members(settled(illustration))))


WRITERS: dict[str, Callable[[str | None, Sequence[Strokes]], None]] = {
    ".ps": _write_ps,
    ".eps": _write_ps,
    ".svg": _write_svg,
    ".pdf": _write_pdf,
    ".png": _write_png,
    ".jsonl": _write_strokes,
    ".penink": lambda output, layers: None,  # written before anything is drawn
}


# ------------------------------------------------------------------- the same by hand


def _chain(
    file: str | None, output: str | None, ending: str, options: dict[str, Any], grid: str,
    choice: OutlineChoice | None, shape: tuple[int, int],
) -> list[str]:  # fmt: skip
    """The filters whose chain gives the same bytes, as one would type them."""
    from penink_cli.illustration.drawing import grey_size

    photo = shlex.quote(file or "-")
    size = grey_size(options["width"], shape[0] / shape[1])
    width = f"--width {options['width']!r}"
    pen = "" if options["pen"] is None else f" --pen {options['pen']!r}"
    blast = f"penink blast -e e.json --texture {shlex.quote(options['texture_name'])} {width}{pen}"
    blast += f" --gamma {options['gamma']!r} --seed {options['seed']}"
    device = f" --device-dpi {'none' if options['device_dpi'] is None else repr(options['device_dpi'])}"
    blast += device
    lines = [f"penink detect-edges {photo} -o e.json"]
    samples = f"penink extract-samples -e e.json {photo} | penink reduce -e e.json {grid} --photo {photo}"
    if ending == ".penink":
        lines.append(f"{samples} -o samples.pgm")
        return [*lines, "# and `penink pack` of an illustration.json that names both, the texture and the outlines"]
    names = "hatching.jsonl"
    if choice:
        lines.append(
            f"penink outline {width}{pen} --min-strength {choice.min_strength} --min-length {choice.min_length:g}"
            f"{device} e.json -o outlines.jsonl"
        )
        blast += " --ink outlines.jsonl"
        names += " outlines.jsonl"
    lines.append(
        f"{samples} | penink enlarge -e e.json --size {size[0]}x{size[1]} --soften | {blast} -o hatching.jsonl"
    )
    command = {".svg": "to-svg", ".pdf": "to-pdf", ".png": "to-png"}.get(ending, "to-ps")
    lines.append(f"penink {command} {names}" + (f" -o {shlex.quote(output)}" if output not in (None, "-") else ""))
    return lines
