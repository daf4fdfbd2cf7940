"""The slow and obvious check of an arrangement: every pair of edges, in exact fractions."""

from fractions import Fraction
from itertools import combinations


def crossings(edges) -> list[tuple[int, int]]:
    """Pairs of edges that meet elsewhere than at one shared vertex."""
    points = [(Fraction(float(x)), Fraction(float(y))) for x, y in edges.vertices]
    ends = [(int(a), int(b)) for a, b in edges.edges]
    boxes = [[sorted(points[v][k] for v in pair) for k in (0, 1)] for pair in ends]
    return [
        (i, j)
        for i, j in combinations(range(len(ends)), 2)
        if all(boxes[i][k][0] <= boxes[j][k][1] and boxes[j][k][0] <= boxes[i][k][1] for k in (0, 1))
        and _meet(points, ends[i], ends[j])
    ]


def _turn(a, b, c) -> int:
    cross = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return (cross > 0) - (cross < 0)


def _meet(points, first, second) -> bool:
    shared = set(first) & set(second)
    if len(shared) == 2:
        return True
    if shared:
        v = points[shared.pop()]
        p, q = (points[(set(pair) - (set(first) & set(second))).pop()] for pair in (first, second))
        ahead = (p[0] - v[0]) * (q[0] - v[0]) + (p[1] - v[1]) * (q[1] - v[1])
        return _turn(v, p, q) == 0 and ahead > 0
    a, b, c, d = (points[v] for v in (*first, *second))
    return _turn(a, b, c) * _turn(a, b, d) <= 0 and _turn(c, d, a) * _turn(c, d, b) <= 0
