"""Illustrations, loose or packed: read, checked, and rounded to the precision that archives keep."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from penink_cli.ground import streams
from penink_cli.ground.errors import FormatError, LimitError, PeninkError

if TYPE_CHECKING:
    from penink_cli.ground.model import Illustration

MAX_MEMBER = 1 << 28  # bytes of a file that a manifest names


def read_illustration(path: str | None, max_pixels: int) -> Illustration:
    """An illustration, packed or as a manifest beside the files that it names; ready to be drawn.

    Samples have no more grey levels than their layer keeps. Edges are a valid arrangement on the grid of a packed
    illustration. So the same illustration is drawn, loose or packed. Raises FormatError and LimitError.
    """
    from penink_cli.formats import archive, illustration
    from penink_cli.geometry import validity
    from penink_cli.options.textures import shipped_texture

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
            place = os.path.join(folder, name)
            with streams.reading("./-" if place == "-" else place) as stream:  # a file of that name, not standard input
                content = stream.read(MAX_MEMBER + 1)
            if len(content) > MAX_MEMBER:
                raise LimitError(f"more than {MAX_MEMBER} bytes")
            return content

    found = illustration.read(text, source, fetch, shipped_texture, max_pixels)
    for i, layer in enumerate(found.layers):
        try:
            if layer.edges is not None:
                validity.check(layer.edges)
        except PeninkError as error:
            raise type(error)(f"layer {i}: edges: {error.message}", source) from None
    if as_kept and all(layer.levels == layer.samples.maxval + 1 for layer in found.layers):
        return found  # compact members are rounded already
    return settled(found)


def settled(illustration: Illustration) -> Illustration:
    """The illustration as an archive keeps it: samples at their levels, edges on the grid, numbers rounded."""
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
