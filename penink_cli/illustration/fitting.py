"""An illustration in fewer bytes: coarser grids, fewer edges, lines and directions, all by one measure.

The measure is the error that a drawing may show at the size at which it is to be seen, by default the natural size.
What a chain of edges must save a bit grows with the square of the error; lines and directions become fewer as it grows.
The error that just fits the bytes is found by bisection.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from penink_cli.formats import archive, illustration
from penink_cli.ground.errors import LimitError
from penink_cli.ground.model import Directions, EdgeList, GreyImage, Illustration, Layer

#: Pixels a sample, along each axis, of the picture that coarser grids are compared with.
FINE = 3
#: Errors in grey levels of 255: that of an archive whose bytes are not limited, the least and the most that are tried.
USUAL, LEAST, MOST = 4.5, 1.0, 96.0
_TRIES = 7  # of the bisection
_LEAST_FIELD = 12  # samples that the shorter side of a field keeps


def packed_within(
    whole: Illustration, most: int | None, settle: Callable[[Illustration], Illustration], threads: int | None = None,
    seen_at: float | None = None,
) -> bytes:  # fmt: skip
    """The archive of an illustration, as fine as `most` bytes allow; None for no limit.

    settle: brings an illustration to the precision at which archives keep it. seen_at: width in points of the largest
    drawing to be made of it; what that would not show is left out, whatever the bytes.

    Raises LimitError where no archive is so small; the error says how small the smallest is.
    """
    width = seen_at or whole.width
    best = archive.pack(illustration.members(whole))
    if seen_at is None and (most is None or len(best) <= most):
        return best
    pictures = [_picture(layer, threads) for layer in whole.layers]

    def packed(limit: float) -> bytes:
        layers = [
            _coarser(layer, picture, limit, width, width * whole.height / whole.width, threads)
            for layer, picture in zip(whole.layers, pictures, strict=True)
        ]
        return archive.pack(illustration.members(settle(replace(whole, layers=tuple(layers)))))

    if seen_at is not None:
        best = min(best, packed(USUAL), key=len)
    if most is None or len(best) <= most:
        return best
    best = packed(MOST)
    if len(best) > most:
        raise LimitError(f"{most} bytes are too few: the least possible is {len(best)}")
    low, high = LEAST, MOST
    for _ in range(_TRIES):
        middle = math.sqrt(low * high)
        found = packed(middle)
        if len(found) <= most:
            best, high = found, middle
        else:
            low = middle
    return best


def _picture(layer: Layer, threads: int | None) -> GreyImage:
    """The picture that a layer's samples and edges stand for, FINE pixels a sample."""
    from penink_cli.reconstruction.enlarge import bands

    h, w = layer.samples.values.shape
    rows = bands(layer.samples, layer.edges, FINE * w, FINE * h, maxval=65535, threads=threads)
    return GreyImage(np.concatenate(list(rows)).astype(np.uint16), 65535)


def _coarser(
    layer: Layer, picture: GreyImage, limit: float, width_pt: float, height_pt: float, threads: int | None
) -> Layer:
    """The layer with no more than a drawing of that size needs for errors within the limit, in levels of 255.

    picture: as of `_picture`.
    """
    from penink_cli.blasting import telling
    from penink_cli.reconstruction import extraction, grid, thinning

    edges = layer.edges or EdgeList(*picture.values.shape[::-1])
    kept = np.zeros(len(edges.edges), bool)
    if layer.outline is not None and len(edges.edges):
        from penink_cli.blasting import outlines

        for run in outlines.runs(edges, layer.outline, None):
            kept[run.edges] = True
    part = (limit / USUAL) ** 2
    edges = thinning.thin_edges(
        edges, picture.grey, worth=thinning.WORTH * part, seen_at=width_pt, kept=kept, threads=threads
    )
    clean = extraction.extract_samples(picture.grey, edges)
    reduced = grid.choose_grid(clean, edges, limit / 255, seen_at=width_pt, photo=picture.grey, threads=threads).samples
    h, w = layer.samples.values.shape
    samples = layer.samples  # kept where the grid found is about as fine: to go over to it would only blur
    if reduced.size < 0.95 * h * w:
        samples = GreyImage.from_grey(reduced, layer.levels - 1)
    lines, field = layer.lines, layer.directions
    if limit >= MOST:
        lines = field = None
    if lines is not None:
        lines = lines.chosen(telling.with_room(lines, width_pt, height_pt, 1 - picture.grey, layer.line, threads or 1))
        count = math.floor(len(lines) * min(1.0, USUAL / limit))
        lines = lines.chosen(np.argsort(-lines.rank, kind="stable")[:count])
    if field is not None:
        field = _fewer(field, min(1.0, math.sqrt(USUAL / limit)))
    return replace(layer, samples=samples, edges=edges if len(edges.edges) else None, lines=lines, directions=field)


def _fewer(field: Directions, part: float) -> Directions:
    """The field on a coarser grid: that part, 0 … 1, of its samples along each side."""
    from penink_cli.reconstruction.shrinking import shrunk

    part = min(1.0, max(part, _LEAST_FIELD / min(field.cos2.shape)))
    if part == 1.0:
        return field
    cos2, sin2, confidence = (
        shrunk(plane.astype(np.float32), 1 / part).astype(np.float64)
        for plane in (field.cos2 * field.confidence, field.sin2 * field.confidence, field.confidence)
    )
    length = np.maximum(np.sqrt(cos2 * cos2 + sin2 * sin2), 1e-9)
    return Directions(cos2 / length, sin2 / length, confidence)
