"""Reading a direction field at any size, by the same reconstruction that enlarges the grey.

The field is one function over the image frame, sharp across discontinuity edges. To read it is to take its values at
the output's centres, so a small drawing and a poster find the same direction at the same place.
"""

from __future__ import annotations

import numpy as np

from penink_cli.ground.model import Directions, EdgeList
from penink_cli.reconstruction.enlarge import Window, check_window, reconstruct

NOTHING = 1e-6  # a vector shorter than this has no direction


def at_size(
    directions: Directions,
    edges: EdgeList | None,
    rows: int,
    columns: int,
    threads: int | None = None,
    window: Window | None = None,
    confident: bool = True,
) -> Directions:
    """The field at the centres of rows × columns pixels that fill the frame: unit vectors, float32.

    Where neighbours disagree, their mean is a short vector, and the confidence is as much less. Where the mean is
    nothing, the direction is that of x and the confidence 0.

    edges: the arrangement of the picture, across which nothing is mixed; None for none.
    window: x, y, width, height of the pixels wanted, all unless given. No value depends on it, nor on threads.
    confident: whether the field's own confidence counts too; else the confidence is how far neighbours agree.

    Raises ParameterError for a window beyond the frame.
    """
    x, y, width, height = check_window(window, columns, rows)
    h, w = directions.cos2.shape
    # For fewer pixels than samples the reconstruction would widen its kernels, and directions would depend on the size.
    # So the field is read at an odd multiple of the size, where a pixel lies at each of the centres wanted.
    down, across = _odd(h, rows), _odd(w, columns)
    finer = x * across, y * down, width * across, height * down

    planes = [directions.cos2, directions.sin2, directions.confidence][: 3 if confident else 2]
    found = reconstruct(
        np.array(planes, np.float64), edges, columns * across, rows * down, window=finer, threads=threads
    )[:, down // 2 :: down, across // 2 :: across]
    cos2, sin2 = found[:2]
    length = np.sqrt(cos2 * cos2 + sin2 * sin2)
    known = length > NOTHING
    divisor = np.where(known, length, 1.0)
    confidence = np.where(known, np.minimum(length, 1.0), 0.0)
    if confident:
        confidence *= np.clip(found[2], 0, 1)
    return Directions(
        np.where(known, cos2 / divisor, 1.0).astype(np.float32),
        np.where(known, sin2 / divisor, 0.0).astype(np.float32),
        confidence.astype(np.float32),
    )


def _odd(samples: int, pixels: int) -> int:
    """The least odd number that makes so many pixels, times it, no fewer than the samples."""
    return -(-samples // pixels) // 2 * 2 + 1
