"""Shortest paths the paper's own way (section 2.2): walk the constrained Delaunay triangulation, all-pairs distances.

A discontinuity vertex is a *fan* here: triangles around one corner, joined across sides that are no edges. No sector is
measured and no angle compared: a path may bend at any fan, and that bending at some never pays is left to Dijkstra.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse.csgraph import dijkstra

from penink_cli.geometry.triangulation import triangulate
from penink_cli.ground.model import EdgeList
from tests.oracles.brute import turn


class Triangulated:
    """Same questions and answers as `brute.Brute`, for an arrangement over w × h samples."""

    def __init__(self, edges: EdgeList, w: int, h: int):
        # The frame is moved so that samples are at integers; the triangulation's frame begins at the origin.
        scaled = edges.vertices * (float(w), float(h)) / (edges.width, edges.height)
        self.mesh = triangulate(EdgeList(w, h, scaled, edges.edges))
        self.v = [(float(x), float(y)) for x, y in self.mesh.vertices - 0.5]
        self.t = self.mesh.triangles.tolist()
        self.beyond = np.where(self.mesh.fixed, -1, self.mesh.neighbours).tolist()
        self.fans = self._fans()
        n = 1 + max(self.fans.values())
        self.corner = [0] * n  # the vertex of each fan
        for (t, k), fan in self.fans.items():
            self.corner[fan] = self.t[t][k]
        x, y = np.array(self.v).T
        at_border = (x <= -0.5) | (y <= -0.5) | (x >= w - 0.5) | (y >= h - 0.5)
        self.usable = [not at_border[self.corner[f]] for f in range(n)]
        graph = np.zeros((n, n))
        for f, g, length in self._arcs():
            graph[f, g] = graph[g, f] = length
        self.between = dijkstra(graph, directed=False)

    def _fans(self):
        """(triangle, corner) -> number of its fan."""
        fans, count = {}, 0
        for t in range(len(self.t)):
            for k in range(3):
                if (t, k) in fans:
                    continue
                stack, v = [(t, k)], self.t[t][k]
                fans[t, k] = count
                while stack:
                    s, i = stack.pop()
                    for side in (i, (i + 2) % 3):  # the two sides at the corner
                        u = self.beyond[s][side]
                        if u >= 0 and (u, self.t[u].index(v)) not in fans:
                            fans[u, self.t[u].index(v)] = count
                            stack.append((u, self.t[u].index(v)))
                count += 1
        return fans

    def _arcs(self):
        """Pairs of fans that see each other, and how far apart they are."""
        for t in range(len(self.t)):
            for k in range(3):
                i = (k + 1) % 3
                yield from self._arc(self.fans[t, k], self.fans[t, i])  # along a side, on this side of it
                for target in range(len(self.v)):  # and straight out between the two sides at the corner
                    found = self._march_between(t, k, target)
                    if found is not None:
                        yield from self._arc(self.fans[t, k], found)

    def _arc(self, f, g):
        if self.usable[f] and self.usable[g]:
            yield f, g, np.hypot(*np.subtract(self.v[self.corner[f]], self.v[self.corner[g]]))

    def _march_between(self, t, k, target):
        p, q = self.v[self.t[t][k]], self.v[target]
        a, b = self.t[t][(k + 1) % 3], self.t[t][(k + 2) % 3]
        if target in self.t[t] or turn(p, self.v[a], q) <= 0 or turn(p, self.v[b], q) >= 0:
            return None
        return self._march(t, (k + 1) % 3, target, lambda c: turn(p, q, self.v[c]))

    def _march(self, t, side, target, on):
        """Go on across a side, to the fan at which the target is reached; None if an edge or a vertex is met first.

        on: the side of the ray on which a vertex lies, 0 for a vertex that the ray meets.
        """
        while True:
            t, came = self.beyond[t][side], t
            if t < 0:
                return None
            if target in self.t[t]:
                return self.fans[t, self.t[t].index(target)]
            back = self.mesh.neighbours[t].tolist().index(came)
            apex = on(self.t[t][(back + 2) % 3])
            if apex == 0:
                return None
            # A ray leaves a triangle across the side a → b with a on its negative side and b on its positive.
            side = (back + 1) % 3 if apex > 0 else (back + 2) % 3
            a, b = self.t[t][side], self.t[t][(side + 1) % 3]
            assert on(a) < 0 < on(b)

    def _query_side(self, p, c, q):
        """Side of the ray from the query p to q, which is a query too or else a vertex, on which the vertex c lies."""
        s = turn(p, q[0], self.v[c])
        if s:
            return s
        # Where q is a query, p and q are shifted alike; else p alone, and (p, q, c) turns as (q, c, p).
        x, y = np.subtract(q[0], p if q[1] else self.v[c])
        return int(np.sign(y) or -np.sign(x))

    def _from_query(self, p, start, q, target):
        """The fan of the target vertex where the walk from the query p arrives, or for a query q whether it does."""
        t = start
        end = self.mesh.locate(q[0][0] + 0.5, q[0][1] + 0.5) if q[1] else None
        came = -1
        while True:
            if q[1] and t == end:
                return True
            if not q[1] and target in self.t[t]:
                return self.fans[t, self.t[t].index(target)]
            for k in range(3):
                a, b = self.t[t][k], self.t[t][(k + 1) % 3]
                if self.mesh.neighbours[t][k] == came and came >= 0:
                    continue
                # Out across the side that the ray leaves through: a to its left, b to its right, as the triangle turns.
                if self._query_side(p, a, q) < 0 < self._query_side(p, b, q):
                    break
            else:
                raise AssertionError("the walk is lost")
            if self.beyond[t][k] < 0:
                return None
            came, t = t, self.beyond[t][k]

    def lengths(self, p, samples, near):
        n = len(self.corner)
        vertices = sorted({c for c, ok in zip(self.corner, self.usable) if ok})

        def to_fans(query):
            out = np.full(n, np.inf)
            start = self.mesh.locate(query[0] + 0.5, query[1] + 0.5)
            for v in vertices:
                fan = self._from_query(query, start, (self.v[v], False), v)
                if fan is not None:
                    out[fan] = np.hypot(*np.subtract(query, self.v[v]))
            return start, out

        p, samples = p.tolist(), samples.tolist()
        of_samples = [to_fans(s)[1] for s in samples]
        out = np.empty(near.shape)
        for i, query in enumerate(p):
            start, mine = to_fans(query)
            through = (mine[:, None] + self.between).min(axis=0)
            for k, s in enumerate(near[i]):
                if query == samples[s] or self._from_query(query, start, (samples[s], True), None):
                    out[i, k] = np.hypot(*np.subtract(query, samples[s]))
                else:
                    out[i, k] = (through + of_samples[s]).min()
        return out
