"""Grey overlays (section 3): a photograph taken apart into layers whose tones add up to its own."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from penink_cli.ground.errors import ParameterError
from penink_cli.ground.model import EdgeList, Floats, GreyImage


def by_mask(photo: GreyImage, mask: GreyImage) -> Floats:
    """The layer's share (h, w), 0 … 1, of each pixel of the photo: the mask's grey.

    Raises ParameterError where the two differ in size.
    """
    if photo.values.shape != mask.values.shape:
        (h, w), (rows, columns) = photo.values.shape, mask.values.shape
        raise ParameterError(f"the mask has {columns} x {rows} pixels; the photo has {w} x {h}")
    return mask.values / float(mask.maxval)


def by_grey(photo: GreyImage, low: float, high: float) -> Floats:
    """Share (h, w): 1 where the grey, 0 … 1, is at least low and less than high, else 0; a high of 1 is included."""
    grey = photo.values / float(photo.maxval)
    return ((grey >= low) & ((grey < high) | (high == 1))).astype(np.float64)


def by_region(photo: GreyImage, edges: EdgeList, points: Sequence[tuple[float, float]]) -> Floats:
    """Share (h, w): 1 where a pixel's centre lies in the regions of the arrangement that hold the points, else 0.

    points: x, y in the edge list's pixels, at least one. Raises ArrangementError for a point outside the frame.
    """
    from penink_cli.geometry import regions

    return regions.region_mask(edges, np.array(points), *photo.values.shape[::-1]).astype(np.float64)


def overlay(photo: GreyImage, share: Floats, invert: bool = False) -> GreyImage:
    """The photo's tone times the share (h, w), on white; inverted, exactly the rest of the photo's tone."""
    ink = photo.maxval - photo.values.astype(np.int64)
    part = np.floor(ink * share + 0.5).astype(np.int64)
    values = photo.maxval - (ink - part if invert else part)
    return GreyImage(values.astype(np.uint8) if photo.maxval < 256 else values.astype(np.uint16), photo.maxval)
