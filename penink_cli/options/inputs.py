"""What subcommands read: open, read, check, and name the file in the error."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import click

from penink_cli.ground import streams
from penink_cli.ground.errors import FormatError, LimitError, PeninkError
from penink_cli.options.common import warn
from penink_cli.options.photographs import photo_choices, photo_limit

if TYPE_CHECKING:
    from penink_cli.ground.model import ColourImage, Directions, EdgeList, GreyImage, Illustration

MAX_MEMBER = 1 << 28  # bytes of a file that a manifest names


def read_grey(path: str | None, max_pixels: int) -> GreyImage:
    """Grey samples from a PGM file."""
    from penink_cli.formats import pgm

    with streams.reading(path) as stream:
        return pgm.read(stream, streams.source_name(path), max_pixels)


def read_photo(path: str | None, max_pixels: int) -> GreyImage:
    """The grey of a photograph, in any of the photo formats, as `photo_options` say."""
    from penink_cli.formats import photo

    with streams.reading(path) as stream:
        return photo.read_grey(stream, streams.source_name(path), photo_limit(max_pixels), photo_choices(), warn)


def read_colours(path: str | None, max_pixels: int) -> GreyImage | ColourImage:
    """A photograph in its colours, in any of the photo formats, as `photo_options` say; grey where it has none."""
    from penink_cli.formats import photo

    with streams.reading(path) as stream:
        return photo.read_colours(stream, streams.source_name(path), photo_limit(max_pixels), photo_choices(), warn)


def read_edges(path: str | None, max_pixels: int = 0) -> EdgeList | None:
    """A valid arrangement of discontinuity edges; None where no file is given. max_pixels allows more than 80 MB."""
    if path is None:
        return None
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
    rows, columns = field.cos2.shape
    if not _same_shape(columns, rows, width, height):
        picture = f"the picture has {width} x {height} pixels, which is another shape"
        raise FormatError(f"a field of {columns} x {rows} samples; {picture}", source)
    return field


def _same_shape(columns: int, rows: int, width: int, height: int) -> bool:
    """Whether some resizing, rounded to whole numbers on either side, leads from the one size to the other."""
    least = max((columns - 1) / width, (rows - 1) / height)
    most = min((columns + 1) / width, (rows + 1) / height)
    return least <= most


def warn_of_another_shape(edges: EdgeList, photo: GreyImage, name: str = "this") -> None:
    """Warn where no resizing, rounded to whole pixels, leads from the edges' frame to the photo.

    The photo may be larger or smaller than the one the edges were found in, but hardly of another shape.
    """
    height, width = photo.values.shape
    if not _same_shape(width, height, edges.width, edges.height):
        frame = f"{edges.width} x {edges.height}"
        warn(f"the edges are of a picture of {frame} pixels, and {name} of {width} x {height} has another shape")


def read_illustration(path: str | None, max_pixels: int) -> Illustration:
    """An illustration, from its manifest and the files that names, or packed; ready to be drawn.

    Its samples have no more grey levels than their layer keeps, its edges lie on the grid that a packed illustration
    keeps them on and are a valid arrangement: loose or packed, it is the same.
    """
    from penink_cli.formats import archive, illustration
    from penink_cli.geometry import validity
    from penink_cli.options.textures import find_texture

    source = streams.source_name(path)
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
    return settled(found)


def settled(illustration: Illustration) -> Illustration:
    """The illustration at the precision it is kept at: samples at their levels, edges on the grid, rounded numbers."""
    from dataclasses import replace

    from penink_cli.formats import compact
    from penink_cli.formats.illustration import rounded
    from penink_cli.geometry.quantisation import quantise

    layers = []
    for layer in illustration.layers:
        edges = layer.edges
        if edges is not None:
            rows, columns = layer.samples.values.shape
            edges = quantise(edges, compact.GRID * columns, compact.GRID * rows, compact.GRID)
        layers.append(replace(layer, edges=edges))
    return rounded(replace(illustration, layers=tuple(layers)))


def fetch_manifest(members: dict[str, bytes], source: str) -> bytes:
    """The manifest among an archive's members."""
    from penink_cli.formats.illustration import MANIFEST

    if MANIFEST not in members:
        raise FormatError(f"an archive without {MANIFEST}; not an illustration", source)
    return members[MANIFEST]


def only_one_standard_input(*paths: str | None) -> None:
    """Refuse a call in which two inputs are both standard input. ``None`` counts only as the first, which is FILE."""
    if sum(path == "-" or (path is None and i == 0) for i, path in enumerate(paths)) > 1:
        raise click.UsageError("two inputs cannot both be standard input")
