"""What subcommands read besides photographs and illustrations: open, read, check, and name the file in the error."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from penink_cli.ground import streams
from penink_cli.ground.errors import FormatError, PeninkError
from penink_cli.ground.shapes import same_shape
from penink_cli.options import remembered
from penink_cli.options.common import is_given, warn
from penink_cli.options.photographs import PHOTO_PIXELS

if TYPE_CHECKING:
    from penink_cli.ground.model import ColourImage, Directions, EdgeList, GreyImage, Lines, Strokes

ENLARGED_PIXELS = 4 * PHOTO_PIXELS  # what the chain makes of the largest photograph


def enlarged_limit(max_pixels: int) -> int:
    """The pixels that an enlarged image may have, read or written: --max-pixels if given, else ENLARGED_PIXELS."""
    return max_pixels if is_given("max_pixels") else ENLARGED_PIXELS


def read_grey(path: str | None, max_pixels: int) -> GreyImage:
    """Grey samples from a PGM file. Raises FormatError and LimitError."""
    from penink_cli.formats import pgm

    with streams.reading(path) as stream:
        return pgm.read(stream, streams.source_name(path), max_pixels)


def read_to_blast(path: str | None, max_pixels: int) -> GreyImage:
    """Grey samples to be drawn; of an image of more than max_pixels pixels a smaller view, which paper does not show.

    So an image that `enlarge` has made of a photograph is not refused, unless --max-pixels is given. Raises FormatError
    and LimitError.
    """
    from penink_cli.formats import pgm

    with streams.reading(path) as stream:
        return pgm.read_at_most(stream, streams.source_name(path), enlarged_limit(max_pixels), max_pixels)


def read_edges(path: str | None, max_pixels: int = 0) -> EdgeList | None:
    """A valid arrangement of discontinuity edges; None where no file is given.

    max_pixels: allows a list of more than 80 MB (see `edge_list.read`). The same text on the workbench is read once.

    Raises FormatError, LimitError and ArrangementError.
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

    return remembered.once("edges", path, read)


def read_directions(path: str | None, width: int, height: int, max_pixels: int) -> Directions | None:
    """A direction field for a picture of width × height pixels; None where no file is given.

    Raises FormatError, also where no resizing, rounded to whole samples, leads from the field to the picture, and
    LimitError.
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
    """Strokes that the user has drawn, from a strokes file or an SVG drawing; None where no file is given.

    Raises FormatError and LimitError.
    """
    if path is None:
        return None
    from penink_cli.formats import strokes, svg_texture

    source = streams.source_name(path)
    with streams.reading(path) as stream:
        start = stream.peek(64)  # type: ignore[attr-defined]
        if start.removeprefix(b"\xef\xbb\xbf").lstrip().startswith((b"<", b"\xff\xfe", b"\xfe\xff")):  # or UTF-16
            return svg_texture.read(stream, source, source).strokes
        return strokes.read(stream, source)


def read_lines(path: str | None, photo: GreyImage | ColourImage | None = None) -> Lines | None:
    """Telling lines; None where no file is given. The same text on the workbench is read once.

    Raises FormatError, also for a frame of another shape than the photo's, and LimitError.
    """
    if path is None:
        return None
    source = streams.source_name(path)

    def read() -> Lines:
        from penink_cli.formats import lines

        with streams.reading(path) as stream:
            return lines.read(stream, source)

    found = remembered.once("lines", path, read)
    height, width = (found.height, found.width) if photo is None else photo.values.shape[:2]
    if not same_shape(found.width, found.height, width, height):
        picture = f"the photo has {width} x {height}, which is another shape"
        raise FormatError(f"lines of a picture of {found.width} x {found.height} pixels; {picture}", source)
    return found


def warn_of_another_shape(edges: EdgeList, photo: GreyImage | ColourImage, name: str = "this") -> None:
    """Warn where no resizing, rounded to whole pixels, leads from the edges' frame to the photo.

    A photo of another size than the one that the edges were found in is right, one of another shape hardly.
    name: what the warning calls the photo.
    """
    height, width = photo.values.shape[:2]
    if not same_shape(width, height, edges.width, edges.height):
        frame = f"{edges.width} x {edges.height}"
        warn(f"the edges are of a picture of {frame} pixels, and {name} of {width} x {height} has another shape")


def only_one_standard_input(*paths: str | None) -> None:
    """Raise UsageError where two inputs are both standard input.

    paths: FILE first, where None means standard input; None for any other path means no file.
    """
    if sum(path == "-" or (path is None and i == 0) for i, path in enumerate(paths)) > 1:
        raise click.UsageError("two inputs cannot both be standard input")
