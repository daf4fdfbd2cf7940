"""``penink draw``."""

from __future__ import annotations

import json
import math
import os
import shlex
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from penink_cli.commands.chain import Chain, Kept, bench, check, found, worded, words
from penink_cli.commands.compose import composition_options
from penink_cli.ground import streams
from penink_cli.ground.codes import code_of
from penink_cli.ground.errors import PeninkError, StreamError, in_quotes
from penink_cli.ground.units import parse_length
from penink_cli.options.common import (
    LENGTH,
    DeviceDpi,
    Finite,
    output_options,
    reporter,
    threads_option,
    verbose_option,
    warn,
)
from penink_cli.options.inks import CMYK, Inks, inks_option
from penink_cli.options.inputs import only_one_standard_input, photo_options, photo_words, read_colours
from penink_cli.options.layers import colour_option, page_options
from penink_cli.options.sheet import check_sheet
from penink_cli.options.styles import STYLE, find_style
from penink_cli.options.textures import TEXTURE, find_texture
from penink_cli.outputs.registry import STROKES, endings, of_illustrations, on_screen, writer

if TYPE_CHECKING:
    from penink_cli.formats.style import Style, Value

STYLE_NAME = "house"
USUAL_WIDTH = 432.0
OUTLINE_STRENGTH = 0.2  # the grey step that is worth an outline
OUTLINE_LENGTH = 0.04  # of the photo's longer side: shorter chains are texture, and the hatching's to show
COMPOSED_DPI = 288.0  # as `compose` has it
PLATES_TEXTURE = "crosshatch"  # true up to the darkest tones, which inks over one another need
PRINTER_DPI = 600.0
POSTER_DPI = 1152.0  # pixels an inch that an illustration is made from: those of a drawing four times as wide
ARCHIVE = ".penink"
# What an archive begins with that is then made as coarse as its bytes ask.
RICH_WORTH, RICH_ERROR = 40.0, 2.0
FIELD_SIDE = 64  # samples of directions along the longer side of an archive
WORTH = 120.0  # squared grey levels a bit that a chain of edges of an archive saves
DEVICE_SIDE = 254  # samples a side that a device is sent at the most

# The options that are told to one stage, by their names there.
_TOLD = {
    "texture_name": ("blast", "texture"),
    "gamma": ("blast", "gamma"),
    "seed": ("blast", "seed"),
    "strength": ("compose", "strength"),
    "detail": ("compose", "detail"),
    "mix": ("compose", "mix"),
    "target": ("compose", "target"),
    "vignette": ("compose", "vignette"),
}


@click.command()
@click.argument("files", nargs=-1, metavar="[FILE]...", type=click.Path(allow_dash=True))
@output_options
@photo_options
@click.option(
    "--out-dir",
    type=click.Path(file_okay=False),
    metavar="DIR",
    help="Draw each photo into a file of its name in this folder, which is made if need be.",
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
    help="A style of drawing (see penink style list), or its file; what other options say goes before it.",
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
@click.option("--gamma", type=Finite(0.05, 20), metavar="G", help="Tone curve: grey is raised to it.  [default: 1]")
@click.option("--seed", type=click.IntRange(0, 2**62), default=0, show_default=True, metavar="N", help="Another hand.")
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
    help="Hatch along this: a field of directions, or your own strokes over the photo, a strokes file or SVG.",
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
    help="The plotter's pens, as to-svg has it (.svg); if all are of one width, everything is drawn with that.",
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

    With --out-dir any number of photos are drawn in one go; what cannot be read is named at the end, and the rest is
    done. With --watch the drawing follows its photo, and the style, texture, mask or strokes given as files, until it
    is interrupted; only what has changed is made anew, and a page reloads itself in the browser.

    With --inks it is drawn in colours, a plate an ink, whose tones are the photo's; lines are the
    darkest ink's, and the texture is crosshatch unless another is named.

    \b
    penink draw photo.jpg -o photo.pdf
    penink draw photo.jpg --style engraving --paper a4 --margin 15mm --device-dpi 1200 | lpr
    penink draw *.jpg --as svg --out-dir drawings
    penink draw photo.jpg --directions strokes.svg --watch -o photo.html
    """
    context = click.get_current_context()
    given = {name: value for name, value in context.params.items() if _is_given(context, name)}
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
    page = _page_words(ending, given)
    if black is not None and inks is None:
        raise click.UsageError("--black goes with --inks")
    if inks is not None and (ending == STROKES or "colours" in given):
        why = f"{ending} has one colour" if ending == STROKES else "--color says what --inks says"
        raise click.UsageError(f"--inks: {why}")
    if inks is not None and "texture_name" not in given:
        given["texture_name"] = PLATES_TEXTURE
    if "pens_file" in given and "pen" not in given:
        given |= _one_width(given["pens_file"])
    style = find_style(style_name)
    check(style, style_name)
    call = _Call(context.params, given, ending, page, style)
    if watching:
        from penink_cli.options.watching import watch

        page += ["--reload"] if ending == ".html" else []
        kept = Kept()

        def draw_again() -> None:
            streams.keep_inputs([output], [file, *read])  # a file saved anew may have an old drawing's inode
            _draw(call.read_anew(), file, output, on_bench, kept)

        with bench() as on_bench:
            watch(draw_again)
    if out_dir is None:
        with bench() as on_bench:
            _draw(call, file, output, on_bench)
        return
    outputs = _names(files, out_dir, ending)
    streams.keep_inputs(outputs, [*files, *read, *(path for path in (style_name, given.get("texture_name")) if path)])
    _draw_all(call, files, outputs)


@dataclass(frozen=True)
class _Call:
    """What the user has asked for, whatever the photo.

    options: all of the call; given: those that the user has named. page: what the filter that writes is told of it.
    """

    options: dict[str, Any]
    given: dict[str, Any]
    ending: str
    page: list[str]
    style: Style

    def read_anew(self) -> _Call:
        """The same, with the style as its file is now."""
        name = self.options["style_name"]
        style = find_style(name)
        check(style, name)
        return replace(self, style=style)


def _draw_all(call: _Call, files: tuple[str, ...], outputs: list[str]) -> None:
    """Each photo into its file; PeninkError at the end for those that could not be drawn."""
    from penink_cli.options.progress import progress

    failed = []
    with progress(len(files), "draw", call.options["quiet"]) as advance:
        for file, output in zip(files, outputs):
            try:
                with bench() as on_bench:
                    _draw(call, file, output, on_bench, quiet=True)
            except (PeninkError, MemoryError) as error:
                why = str(error) if isinstance(error, PeninkError) else "not enough memory"
                failed.append(why if why.startswith(file) else f"{file}: {why}")
            advance(1)
    if failed:
        raise PeninkError(f"{len(failed)} of {len(files)} photos could not be drawn: {'; '.join(failed)}")


def _names(files: tuple[str, ...], out_dir: str, ending: str) -> list[str]:
    """Where each photo is drawn, in a folder that is there afterwards; UsageError where two would be one file."""
    outputs: dict[str, str] = {}
    for file in files:
        output = os.path.join(out_dir, os.path.splitext(os.path.basename(file))[0] + ending)
        if output in outputs:
            raise click.UsageError(f"{in_quotes(outputs[output])} and {in_quotes(file)} would both become {output}")
        outputs[output] = file
    try:
        os.makedirs(out_dir, exist_ok=True)
    except OSError as error:
        raise StreamError(os.strerror(error.errno or 0), out_dir) from error
    return list(outputs)


def _ending(output: str | None, out_dir: str | None, wanted: str | None, watching: bool) -> str:
    """The ending of what is to be written."""
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


def _draw(
    call: _Call, file: str | None, output: str | None, files: dict[str, bytes], kept: Kept | None = None,
    quiet: bool = False,
) -> None:  # fmt: skip
    """One photo. files: the bench that it is drawn on. kept: what filters have made before."""
    from penink_cli.options.progress import progress

    options, given, ending = call.options, call.given, call.ending
    stages = _told(call.style, given)
    width, max_pixels = options["width"], options["max_pixels"]
    inks: Inks | None = options["inks"]
    steps = 9 if inks is None else 6 + 4 * len(inks.names)
    with progress(steps, "draw", quiet or options["quiet"]) as advance:
        shape = read_colours(file, max_pixels).values.shape
        rows, columns = shape[:2]
        if options["height"] is not None:
            width = options["height"] * columns / rows
        if width is None:
            width = min(USUAL_WIDTH, _room(given, rows / columns))
        check_sheet(width, width * rows / columns, max_pixels)
        taken = (file, output, given.get("mask"), given.get("directions_file"), given.get("texture_name"))
        limit = max_pixels if "max_pixels" in given else None
        say = reporter(options["verbose"])
        chain = Chain(files, taken, options["threads"], limit, say, lambda: advance(1), kept)
        device_dpi = given.get("device_dpi", None if on_screen(ending) else PRINTER_DPI)
        _Drawing(chain, stages, given, width, rows / columns, ending, device_dpi, inks).draw(
            file, shape, output, call.page
        )
    if kept is not None:
        kept.forget_others()


draw.help = (draw.help or "").replace("ENDINGS", ", ".join(endings()))


def _one_width(path: str) -> dict[str, Any]:
    """The width of the pens of a file, where all have the same."""
    from penink_cli.formats import pens

    with streams.reading(path) as stream:
        widths = {pen.width for pen in pens.read(stream, streams.source_name(path))}
    return {"pen": widths.pop()} if len(widths) == 1 else {}


def _room(given: dict[str, Any], aspect: float) -> float:
    """The widest that a picture of that aspect (height over width) can be on the paper that is given."""
    if "paper" not in given:
        return math.inf
    from penink_cli.outputs.page import turned_paper

    across, down = turned_paper(given["paper"], given.get("landscape", False))
    margin = given.get("margin", 0.0)
    left, top = given.get("at", (margin, margin))
    width, height = across - left - margin, down - top - margin
    # a sheet is whole pixels of grey high, half a point each; where nothing fits the page says so
    room = math.floor(min(width, (height - 0.5) / aspect) * 100) / 100
    return room if room > 0 else math.inf


def _is_given(context: click.Context, name: str) -> bool:
    return context.get_parameter_source(name) is not ParameterSource.DEFAULT


def _page_words(ending: str, given: dict[str, Any]) -> list[str]:
    """What the filter that writes the picture is told of the page; UsageError where it knows no such thing."""
    by = writer(ending)
    known = {parameter.name for parameter in found(by).params} if by else set()
    words: list[str] = []
    for name in ("paper", "margin", "landscape", "at", "colours", "order", "pens_file"):
        if name not in given:
            continue
        option = {"colours": "color", "pens_file": "pens"}.get(name, name)
        if name not in known:
            raise click.UsageError(f"--{option} is of no use for {ending}")
        for value in given[name] if name == "colours" else (given[name],):
            words += worded(option, value)
    return words


def _told(style: Style, given: dict[str, Any]) -> dict[str, dict[str, Value]]:
    """The style's options, and those given before them."""
    stages = {stage: dict(options) for stage, options in style.stages.items()}
    for name in ("outline", "lines"):
        wanted = given.get({"outline": "outlines"}.get(name, name))
        if wanted is False:
            stages.pop(name, None)
        elif wanted:
            stages.setdefault(name, {"min-strength": OUTLINE_STRENGTH} if name == "outline" else {})
    stages.setdefault("compose", {"strength": 0.0})
    if "strength" not in given and {"detail", "mix", "target"} & set(given) and stages["compose"].get("strength") == 0:
        del stages["compose"]["strength"]  # who asks for a target asks for composing
    stages.setdefault("blast", {})
    for name, (stage, option) in _TOLD.items():
        if name in given:
            stages[stage][option] = worded(option, given[name])[1]
    if "pen" in given:
        for stage in ("blast", "outline", "lines"):
            if stage in stages:
                stages[stage]["pen"] = given["pen"]
        stages["blast"].pop("swell", None)
        if "lines" in stages:
            stages["lines"]["even"] = True
    return stages


@dataclass(frozen=True)
class Plate:
    """Grey that one ink draws: of the drawing's only one, or of several.

    number: among the inks, from 1; 0 where there is one ink. turn: degrees that its hatching is turned.
    """

    grey: str
    number: int = 0
    name: str = ""
    colour: str = ""
    turn: float = 0.0
    seed: int = 0

    def named(self, wanted: str) -> str:
        """A name for what is made of this plate."""
        return f"{self.number}-{wanted}" if self.number else wanted

    def words(self) -> list[str]:
        """What `blast` is told of it."""
        if not self.number:
            return []
        return ["--turn", repr(self.turn), "--seed", str(self.seed), "--color", self.colour, "--layer", self.name]

    def members(self) -> dict[str, Any]:
        """The same, as a manifest has it."""
        if not self.number:
            return {}
        return {"name": self.name, "color": self.colour, "turn": self.turn, "seed": self.seed}


class _Drawing:
    """One call of `draw`: the filters it runs, in their order."""

    def __init__(
        self, chain: Chain, stages: dict[str, dict[str, Value]], given: dict[str, Any], width: float, aspect: float,
        ending: str, device_dpi: float | None, inks: Inks | None,
    ):  # fmt: skip
        self.inks = inks
        self.chain, self.stages, self.given, self.ending = chain, stages, given, ending
        self.aspect = aspect
        self.width = width
        self.on_paper = ["--width", repr(width)]
        self.device_dpi = device_dpi
        self.device = ["--device-dpi", "none" if device_dpi is None else repr(device_dpi)]

    def with_finer_pens(self) -> None:
        """Pens that suit a small print, unless the user has named one; an archive is drawn with them when it is."""
        from penink_cli.ground import pens

        by = pens.part(self.width)
        if by == 1.0 or "pen" in self.given or of_illustrations(self.ending):
            return
        for stage, name, usual in (("blast", "pen", None), ("outline", "weight", 0.7), ("lines", "pen", 1.3)):
            if stage not in self.stages:
                continue
            told = self.stages[stage]
            name = "pen" if "pen" in told else name
            if (pen := told.get(name, usual)) is not None:
                width = parse_length(pen) if isinstance(pen, str) else float(pen)
                told[name] = pens.finer(width, by, self.device_dpi)
            if stage == "blast":
                told["finer"] = by

    def words(self, stage: str, filter_name: str) -> list[str]:
        """What the stage's options say to the filter."""
        options = self.stages.get(stage, {})
        grows = filter_name == "blast" and find_texture(str(options.get("texture", "crosshatch"))).scales is not None
        if grows and "natural" not in options:
            options = {**options, "natural": self.width}
        return words(stage, filter_name, options)

    def run(self, filter_name: str, words: list[str], wanted: str) -> str:
        """Run a filter whose result is handed on under that name, or one like it."""
        name = self.chain.name(wanted)
        self.chain.run(filter_name, words, name)
        return name

    def draw(self, file: str | None, shape: tuple[int, ...], output: str | None, page: list[str]) -> None:
        """All of it."""
        self.with_finer_pens()
        photo = [*shlex.split(photo_words()), "-" if file is None else file]
        grey, size = self.composed(photo, shape)
        edges = self.run("detect-edges", [*self.words("edges", "detect-edges"), grey], "e.json")
        if self.ending == ARCHIVE:
            edges = self.thinned(edges, grey, size)
        lines = None
        if "lines" in self.stages:
            told = [*self.words("lines", "detect-lines"), *self.seen_at()]
            lines = self.run("detect-lines", [*told, *photo], "lines.json")
        directions = self.directions(photo, edges, lines)
        plates = [Plate(grey)] if self.inks is None else self.plates(photo)
        if of_illustrations(self.ending):
            self.illustrated(plates, size, edges, lines, directions, output, page)
            return
        over = self.over(size, edges, lines)
        along = ["--directions", directions] if directions else []
        white = ["--lines", lines] if lines else []
        hatchings = []
        for plate in plates:
            grey = self.enlarged(plate, size if self.inks is None else (shape[1], shape[0]), edges)
            ink = [word for name in over for word in ("--ink", name)] if plate is plates[-1] else []
            told = [*self.on_paper, *self.device, *self.words("blast", "blast"), *plate.words(), *along, *white, *ink]
            hatchings.append(self.run("blast", ["-e", edges, *told, grey], plate.named("hatching.jsonl")))
        if not any(self.chain.lines(name) > 1 for name in (*hatchings, *over)):
            warn("a drawing without a stroke: the photo is paper white, or was made so")
        by = writer(self.ending)
        if by is None:
            self.chain.joined([*hatchings, *over], output)
            return
        if self.inks is not None:
            own = [plate.colour for plate in plates] + [plates[-1].colour] * len(over)
            knows_colours = any(parameter.name == "colours" for parameter in found(by).params)
            page = page + [word for colour in own * knows_colours for word in ("--color", colour)]
        self.chain.run(by, [*page, *hatchings, *over], output)

    def plates(self, photo: list[str]) -> list[Plate]:
        """The plate of each ink, the lightest first."""
        from penink_cli.composition.separation import lightest_first, turns

        assert self.inks is not None
        n = len(self.inks.names)
        order = lightest_first(self.inks.colours)
        texture = find_texture(str(self.stages["blast"].get("texture", "crosshatch")))
        first = texture.layers[0].angle if texture.layers else 0.0
        apart = [layer.angle - first if layer.turn is None else layer.turn for layer in texture.layers]
        turned = turns(apart, n)[::-1]  # the darkest lies as the texture has it
        seed = int(self.stages["blast"].get("seed", 0))
        told = ["--inks", "cmyk" if self.inks is CMYK else ",".join(self.inks.names)]
        told += ["--black", repr(self.given["black"])] if "black" in self.given else []
        result = []
        for place, number in enumerate(order):
            name = self.inks.names[number]
            grey = self.run("separate", [*told, "--plate", str(number + 1), *photo], f"plate-{number + 1}.pgm")
            colour = code_of(self.inks.colours[number])
            result.append(Plate(grey, number + 1, name, colour, turned[place], seed + n - 1 - place))
        return result

    def seen_at(self) -> list[str]:
        """What is told to filters that leave out what the drawing of an archive would not show."""
        return ["--seen-at", repr(self.width)] if self.ending == ARCHIVE else []

    def thinned(self, edges: str, grey: str, size: tuple[int, int]) -> str:
        """The edges that are worth their bytes, and those that will be outlined."""
        worth = RICH_WORTH if "max_bytes" in self.given else WORTH
        told = ["--worth", repr(worth), *self.seen_at(), "--photo", grey]
        if "outline" in self.stages:
            choice = self.stages["outline"]
            told += ["--keep-strength", str(choice.get("min-strength", 0))]
            told += ["--keep-length", str(choice.get("min-length", _least_length(size)))]
        return self.run("thin-edges", ["-e", edges, *told], "thin.json")

    def composed(self, photo: list[str], shape: tuple[int, ...]) -> tuple[str, tuple[int, int]]:
        """The grey of the drawing, and its width and height."""
        from penink_cli.composition.compose import working_size

        told = self.words("compose", "compose")
        told += ["--mask", self.given["mask"]] if "mask" in self.given else []
        dpi = COMPOSED_DPI
        if of_illustrations(self.ending):
            dpi = POSTER_DPI
            told += ["--dpi", repr(dpi)]
        grey = self.run("compose", [*self.on_paper, *told, *photo], "grey.pgm")
        return grey, working_size(shape, self.width, dpi / 72)

    def enlarged(self, plate: Plate, size: tuple[int, int], edges: str) -> str:
        """The grey that is blasted: reconstructed where the photo has fewer pixels than the drawing can show."""
        from penink_cli.illustration.drawing import grey_size

        across, down = grey_size(self.width, self.aspect)
        if size[0] >= across:
            return plate.grey
        samples = self.run("extract-samples", ["-e", edges, plate.grey], plate.named("samples.pgm"))
        enlarge = ["-e", edges, "--size", f"{across}x{down}", "--soften", samples]
        return self.run("enlarge", enlarge, plate.named("enlarged.pgm"))

    def directions(self, photo: list[str], edges: str, lines: str | None) -> str | None:
        """The field that is hatched along, if any."""
        own = self.given.get("directions_file")
        if own is None and ("directions" not in self.stages or not self.follows()):
            return None
        if own is not None and own.lower().endswith(".pgm"):
            return own
        told = self.words("directions", "detect-directions") if "directions" in self.stages else []
        if self.ending == ARCHIVE and "size" not in self.stages.get("directions", {}):
            told += ["--size", str(FIELD_SIDE)]
        told += ["--lines", lines] if lines else []
        told += ["--strokes", own] if own is not None else []
        return self.run("detect-directions", ["-e", edges, *told, *photo], "directions.pgm")

    def follows(self) -> bool:
        """Whether the strokes of the texture can follow a field."""
        from penink_cli.blasting.rules import rule

        blast = self.stages["blast"]
        texture = find_texture(str(blast.get("texture", "crosshatch")))
        return bool(rule(str(blast.get("rule", "best"))).follows(texture))

    def over(self, size: tuple[int, int], edges: str, lines: str | None) -> list[str]:
        """Strokes over the hatching, which are ink before it is laid."""
        result = []
        if lines:
            result.append(self.run("lines", [*self.on_paper, *self.words("lines", "lines"), lines], "lines.jsonl"))
        if "outline" in self.stages:
            least = [] if "min-length" in self.stages["outline"] else ["--min-length", str(_least_length(size))]
            told = [*self.on_paper, *self.device, *self.words("outline", "outline"), *least]
            result.append(self.run("outline", [*told, edges], "outlines.jsonl"))
        return result

    def illustrated(
        self, plates: list[Plate], size: tuple[int, int], edges: str, lines: str | None, directions: str | None,
        output: str | None, page: list[str],
    ) -> None:  # fmt: skip
        """The illustration itself, or a page that draws it."""
        shrink = max(2.0, max(size) / DEVICE_SIDE)
        smaller = f"{max(1, math.floor(size[0] / shrink))}x{max(1, math.floor(size[1] / shrink))}"
        blast = self.stages["blast"]
        layers = []
        for plate in plates:
            samples = self.run("extract-samples", ["-e", edges, plate.grey], plate.named("samples.pgm"))
            reduced = self.chain.name(plate.named("reduced.pgm"))
            reduce = ["-e", edges, "--photo", plate.grey]
            # a page draws itself, and no grid comes near to a photo of noise or fine texture: half of it is enough
            auto = [*reduce, "--auto", "--seen-at", repr(self.width)]
            auto += ["--max-error", repr(RICH_ERROR)] * ("max_bytes" in self.given) + [samples]
            if self.ending == ".html" or not self.chain.run("reduce", auto, reduced, may_fail=True):
                self.chain.run("reduce", [*reduce, "--size", smaller, samples], reduced)
            layer: dict[str, Any] = {"samples": reduced, "edges": edges, "texture": blast.get("texture", "crosshatch")}
            if directions:
                layer["directions"] = directions
            for name in ("pen", "gamma", "seed", "rule", "swell"):
                if name in blast:
                    layer[name] = _number(name, blast[name])
            layers.append(layer | plate.members())
        if lines:
            told = self.stages["lines"]
            layers[-1]["lines"] = lines
            layers[-1]["line"] = {
                name.replace("-", "_"): _number(name, told[name])
                for name in ("pen", "even", "density", "per-inch2", "min-rank")
                if name in told
            }
        if "outline" in self.stages:
            told = self.stages["outline"]
            pen = told.get("pen", told.get("weight", 0.7))
            layers[-1]["outline"] = {
                "pen": _number("pen", pen),
                "even": "pen" in told,
                "min_strength": float(told.get("min-strength", 0)),
                "min_length": float(told.get("min-length", _least_length(size))),
            }
        manifest = {"format": "penink-illustration", "version": 1, "width": self.width}
        manifest |= {"height": self.width * self.aspect, "layers": layers}
        name = self.chain.name("drawing.illustration.json")
        self.chain.put(name, json.dumps(manifest) + "\n")
        by = writer(self.ending)
        assert by is not None
        if "max_bytes" in self.given:
            page = [*page, "--max-bytes", str(self.given["max_bytes"])]
        self.chain.run(by, [*page, name], output)


def _least_length(size: tuple[int, int]) -> int:
    """Pixels of the shortest chain of edges that is outlined."""
    return math.floor(OUTLINE_LENGTH * max(size) + 0.5)


def _number(name: str, value: Value) -> Value:
    """The value of an option as a manifest has it: lengths in points."""
    if name == "rule" or not isinstance(value, str):
        return value
    return parse_length(value) if name == "pen" else int(value) if name == "seed" else float(value)
