"""What subcommands read: open, read, check, and name the file in the error."""

from __future__ import annotations

import click

from penink_cli import streams
from penink_cli.errors import PeninkError
from penink_cli.model import EdgeList, GreyImage


def read_grey(path: str | None, max_pixels: int) -> GreyImage:
    """Grey samples from a PGM file."""
    from penink_cli.formats import pgm

    with streams.reading(path) as stream:
        return pgm.read(stream, streams.source_name(path), max_pixels)


def read_photo(path: str | None, max_pixels: int) -> GreyImage:
    """The grey of a photograph, in any of the photo formats."""
    from penink_cli.formats import photo

    with streams.reading(path) as stream:
        return photo.read_grey(stream, streams.source_name(path), max_pixels)


def read_edges(path: str | None) -> EdgeList | None:
    """A valid arrangement of discontinuity edges; None where no file is given."""
    if path is None:
        return None
    from penink_cli.arrangement import validity
    from penink_cli.formats import edge_list

    source = streams.source_name(path)
    with streams.reading(path) as stream:
        edges = edge_list.read(stream, source)
    try:
        validity.check(edges)
    except PeninkError as error:
        raise error.from_source(source) from None
    return edges


def only_one_standard_input(*paths: str | None) -> None:
    """Refuse a call in which two inputs are both standard input. ``None`` counts only as the first, which is FILE."""
    if sum(path == "-" or (path is None and i == 0) for i, path in enumerate(paths)) > 1:
        raise click.UsageError("two inputs cannot both be standard input")
