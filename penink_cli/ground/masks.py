"""Masks of pixels: connected parts, and distances. This module alone imports the compiled kernel.

scipy has the same, but loading it takes longer than all that these functions do for a drawing.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from penink_cli.ground import threads as threading
from penink_cli.ground._compiled import masks as _masks
from penink_cli.ground.model import Floats, Ints

Mask = npt.NDArray[np.bool_]

_FEW = 150.0  # pixels: up to this reach comparing all steps is faster than finding each pixel's nearest
_BAND = 64  # rows of a task: the numbers of these a processor's cache holds


def labelled(mask: Mask) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int32]]:
    """The number (h, w) of the part of the mask that each pixel is in, and each part's box (parts, 4).

    Pixels of a part touch at sides or corners. Parts are numbered from 1 in the order of their first pixels; 0 is
    outside. A box is the part's first row, the row past its last, its first column and the column past its last.

    >>> part, box = labelled(np.eye(3, 5, 2) > 0)
    >>> part.max(), box.tolist()
    (np.int32(1), [[0, 3, 2, 5]])
    """
    part, count = parts(mask)
    box = np.empty((count, 4), np.int32)
    _masks.boxes(part, box)
    return part, box


def parts(mask: Mask) -> tuple[npt.NDArray[np.int32], int]:
    """The same numbers (h, w), and how many parts there are."""
    part = np.empty(mask.shape, np.int32)
    return part, _masks.label(_octets(mask), True, part)


def sizes(part: npt.NDArray[np.int32], count: int, mask: Mask) -> Ints:
    """How many pixels of the mask (h, w) are in each of `count` parts, (count + 1,); the first number is of no part.

    part: (h, w) as of `labelled`.

    >>> sizes(labelled(np.eye(3, 5, 2) > 0)[0], 1, np.ones((3, 5), bool)).tolist()
    [12, 3]
    """
    size = np.zeros(count + 1, np.int64)
    _masks.sizes(part, _octets(mask), size)
    return size


def distance(mask: Mask) -> Floats:
    """Distances (h, w) in pixels from each pixel of the mask to the nearest pixel outside, between their middles.

    They are 0 outside the mask, and 1e300 where there is no pixel outside.

    >>> distance(np.array([[False, True, True]])).tolist()
    [[0.0, 1.0, 2.0]]
    """
    out = np.empty(mask.shape)
    _masks.distance(_octets(mask), out)
    return out


def near(mask: Mask, reach: float, strictly: bool = False, threads: int = 1) -> Mask:
    """Which pixels (h, w) are no further than `reach` pixels from one outside the mask; all pixels outside are.

    strictly: which are nearer than `reach`. The same as `distance(mask) <= reach`, or `<`, in a fraction of the time
    where the reach is a few pixels.

    >>> near(np.array([[True, False, True, True, True]]), 1.0).tolist()
    [[True, True, True, False, False]]
    """
    if reach > _FEW:
        away = distance(mask)
        return away < reach if strictly else away <= reach
    most = int(reach * reach) + 2  # of the squares of distances, which are whole
    while most >= 0 and not (math.sqrt(most) < reach or (math.sqrt(most) == reach and not strictly)):
        most -= 1
    if most < 0:
        return np.zeros(mask.shape, np.bool_)
    around, octets = math.isqrt(most), _octets(mask)
    reaches = np.array([math.isqrt(most - k * k) for k in range(around + 1)], np.uint8)
    out = np.empty(mask.shape, np.bool_)

    def band(top: int, bottom: int) -> None:
        down = np.empty((bottom - top + 2 * around, mask.shape[1] + 2 * around), np.uint8)
        _masks.within(octets, reaches, down, top, out[top:bottom].view(np.uint8))

    threading.share(threading.ranges(band, len(mask), max(_BAND, 4 * around)), threads)
    return out


def part_at(mask: Mask, row: int, column: int) -> Mask:
    """The part of the mask (h, w) that a pixel is in, of pixels that touch at their sides; empty for a pixel outside.

    >>> part_at(np.array([[True, True, False, True]]), 0, 1).tolist()
    [[True, True, False, False]]
    """
    part = np.empty(mask.shape, np.int32)
    _masks.label(_octets(mask), False, part)
    return (part == part[row, column]) & mask


def filled(mask: Mask) -> Mask:
    """The mask (h, w) with its holes filled: pixels outside that no way over sides joins to the frame.

    >>> filled(np.array([[0, 1, 0], [1, 0, 1], [0, 1, 0]]) > 0).astype(int).tolist()
    [[0, 1, 0], [1, 1, 1], [0, 1, 0]]
    """
    part = np.empty(mask.shape, np.int32)
    outside = np.zeros(_masks.label(_octets(~mask), False, part) + 1, np.bool_)
    for side in (part[0], part[-1], part[:, 0], part[:, -1]):
        outside[side] = True
    outside[0] = False
    return ~outside[part]


def opened(mask: Mask, radius: float) -> Mask:
    """The pixels of the mask (h, w) that are covered by discs of that radius (pixels) within the mask and the frame.

    >>> opened(np.array([[1, 0, 0, 0], [1, 0, 1, 0], [1, 1, 1, 1], [0, 0, 1, 0]]) > 0, 1.0).astype(int).tolist()
    [[0, 0, 0, 0], [0, 0, 1, 0], [0, 1, 1, 1], [0, 0, 1, 0]]
    """
    centres = ~near(np.pad(mask, 1), radius)[1:-1, 1:-1]
    return near(~centres, radius)


def grown(mask: Mask, steps: int) -> Mask:
    """The mask (h, w) and all pixels that at most so many steps over sides lead to.

    >>> grown(np.array([[True, False, False, False]]), 2).tolist()
    [[True, True, True, False]]
    """
    for _ in range(steps):
        wider = mask.copy()
        wider[1:] |= mask[:-1]
        wider[:-1] |= mask[1:]
        wider[:, 1:] |= mask[:, :-1]
        wider[:, :-1] |= mask[:, 1:]
        mask = wider
    return mask


def _octets(mask: Mask) -> npt.NDArray[np.uint8]:
    return np.ascontiguousarray(mask).view(np.uint8)
