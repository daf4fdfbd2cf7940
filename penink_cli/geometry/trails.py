"""Edges as few long trails, as a pen would follow them: straight on at junctions, each edge once.

Formats write edges as trails, and outlines are drawn along them. This module alone imports the compiled kernel.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.geometry._compiled import trails as _trails
from penink_cli.ground.model import Ints

Trail = tuple[list[int], list[int]]


def trails(points: npt.NDArray[np.floating] | Ints, ends: Ints, least_cosine: float = -1.0) -> list[Trail]:
    """The trails of an arrangement, each as its vertices and its edges (one fewer), in order along it.

    points: (n, 2); ends: (m, 2). At a junction a trail goes on along the straightest edge left. It ends there if the
    cosine of the bend would be under least_cosine. Trails start where an odd number of edges meet; the rings that
    remain start at their topmost vertex. The result depends on the places of vertices and edges alone, not on their
    numbers.
    """
    rank = np.empty(len(points), np.int64)
    by_place = np.lexsort((points[:, 0], points[:, 1]))
    rank[by_place] = np.arange(len(points))
    order = np.lexsort((rank[ends].max(axis=1), rank[ends].min(axis=1)))
    m = len(ends)
    vertices, along, count = np.empty(2 * m, np.int32), np.empty(m, np.int32), np.empty(m, np.int32)
    found = _trails.follow(
        np.ascontiguousarray(points, np.float64), np.ascontiguousarray(ends, np.int32), by_place, order,
        least_cosine * abs(least_cosine), vertices, along, count,
    )  # fmt: skip
    met, edges = vertices[: m + found].tolist(), along.tolist()
    result, i = [], 0
    for k, edges_of_it in enumerate(count[:found].tolist()):
        j = i + edges_of_it
        result.append((met[i + k : j + k + 1], edges[i:j]))
        i = j
    return result


def hanging_together(edges: npt.NDArray[np.integer], count: int) -> Ints:
    """(m,) for each edge (m, 2) between `count` vertices the least vertex of its connected component.

    >>> hanging_together(np.array([[4, 1], [2, 3], [1, 5]]), 6).tolist()
    [1, 2, 1]
    """
    label = np.arange(count)
    while True:
        ends = label[edges]
        if (ends[:, 0] == ends[:, 1]).all():
            return np.asarray(ends[:, 0], np.int64)
        # the greater of two roots goes under the lesser, then every vertex straight under its root
        np.minimum.at(label, ends.max(axis=1), ends.min(axis=1))
        while (label[label] != label).any():
            label = label[label]
