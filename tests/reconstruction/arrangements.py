"""Arrangements to be hostile with, each in a frame of a few samples."""

from __future__ import annotations

import numpy as np

from penink_cli.geometry.validity import check
from penink_cli.ground.errors import ArrangementError
from penink_cli.ground.model import EdgeList


def edge_list(width, height, vertices, edges):
    """A valid edge list."""
    found = EdgeList(width, height, np.array(vertices, float).reshape(-1, 2), np.array(edges, np.int64).reshape(-1, 2))
    check(found)
    return found


def chain(width, height, points, closed=False):
    """One polyline."""
    n = len(points)
    return edge_list(width, height, points, [(k, (k + 1) % n) for k in range(n if closed else n - 1)])


def random_edges(rng, width, height, count, length=2.0, lattice=None):
    """Edges at random, most of them grown from vertices already there; on a lattice of 1/lattice if given."""

    def place(x, y):
        x, y = min(max(x, 0.0), width), min(max(y, 0.0), height)
        return (round(x * lattice) / lattice, round(y * lattice) / lattice) if lattice else (x, y)

    vertices, edges = [], []
    for _ in range(6 * count):
        if len(edges) == count:
            break
        if vertices and rng.random() < 0.6:
            p = vertices[rng.integers(len(vertices))]
        else:
            p = place(rng.uniform(0, width), rng.uniform(0, height))
        angle, far = rng.uniform(0, 2 * np.pi), rng.exponential(length) + 0.05
        q = place(p[0] + far * np.cos(angle), p[1] + far * np.sin(angle))
        trial = list(vertices)
        for v in (p, q):
            if v not in trial:
                trial.append(v)
        more = [*edges, (trial.index(p), trial.index(q))]
        try:
            edge_list(width, height, trial, more)
        except ArrangementError:
            continue
        vertices, edges = trial, more
    return edge_list(width, height, vertices, edges)


def star(width, height, x, y, count, radius):
    """Edges that meet in one vertex."""
    angles = np.arange(count) * 2 * np.pi / count + 0.1
    tips = [(x + radius * np.cos(a), y + radius * np.sin(a)) for a in angles]
    return edge_list(width, height, [(x, y), *tips], [(0, k + 1) for k in range(count)])


def spiral(width, height, turns, step):
    """A polyline that winds from the middle outwards."""
    t = np.linspace(0.5, turns, int(8 * turns))
    r = step * t
    return chain(width, height, np.c_[width / 2 + r * np.cos(2 * np.pi * t), height / 2 + r * np.sin(2 * np.pi * t)])


def comb(width, height, teeth, gap):
    """Parallel edges closer together than samples."""
    vertices, edges = [], []
    for k in range(teeth):
        x = width / 2 + (k - teeth / 2) * gap
        vertices += [(x, 1.0 + 0.3 * (k % 2)), (x, height - 1.2)]
        edges.append((2 * k, 2 * k + 1))
    return edge_list(width, height, vertices, edges)


def tiny(rng, width, height, side):
    """side² tiny edges within one cell."""
    vertices = []
    for i in range(side):
        for j in range(side):
            x, y = 2.6 + 0.8 * (j + 0.5) / side, 2.6 + 0.8 * (i + 0.5) / side
            a = rng.uniform(0, np.pi)
            d = 0.3 / side
            vertices += [(x - d * np.cos(a), y - d * np.sin(a)), (x + d * np.cos(a), y + d * np.sin(a))]
    return edge_list(width, height, vertices, [(2 * k, 2 * k + 1) for k in range(side * side)])


# Name -> arrangement over 6 × 5 samples, which are at k + ½ in the frame's coordinates.
HOSTILE = {
    "none": edge_list(6, 5, [], []),
    "through samples": edge_list(6, 5, [(1.5, 0.5), (1.5, 3.5), (3.5, 1.5), (5.5, 3.5)], [(0, 1), (2, 3)]),
    "ends at samples": edge_list(6, 5, [(2.5, 2.5), (4.5, 2.5), (2.5, 3.5)], [(0, 1), (0, 2)]),
    "between samples": edge_list(6, 5, [(2, 1), (2, 4), (4, 4), (4, 2)], [(0, 1), (1, 2), (2, 3)]),
    "through pixel centres": edge_list(6, 5, [(1.0625, 1.0625), (4.0625, 4.0625), (5.0, 1.0625)], [(0, 1), (1, 2)]),
    "straight chain": chain(6, 5, [(1 + 0.5 * k, 2.25) for k in range(8)]),
    "slanting straight chain": chain(6, 5, [(1 + 0.5 * k, 1 + 0.25 * k) for k in range(8)]),
    "T": edge_list(6, 5, [(1, 2.5), (3, 2.5), (5, 2.5), (3, 4.5)], [(0, 1), (1, 2), (1, 3)]),
    "collinear and apart": edge_list(
        6, 5, [(1, 2), (2, 2), (3, 2), (4, 2), (4.5, 2), (5, 2)], [(0, 1), (2, 3), (4, 5)]
    ),
    "nearly closed square": chain(6, 5, [(2, 1), (4, 1), (4, 3), (2, 3), (2, 1.05)]),
    "closed square without a sample": chain(6, 5, [(2.6, 2.6), (3.4, 2.6), (3.4, 3.4), (2.6, 3.4)], closed=True),
    "closed square": chain(6, 5, [(1, 1), (4, 1), (4, 4), (1, 4)], closed=True),
    "frame": chain(6, 5, [(0, 0), (6, 0), (6, 5), (0, 5)], closed=True),
    "along and across the border": edge_list(
        6, 5, [(0, 1), (0, 3), (2.2, 3), (3, 0), (3.3, 1.7), (6, 4), (4, 5)], [(0, 1), (1, 2), (3, 4), (5, 6)]
    ),
    "wall from side to side": edge_list(6, 5, [(0, 2.3), (3.1, 2.6), (6, 2.2)], [(0, 1), (1, 2)]),
    "vertex on the border": chain(6, 5, [(1, 2), (2.5, 0), (4, 2)]),
    "star": star(6, 5, 3.0, 2.5, 11, 1.7),
    "star at a sample": star(6, 5, 2.5, 2.5, 8, 1.2),
    "spiral": spiral(6, 5, 3.5, 0.6),
    "comb": comb(6, 5, 9, 0.2),
    "tiny": tiny(np.random.default_rng(4), 6, 5, 6),
}
