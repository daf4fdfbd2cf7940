"""Rendered scenes with known curves: what edge detection and extraction are measured against."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.ndimage import gaussian_filter
from scipy.spatial import cKDTree

LEVEL = 1 / 255
FINE = 8  # points a pixel, along each axis, of the truth that a pixel averages
STEP = 0.05  # pixels between the points of a true curve


@dataclass
class Shape:
    """A disc or a polygon, painted with a plane of grey over what lies below."""

    points: np.ndarray  # (n, 2) closed outline, dense
    corners: np.ndarray  # (c, 2)
    inside: object  # (x, y) -> bool
    grey: tuple[float, float, float]  # value at the origin, slope in x, slope in y

    def value(self, x, y):
        return self.grey[0] + self.grey[1] * x + self.grey[2] * y


@dataclass
class Scene:
    """Shapes painted one over the other on a background."""

    size: int
    shapes: list[Shape] = field(default_factory=list)

    def truth(self, x, y):
        """Grey at places (any shape), seen without lens, pixel or noise."""
        value = np.full(np.shape(x), 0.5)
        for shape in self.shapes:
            value = np.where(shape.inside(x, y), shape.value(x, y), value)
        return value

    def sharp(self, fine=FINE):
        """Mean of the truth over each pixel (size, size)."""
        at = (np.arange(self.size * fine) + 0.5) / fine
        value = self.truth(at[None, :], at[:, None])
        return value.reshape(self.size, fine, self.size, fine).mean(axis=(1, 3))

    def photo(self, blur, noise, seed=0):
        """What a camera makes of it: a lens of that blur (pixels), noise of that many levels, 8 bits."""
        at = (np.arange(self.size * FINE) + 0.5) / FINE
        fine = gaussian_filter(self.truth(at[None, :], at[:, None]), blur * FINE, mode="nearest", truncate=4)
        grey = fine.reshape(self.size, FINE, self.size, FINE).mean(axis=(1, 3))
        grey = grey + np.random.default_rng(seed).normal(0, 1, grey.shape) * noise * LEVEL
        return np.round(np.clip(grey, 0, 1) * 255) / 255

    def curves(self):
        """Points (n, 2) of the visible outlines, `STEP` apart, and the grey step (n,) at each."""
        kept, contrast = [], []
        for k, shape in enumerate(self.shapes):
            p = shape.points
            seen = ((p > 0) & (p < self.size)).all(axis=1)
            for later in self.shapes[k + 1 :]:
                seen &= ~later.inside(p[:, 0], p[:, 1])
            tangent = np.roll(p, -1, axis=0) - np.roll(p, 1, axis=0)
            normal = np.column_stack([-tangent[:, 1], tangent[:, 0]]) / np.hypot(*tangent.T)[:, None]
            left, right = p + 0.05 * normal, p - 0.05 * normal
            step = np.abs(self.truth(*left.T) - self.truth(*right.T))
            kept.append(p[seen])
            contrast.append(step[seen])
        return np.concatenate(kept), np.concatenate(contrast)

    def junctions(self):
        """Corners (c, 2), and places (t, 2) where an outline vanishes under another shape."""
        corners, tees = [], []
        for k, shape in enumerate(self.shapes):
            p = shape.points
            hidden = np.zeros(len(p), bool)
            hidden_corner = np.zeros(len(shape.corners), bool)
            for later in self.shapes[k + 1 :]:
                hidden |= later.inside(*p.T)
                hidden_corner |= later.inside(*shape.corners.T) if len(shape.corners) else False
            corners.extend(shape.corners[~hidden_corner])
            tees.extend(p[hidden != np.roll(hidden, -1)])
        clip = lambda q: np.array([c for c in q if (np.array(c) > 4).all() and (np.array(c) < self.size - 4).all()])  # noqa: E731
        return clip(corners).reshape(-1, 2), clip(tees).reshape(-1, 2)


def disc(x, y, radius, grey):
    n = max(16, int(2 * np.pi * radius / STEP))
    t = np.arange(n) * 2 * np.pi / n
    points = np.column_stack([x + radius * np.cos(t), y + radius * np.sin(t)])
    return Shape(points, np.zeros((0, 2)), lambda a, b: (a - x) ** 2 + (b - y) ** 2 < radius * radius, grey)


def polygon(corners, grey):
    """A convex polygon, corners in order."""
    corners = np.asarray(corners, float)
    following = np.roll(corners, -1, axis=0)
    points = np.concatenate(
        [a + np.linspace(0, 1, max(2, int(np.hypot(*(b - a)) / STEP)), endpoint=False)[:, None] * (b - a)
         for a, b in zip(corners, following)]
    )  # fmt: skip
    (ax, ay), (bx, by) = corners[1] - corners[0], corners[2] - corners[1]
    turn = np.sign(ax * by - ay * bx)

    def inside(x, y):
        result = True
        for a, b in zip(corners, following):
            result = result & (turn * ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) > 0)
        return result

    return Shape(points, corners, inside, grey)


def random_scene(seed, size=200, shapes=6, least=25 * LEVEL):
    """Discs and convex polygons on one another, every step between neighbours at least `least`.

    Outlines cross at an angle or keep 6 pixels apart: what lies nearer is no longer two edges to a blurred photo.
    """
    random = np.random.default_rng(seed)
    levels = random.permutation(np.linspace(0.06, 0.94, shapes + 1))
    levels = np.delete(levels, np.argmin(np.abs(levels - 0.5)))
    assert 0.88 / shapes > 1.2 * least
    scene = Scene(size, [])
    while len(scene.shapes) < shapes:
        slope = random.uniform(-0.1, 0.1, 2) * least / size
        grey = levels[len(scene.shapes)], slope[0], slope[1]
        x, y = random.uniform(0.12, 0.88, 2) * size
        if random.random() < 0.5:
            shape = disc(x, y, random.uniform(10, 0.3 * size), grey)
        else:
            n = random.integers(3, 6)
            angle = random.uniform(0, 2 * np.pi) + (np.arange(n) + random.uniform(-0.25, 0.25, n)) * 2 * np.pi / n
            radius = random.uniform(20, 0.35 * size)
            shape = polygon(np.column_stack([x + radius * np.cos(angle), y + radius * np.sin(angle)]), grey)
        if all(_apart(shape, other) for other in scene.shapes):
            scene.shapes.append(shape)
    return scene


def _apart(shape, other):
    """Whether two outlines keep their distance, save around places where they cross at an angle."""
    far, _ = cKDTree(other.points).query(shape.points[::4])
    close = shape.points[::4][far < 6]
    inside = other.inside(*shape.points.T)
    crossings = shape.points[inside != np.roll(inside, -1)]
    if not len(close):
        return True
    return bool(len(crossings)) and cKDTree(crossings).query(close)[0].max() < 12


def true_steps(scene, edges):
    """(m,) whether a true outline is within a pixel of each edge's middle, and (m,) the grey step across it."""
    outline, step = scene.curves()
    away, which = cKDTree(outline).query(edges.vertices[edges.edges].mean(axis=1))
    return away < 1, step[which]
