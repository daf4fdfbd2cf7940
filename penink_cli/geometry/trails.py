"""Edges as few long trails, as a pen would follow them: straight on at junctions, each edge once.

Used by those who write edges down and by those who draw them.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.ground.model import Ints

Trail = tuple[list[int], list[int]]


def trails(points: npt.NDArray[np.floating] | Ints, ends: Ints, least_cosine: float = -1.0) -> list[Trail]:
    """The trails of an arrangement, each as its vertices and its edges (one fewer), in order along it.

    points: (n, 2); ends: (m, 2). At a junction a trail goes on along the straightest edge left, and ends if the cosine
    of the bend would be under least_cosine. Trails start where an odd number of edges meet, then, for the
    rings that remain, at their topmost vertex. The result depends
    on the places of vertices and edges alone, not on their numbers.
    """
    rank = np.empty(len(points), np.int64)
    by_place = np.lexsort((points[:, 0], points[:, 1]))
    rank[by_place] = np.arange(len(points))
    around: list[list[tuple[int, int]]] = [[] for _ in range(len(points))]
    for edge in np.lexsort((rank[ends].max(axis=1), rank[ends].min(axis=1))).tolist():
        a, b = ends[edge].tolist()
        around[a].append((b, edge))
        around[b].append((a, edge))
    at, used = points.tolist(), bytearray(len(ends))
    limit = least_cosine * abs(least_cosine)

    def onward(here: int, came: tuple[float, float] | None) -> tuple[int, int] | None:
        free = [way for way in around[here] if not used[way[1]]]
        if came is None or not free or len(around[here]) == 2:
            return free[0] if free else None
        x, y = at[here]
        length = came[0] * came[0] + came[1] * came[1]

        def straightness(way: tuple[int, int]) -> float:
            dx, dy = at[way[0]][0] - x, at[way[0]][1] - y
            along = dx * came[0] + dy * came[1]
            return float(along * abs(along) / ((dx * dx + dy * dy) * length))

        best = max(free, key=straightness)
        return best if straightness(best) >= limit else None

    def walk(start: int) -> Trail:
        vertices, edges, here = [start], [], start
        came: tuple[float, float] | None = None
        while (way := onward(here, came)) is not None:
            used[way[1]] = 1
            edges.append(way[1])
            came = at[way[0]][0] - at[here][0], at[way[0]][1] - at[here][1]
            here = way[0]
            vertices.append(here)
        return vertices, edges

    found = []
    for rings in (False, True):
        for start in by_place.tolist():
            while (left := sum(not used[edge] for _, edge in around[start])) and (rings or left % 2):
                found.append(walk(start))
    return found


def hanging_together(edges: npt.NDArray[np.integer], count: int) -> Ints:
    """(m,) for each edge (m, 2) between count vertices the least vertex that it hangs together with.

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
