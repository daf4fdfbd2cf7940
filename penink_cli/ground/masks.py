"""Masks of pixels: parts that hang together, and distances. This module alone imports the compiled kernel.

scipy has the same, and takes longer to load than a drawing's marks take to be found.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.ground._compiled import masks as _masks
from penink_cli.ground.model import Floats

Mask = npt.NDArray[np.bool_]


def labelled(mask: Mask) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int32]]:
    """The number (h, w) of the part of the mask that each pixel is in, and each part's box (parts, 4).

    Parts are numbered from 1 in the order of their first pixels, which touch at sides or corners; 0 is outside. A box
    is its first row, one past the last, first column, one past the last.

    >>> part, box = labelled(np.eye(3, 5, 2) > 0)
    >>> part.max(), box.tolist()
    (np.int32(1), [[0, 3, 2, 5]])
    """
    part = np.empty(mask.shape, np.int32)
    box = np.empty((_masks.label(np.ascontiguousarray(mask).view(np.uint8), part), 4), np.int32)
    _masks.boxes(part, box)
    return part, box


def distance(mask: Mask) -> Floats:
    """From the middle of each pixel (h, w) of the mask to that of the nearest one outside, pixels; 0 outside.

    >>> distance(np.array([[False, True, True]])).tolist()
    [[0.0, 1.0, 2.0]]
    """
    out = np.empty(mask.shape)
    _masks.distance(np.ascontiguousarray(mask).view(np.uint8), out)
    return out
