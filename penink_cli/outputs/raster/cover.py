"""Strokes to grey pixels, by the area that ink covers, in bands from the top."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import numpy.typing as npt

from penink_cli.ground.model import Strokes
from penink_cli.ground.threads import in_order
from penink_cli.outputs.page import Page
from penink_cli.outputs.raster._compiled import cover as _cover

ROOM = 1 << 21  # bytes of bits in a band: about as many as a processor's own cache holds

Band = npt.NDArray[np.uint8]


def size(page: Page, dpi: float) -> tuple[int, int]:
    """Width and height in pixels of a page at a resolution, rounded up."""
    width, height = (max(1, math.ceil(side * dpi / 72 - 1e-6)) for side in (page.width, page.height))
    return width, height


def bands(layers: Sequence[Strokes], page: Page, dpi: float, maxval: int, threads: int = 1) -> Iterator[Band]:
    """Bands (rows, width) of grey values 0 … maxval (≤ 255) from the top; the same for any number of threads.

    layers: at least one. The value is maxval · (1 - tone), rounded to the nearest; tone is the share of the pixel's
    area that strokes cover. Memory grows with the strokes and the width, not with the height.
    """
    width, height = size(page, dpi)
    scale = dpi / 72
    drawn = Strokes.joined([replace(s, points=(s.points + np.array((page.x, page.y))) * scale) for s in layers])
    points, first, radii = drawn.points, drawn.first, drawn.widths * (scale / 2)
    knot_radii = np.zeros(0) if drawn.knot_widths is None else drawn.knot_widths * (scale / 2)
    greys = np.rint(maxval * (1 - np.arange(257) / 256)).astype(np.uint8)
    padded = -(-width // 4) * 4
    rows = min(max(ROOM // (32 * padded), 1), 64, height)
    members, starts = _members(points, first, drawn.widest * (scale / 2), rows, -(-height // rows))

    def draw(number: int) -> Band:
        top = number * rows
        out = np.empty((min(rows, height - top), width), np.uint8)
        chosen = members[starts[number] : starts[number + 1]]
        if not len(chosen):
            out[:] = maxval
            return out
        bits = np.empty((16 * len(out), padded), np.uint16)
        _cover.band(points, first, radii, knot_radii, chosen, top, bits, np.empty(padded // 4, np.uint64), greys, out)
        return out

    return in_order((partial(draw, number) for number in range(-(-height // rows))), threads)


def _members(
    points: npt.NDArray[np.float64], first: npt.NDArray[np.int64], radii: npt.NDArray[np.float64], rows: int, count: int
) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int64]]:
    """(members, starts): members[starts[b] : starts[b + 1]] are the strokes that may touch band b of ``count``.

    points, first: of the strokes, pixels. radii: (s,) half the largest width of each. rows: pixel rows a band.
    """
    if not len(radii):
        return np.zeros(0, np.int32), np.zeros(count + 1, np.int64)
    low = np.minimum.reduceat(points[:, 1], first[:-1]) - radii
    high = np.maximum.reduceat(points[:, 1], first[:-1]) + radii
    begin = np.clip(np.floor(low / rows), 0, count).astype(np.int64)
    end = np.clip(np.floor(high / rows) + 1, 0, count).astype(np.int64)
    many = np.maximum(end - begin, 0)
    stroke = np.repeat(np.arange(len(radii), dtype=np.int32), many)
    band = np.arange(many.sum()) - np.repeat(np.cumsum(many) - many, many) + np.repeat(begin, many)
    order = np.argsort(band, kind="stable")
    starts = np.concatenate([[0], np.cumsum(np.bincount(band, minlength=count))])
    return stroke[order], starts.astype(np.int64)
