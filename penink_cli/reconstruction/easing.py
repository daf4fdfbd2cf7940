"""Rounded samples eased: a slow ramp of few grey levels is a ramp again, not stairs.

Where the grey changes slowly, samples of few levels lie in broad plateaus, and a large print shows their borders.
Within half a level of what they were rounded to, such samples are given the smoothest values there are: each the mean
of its neighbours. Neighbours that an edge parts, or that differ by more than a level, say nothing of one another. A
plateau that lies between a darker one and a lighter one becomes a slope; one that is lighter or darker than all about
it is back at its own level two samples from its border. Small plateaus beside one another are detail,
and stay; one by itself is what noise has made of a border.
"""

from __future__ import annotations

import numpy as np

from penink_cli.geometry.walls import DOWN, RIGHT, regions
from penink_cli.geometry.walls import walls as walls_of
from penink_cli.ground.model import EdgeList, GreyImage
from penink_cli.reconstruction._compiled import easing as _easing

FEW = 64  # levels; finer steps show nowhere
PARTS = 256  # of a level, that eased samples are rounded to
PLATEAU = 16  # samples of the smallest that is no detail
PULL = 1 / 2  # to its own level, of a plateau that is no slope: it is there two samples from its border
SWEEPS, HURRY = 100, 1.9
_MOST = 1 << 25  # samples times sweeps


def eased(samples: GreyImage, edges: EdgeList | None) -> GreyImage:
    """The samples (h, w), without stairs where they have few levels, in steps of PARTS to the level."""
    values = samples.values.astype(np.int64)
    h, w = values.shape
    if samples.maxval >= FEW:
        return samples
    walls = np.zeros((h, w), np.uint8)
    if edges is not None and len(edges.edges):
        walls = walls_of(edges, w, h)
    across, down = np.diff(values, axis=1), np.diff(values, axis=0)
    linked = np.zeros((h, w), np.uint8)
    linked[:, :-1] |= ((walls[:, :-1] & RIGHT == 0) & (np.abs(across) <= 1)).astype(np.uint8)
    linked[:-1] |= 2 * ((walls[:-1] & DOWN == 0) & (np.abs(down) <= 1)).astype(np.uint8)
    east, south = linked[:, :-1] & 1 > 0, linked[:-1] & 2 > 0

    parted = walls.copy()
    parted[:, :-1] |= np.where(across, RIGHT, 0).astype(np.uint8)
    parted[:-1] |= np.where(down, DOWN, 0).astype(np.uint8)
    parent = regions(parted)
    plateau = parent.reshape(h, w)
    lighter, darker = np.zeros(h * w, bool), np.zeros(h * w, bool)
    for step, link, one, other in (
        (across, east, plateau[:, :-1], plateau[:, 1:]),
        (down, south, plateau[:-1], plateau[1:]),
    ):
        up, fall = link & (step > 0), link & (step < 0)
        lighter[one[up]] = darker[other[up]] = True
        darker[one[fall]] = lighter[other[fall]] = True
    small = np.bincount(parent, minlength=h * w) < PLATEAU
    detail = np.zeros(h * w, bool)
    for open_way, one, other in (
        (walls[:, :-1] & RIGHT == 0, plateau[:, :-1], plateau[:, 1:]),
        (walls[:-1] & DOWN == 0, plateau[:-1], plateau[1:]),
    ):
        crowd = open_way & (one != other) & small[one] & small[other]
        detail[one[crowd]] = detail[other[crowd]] = True
    pull = np.where((lighter & darker)[plateau], 0.0, PULL)
    reach = np.where(detail[plateau], 0.0, 0.5)
    relaxed = values.astype(np.float64)
    sweeps = max(1, min(SWEEPS, _MOST // values.size))
    _easing.relax(relaxed, relaxed - reach, relaxed + reach, pull, linked, sweeps, HURRY)
    fine = np.floor(relaxed * PARTS + 0.5).clip(0, samples.maxval * PARTS)
    return GreyImage(fine.astype(np.uint16), samples.maxval * PARTS)
