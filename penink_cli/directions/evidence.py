"""What a photograph says of the form: tangents of its tones, each with a weight, before the field is smoothed.

Directions are double-angle vectors (cos 2θ, sin 2θ), so that opposite directions are the same and may be added up. The
length of a sum says how far its parts agree.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from penink_cli.composition.filters import Picture, blurred, shrunk
from penink_cli.composition.mixing import lab
from penink_cli.directions._compiled import field as kernel
from penink_cli.geometry import walls
from penink_cli.ground.model import ColourImage, EdgeList, Floats, GreyImage

LONG = 384  # pixels of the long side of the view in which tangents are measured
_HUE = 0.7  # how much a step in colour counts beside one in lightness
_FINE = 0.8  # σ, pixels of that view: the view is blurred by it before gradients are taken
_GRAIN = 0.012  # a gradient, Lab lightness of 1 a pixel, that is hardly more than grain
_AROUND = 6.0  # σ, pixels: the evidence of each place is weighed by how much there is around it
_RIM = 0.012  # part of the width that does not count at each side: scans have dark rims, which would outweigh the rest
_BESIDE = 2.5  # pixels on either side of a strong edge in which gradients are the silhouette's, not the form's
STRONG = 0.15  # least grey step of an edge that parts one thing from another
_OUTSIDE, _INSIDE = 0.05, 0.5  # weight beside such an edge: where no others are around, and where they are all around
_REACH = 0.13  # part of the long side within which an edge is around a place
_STEEP = (0.9807852804032304, 0.19509032201612825), (0.8314696123025452, 0.5555702330196022)  # of 11.25° and 33.75°
_RAYS = np.array(  # 16 directions, half a step off the axes
    [(s * a, t * b) for c, d in _STEEP for a, b in ((c, d), (d, c)) for s in (1, -1) for t in (1, -1)]
)


@dataclass(frozen=True, eq=False)
class Evidence:
    """Directions that a photograph shows.

    vectors: (h, w, 2) double-angle vectors, none longer than its weight. weight: (h, w) how much evidence there is
    beside the noise, 0 … 1. trust: (h, w) 1, but less beside silhouettes and 0 at the frame.
    """

    vectors: Floats
    weight: Floats
    trust: Floats


def tangents(photo: GreyImage | ColourImage, edges: EdgeList, noise: float) -> Evidence:
    """The directions along which the photo's tones and colours change least, in a view of at most LONG pixels.

    noise: a mean gradient, of 1 a pixel; places with less count less and less.
    """
    h, w = photo.values.shape[:2]
    shrink = max(1.0, max(h, w) / LONG)
    rows, columns = max(1, round(h / shrink)), max(1, round(w / shrink))
    vectors = np.zeros((rows, columns, 2))
    for plane in _planes(photo, columns, rows):
        dx, dy = _gradient(blurred(plane, _FINE))
        vectors[..., 0] += dy * dy - dx * dx  # along the tones: −(dx + i dy)²
        vectors[..., 1] -= 2 * dx * dy
    square = np.sqrt(vectors[..., 0] * vectors[..., 0] + vectors[..., 1] * vectors[..., 1])
    # A place counts by its gradient and not by the square of it, by which strong edges would outweigh all others.
    trust = _trust(edges, rows, columns)
    loud = trust * np.sqrt(square) / (square + _GRAIN * _GRAIN)
    around = smooth(loud * square, _AROUND) / np.maximum(smooth(trust, _AROUND), 0.15) + noise
    return Evidence(vectors * (loud / around)[..., None], loud * square / around, trust)


def _planes(photo: GreyImage | ColourImage, width: int, height: int) -> list[Picture]:
    """Planes (height, width) of Lab / 100: lightness and, of a coloured photo, both of colour, which count by _HUE."""
    small = shrunk(photo.values, width, height, 1 / photo.maxval)
    if small.ndim == 2:
        small = np.dstack([small] * 3)
    planes = lab(small) * np.array([0.01, 0.01 * _HUE, 0.01 * _HUE])
    count = 3 if isinstance(photo, ColourImage) else 1
    return [np.ascontiguousarray(planes[..., k], np.float32) for k in range(count)]


def _gradient(plane: Picture) -> tuple[Floats, Floats]:
    """Central differences along x and y, a pixel; at the frame half the difference to the one neighbour there is."""
    padded = np.pad(plane.astype(np.float64), 1, mode="edge")
    return (padded[1:-1, 2:] - padded[1:-1, :-2]) * 0.5, (padded[2:, 1:-1] - padded[:-2, 1:-1]) * 0.5


def smooth(values: Floats, sigma: float) -> Floats:
    """Values (h, w) low-passed by a Gaussian of sigma pixels."""
    return blurred(np.ascontiguousarray(values, np.float32), sigma).astype(np.float64)


def _trust(edges: EdgeList, rows: int, columns: int) -> Floats:
    """How far gradients (rows, columns) tell of the form: little beside a silhouette, where they are of the border.

    They count more where strong edges are all around, as they are within a small thing. So a thing keeps its roundness,
    and neither the sky around a head nor the inside of a coin is filled with rings along the silhouette.
    """
    trust = np.ones((rows, columns))
    strong = _strong(edges)
    if len(strong.edges):
        beside = walls.distances(strong, columns, rows, _BESIDE) <= _BESIDE
        h, w = max(1, -(-rows // 4)), max(1, -(-columns // 4))
        part = np.clip((_surrounded(strong, h, w) - 0.5) / 0.3, 0, 1)
        part = (part * part * (3 - 2 * part))[np.arange(rows) * h // rows][:, np.arange(columns) * w // columns]
        trust = np.where(beside, _OUTSIDE + (_INSIDE - _OUTSIDE) * part, 1.0)
    rim = max(3, round(_RIM * columns))
    trust[:rim] = trust[-rim:] = 0
    trust[:, :rim] = trust[:, -rim:] = 0
    return trust


def _strong(edges: EdgeList) -> EdgeList:
    """The edges that part one thing from another; all edges where no strength is known."""
    if edges.strength is None:
        return edges
    return EdgeList(edges.width, edges.height, edges.vertices, edges.edges[edges.strength >= STRONG])


def _surrounded(strong: EdgeList, h: int, w: int) -> Floats:
    """(h, w) the part of the directions in which a strong edge is met within reach."""
    distance = walls.distances(strong, 2 * w, 2 * h, 0.8)
    out = np.empty((h, w))
    kernel.surrounded((distance <= 0.8).astype(np.uint8), _REACH * 2 * max(h, w), _RAYS, out)
    return out


def links(edges: EdgeList, rows: int, columns: int) -> tuple[Floats, Floats]:
    """Whether strong edges cut the links of each sample (rows, columns): to the next in its row; to the row below.

    1 where a link is cut, else 0.
    """
    met = walls.walls(_strong(edges), columns, rows)
    return (met & walls.RIGHT != 0).astype(np.float64), (met & walls.DOWN != 0).astype(np.float64)
