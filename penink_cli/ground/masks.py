"""Masks of pixels: parts that hang together, and distances. This module alone imports the compiled kernel.

scipy has the same, and takes longer to load than a drawing's marks take to be found.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from penink_cli.ground import threads as threading
from penink_cli.ground._compiled import masks as _masks
from penink_cli.ground.model import Floats, Ints

Mask = npt.NDArray[np.bool_]

_FEW = 60.0  # pixels: as far it is faster to look at all there are than for the nearest
_BAND = 64  # rows of a task, whose numbers a processor's cache holds


def labelled(mask: Mask) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int32]]:
    """The number (h, w) of the part of the mask that each pixel is in, and each part's box (parts, 4).

    Parts are numbered from 1 in the order of their first pixels, which touch at sides or corners; 0 is outside. A box
    is its first row, one past the last, first column, one past the last.

    >>> part, box = labelled(np.eye(3, 5, 2) > 0)
    >>> part.max(), box.tolist()
    (np.int32(1), [[0, 3, 2, 5]])
    """
    part = np.empty(mask.shape, np.int32)
    box = np.empty((_masks.label(_octets(mask), True, part), 4), np.int32)
    _masks.boxes(part, box)
    return part, box


def sizes(part: npt.NDArray[np.int32], count: int, mask: Mask) -> Ints:
    """How many pixels of the mask (h, w) are in each of so many parts, (count + 1,); before them those in none.

    >>> sizes(labelled(np.eye(3, 5, 2) > 0)[0], 1, np.ones((3, 5), bool)).tolist()
    [12, 3]
    """
    size = np.zeros(count + 1, np.int64)
    _masks.sizes(part, _octets(mask), size)
    return size


def distance(mask: Mask) -> Floats:
    """From the middle of each pixel (h, w) of the mask to that of the nearest one outside, pixels; 0 outside.

    >>> distance(np.array([[False, True, True]])).tolist()
    [[0.0, 1.0, 2.0]]
    """
    out = np.empty(mask.shape)
    _masks.distance(_octets(mask), out)
    return out


def near(mask: Mask, reach: float, strictly: bool = False, threads: int = 1) -> Mask:
    """Which pixels (h, w) are no further than `reach` from one outside the mask, `strictly`: nearer; those outside are.

    The same as `distance(mask) <= reach`, in a fraction of the time where that is a few pixels.

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
    out = np.empty(mask.shape, np.bool_)

    def band(top: int, bottom: int) -> None:
        down = np.empty((bottom - top + 2 * around, mask.shape[1]), np.uint8)
        best = np.empty((2, mask.shape[1] + 2 * around), np.int16)
        _masks.within(octets, around, most, down, best, top, out[top:bottom].view(np.uint8))

    threading.share(threading.ranges(band, len(mask), max(_BAND, 4 * around)), threads)
    return out


def part_at(mask: Mask, row: int, column: int) -> Mask:
    """The part of the mask (h, w) that this pixel is in, of pixels that touch at their sides; nothing where it is out.

    >>> part_at(np.array([[True, True, False, True]]), 0, 1).tolist()
    [[True, True, False, False]]
    """
    part = np.empty(mask.shape, np.int32)
    _masks.label(_octets(mask), False, part)
    return (part == part[row, column]) & mask


def filled(mask: Mask) -> Mask:
    """The mask (h, w) without its holes: with all that no way over sides leads to from beyond.

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
    """What discs of that radius (pixels) cover that lie in the mask (h, w) and its frame.

    >>> opened(np.array([[1, 0, 0, 0], [1, 0, 1, 0], [1, 1, 1, 1], [0, 0, 1, 0]]) > 0, 1.0).astype(int).tolist()
    [[0, 0, 0, 0], [0, 0, 1, 0], [0, 1, 1, 1], [0, 0, 1, 0]]
    """
    centres = ~near(np.pad(mask, 1), radius)[1:-1, 1:-1]
    return near(~centres, radius)


def grown(mask: Mask, steps: int) -> Mask:
    """The mask (h, w) and what so many steps over sides lead to.

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
