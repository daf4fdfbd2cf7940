"""Filling with a clean border: strokes along the border, just within it, and rows of a pen inside of them.

Rows alone end in steps that are seen from 400 dpi on. Here a stroke's outer side is the border. Rows end beneath it:
the middles of both lie at least half a painted width within, so that nothing of them can stick out, and rows lie close
enough that together they cover all. What is too thin for that is left to rows that begin and end at the border.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from penink_cli.blasting import curve_fitting, curves, marks
from penink_cli.blasting._compiled import contours as _marching
from penink_cli.blasting.gaps import Gaps
from penink_cli.composition.filters import Picture
from penink_cli.ground.masks import near, parts, sizes
from penink_cli.ground.model import Floats

#: The border is told by places STEP_PT apart, and every place by its neighbours, ROUNDS times: it is known to about
#: a pixel, of which there are two to four in a point.
STEP_PT, ROUNDS = 0.25, 4
#: Rings of fewer places are no border.
LEAST_PLACES = 5
#: How far a stroke may stray from its place. Rows begin WITHIN of half a painted width from the border and are PITCH
#: painted widths apart: what lies beyond the stroke, at 2 halves less this, is then no further than 2 - 1.05 = .95
#: halves from a place of a row, of which .75 are needed.
TOLERANCE_PT, WITHIN, PITCH = 0.03, 1.05, 0.75
#: Rows begin CLEAR of half a painted width from a white line, BEYOND beyond its ends; strokes beside it go on for one.
CLEAR, BEYOND = 1.2, 0.4
#: The least area too thin for strokes along its border that is filled, square points: less is roughness of the border.
LEAST_THIN_PT2 = 0.3


@dataclass(frozen=True, eq=False)
class Shape:
    """What is to be filled: its border as rings (n, 2), points, and what of it is too thin for strokes there (h, w)."""

    rings: list[Floats]
    thin: marks.Mask


def shape(tone: Picture, scale: Floats, pen_pt: float, gain_pt: float) -> Shape:
    """The shape of where the tone exceeds `marks.LEVEL`; the arguments are those of `fill`."""
    return Shape(_rings(tone, scale), _thin(tone > marks.LEVEL, (pen_pt + gain_pt) / 2, 1 / float(scale[0])))


def fill(
    tone: Picture, scale: Floats, pen_pt: float, gain_pt: float, chains: list[Floats], widths: list[float], fixed: bool,
    gaps: Gaps | None = None, known: Shape | None = None,
) -> None:  # fmt: skip
    """Strokes that fill where the tone (h, w) exceeds `marks.LEVEL`; scale (2,): a pixel's width and height, points.

    pen_pt: their width, which thin places narrow unless it is `fixed`; gain_pt: how much wider the device paints them.
    gaps: lines within that are left white, with room for a stroke to either side. known: its shape, where that is.
    """
    half = (pen_pt + gain_pt) / 2
    if not (tone > marks.LEVEL).any():
        return
    known = known or shape(tone, scale, pen_pt, gain_pt)
    rings, thin = known.rings, known.thin
    edges = []
    for ring in rings:
        normal = _normals(ring)
        roomy = _inside(tone, scale, ring + 2 * half * normal)
        for piece, whole in _pieces(ring + half * normal, roomy):
            chains.append(curve_fitting.fit(piece, TOLERANCE_PT, whole))
            widths.append(pen_pt)
        path = ring + WITHIN * half * normal
        edges.append(np.stack([path, _beside(path)[1]], axis=1))
    along = np.array([1.0, 0.0])
    if gaps:
        flanks = gaps.flanks(pen_pt, gain_pt)
        chains.extend(flanks)
        widths.extend([pen_pt] * len(flanks))
        for rim in gaps.rims(CLEAR * pen_pt / 2, CLEAR * gain_pt, BEYOND * half):
            edges.append(np.stack([rim, np.roll(rim, -1, axis=0)], axis=1))
        along = gaps.direction()  # rows along them are cut by the fewest
    if edges:
        rows = marks.straight(*_rows(_turned(np.concatenate(edges), along * [1, -1]), PITCH * 2 * half))
        if gaps and rows:
            rows = list(_turned(np.stack(rows), along))
        chains.extend(rows)
        widths.extend([pen_pt] * len(rows))
    if thin.any():
        places: Floats = np.where(thin, tone, 0.0).astype(np.float64)
        marks.fill(places, np.zeros(2), scale, pen_pt, gain_pt, chains, widths, fixed)


def _rings(tone: Picture, scale: Floats) -> list[Floats]:
    """The border as smooth rings (n, 2), points, the last beside the first; what is dark lies on the same side of all.

    It closes along the frame.
    """
    level = marks.LEVEL
    padded = np.pad(tone, 1, mode="edge")
    for side in (padded[0], padded[-1], padded[1:-1, 0], padded[1:-1, -1]):
        side[:] = np.where(side > level, 2 * level - side, 0.0)  # half way is the frame
    padded[[0, 0, -1, -1], [0, -1, 0, -1]] = 0.0
    rings = []
    shortest = LEAST_PLACES * STEP_PT / (2 * float(scale.max()))  # its places lie within a pixel and a half
    for contour in _contours(padded, level):
        if len(contour) < shortest:
            continue
        points = _sampled((contour[:-1, ::-1] - 0.5) * scale)
        if len(points) < LEAST_PLACES:
            continue
        for _ in range(ROUNDS):
            before, after = _beside(points)
            points = (before + 2 * points + after) / 4
        rings.append(points)
    return rings


def _contours(image: Picture, level: float) -> list[Floats]:
    """The rings (n, 2), row and column, at which an image passes a level that it exceeds nowhere along its frame.

    The last place is the first one again. Higher values are to the right, for who looks at the image.

    scikit-image has the same; of it nothing else is needed, and it takes ten times as long.
    """
    above = image > level
    n = int(np.count_nonzero(above[:, 1:] != above[:, :-1]) + np.count_nonzero(above[1:] != above[:-1]))
    places, (following, begins, order) = np.empty((n, 2)), np.empty((3, n), np.int32)
    known = np.zeros((2, image.shape[1]), np.int32)
    _marching.cross(image, above.view(np.uint8), level, known, places, following, begins)
    out, first = np.empty((n + n // 4, 2)), np.empty(n // 4 + 1, np.int64)
    rings = _marching.follow(places, following, begins, order, out, first)
    return [out[a:b] for a, b in pairwise(first[: rings + 1].tolist())]


def _beside(ring: Floats) -> tuple[Floats, Floats]:
    """The places (n, 2) before and after each of a ring's (n, 2)."""
    around = np.concatenate([ring[-1:], ring, ring[:1]])
    return around[:-2], around[2:]


def _sampled(ring: Floats) -> Floats:
    """Places along a ring (n, 2), about `STEP_PT` apart."""
    legs = np.roll(ring, -1, axis=0) - ring
    along = np.concatenate([[0.0], np.cumsum(np.sqrt(legs[:, 0] * legs[:, 0] + legs[:, 1] * legs[:, 1]))])
    count = max(1, int(along[-1] / STEP_PT))
    at = np.arange(count) * (along[-1] / count)
    which = np.clip(np.searchsorted(along, at, side="right") - 1, 0, len(ring) - 1)
    part = (at - along[which]) / np.maximum(along[which + 1] - along[which], 1e-12)
    return np.asarray(ring[which] + legs[which] * part[:, None])


def _normals(ring: Floats) -> Floats:
    """Unit normals (n, 2) towards what is dark."""
    before, after = _beside(ring)
    ahead = after - before
    length = np.maximum(np.sqrt(ahead[:, 0] * ahead[:, 0] + ahead[:, 1] * ahead[:, 1]), 1e-9)
    return np.column_stack([-ahead[:, 1], ahead[:, 0]]) / length[:, None]


def _inside(tone: Picture, scale: Floats, points: Floats) -> marks.Mask:
    """Whether the tone between pixels exceeds the level at points (n, 2)."""
    h, w = tone.shape
    at = np.clip(points / scale - 0.5, 0, [w - 1, h - 1])
    i = np.minimum(at.astype(np.int64), [max(w - 2, 0), max(h - 2, 0)])
    fx, fy = (at - i).T
    x, y = i.T
    across = np.minimum(x + 1, w - 1)
    down = np.minimum(y + 1, h - 1)
    upper = tone[y, x] * (1 - fx) + tone[y, across] * fx
    lower = tone[down, x] * (1 - fx) + tone[down, across] * fx
    return np.asarray(upper * (1 - fy) + lower * fy > marks.LEVEL)


def _pieces(ring: Floats, wanted: marks.Mask) -> list[tuple[Floats, bool]]:
    """The runs of a ring's places that are wanted, and whether it is the whole ring, which ends where it began."""
    if wanted.all():
        return [(np.concatenate([ring, ring[:1]]), True)]
    begin = int(np.argmin(wanted))
    ring, wanted = np.roll(ring, -begin, axis=0), np.roll(wanted, -begin)
    change = np.flatnonzero(np.diff(np.concatenate([wanted, [False]]).astype(np.int8))) + 1
    return [(ring[i:j], False) for i, j in zip(change[::2].tolist(), change[1::2].tolist()) if j - i > 1]


def _rows(edges: Floats, pitch: float) -> tuple[Floats, Floats, Floats]:
    """Begin, end and height of rows within rings that are given by their edges (m, 2, 2).

    Within is where they wind around a place more often with the dark inside than outside: where a ring that was moved
    inwards crosses itself, as in a narrow place, it winds the wrong way around.
    """
    (x0, y0), (x1, y1) = edges[:, 0].T, edges[:, 1].T
    # the rows that an edge crosses: those whose number k has k + 1/2 from the lower end to before the upper
    low, high = np.ceil(np.minimum(y0, y1) / pitch - 0.5), np.ceil(np.maximum(y0, y1) / pitch - 0.5)
    count = (high - low).astype(np.int64)
    which = np.repeat(np.arange(len(count)), count)
    row = low[which].astype(np.int64) + curves.ramp(count)
    y = (row + 0.5) * pitch
    x = x0[which] + (x1 - x0)[which] * ((y - y0[which]) / (y1 - y0)[which])
    turn = np.where(y1 > y0, -1, 1)[which]
    order = np.lexsort((x, row))
    winding = np.cumsum(turn[order])
    within = winding > 0
    before = np.concatenate([[False], within[:-1]])
    begin, end = order[within & ~before], order[~within & before]
    return x[begin], x[end], y[begin]


def _turned(points: Floats, by: Floats) -> Floats:
    """Points (…, 2) turned by the angle that has this cosine and sine."""
    x, y = points[..., 0], points[..., 1]
    return np.stack([x * by[0] - y * by[1], x * by[1] + y * by[0]], axis=-1)


def _thin(inside: marks.Mask, half: float, px: float) -> marks.Mask:
    """Where it is too thin for strokes along the border, and as far around as rows need to begin, (h, w).

    px: pixels in a point.
    """
    deep = ~near(np.pad(inside, 1), half * px + 0.5, strictly=True)[1:-1, 1:-1]
    thin = inside & ~near(~deep, half * px + 1.0)
    if not thin.any():
        return thin
    part, count = parts(thin)
    size = sizes(part, count, thin)
    thin &= size[part] >= LEAST_THIN_PT2 * px * px
    return np.asarray(inside & (thin | near(~thin, half * px + 1.5, strictly=True)))
