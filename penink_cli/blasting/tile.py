"""The instances of a texture's tile over a sheet, and the tone at which each of its strokes enters."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from penink_cli.blasting import curves
from penink_cli.blasting.sheet import Sheet
from penink_cli.model import Floats, Ints, Strokes, Texture


def thresholds(texture: Texture, gain_pt: float) -> Floats:
    """(s,) the tone of the tile before each stroke is drawn, all strokes of lower priority being there.

    A stroke belongs in a picture where the tone exceeds its threshold: that is the whole of
    the threshold rule, and all that a renderer without a coverage buffer needs. The tile is
    laid on a torus: strokes over its border come in again on the other side.
    """
    strokes = texture.strokes
    w, h = strokes.width, strokes.height
    sheet = Sheet(np.zeros((1, 1)), w, h, gain_pt)
    lines = curves.sample(strokes.points, strokes.first, curves.pieces_of(strokes.points, strokes.first, 1.0))
    lo = np.minimum.reduceat(lines.points, lines.first[:-1])
    hi = np.maximum.reduceat(lines.points, lines.first[:-1])
    out = np.zeros(len(strokes))
    area = float(sheet.rows * sheet.columns * 64)
    inked = 0
    pad = float(strokes.widths.max()) + gain_pt
    for i in range(len(strokes)):
        out[i] = inked / area
        line = lines.points[lines.first[i] : lines.first[i + 1]]
        x0, x1 = int(np.floor((lo[i, 0] - pad) / w)), int(np.floor((hi[i, 0] + pad) / w))
        y0, y1 = int(np.floor((lo[i, 1] - pad) / h)), int(np.floor((hi[i, 1] + pad) / h))
        copies = [line - (a * w, b * h) for a in range(x0, x1 + 1) for b in range(y0, y1 + 1)]
        n = len(copies)
        inked += sheet.paint(
            curves.Polylines(np.concatenate(copies), np.arange(n + 1) * len(line)), np.full(n, strokes.widths[i])
        )
    return out


@dataclass(frozen=True, eq=False)
class Instances:
    """Every copy of every stroke of a tile that touches the sheet, in order of priority.

    strokes: the copies; enters: (n,) the tone at which each enters; source: (n,) its stroke in the tile.
    """

    strokes: Strokes
    enters: Floats
    source: Ints


def instances(texture: Texture, width_pt: float, height_pt: float, enters: Floats, seed: int) -> Instances:
    """Lay the tile over the sheet, its origin at a place drawn from the seed.

    Copies of one stroke come in an order that does not run along the rows of tiles.
    """
    tile = texture.strokes
    w, h = tile.width, tile.height
    n = len(tile)
    lo = np.minimum.reduceat(tile.points, tile.first[:-1])
    hi = np.maximum.reduceat(tile.points, tile.first[:-1])
    rng = np.random.default_rng([seed, 1])
    origin = rng.uniform(0, 1, 2) * (w, h)
    pad = tile.widths[:, None]
    first = np.ceil((-origin - hi - pad) / (w, h)).astype(np.int64)
    last = np.floor(((width_pt, height_pt) - origin - lo + pad) / (w, h)).astype(np.int64)
    across, down = np.maximum(last - first + 1, 0).T
    copies = across * down
    source = np.repeat(np.arange(n), copies)
    k = curves.ramp(copies)
    shift = np.column_stack([first[source, 0] + k % across[source], first[source, 1] + k // across[source]]) * (w, h)
    order = np.lexsort((rng.random(len(source)), source))
    source, shift = source[order], shift[order] + origin
    sizes = np.diff(tile.first)[source]
    begin = curves.starts(sizes)
    points = tile.points[np.repeat(tile.first[source], sizes) + curves.ramp(sizes)] + np.repeat(shift, sizes, axis=0)
    return Instances(Strokes(width_pt, height_pt, points, begin, tile.widths[source]), enters[source], source)
