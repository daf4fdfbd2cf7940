"""Edges drawn into a grid of pixels: as walls between the centres of pixels, and as distances from them.

A step from a pixel's centre to the next in its row, or to the one below, meets an edge or is open. A centre on an edge
stands for itself shifted by (ε, ε²), the tie rule of `_compiled/predicates.pyx`. Open steps join pixels to a region.

This module alone imports the compiled kernel.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.geometry._compiled import walls as _walls
from penink_cli.ground.model import EdgeList, Floats

RIGHT, DOWN = _walls.RIGHT, _walls.DOWN

Walls = npt.NDArray[np.uint8]


def segments(edges: EdgeList, width: int, height: int) -> tuple[Floats, Floats, Floats, Floats]:
    """Ends ax, ay, bx, by (m,) of the edges in pixels of an image of width × height."""
    vertices = edges.scaled(width, height)
    a, b = vertices[edges.edges[:, 0]], vertices[edges.edges[:, 1]]
    ax, ay, bx, by = (np.ascontiguousarray(part) for part in (*a.T, *b.T))
    return ax, ay, bx, by


def walls(edges: EdgeList, width: int, height: int) -> Walls:
    """(h, w) bits: `RIGHT` where the step to the next pixel in the row meets an edge, `DOWN` where that below does."""
    met = np.zeros((height, width), np.uint8)
    _walls.block(*segments(edges, width, height), met)
    return met


def distances(edges: EdgeList, width: int, height: int, most: float) -> npt.NDArray[np.float32]:
    """(h, w) distance in pixels from each pixel's centre to the nearest edge, infinite where it is beyond `most`."""
    away = np.full((height, width), np.inf, np.float32)
    _walls.near(*segments(edges, width, height), most, away)
    return away


def nearest(edges: EdgeList, width: int, height: int, most: float) -> npt.NDArray[np.int32]:
    """(h, w) the edge that is nearest to each pixel's centre, -1 where all are beyond `most` pixels."""
    away, which = np.full((height, width), np.inf, np.float32), np.full((height, width), -1, np.int32)
    _walls.near(*segments(edges, width, height), most, away, which)
    return which


def regions(met: Walls) -> npt.NDArray[np.int32]:
    """(h · w,) for each pixel the first pixel of its region. met: as of `walls`."""
    parent = np.zeros(met.size, np.int32)
    _walls.regions(met, parent)
    return parent
