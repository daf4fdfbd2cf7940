"""A few edges in a window, and what might be there instead."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from penink_cli.arrangement._window import MOST_MOVED

Point = tuple[float, float]

_BENT = 2.0  # pixels: shorter edges have no bend


@dataclass(frozen=True, eq=False)
class Place:
    """The arrangement in a window: vertices' positions by number, and edges by their segment (−1: a new one)."""

    at: dict[int, Point]
    edges: list[tuple[int, int, int]]
    free: frozenset[int]

    def degree(self, v: int) -> int:
        """How many edges meet at v."""
        return sum(v in (a, b) for a, b, _ in self.edges)

    def others(self, v: int, but: int) -> list[int]:
        """Neighbours of v, one excepted."""
        return [b if a == v else a for a, b, _ in self.edges if v in (a, b) and but not in (a, b)]

    def turns(self) -> Iterator[tuple[float, float]]:
        """At each free vertex of two edges how far the way turns, in radians, and how long the shorter arm is.

        An arm that ends at a junction has no end that could be told from it: its length is infinite.
        """
        around: dict[int, list[int]] = {v: [] for v in self.at}
        for a, b, _ in self.edges:
            around[a].append(b)
            around[b].append(a)
        for v in sorted(self.free):
            if len(around[v]) == 2:
                p, q, r = (self.at[u] for u in (around[v][0], v, around[v][1]))
                arms = [math.dist(self.at[u], q) for u in around[v] if len(around[u]) < 3]
                yield abs(angle(p, q, r)), min(arms, default=math.inf)

    def closed(self) -> bool:
        """Whether no edge leads out of the free vertices: a speck."""
        return not any((a in self.free) != (b in self.free) for a, b, _ in self.edges)

    def changes(self, near: float) -> Iterator[Place]:
        """What might be instead: a short edge gone, an open end joined."""
        for a, b, _ in self.edges:
            if a in self.free and b in self.free and math.dist(self.at[a], self.at[b]) < near:
                yield from self._merged(a, b, near)
        for v in sorted(self.free):
            if self.degree(v) == 1:
                yield from self._joined(v, near)

    def bends(self) -> Iterator[Place]:
        """An edge of which both ends are close with a vertex in its middle."""
        if len(self.free) == MOST_MOVED:
            return
        v = min(0, *self.at) - 1  # a vertex still to be had
        for edge in self.edges:
            a, b, s = edge
            if a in self.free and b in self.free and math.dist(self.at[a], self.at[b]) > _BENT:
                (x0, y0), (x1, y1) = self.at[a], self.at[b]
                at = {**self.at, v: ((x0 + x1) / 2, (y0 + y1) / 2)}
                others = [e for e in self.edges if e != edge]
                yield Place(at, [*others, (a, v, s), (v, b, -1)], self.free | {v})

    def _merged(self, a: int, b: int, near: float) -> Iterator[Place]:
        """Vertices a and b as one: where their other edges cross, or where the busier one is, or between."""
        p, q = self.at[a], self.at[b]
        one, two = self.others(a, b), self.others(b, a)
        if len(one) == len(two) == 1:
            tip = _meeting(self.at[one[0]], p, self.at[two[0]], q)
            if tip is not None and math.dist(tip, p) + math.dist(tip, q) < 3 * near:
                yield self._united(a, b, tip)
        if len(one) == len(two):
            yield self._united(a, b, ((p[0] + q[0]) / 2, (p[1] + q[1]) / 2))
        else:
            yield self._united(a, b, p if len(one) > len(two) else q)

    def _joined(self, v: int, near: float) -> Iterator[Place]:
        """An open end at the vertices and edges near it."""
        p = self.at[v]
        for a, b, s in self.edges:
            if v in (a, b):
                continue
            gap, part = distance(p, self.at[a], self.at[b])
            if gap > near:
                continue
            for u, close in ((a, part < 0.5), (b, part > 0.5)):
                if close and u in self.free and math.dist(p, self.at[u]) < near:
                    yield self._united(u, v, self.at[u])
            if 0 < part < 1:
                (x0, y0), (x1, y1) = self.at[a], self.at[b]
                foot = x0 + part * (x1 - x0), y0 + part * (y1 - y0)
                edges = [e for e in self.edges if e[2] != s or s < 0]
                yield Place({**self.at, v: foot}, [*edges, (a, v, s), (v, b, -1)], self.free)

    def _united(self, a: int, b: int, where: Point) -> Place:
        edges, seen = [], set()
        for p, q, s in self.edges:
            p, q = a if p == b else p, a if q == b else q
            if p != q and (min(p, q), max(p, q)) not in seen:
                seen.add((min(p, q), max(p, q)))
                edges.append((p, q, s))
        at = {v: xy for v, xy in self.at.items() if v != b}
        return Place({**at, a: where}, edges, self.free - {b})


def angle(p: Point, q: Point, r: Point) -> float:
    """How far the way p, q, r turns at q, radians, positive to the right on the screen."""
    ux, uy, vx, vy = q[0] - p[0], q[1] - p[1], r[0] - q[0], r[1] - q[1]
    return math.atan2(ux * vy - uy * vx, ux * vx + uy * vy)


def distance(p: Point, a: Point, b: Point) -> tuple[float, float]:
    """From p to the segment a b, and the part 0 … 1 of it where it is nearest."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    part = ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / max(1e-12, dx * dx + dy * dy)
    part = min(1.0, max(0.0, part))
    return math.dist(p, (a[0] + part * dx, a[1] + part * dy)), part


def _meeting(a: Point, p: Point, b: Point, q: Point) -> Point | None:
    """Where the ways a → p and b → q meet if they go on, if ahead of both."""
    ux, uy, vx, vy = p[0] - a[0], p[1] - a[1], q[0] - b[0], q[1] - b[1]
    across = ux * vy - uy * vx
    if abs(across) < 0.2 * math.hypot(ux, uy) * math.hypot(vx, vy):
        return None
    s = ((q[0] - p[0]) * vy - (q[1] - p[1]) * vx) / across
    t = ((q[0] - p[0]) * uy - (q[1] - p[1]) * ux) / across
    if s < 0 or t < 0:
        return None
    return p[0] + s * ux, p[1] + s * uy
