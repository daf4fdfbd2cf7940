"""How blurred a photo is, measured on its own edges."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.ground import exact
from penink_cli.ground.median import quantile
from penink_cli.ground.model import EdgeList, Floats

LEAST_BLUR, MOST_BLUR = 0.4, 3.0
USUAL_BLUR = 0.5  # pixels: of a photo with too few edges to measure
_LOOKS = 20_000  # places on edges that are measured; more change the median by less than 0.01 pixels
_SMOOTH = 0.7  # σ, pixels, of the Gaussian along the edge under which slopes are taken
_REACH = 5  # pixels: nearer to the frame no slope is taken
_FEW = 20  # places; with fewer nothing is measured
# Variance of what the measurement itself adds: the smoothing, the pixel's area and the difference of neighbours.
_OWN = 1 / 12 + 0.25


def camera_blur(grey: npt.NDArray[np.floating], edges: EdgeList) -> float:
    """Standard deviation (pixels) of the Gaussian by which the lens has blurred the steps of a photo.

    Across an edge the grey's slope is taken at three pixels; the parabola through the logarithms
    gives the width of a Gaussian. The quantile at 0.35 is returned, a little low on purpose: a fit
    that believes in too much blur invents contrast and costs up to 5 dB, too little costs 1.7 at most.

    Args:
        grey: (h, w), 0 … 1.
        edges: in the frame of the same picture.

    """
    height, width = grey.shape
    places, normals = _looks(edges, width, height)
    column, row = np.floor(places).astype(int).T
    inside = (column > _REACH) & (row > _REACH) & (column < width - 1 - _REACH) & (row < height - 1 - _REACH)
    column, row, normals = column[inside], row[inside], normals[inside]
    if len(column) < _FEW:
        return USUAL_BLUR
    along_x = np.abs(normals[:, 0]) >= np.abs(normals[:, 1])
    pixels = np.ascontiguousarray(grey).ravel()
    place, onward = row * width + column, np.where(along_x, 1, width)
    offsets = np.arange(-2, 3)
    taps = exact.exp(-0.5 * (offsets / _SMOOTH) ** 2)
    taps /= taps.sum()
    variance = float((taps * offsets**2).sum())

    def slope(step: int) -> Floats:
        total = np.zeros(len(column))
        for i, down in zip(offsets, taps):
            for j, across in zip(offsets, taps):
                at = place + step * onward + (i * width + j)
                horizontal = pixels.take(at + 1).astype(float) - pixels.take(at - 1)
                vertical = pixels.take(at + width).astype(float) - pixels.take(at - width)
                total += 0.5 * down * across * (horizontal * normals[:, 0] + vertical * normals[:, 1])
        return total

    here = slope(0)
    rising = np.sign(here)
    here, before, after, far_before, far_after = np.abs(here), *(rising * slope(step) for step in (-1, 1, -2, 2))
    # Beside a thin line the slope turns within two pixels, and would pass for sharpness of the lens.
    usable = (
        (here > 0.01)
        & (np.minimum(before, after) > 0.05 * here)
        & (np.maximum(before, after) < 1.2 * here)
        & (np.minimum(far_before, far_after) > -0.05 * here)
    )
    if usable.sum() < _FEW:
        return USUAL_BLUR
    before, here, after = before[usable], here[usable], after[usable]
    bend = -exact.log(before / here) - exact.log(after / here)
    cosine = np.maximum(np.abs(normals[usable, 0]), np.abs(normals[usable, 1]))
    width2 = np.where(bend > 1e-3, cosine**2 / np.maximum(bend, 1e-3), np.inf)
    square = quantile(width2, 0.35) - variance - _OWN
    return float(np.clip(np.sqrt(max(0.0, square)), LEAST_BLUR, MOST_BLUR))


def _looks(edges: EdgeList, width: int, height: int) -> tuple[Floats, Floats]:
    """Places (n, 2) spread evenly over the edges, and the normals (n, 2) there."""
    vertices = edges.scaled(width, height)
    a, b = vertices[edges.edges[:, 0]], vertices[edges.edges[:, 1]]
    length = exact.length(b - a)
    total = float(length.sum())
    if not total:
        return np.zeros((0, 2)), np.zeros((0, 2))
    end = np.cumsum(length)
    at = (np.arange(min(_LOOKS, int(total) + 1)) + 0.5) * total / min(_LOOKS, int(total) + 1)
    edge = np.minimum(np.searchsorted(end, at), len(end) - 1)
    t = np.clip((at - (end[edge] - length[edge])) / length[edge], 0, 1)[:, None]
    direction = (b[edge] - a[edge]) / length[edge][:, None]
    return a[edge] + t * (b[edge] - a[edge]), np.column_stack([-direction[:, 1], direction[:, 0]])
