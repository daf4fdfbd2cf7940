"""``penink texture``."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import click

from penink_cli.ground.errors import ParameterError
from penink_cli.ground.streams import reading, source_name, writing
from penink_cli.options.common import LENGTH, TEXT, DeviceDpi, Finite, Length, output_options, warn
from penink_cli.options.textures import TEXTURE, find_texture, shipped
from penink_cli.textures.registry import KINDS

if TYPE_CHECKING:
    from penink_cli.ground.model import Texture


@click.group(name="texture")
@click.help_option("-h", "--help")
def texture() -> None:
    """List, show, make and import stroke textures.

    A texture is a tile of strokes that repeats. Each stroke has a priority: light tones hold only those drawn first.

    \b
    penink texture list
    penink texture make crosshatch --angle 30 --pen 0.3mm -o mine.texture.json
    penink blast --texture mine.texture.json --width 4in photo.pgm | penink to-ps -o photo.ps
    """


@texture.command(name="list")
@output_options
def list_textures(output: str | None, **_: Any) -> None:
    """Name the textures that come with the program."""
    text = "".join(f"{name:12} {KINDS.get(name, '')}".rstrip() + "\n" for name in shipped())
    with writing(output, binary=False) as out:
        out.write(text.encode("utf-8"))


def describe(found: Texture, device_dpi: float | None) -> str:
    """A texture in lines of text: its tile, strokes, pens, the tones it reaches, its layers and its engraving."""
    from penink_cli.blasting.reach import reachable

    strokes = found.strokes
    pens = sorted({f"{w:g}" for w in strokes.widths.tolist()}, key=float)
    low, high = reachable(found, 72.0 / device_dpi if device_dpi else 0.0)
    kind = ", drawn whole or not at all" * found.whole + ", a set, laid along directions" * found.oriented
    lines = [
        f"name      {found.name}",
        f"tile      {strokes.width:g} × {strokes.height:g} pt",
        f"strokes   {len(strokes)}{kind}",
        f"pen       {', '.join(pens[:6])}{', …' if len(pens) > 6 else ''} pt",
        f"tone      {low:.3f} to {high:.3f}"
        + (f" at {device_dpi:g} dpi" if device_dpi else " without a device's gain"),
    ]
    for layer in found.layers:
        closest = f", no closer than {layer.spacing_pt:g} pt" if layer.spacing_pt else ""
        wave = f", wandering {layer.wave_pt:g} pt over {layer.wave_length_pt:g} pt" if layer.wave_pt else ""
        lines.append(
            f"layer     {layer.angle:g}° from tone {layer.low:g} to {layer.high:g}, "
            f"pen {layer.pen_pt:g} pt{closest}{wave}"
        )
    if (lines_of := found.engraving) is not None:
        shape = "along the form, else at" if lines_of.along else "wavering at" if lines_of.waver else "straight at"
        how = "rings" if lines_of.centre else f"{shape} {lines_of.angle:g}°"
        apart = f"{lines_of.lines} across" if lines_of.lines else f"{lines_of.spacing_pt:g} pt apart"
        crossed = f", crossed from tone {lines_of.crosses:g} on" if lines_of.crosses < 1 else ""
        lines.append(f"engraving lines that swell, {how}, {apart}, from {lines_of.finest_pt:g} pt on{crossed}")
    return "\n".join(lines) + "\n"


@texture.command()
@click.argument("name", metavar="NAME|FILE", type=TEXTURE)
@click.option("--json", "as_file", is_flag=True, help="Write the texture file itself.")
@click.option("--device-dpi", type=DeviceDpi(), default="600", show_default=True, metavar="N|none")
@output_options
def show(name: str, as_file: bool, device_dpi: float | None, output: str | None, **_: Any) -> None:
    """Say what a texture is like, and from which tone to which it reaches."""
    found = find_texture(name)
    text = None if as_file else describe(found, device_dpi)
    from penink_cli.formats import texture as texture_format

    with writing(output, binary=False) as out:
        if text is None:
            texture_format.write(out, found)
        else:
            out.write(text.encode("utf-8"))


@texture.command()
@click.argument("kind", type=click.Choice(sorted(KINDS)))
@click.option("--angle", type=Finite(-360, 360), metavar="DEGREES", help="Direction, clockwise from the right.")
@click.option(
    "--spacing",
    type=Length(zero=True),
    help="Of hatching: the least distance of the lines of one layer. Of an engraving: the distance of its lines.",
)
@click.option("--pen", type=LENGTH, help="Width of the strokes.")
@click.option("--finest", type=LENGTH, help="Of an engraving: least width of a line.")
@click.option(
    "--lines",
    type=click.IntRange(1, 100_000),
    metavar="N",
    help="Of an engraving: N lines to the picture's width, whatever its size, instead of --spacing.",
)
@click.option(
    "--crosses",
    type=Finite(0.01, 1),
    metavar="TONE",
    help="Of an engraving: from this tone on a second set of lines crosses the first.",
)
@click.option(
    "--centre",
    "--center",
    type=(Finite(-100, 100), Finite(-100, 100)),
    metavar="X Y",
    help="Of contour-rings: their centre, in parts of the picture's width and height.",
)
@click.option("--layers", type=click.IntRange(1, 4), metavar="1…4", help="Directions of hatching.")
@click.option("--seed", type=click.IntRange(0, 2**63 - 1), metavar="N", help="Each number is another hand.")
@click.option("--name", type=TEXT, help="The texture's name.  [default: KIND]")
@output_options
def make(
    kind: str,
    angle: float | None,
    spacing: float | None,
    pen: float | None,
    layers: int | None,
    seed: int | None,
    finest: float | None,
    lines: int | None,
    centre: tuple[float, float] | None,
    crosses: float | None,
    name: str | None,
    output: str | None,
    **_: Any,
) -> None:
    """Make a texture of a KIND, evenly spaced in every tone.

    This takes some seconds. Without options the texture is the one that comes with the program. An option that means
    nothing to the KIND is refused.
    """
    from penink_cli.textures.make import make as make_texture

    made = make_texture(
        kind, angle=angle, pen=pen, spacing=spacing, layers=layers, seed=seed, finest=finest, lines=lines,
        centre=centre, crosses=crosses,
    )  # fmt: skip
    if name:
        made = replace(made, name=name)
    from penink_cli.formats import texture as texture_format

    with writing(output, binary=False) as out:
        texture_format.write(out, made)


def _title(source: str) -> str:
    """The name of a texture by that of its file, which need not be UTF-8."""
    name = source.rsplit("/", 1)[-1].removesuffix(".svg")
    return name.encode("utf-8", "replace").decode("utf-8")


@texture.command(name="import")
@click.argument("file", required=False, metavar="[SVG]", type=click.Path(allow_dash=True))
@click.option("--name", type=TEXT, help="The texture's name.  [default: the file's]")
@click.option("--pen", type=LENGTH, help="Width of all strokes.  [default: each path's stroke-width]")
@click.option("--whole", is_flag=True, help="Strokes are drawn whole or not at all.")
@click.option("--oriented", is_flag=True, help="A set of examples, each path from left to right along the form.")
@output_options
def import_svg(
    file: str | None, name: str | None, pen: float | None, whole: bool, oriented: bool, output: str | None, **_: Any
) -> None:
    """Make a texture of an SVG drawing.

    Its paths, lines and shapes become strokes; their order in the drawing is their priority. The drawing's size is the
    tile's. What is invisible or white, a background, text and images are left out: turn text to paths first.

    With --oriented the strokes are examples that `blast --directions` bends along the form, in the size that they are
    drawn in.

    \b
    penink texture import --oriented hair.svg -o hair.texture.json
    """
    from penink_cli.formats import svg_texture

    if whole and oriented:
        raise click.UsageError("--whole is of a tile, and does not go with --oriented")
    source = source_name(file)
    with reading(file) as stream:
        title = name or (_title(source) if file and file != "-" else "imported")
        drawing = svg_texture.read(stream, source, title, pen, whole, lambda line: warn(f"{source}: {line}"))
    if oriented:
        from penink_cli.textures.sets import as_set

        drawing, left_out = as_set(drawing)
        if left_out and len(drawing.strokes):
            warn(f"{source}: {left_out} of the paths left out, which lead less than 1 pt from left to right")
    if not len(drawing.strokes):
        raise ParameterError(f"no stroke {'from left to right ' * oriented}in the drawing").from_source(source)
    from penink_cli.formats import texture as texture_format

    with writing(output, binary=False) as out:
        texture_format.write(out, drawing)
