"""``penink draw``."""

from __future__ import annotations

import os
from typing import Any

import click

from penink_cli.chain.drawing import draw_one
from penink_cli.chain.filters import bench
from penink_cli.chain.job import ARCHIVE
from penink_cli.chain.kept import Kept
from penink_cli.chain.many import draw_all, output_names
from penink_cli.chain.request import Request, checked_style, page_words, pen_of_all
from penink_cli.ground import streams
from penink_cli.ground.errors import in_quotes
from penink_cli.options.common import (
    LENGTH,
    DeviceDpi,
    Finite,
    is_given,
    output_options,
    threads_option,
    verbose_option,
)
from penink_cli.options.composition import composition_options
from penink_cli.options.inks import Inks, inks_option
from penink_cli.options.inputs import only_one_standard_input
from penink_cli.options.layers import colour_option, page_options
from penink_cli.options.photographs import photo_options
from penink_cli.options.styles import STYLE
from penink_cli.options.textures import TEXTURE
from penink_cli.outputs.registry import STROKES, endings, on_screen

STYLE_NAME = "house"
PLATES_TEXTURE = "crosshatch"  # its tone is true up to the darkest, which inks over one another need


@click.command()
@click.argument("files", nargs=-1, metavar="[FILE]...", type=click.Path(allow_dash=True))
@output_options
@photo_options
@click.option(
    "--out-dir",
    type=click.Path(file_okay=False),
    metavar="DIR",
    help="Draw each photo into a file of the photo's name in this folder, which is made if need be.",
)
@click.option(
    "--as",
    "wanted",
    type=click.Choice([ending.removeprefix(".") for ending in endings()]),
    help="What to write, where no ending of -o says it.  [default: ps]",
)
@click.option(
    "--watch", "watching", is_flag=True, help="Draw again whenever the photo or another file of the call changes."
)
@click.option(
    "--style",
    "style_name",
    type=STYLE,
    default=STYLE_NAME,
    show_default=True,
    metavar="NAME|FILE",
    help="A style of drawing (see penink style list), or its file; other options go before what it says.",
)
@click.option(
    "-t",
    "--texture",
    "texture_name",
    type=TEXTURE,
    metavar="NAME|FILE",
    help="A shipped texture (see penink texture list) or a texture file.  [default: the style's]",
)
@click.option("--width", type=LENGTH, help="Width on paper: 4in, 100mm.  [default: 6in, or what --paper holds]")
@click.option("--height", type=LENGTH, help="Height on paper, instead of --width.")
@click.option("--pen", type=LENGTH, help="Draw everything with one pen of this width.  [default: the style's]")
@click.option("--gamma", type=Finite(0.05, 20), metavar="G", help="Tone curve: grey to the power of G.  [default: 1]")
@click.option(
    "--seed",
    type=click.IntRange(0, 2**62),
    default=0,
    show_default=True,
    metavar="N",
    help="Each number is another hand.",
)
@click.option(
    "--device-dpi",
    type=DeviceDpi(),
    metavar="N|none",
    help="Resolution of the printer, which paints every dot that a stroke touches; none for plotters and screens."
    f"  [default: 600, for {', '.join(filter(on_screen, endings()))} none]",
)
@click.option("--outlines/--no-outlines", default=None, help="Strokes along strong edges.  [default: the style's]")
@click.option("--lines/--no-lines", default=None, help="Telling lines.  [default: the style's]")
@click.option(
    "--directions",
    "directions_file",
    type=click.Path(allow_dash=True),
    metavar="FILE",
    help="Hatch along this file: a field of directions, or your own strokes over the photo, as strokes or SVG.",
)
@inks_option
@click.option("--black", type=Finite(0, 1), metavar="SHARE", help="With --inks, as separate has it.  [default: 0.8]")
@composition_options
@page_options
@colour_option
@click.option("--order", is_flag=True, help="Order and turn the strokes so that a pen travels little (.svg).")
@click.option(
    "--max-bytes", type=click.IntRange(1), metavar="N", help="The best illustration of at most N bytes (.penink)."
)
@click.option(
    "--pens",
    "pens_file",
    type=click.Path(),
    metavar="FILE",
    help="The plotter's pens, as of to-svg (.svg); if all have one width, everything is drawn with that width.",
)
@threads_option
@verbose_option
def draw(
    files: tuple[str, ...],
    output: str | None,
    max_pixels: int,
    style_name: str,
    width: float | None,
    height: float | None,
    out_dir: str | None,
    wanted: str | None,
    watching: bool,
    inks: Inks | None,
    black: float | None,
    **_: Any,
) -> None:
    """Turn a photo into a pen-and-ink drawing, the whole chain in one call.

    The result is PostScript, or what --as or the ending of -o says: ENDINGS. Of these .jsonl is the strokes, .penink
    the illustration itself, which `penink render` draws at any size, and .html a page that draws it.
    --verbose prints the chain of filters that gives the same bytes.

    With --out-dir any number of photos are drawn in one go; photos that cannot be read are named at the end. With
    --watch the photo is drawn again whenever it changes, or the style, texture, mask or strokes given as files, until
    the command is interrupted; only what has changed is made anew, and a page reloads itself in the browser.

    With --inks the drawing is in colours, one plate for each ink. The colours are the photo's, unless --strength,
    --detail, --target, --mask or --style says how to compose them. Lines go to the darkest ink, and the texture is
    crosshatch unless another is named. Plates are drawn twice, so that together they have the right colours (see penink
    balance).

    \b
    penink draw photo.jpg -o photo.pdf
    penink draw photo.jpg --style engraving --paper a4 --margin 15mm --device-dpi 1200 | lpr
    penink draw *.jpg --as svg --out-dir drawings
    penink draw photo.jpg --directions strokes.svg --watch -o photo.html
    """
    context = click.get_current_context()
    given = {name: value for name, value in context.params.items() if is_given(name)}
    ending = _ending(output, out_dir, wanted, watching)
    if "max_bytes" in given and ending != ARCHIVE:
        raise click.UsageError(f"--max-bytes is of no use for {ending}")
    if width is not None and height is not None:
        raise click.UsageError("give one of --width and --height")
    read = [path for name in ("mask", "directions_file", "pens_file") if (path := given.get(name)) is not None]
    dashes = [path for path in (style_name, given.get("texture_name")) if path == "-"]
    if out_dir is None and len(files) > 1:
        raise click.UsageError("several photos need --out-dir DIR")
    if (out_dir or watching) and ("-" in (*files, *read, *dashes) or not files):
        raise click.UsageError(f"{'--out-dir' if out_dir else '--watch'} reads files, not standard input")
    file = files[0] if files else None
    only_one_standard_input(file, *read, *dashes)
    page = page_words(ending, given)
    if black is not None and inks is None:
        raise click.UsageError("--black goes with --inks")
    if inks is not None and (ending == STROKES or "colours" in given):
        why = f"{ending} has one colour" if ending == STROKES else "--color says what --inks says"
        raise click.UsageError(f"--inks: {why}")
    if inks is not None and "texture_name" not in given:
        given["texture_name"] = PLATES_TEXTURE
    if "pens_file" in given and "pen" not in given and (pen := pen_of_all(given["pens_file"])) is not None:
        given["pen"] = pen
    request = Request(context.params, given, ending, page, checked_style(style_name))
    named = [path for path in (style_name, given.get("texture_name")) if path]
    if watching:
        _draw_again(request, file, output, read)
    elif out_dir is not None:
        outputs = output_names(files, out_dir, ending)
        streams.keep_inputs(outputs, [*files, *read, *named])
        draw_all(request, files, outputs)
    else:
        with bench() as between:
            draw_one(request, file, output, between)


draw.help = (draw.help or "").replace("ENDINGS", ", ".join(endings()))


def _draw_again(request: Request, file: str | None, output: str | None, read: list[str]) -> None:
    """Draw, and draw again after each change of a file of the call, until a signal ends the process."""
    from penink_cli.ground.recall import remembering
    from penink_cli.options.watching import watch

    request.page.extend(["--reload"] if request.ending == ".html" else [])
    kept = Kept()

    def once() -> None:
        streams.keep_inputs([output], [file, *read])  # a file saved anew may have an old drawing's inode
        draw_one(request.read_anew(), file, output, between, kept)

    with bench() as between, remembering():
        watch(once)


def _ending(output: str | None, out_dir: str | None, wanted: str | None, watching: bool) -> str:
    """The ending of what is to be written. Raises UsageError where -o, --out-dir, --as and --watch do not agree."""
    own = os.path.splitext(output or "-")[1].lower()  # a FIFO or device has none
    if own and own not in endings():
        raise click.UsageError(f"-o {in_quotes(output or '')}: known endings are {', '.join(endings())}")
    if out_dir is not None and (output is not None or watching):
        raise click.UsageError(f"--out-dir does not go with {'--watch' if output is None else '-o'}")
    if watching and output in (None, "-"):
        raise click.UsageError("--watch needs -o FILE")
    if own and wanted is not None and own != f".{wanted}":
        raise click.UsageError(f"--as {wanted} and -o {in_quotes(output or '')} differ")
    return own or f".{wanted or 'ps'}"
