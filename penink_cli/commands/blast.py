"""``penink blast``."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import click

from penink_cli.ground.rules import RULES
from penink_cli.ground.streams import writing
from penink_cli.options.colours import COLOUR
from penink_cli.options.common import (
    LENGTH,
    POSITIVE,
    TEXT,
    Finite,
    edges_option,
    filter_options,
    printer_option,
    processors,
    reporter,
    threads_option,
    verbose_option,
    warn,
)
from penink_cli.options.inputs import (
    only_one_standard_input,
    read_directions,
    read_edges,
    read_grey,
    read_lines,
    read_to_blast,
)
from penink_cli.options.layers import read_layers
from penink_cli.options.progress import progress
from penink_cli.options.sheet import check_sheet
from penink_cli.options.textures import find_texture, texture_option

if TYPE_CHECKING:
    from penink_cli.ground.model import Floats, Texture


@click.command()
@texture_option
@edges_option(required=False, says="Strokes end at them.")
@click.option("--width", type=LENGTH, help="Width of the picture on paper: 4in, 100mm, 288 (points).")
@click.option("--dpi", type=POSITIVE, metavar="N", help="Size on paper by the samples per inch, instead of --width.")
@click.option("--pen", type=LENGTH, help="Draw all strokes with one pen of this width.  [default: the texture's]")
@click.option(
    "--finer",
    type=Finite(0.1, 1),
    default=1.0,
    metavar="F",
    help="Draw with pens F times as wide, and with lines as much closer.  [default: 1]",
)
@click.option(
    "--natural",
    type=LENGTH,
    help="Width of the picture in which a texture that grows has its own size.  [default: as the texture says]",
)
@click.option("--gamma", type=Finite(0.05, 20), default=1.0, metavar="G", help="Tone curve: grey to the power of G.")
@click.option(
    "--seed",
    type=click.IntRange(0, 2**63 - 1),
    default=0,
    show_default=True,
    metavar="N",
    help="Each number is another hand; the rule threshold has only one.",
)
@printer_option()
@click.option(
    "--rule",
    type=click.Choice(list(RULES)),
    default="best",
    show_default=True,
    help=" ".join(f"{name}: {what}." for name, what in RULES.items()),
)
@click.option(
    "--swell",
    type=Finite(0, 2),
    default=0.0,
    metavar="S",
    help="Strokes of hatching swell where the picture is darker than around: S times as much as it is darker.  "
    "[default: 0]",
)
@click.option(
    "--tone-of",
    "true_file",
    type=click.Path(allow_dash=True),
    metavar="FILE",
    help="A PGM: the drawing gets its tone, where FILE is a sharper image made of it.",
)
@click.option(
    "--directions",
    "directions_file",
    type=click.Path(allow_dash=True),
    metavar="FILE",
    help="A field of directions of the picture (see penink detect-directions): hatching runs along it.",
)
@click.option(
    "--lines",
    "lines_file",
    type=click.Path(allow_dash=True),
    metavar="FILE",
    help="Telling lines of the picture: light ones are left out, and hatching keeps clear of dark ones (--ink).",
)
@click.option(
    "--ink",
    "ink_files",
    type=click.Path(allow_dash=True),
    multiple=True,
    metavar="FILE",
    help="Strokes that are on the paper already, such as outlines: counted, not written; may be repeated.",
)
@click.option(
    "--turn",
    type=Finite(-360, 360),
    default=0.0,
    metavar="DEGREES",
    help="Turn the hatching clockwise, also from a field of directions, so that hatching of several inks crosses.",
)
@click.option(
    "--solid",
    type=Finite(0.5, 1),
    metavar="TONE",
    help="If the texture reaches black, fill what is as dark as TONE or darker: .985 for a plate.  "
    "[default: .93 or .97]",
)
@click.option("--color", "--colour", "colour", type=COLOUR, metavar="COLOUR", help="Colour of the ink, for the result.")
@click.option("--layer", "layer_name", type=TEXT, metavar="NAME", help="Name of the layer, for the result.")
@threads_option
@verbose_option
@filter_options
def blast(
    file: str | None,
    output: str | None,
    max_pixels: int,
    texture_name: str,
    edges_file: str | None,
    width: float | None,
    dpi: float | None,
    pen: float | None,
    finer: float,
    natural: float | None,
    gamma: float,
    seed: int,
    device_dpi: float | None,
    rule: str,
    swell: float,
    true_file: str | None,
    directions_file: str | None,
    lines_file: str | None,
    ink_files: tuple[str, ...],
    turn: float,
    solid: float | None,
    colour: tuple[float, float, float] | None,
    layer_name: str | None,
    threads: int | None,
    quiet: bool,
    verbose: bool,
    **_: Any,
) -> None:
    """Turn grey into pen strokes of the same tone.

    The width and the density of strokes do not depend on the size: blasted for any size, a picture has the same tone
    and as many strokes to the inch. Given the edges of the image, strokes end at them.

    \b
    penink blast --texture crosshatch --width 4in photo.pgm | penink to-ps -o photo.ps
    penink blast --texture form -e photo.edges.json --directions photo.directions.pgm --width 4in photo.pgm
    """
    from penink_cli.blasting.blast import TICKS
    from penink_cli.blasting.blast import blast as blast_tone
    from penink_cli.blasting.pens import finer_texture
    from penink_cli.blasting.rules import rule as find_rule
    from penink_cli.formats import strokes as strokes_format
    from penink_cli.ground.codes import code_of
    from penink_cli.ground.model import Strokes, turned
    from penink_cli.illustration.drawing import tone_curve

    if (width is None) == (dpi is None):
        raise click.UsageError("give one of --width and --dpi")
    piped_texture = texture_name if texture_name == "-" else None
    only_one_standard_input(file, edges_file, true_file, directions_file, lines_file, *ink_files, piped_texture)
    texture = turned(finer_texture(find_texture(texture_name), finer, device_dpi), turn)
    edges = read_edges(edges_file, max_pixels)
    image = read_grey(file, max_pixels) if width is None else read_to_blast(file, max_pixels)
    rows, columns = image.values.shape
    wide, high = (columns, rows) if edges is None else (edges.width, edges.height)
    directions = read_directions(directions_file, wide, high, max_pixels)
    lines = read_lines(lines_file, image)
    width_pt = width if width is not None else columns / (dpi or 1.0) * 72.0
    height_pt = width_pt * rows / columns
    check_sheet(width_pt, height_pt, max_pixels)
    ink = read_layers(ink_files) if ink_files else []
    tone = tone_curve(image, gamma)
    true = None if true_file is None else tone_curve(read_to_blast(true_file, max_pixels), gamma)
    for line in warnings(tone, texture, pen, device_dpi):
        warn(line)
    if directions and not find_rule(rule).follows(texture):
        why = 'by the rule "best" one with hatching layers or a set is, save straight engravings'
        warn(f"{texture.name} is not drawn along directions: {why}")
    with progress(TICKS, "blasting", quiet) as more:
        strokes = blast_tone(
            tone,
            width_pt,
            height_pt,
            edges,
            texture,
            seed=seed,
            pen_pt=pen,
            natural_pt=natural,
            true=true,
            solid=solid,
            device_dpi=device_dpi,
            rule=rule,
            outlines=Strokes.joined(ink) if ink else None,
            directions=directions and directions.turned(turn),
            lines=lines,
            swell=swell,
            threads=threads or processors(),
            tick=lambda: more(1),
        )
    if len(strokes):
        pens = f"{strokes.widths.min():.2f} to {strokes.widths.max():.2f} pt"
        reporter(verbose)(f"{len(strokes)} strokes of {texture.name}, {pens} wide, on {width_pt:g} x {height_pt:g} pt")
    with writing(output, binary=False) as out:
        strokes_format.write(out, replace(strokes, color=colour and code_of(colour), layer=layer_name))


def warnings(tone: Floats, texture: Texture, pen: float | None, device_dpi: float | None) -> list[str]:
    """What will keep the picture from having its tone, a line each.

    tone: (h, w), 0 … 1. pen: width of the one pen, points, None for the texture's.
    """
    from penink_cli.blasting.blast import too_dark
    from penink_cli.blasting.reach import reachable

    lines = []
    if device_dpi:
        narrowest = (pen or float(texture.strokes.widths.min())) * device_dpi / 72
        if narrowest < 1.5:
            lines.append(
                f"a pen of {narrowest:.2g} dots at {device_dpi:g} dpi: from 1.5 on the tone is true; use a wider --pen"
            )
    _, darkest = reachable(texture, 72.0 / device_dpi if device_dpi else 0.0)
    part = too_dark(tone, darkest)
    if part > 0.001:
        lines.append(f"{part:.1%} of the picture is darker than {texture.name} can be ({darkest:.3f})")
    return lines
