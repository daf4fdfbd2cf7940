"""The arrangement under construction: exact coordinates, and only changes that keep it one."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.arrangement._compiled.planar import Planar
from penink_cli.ground.model import Floats, Ints

Ints32 = npt.NDArray[np.int32]

UNIT = 0.01  # pixels: a twentieth of the accuracy that edges are found with, and short to write
_CELL_PX = 4


def to_units(positions: Floats) -> Ints:
    """Nearest grid points (n, 2) to positions in pixels."""
    return np.rint(positions / UNIT).astype(np.int64)


def from_units(vertices: Ints) -> Floats:
    """Positions in pixels (n, 2) of grid points, as the decimals they are written with."""
    return vertices / (1 / UNIT)


def planar(width: int, height: int, vertices: Ints, ends: Ints32) -> Planar:
    """An empty arrangement in the frame, over vertices (n, 2) units and candidate segments (m, 2)."""
    cell = round(_CELL_PX / UNIT)
    longest = np.abs(vertices[ends[:, 0]] - vertices[ends[:, 1]]).sum(axis=1) // cell + 3 if len(ends) else np.zeros(0)
    return Planar(
        np.ascontiguousarray(vertices, np.int64),
        np.ascontiguousarray(ends, np.int32),
        np.zeros(max(1, len(ends)), np.uint8),
        np.full((height // _CELL_PX + 2, width // _CELL_PX + 2), -1, np.int32),
        np.zeros((int(longest.sum()) + 64, 2), np.int32),
        np.zeros(max(1, len(ends)), np.int32),
        cell,
    )
