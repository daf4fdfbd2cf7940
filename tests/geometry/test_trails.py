"""Trails: every edge once, straight on at junctions; and the same as the definition followed word by word."""

from itertools import pairwise

import numpy as np
import pytest

from penink_cli.geometry.trails import hanging_together, trails


def as_defined(points, ends, least_cosine):
    """The definition, an edge at a time."""
    place = {v: (points[v][1], points[v][0]) for v in range(len(points))}
    inner = sorted(range(len(ends)), key=lambda e: sorted(place[v] for v in ends[e]))
    around = {v: [(b, e) for e in inner for a, b in (ends[e], ends[e][::-1]) if a == v] for v in place}
    used = set()

    def straightness(before, here, after):
        a, b = np.subtract(points[here], points[before]), np.subtract(points[after], points[here])
        along = float(a[0] * b[0] + a[1] * b[1])
        return along * abs(along) / float((b[0] * b[0] + b[1] * b[1]) * (a[0] * a[0] + a[1] * a[1]))

    def walk(start):
        vertices, edges = [start], []
        while free := [way for way in around[vertices[-1]] if way[1] not in used]:
            way = free[0]
            if edges and len(around[vertices[-1]]) != 2:
                worth = [straightness(vertices[-2], vertices[-1], v) for v, _ in free]
                way = free[int(np.argmax(worth))]
                if max(worth) < least_cosine * abs(least_cosine):
                    break
            used.add(way[1])
            vertices.append(way[0])
            edges.append(way[1])
        return vertices, edges

    found = []
    for rings in (False, True):
        for start in sorted(place, key=place.get):
            while (left := sum(e not in used for _, e in around[start])) and (rings or left % 2):
                found.append(walk(start))
    return found


@pytest.mark.parametrize("least_cosine", [-1.0, 0.0, 0.5])
@pytest.mark.parametrize("seed", range(40))
def test_trails_are_as_defined_and_go_along_every_edge_once(seed, least_cosine):
    rng = np.random.default_rng(seed)
    points = np.unique(rng.integers(0, 7, (rng.integers(2, 40), 2)), axis=0)
    points = points * 0.37 if seed % 2 else points
    ends = np.sort(rng.integers(0, len(points), (rng.integers(0, 80), 2)), axis=1)
    ends = rng.permutation(np.unique(ends[ends[:, 0] != ends[:, 1]], axis=0))
    found = trails(points, ends, least_cosine)
    assert found == as_defined(points.tolist(), ends.tolist(), least_cosine)
    assert sorted(e for _, edges in found for e in edges) == list(range(len(ends)))
    for vertices, edges in found:
        assert [sorted(pair) for pair in pairwise(vertices)] == ends[edges].tolist()


def test_a_trail_goes_straight_on_and_rings_begin_at_their_top():
    cross = np.array([[0, 5], [5, 5], [9, 6], [6, 0], [4, 9]])
    assert trails(cross, np.array([[0, 1], [1, 2], [3, 1], [1, 4]])) == [([3, 1, 4], [2, 3]), ([0, 1, 2], [0, 1])]
    square = np.array([[0, 1], [1, 0], [2, 1], [1, 2]])
    ((vertices, edges),) = trails(square, np.array([[0, 1], [1, 2], [2, 3], [3, 0]]))
    assert vertices[0] == vertices[-1] == 1 and sorted(edges) == [0, 1, 2, 3]


def test_edges_hang_together_by_their_least_vertex():
    edges = np.array([[7, 6], [2, 3], [6, 1], [3, 9], [5, 4]])
    assert hanging_together(edges, 10).tolist() == [1, 2, 1, 2, 4]
