"""Filling a tile with strokes, every prefix of them evenly spaced, until it is nearly black."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from penink_cli.ground import exact
from penink_cli.ground.angles import direction
from penink_cli.ground.device import MEAN
from penink_cli.ground.model import Floats, HatchLayer, Scales, Strokes, Texture
from penink_cli.textures.even import Torus

TILE_PT = 144.0  # side of a tile of hatching
FULL = 0.978  # the part of a full tile that is covered
PIXEL_PT = 72 / 600  # side of a pixel of the printer that tiles are filled for
GAIN_PT = MEAN * PIXEL_PT  # by which that printer widens a stroke
#: Of textures that grow: the width of the picture that they are made for; least side of a tile; largest scale.
NATURAL_PT, LEAST_PT, MOST_SCALE = 288.0, 6.0, 1000.0

#: Makes so many candidates (n, 3k + 1, 2) at random.
Maker = Callable[[np.random.Generator, int], Floats]


def bowed_line(centre: Floats, angle: Floats, length: Floats, bow: Floats) -> Floats:
    """Cubics (n, 4, 2): strokes about centre (n, 2), their middle pushed sideways by bow (n,).

    angle: (n,) degrees, clockwise from the right. length: (n,) points.
    """
    along = np.array([direction(a) for a in angle.tolist()])
    half = along * length[:, None] / 2
    across = np.column_stack([-along[:, 1], along[:, 0]]) * bow[:, None]
    ends = np.stack([centre - half, centre - half / 3, centre + half / 3, centre + half], axis=1)
    return ends + np.stack([-across / 3, across, across, -across / 3], axis=1)


def fill(
    torus: Torus, candidates: Maker, pen: float, until: float, reached: float, choices: int, rng: np.random.Generator
) -> list[Floats]:
    """Strokes (3k + 1, 2) that bring the tile's coverage from `reached` to `until`, each the emptiest of its choices.

    torus: filled with the strokes' ink. candidates: makes the choices. pen: width of a stroke, points, with the gain.

    Coverage is counted in the cells of the torus. A stroke covers its share of what is bare in each cell that it runs
    through: right for strokes that lie at random, a little too small for these, which keep apart.
    """
    bare = np.full((torus.rows, torus.columns), 1.0 - reached)
    cell = float(1.0 / (torus.scale[0] * torus.scale[1]))
    mean = 1.0 - reached
    out = []
    while mean > 1.0 - until:
        strokes = candidates(rng, choices)
        samples = along_curve(strokes)
        best = torus.emptiest(samples)
        length = max(polygon_length(strokes[best]), pen * 0.8)
        torus.add(samples[best], length)
        rows, columns = torus.cells(samples[best])
        keep = exact.exp(-length / len(rows) * pen / cell)
        for r, c in zip(rows.tolist(), columns.tolist(), strict=True):
            was = bare[r, c]
            bare[r, c] = was * keep
            mean -= float(was - was * keep) / bare.size
        out.append(strokes[best])
    return out


def along_curve(strokes: Floats) -> Floats:
    """Points (n, p, 2) along chains (n, 3k + 1, 2), about one to a point of length; a dot is its own."""
    k = (strokes.shape[1] - 1) // 3
    if k == 0:
        return strokes
    per = max(2, round(polygon_length(strokes[0]) / k))
    t = (np.arange(per) / per)[:, None]
    u = 1 - t
    parts = []
    for j in range(k):
        p = strokes[:, 3 * j : 3 * j + 4, None]
        parts.append(u * u * u * p[:, 0] + 3 * u * u * t * p[:, 1] + 3 * u * t * t * p[:, 2] + t * t * t * p[:, 3])
    return np.concatenate(parts, axis=1)


def polygon_length(stroke: Floats) -> float:
    """Length of a control polygon (p, 2)."""
    legs = np.diff(stroke, axis=0)
    return float(np.sqrt((legs * legs).sum(axis=1)).sum())


def tile(
    name: str, strokes: list[Floats], widths: list[float], width: float, height: float, seed: int, whole: bool = False,
    layers: tuple[HatchLayer, ...] = (),
) -> Texture:  # fmt: skip
    """A texture of strokes (3k + 1, 2) each, the first to be drawn first; coordinates are rounded to .01 pt."""
    first = np.zeros(len(strokes) + 1, np.int64)
    np.cumsum([len(s) for s in strokes], out=first[1:])
    points: Floats = np.round(np.concatenate(strokes), 2).astype(np.float64)
    laid = Strokes(width, height, points, first, np.array(widths), texture=name, seed=seed)
    return Texture(name, laid, np.arange(len(strokes), dtype=np.float64), whole, layers)


def growing(
    name: str, strokes: list[Floats], from_scale: list[float], rest: list[Floats], pen: float, width: float,
    height: float, seed: int,
) -> Texture:  # fmt: skip
    """A tile whose strokes grow with the picture; `rest` are strokes that do not, drawn after them.

    from_scale: for each stroke the scale of the picture from which on it is there.
    """
    whole = tile(name, [*strokes, *rest], [pen] * (len(strokes) + len(rest)), width, height, seed, whole=True)
    first = np.round(np.array(from_scale), 4)
    spans = np.column_stack([first, np.full(len(first), MOST_SCALE)])
    there = np.flatnonzero(np.concatenate([first <= 1, np.ones(len(rest), bool)]))
    grows = np.arange(len(strokes))
    scales = Scales(
        NATURAL_PT, LEAST_PT, "parallel", whole.strokes.taken(grows), whole.priorities[grows], spans,
        there >= len(strokes),
    )  # fmt: skip
    return replace(whole, strokes=whole.strokes.taken(there), priorities=whole.priorities[there], scales=scales)
