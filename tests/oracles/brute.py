"""The reconstruction straight from its definition: every sample against every edge, every path through every vertex.

Nothing is bounded, bucketed, pruned or remembered. Signs are exact: floating point where it is certain, fractions
where it is not. Written from the definition alone, it shares no line with the code it judges.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cmp_to_key

import numpy as np


def sign(ax, ay, bx, by, cx, cy):
    """Exact signs of (b − a) × (c − a), broadcast."""
    ax, ay, bx, by, cx, cy = np.broadcast_arrays(*(np.asarray(v, float) for v in (ax, ay, bx, by, cx, cy)))
    left, right = (bx - ax) * (cy - ay), (by - ay) * (cx - ax)
    out = np.array(np.sign(left - right), int)
    for k in np.argwhere(np.abs(left - right) <= 1e-14 * (np.abs(left) + np.abs(right))):
        k = tuple(k)
        px, py, qx, qy, rx, ry = (Fraction(float(v[k])) for v in (ax, ay, bx, by, cx, cy))
        exact = (qx - px) * (ry - py) - (qy - py) * (rx - px)
        out[k] = (exact > 0) - (exact < 0)
    return out


def turn(a, b, c):
    """The same for three points."""
    left, right = (b[0] - a[0]) * (c[1] - a[1]), (b[1] - a[1]) * (c[0] - a[0])
    if abs(left - right) > 1e-14 * (abs(left) + abs(right)):
        return 1 if left > right else -1
    (px, py), (qx, qy), (rx, ry) = ((Fraction(float(x)), Fraction(float(y))) for x, y in (a, b, c))
    exact = (qx - px) * (ry - py) - (qy - py) * (rx - px)
    return (exact > 0) - (exact < 0)


def side(a, b, q):
    """Side of the line of vertices a → b on which the query q + (ε, ε²) is; never zero."""
    s = sign(a[0], a[1], b[0], b[1], q[..., 0], q[..., 1])
    tie = -np.sign(b[1] - a[1]) or np.sign(b[0] - a[0])
    return np.where(s == 0, tie, s)


def side_from(p, q, a):
    """Side of the line of queries p → q, both shifted by (ε, ε²), on which the vertex a is; zero only if p is q."""
    s = sign(p[..., 0], p[..., 1], q[..., 0], q[..., 1], a[0], a[1])
    up = np.sign(q[..., 1] - p[..., 1])
    return np.where(s == 0, np.where(up != 0, up, -np.sign(q[..., 0] - p[..., 0])), s)


class Brute:
    """The path graph of an arrangement over w × h samples."""

    def __init__(self, edges, w, h):
        self.w, self.h = w, h
        self.v = edges.vertices * (float(w), float(h)) / (edges.width, edges.height) - 0.5
        self.at = [(float(x), float(y)) for x, y in self.v]
        self.e = [(int(a), int(b)) for a, b in edges.edges]
        self.sectors = [s for v in range(len(self.v)) for s in self._sectors(v)]
        self.between = self._all_pairs()

    def _sectors(self, v):
        """(vertex, from, to) of each sector of π and more, turning positively; from is to at a dangling end."""
        x, y = self.v[v]
        around = [b if a == v else a for a, b in self.e if v in (a, b)]
        if not around or not (-0.5 < x < self.w - 0.5 and -0.5 < y < self.h - 0.5):
            return []
        if len(around) == 1:
            return [(v, around[0], around[0])]

        def half(u):
            dx, dy = self.v[u] - self.v[v]
            return 0 if dy > 0 or (dy == 0 and dx > 0) else 1

        def compare(a, b):
            return half(a) - half(b) or -turn(self.at[v], self.at[a], self.at[b])

        around.sort(key=cmp_to_key(compare))
        return [
            (v, a, b)
            for a, b in zip(around, around[1:] + around[:1])
            if turn(self.at[v], self.at[a], self.at[b]) <= 0  # turning from a to b takes π or more
        ]

    def _holds(self, sector, u):
        """Whether the closed sector holds the direction of the vertex u."""
        v, a, b = sector
        return a == b or turn(self.at[v], self.at[a], self.at[u]) >= 0 or turn(self.at[v], self.at[b], self.at[u]) <= 0

    def _arc(self, s, t):
        u, v = s[0], t[0]
        if u == v:
            return np.inf
        length = float(np.hypot(*(self.v[u] - self.v[v])))
        if (u, v) in self.e or (v, u) in self.e:
            left = s[1] == v and t[2] == u
            right = s[2] == v and t[1] == u
            return length if left or right else np.inf
        if not (self._holds(s, v) and self._holds(t, u)):
            return np.inf
        p, q = self.at[u], self.at[v]
        used = {k for edge in self.e for k in edge} - {u, v}
        for k in used:
            c = self.at[k]
            within = min(p, q) < c < max(p, q)  # by x, then y: enough on one line
            if within and turn(p, q, c) == 0:
                return np.inf
        for a, b in self.e:
            if {a, b} & {u, v}:
                continue
            c, d = self.at[a], self.at[b]
            if turn(p, q, c) * turn(p, q, d) < 0 and turn(c, d, p) * turn(c, d, q) < 0:
                return np.inf
        return length

    def _all_pairs(self):
        n = len(self.sectors)
        d = np.full((n, n), np.inf)
        for i in range(n):
            for j in range(i):
                d[i, j] = d[j, i] = self._arc(self.sectors[i], self.sectors[j])
            d[i, i] = 0.0
        for k in range(n):
            d = np.minimum(d, d[:, k : k + 1] + d[k : k + 1])
        return d

    def to_sectors(self, q):
        """(n, sectors) distance of each query to each bend that it sees."""
        out = np.full((len(q), len(self.sectors)), np.inf)
        for k, (v, a, b) in enumerate(self.sectors):
            x = self.v[v]
            ok = np.ones(len(q), bool)
            if a != b:
                ok &= (side(x, self.v[a], q) > 0) | (side(x, self.v[b], q) < 0)
            for c, d in self.e:
                if v in (c, d):
                    continue
                p, r = self.v[c], self.v[d]
                own = turn(p, r, x)
                if own != 0:
                    ok &= ~((side(x, p, q) != side(x, r, q)) & (side(p, r, q) != own))
            out[ok, k] = np.hypot(*(q[ok] - x).T)
        return out

    def sees(self, p, q):
        """Whether the queries p[k] and q[k] see each other."""
        ok = np.ones(len(p), bool)
        for a, b in self.e:
            c, d = self.v[a], self.v[b]
            ok &= ~((side_from(p, q, c) != side_from(p, q, d)) & (side(c, d, p) != side(c, d, q)))
        return ok

    def lengths(self, p, samples, near):
        """(n, taps) shortest paths from each query to each of its samples; near: (n, taps) indices into samples."""
        to_p, to_s = self.to_sectors(p), self.to_sectors(samples)
        through = np.full(to_p.shape, np.inf)
        for k in range(len(self.sectors)):
            through = np.minimum(through, to_p[:, k : k + 1] + self.between[k])
        out = np.empty(near.shape)
        for k in range(near.shape[1]):
            s = near[:, k]
            straight = np.hypot(*(p - samples[s]).T)
            round_about = (through + to_s[s]).min(axis=1, initial=np.inf)
            out[:, k] = np.where(self.sees(p, samples[s]), straight, round_about)
        return out


def cubic(x):
    x = np.abs(x)
    near, far = 1.5 * x**3 - 2.5 * x**2 + 1, -0.5 * x**3 + 2.5 * x**2 - 4 * x + 2
    return np.where(x < 1, near, np.where(x < 2, far, 0.0))


def bspline(x):
    x = np.abs(x)
    return np.where(x < 1, 3 * x**3 - 6 * x**2 + 4, np.where(x < 2, -(x**3) + 6 * x**2 - 12 * x + 8, 0.0)) / 6


def smooth(t):
    t = np.clip(t, 0, 1)
    return 3 * t**2 - 2 * t**3


def reconstruct(samples, edges, width, height, radius=1.0, kernel="cubic", graph=Brute):
    """(height, width) values, neither clamped nor rounded, from samples (h, w)."""
    h, w = samples.shape
    scene = graph(edges, w, h)
    x = (np.arange(width) + 0.5) * w / width - 0.5
    y = (np.arange(height) + 0.5) * h / height - 0.5
    p = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    grid = np.stack(np.meshgrid(np.arange(w), np.arange(h)), axis=-1).reshape(-1, 2).astype(float)
    wide_x, wide_y = max(1.0, w / width), max(1.0, h / height)
    radius = radius * max(wide_x, wide_y)
    # Every tap that a kernel can reach, and its weight at its own place; its source is within the frame.
    ix = np.floor(p[:, :1]).astype(int) + np.arange(-int(2 * wide_x) - 1, int(2 * wide_x) + 3)
    iy = np.floor(p[:, 1:]).astype(int) + np.arange(-int(2 * wide_y) - 1, int(2 * wide_y) + 3)
    weights = {}
    for name, k in (("cubic", cubic), ("bspline", bspline)):
        kx, ky = k((p[:, :1] - ix) / wide_x), k((p[:, 1:] - iy) / wide_y)
        kx, ky = kx / kx.sum(axis=1, keepdims=True), ky / ky.sum(axis=1, keepdims=True)
        weights[name] = (ky[:, :, None] * kx[:, None, :]).reshape(len(p), -1)
    source = (np.clip(iy, 0, h - 1)[:, :, None] * w + np.clip(ix, 0, w - 1)[:, None, :]).reshape(len(p), -1)
    straight = np.hypot(p[:, :1] - grid[source, 0], p[:, 1:] - grid[source, 1])
    detour = scene.lengths(p, grid, source) - straight
    alpha = np.where(detour <= 0, 1.0, 1.0 - smooth(detour / radius))
    f = samples.reshape(-1)[source]
    c, b = alpha * weights["cubic"], alpha * weights["bspline"]
    den_c, den_b = c.sum(axis=1), b.sum(axis=1)
    omega = smooth(den_c / 0.5) if kernel == "cubic" else np.zeros(len(p))
    k = omega[:, None] * c + (1 - omega[:, None]) * b
    total = k.sum(axis=1)
    value = np.divide((k * f).sum(axis=1), total, out=np.zeros(len(p)), where=total > 0)
    plain = (weights[kernel] * f).sum(axis=1)
    fade = 1 - smooth(den_b / 1e-4)
    return ((1 - fade) * value + fade * plain).reshape(height, width)
