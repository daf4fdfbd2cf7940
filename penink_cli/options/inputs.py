"""What subcommands read: open, read, check, and name the file in the error; and how photographs are to be read."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar

import click
from click.core import ParameterSource

from penink_cli.ground import changes, streams
from penink_cli.ground.errors import FormatError, LimitError, PeninkError, in_quotes
from penink_cli.ground.shapes import same_shape
from penink_cli.options.common import MAX_PIXELS, warn

if TYPE_CHECKING:
    from penink_cli.formats.photo.choices import Choices
    from penink_cli.ground.model import ColourImage, Directions, EdgeList, GreyImage, Illustration, Lines, Strokes

F = TypeVar("F", bound=Callable[..., Any])
T = TypeVar("T")

PHOTO_PIXELS = 250_000_000  # of a photograph and of samples as large: telephones take more than 100 megapixels
ENLARGED_PIXELS = 4 * PHOTO_PIXELS  # what the chain makes of such a photograph
ALPHA = "alpha"
NAMED = {"white": (255, 255, 255), "black": (0, 0, 0), "grey": (128, 128, 128)}
_META = "penink.photo"
_photos: dict[str | None, tuple[changes.State, ColourImage | GreyImage]] | None = None  # remembered, by their paths
_last: dict[str, tuple[changes.State, Any]] = {}  # the edges, and the lines, last read from the workbench; their text
MAX_MEMBER = 1 << 28  # bytes of a file that a manifest names


class Background(click.ParamType):
    """``white``, ``#rrggbb`` or ``alpha``."""

    name = "COLOR|alpha"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[int, int, int] | str:
        """(red, green, blue), 0 … 255, or ALPHA."""
        if isinstance(value, tuple) or value == ALPHA:
            return value
        if value in NAMED:
            return NAMED[value]
        if re.fullmatch(r"#[0-9a-fA-F]{3}", value):
            value = "#" + "".join(2 * digit for digit in value[1:])
        if not re.fullmatch(r"#[0-9a-fA-F]{6}", value):
            self.fail(f"{in_quotes(value)} is no color such as white, black or #f0e0d0, nor alpha", param, ctx)
        return int(value[1:3], 16), int(value[3:5], 16), int(value[5:7], 16)


def _keep(ctx: click.Context, param: click.Parameter, value: Any) -> Any:
    ctx.meta.setdefault(_META, {})[param.name] = value
    return value


def photo_options(function: F) -> F:
    """--background, --profile, --strict and --lenient, which `inputs.read_photo` follows; they give no parameters."""
    for decorate in (
        click.option(
            "--lenient",
            is_flag=True,
            expose_value=False,
            callback=_keep,
            help="Read what is left of a damaged photograph.",
        ),
        click.option(
            "--strict",
            is_flag=True,
            expose_value=False,
            callback=_keep,
            help="Refuse a photograph whose file is not whole, even if all its pixels are.",
        ),
        click.option(
            "--profile",
            type=click.Choice(["apply", "ignore"]),
            default="apply",
            show_default=True,
            expose_value=False,
            callback=_keep,
            help="The photograph's color profile or gamma: follow it, or take its values for sRGB's.",
        ),
        click.option(
            "--background",
            type=Background(),
            default="white",
            show_default=True,
            expose_value=False,
            callback=_keep,
            help="What a transparent photograph lies on: white, black, #rrggbb; alpha draws its opacity instead.",
        ),
    ):
        function = decorate(function)
    return function


def photo_choices() -> Choices:
    """What the options of the command that runs say."""
    from penink_cli.formats.photo.choices import Choices

    context = click.get_current_context(silent=True)
    given = context.meta.get(_META, {}) if context else {}
    if given.get("strict") and given.get("lenient"):
        raise click.UsageError("--strict and --lenient exclude each other")
    damage = "strict" if given.get("strict") else "lenient" if given.get("lenient") else ""
    return Choices(given.get("background", NAMED["white"]), given.get("profile") != "ignore", damage)


def photo_words() -> str:
    """The options as they were given, for the command lines of other filters; each with a blank before it."""
    choices = photo_choices()
    words = ""
    if choices.background == ALPHA:
        words += f" --background {ALPHA}"
    elif choices.background != NAMED["white"]:
        words += " --background " + shlex.quote("#" + "".join(f"{level:02x}" for level in choices.background))
    if not choices.profile:
        words += " --profile ignore"
    return words + (f" --{choices.damage}" if choices.damage else "")


def photo_limit(max_pixels: int) -> int:
    """The pixels that a photograph, or samples of its size, may have: by --max-pixels, or by a limit of their own."""
    context = click.get_current_context(silent=True)
    if context is None or context.get_parameter_source("max_pixels") is not ParameterSource.DEFAULT:
        return max_pixels
    return max(PHOTO_PIXELS, MAX_PIXELS)


def enlarged_limit(max_pixels: int) -> int:
    """The pixels of an enlarged image, read or written: by --max-pixels, or what the chain makes of a photograph."""
    context = click.get_current_context()
    chosen = context.get_parameter_source("max_pixels") is not ParameterSource.DEFAULT
    return max_pixels if chosen else ENLARGED_PIXELS


def read_grey(path: str | None, max_pixels: int) -> GreyImage:
    """Grey samples from a PGM file."""
    from penink_cli.formats import pgm

    with streams.reading(path) as stream:
        return pgm.read(stream, streams.source_name(path), max_pixels)


def read_to_blast(path: str | None, max_pixels: int) -> GreyImage:
    """Grey samples that need not be finer than paper shows: of an image of very many pixels a smaller view.

    So nothing that `enlarge` makes of a photograph is refused, unless --max-pixels is said.
    """
    from penink_cli.formats import pgm

    with streams.reading(path) as stream:
        return pgm.read_at_most(stream, streams.source_name(path), enlarged_limit(max_pixels), max_pixels)


@contextmanager
def remembering_photos() -> Iterator[None]:
    """While the block runs, a photograph that several filters of one process read is decoded once."""
    global _photos  # noqa: PLW0603
    before, _photos = _photos, {}
    try:
        yield
    finally:
        _photos = before
        _last.clear()


def _remembered(path: str | None, read: Callable[[], ColourImage | GreyImage]) -> ColourImage | GreyImage:
    known = _known(path)
    if known is not None:
        return known
    state = streams.state(path)
    found = read()
    if _photos is not None:
        _photos[None if path == "-" else path] = state, found
    return found


def _known(path: str | None) -> ColourImage | GreyImage | None:
    """The photograph of that path if it is remembered, and its file has not changed."""
    state, found = (_photos or {}).get(None if path == "-" else path, (None, None))
    if found is None or state != streams.state(path):
        return None
    if path is not None and path != "-":
        changes.note(path, state)
    return found


def read_photo(path: str | None, max_pixels: int) -> GreyImage:
    """The grey of a photograph, in any of the photo formats, as `photo_options` say."""
    from penink_cli.formats import photo
    from penink_cli.ground.model import ColourImage

    known = _known(path)
    if known is not None:
        return photo.grey_of(known) if isinstance(known, ColourImage) else known
    with streams.reading(path) as stream:
        return photo.read_grey(stream, streams.source_name(path), photo_limit(max_pixels), photo_choices(), warn)


def read_colours(path: str | None, max_pixels: int) -> GreyImage | ColourImage:
    """A photograph in its colours, in any of the photo formats, as `photo_options` say; grey where it has none."""
    from penink_cli.formats import photo

    def read() -> ColourImage | GreyImage:
        with streams.reading(path) as stream:
            return photo.read_colours(stream, streams.source_name(path), photo_limit(max_pixels), photo_choices(), warn)

    return read() if streams.on_bench(path) else _remembered(path, read)


def read_image_or_strokes(path: str | None, max_pixels: int) -> GreyImage | Strokes:
    """What a drawing is compared with: strokes, or the grey of a PGM image or a photograph."""
    from penink_cli.formats import photo, strokes

    source = streams.source_name(path)
    with streams.reading(path) as stream:
        if stream.peek(1)[:1] == b"{":  # type: ignore[attr-defined]
            return strokes.read(stream, source)
        return photo.read_grey(stream, source, photo_limit(max_pixels), photo_choices(), warn)


def read_edges(path: str | None, max_pixels: int = 0) -> EdgeList | None:
    """A valid arrangement of discontinuity edges; None where no file is given. max_pixels allows more than 80 MB.

    What one filter of this process has read from the workbench the next one is given.
    """
    if path is None:
        return None

    def read() -> EdgeList:
        from penink_cli.formats import edge_list
        from penink_cli.geometry import validity

        source = streams.source_name(path)
        with streams.reading(path) as stream:
            edges = edge_list.read(stream, source, max_pixels)
        try:
            validity.check(edges)
        except PeninkError as error:
            raise error.from_source(source) from None
        return edges

    return _read_once("edges", path, read)


def _read_once(kind: str, path: str, read: Callable[[], T]) -> T:
    """What `read` reads from a file, or has read from the same text on the workbench."""
    text = streams.state(path) if streams.on_bench(path) else None
    if text is None:
        return read()
    if kind in _last and _last[kind][0] == text:
        changes.note(path, text)
        return _last[kind][1]
    found = read()
    _last[kind] = text, found
    return found


def read_directions(path: str | None, width: int, height: int, max_pixels: int) -> Directions | None:
    """A direction field for a picture of width × height pixels; None where no file is given.

    Raises FormatError where no resizing, rounded to whole samples, leads from the one to the other.
    """
    if path is None:
        return None
    from penink_cli.formats import directions

    source = streams.source_name(path)
    with streams.reading(path) as stream:
        field = directions.read(stream, source, max_pixels)
    try:
        directions.check_shape(field, width, height)
    except PeninkError as error:
        raise error.from_source(source) from None
    return field


def read_strokes_or_svg(path: str | None) -> Strokes | None:
    """What somebody has drawn, as a strokes file or as SVG; None where no file is given."""
    if path is None:
        return None
    from penink_cli.formats import strokes, svg_texture

    source = streams.source_name(path)
    with streams.reading(path) as stream:
        start = stream.peek(64)  # type: ignore[attr-defined]
        if start.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"<"):
            return svg_texture.read(stream, source, source).strokes
        return strokes.read(stream, source)


def read_lines(path: str | None, photo: GreyImage | ColourImage | None = None) -> Lines | None:
    """Telling lines; None where no file is given. Raises FormatError for a frame of another shape than the photo's.

    What one filter of this process has read from the workbench the next one is given.
    """
    if path is None:
        return None
    source = streams.source_name(path)

    def read() -> Lines:
        from penink_cli.formats import lines

        with streams.reading(path) as stream:
            return lines.read(stream, source)

    found = _read_once("lines", path, read)
    height, width = (found.height, found.width) if photo is None else photo.values.shape[:2]
    if not same_shape(found.width, found.height, width, height):
        picture = f"the photo has {width} x {height}, which is another shape"
        raise FormatError(f"lines of a picture of {found.width} x {found.height} pixels; {picture}", source)
    return found


def warn_of_another_shape(edges: EdgeList, photo: GreyImage | ColourImage, name: str = "this") -> None:
    """Warn where no resizing, rounded to whole pixels, leads from the edges' frame to the photo.

    The photo may be larger or smaller than the one the edges were found in, but hardly of another shape.
    """
    height, width = photo.values.shape[:2]
    if not same_shape(width, height, edges.width, edges.height):
        frame = f"{edges.width} x {edges.height}"
        warn(f"the edges are of a picture of {frame} pixels, and {name} of {width} x {height} has another shape")


def read_illustration(path: str | None, max_pixels: int) -> Illustration:
    """An illustration, from its manifest and the files that names, or packed; ready to be drawn.

    Its samples have no more grey levels than their layer keeps, its edges lie on the grid that a packed illustration
    keeps them on and are a valid arrangement: loose or packed, it is the same. Raises FormatError and LimitError.
    """
    from penink_cli.formats import archive, illustration
    from penink_cli.geometry import validity
    from penink_cli.options.textures import find_texture

    source = streams.source_name(path)
    as_kept = False
    with streams.reading(path) as stream:
        text = stream.read(archive.MAX_BYTES + 1)
    if text.startswith(archive.MAGIC) or source.endswith(".penink"):
        if source.endswith(".json"):
            raise FormatError("is an archive, not JSON; name it *.penink", source)
        members = archive.read(text, source)

        def fetch(name: str) -> bytes:
            if name not in members:
                raise FormatError("is not in the archive")
            return members[name]

        text = fetch_manifest(members, source)
        as_kept = all(data.startswith(illustration.COMPACT) for data in members.values() if data is not text)
    else:
        folder = os.path.dirname(path) if path is not None and path != "-" else ""

        def fetch(name: str) -> bytes:
            with streams.reading(os.path.join(folder, name)) as stream:
                content = stream.read(MAX_MEMBER + 1)
            if len(content) > MAX_MEMBER:
                raise LimitError(f"more than {MAX_MEMBER} bytes")
            return content

    found = illustration.read(text, source, fetch, find_texture, max_pixels)
    for i, layer in enumerate(found.layers):
        try:
            if layer.edges is not None:
                validity.check(layer.edges)
        except PeninkError as error:
            raise type(error)(f"layer {i}: edges: {error.message}", source) from None
    if as_kept and all(layer.levels == layer.samples.maxval + 1 for layer in found.layers):
        return found  # what came in compact forms is at their precision
    return settled(found)


def settled(illustration: Illustration) -> Illustration:
    """The illustration at the precision it is kept at: samples at their levels, edges on the grid, rounded numbers."""
    from dataclasses import replace

    from penink_cli.formats import compact_edges
    from penink_cli.formats.illustration import rounded
    from penink_cli.geometry.quantisation import quantise

    layers = []
    for layer in illustration.layers:
        edges = layer.edges
        if edges is not None:
            rows, columns = layer.samples.values.shape
            if compact_edges.on_grid(edges, columns, rows) is None:
                points = compact_edges.points_to_spacing(edges, columns, rows)
                edges = quantise(edges, points * columns, points * rows, points)
        layers.append(replace(layer, edges=edges))
    return rounded(replace(illustration, layers=tuple(layers)))


def fetch_manifest(members: dict[str, bytes], source: str) -> bytes:
    """The manifest among an archive's members. Raises FormatError where there is none."""
    from penink_cli.formats.illustration import MANIFEST

    if MANIFEST not in members:
        raise FormatError(f"an archive without {MANIFEST}; not an illustration", source)
    return members[MANIFEST]


def only_one_standard_input(*paths: str | None) -> None:
    """Refuse a call in which two inputs are both standard input. ``None`` counts only as the first, which is FILE."""
    if sum(path == "-" or (path is None and i == 0) for i, path in enumerate(paths)) > 1:
        raise click.UsageError("two inputs cannot both be standard input")
