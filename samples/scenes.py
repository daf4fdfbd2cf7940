#!/usr/bin/env python3
"""Render the sample scenes: ``scenes.py FOLDER [NAME …]`` writes billiard.png, keys.png and keys-mask.png.

Billiard balls on a table, after the paper's figure 8, by ray casting; two keys on a ring and the
shadow they throw, after its figure 5, from signed distances. The mask is white on the keys and
black elsewhere, so that keys and shadow can be given a texture each.
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_filter


def unit(v: np.ndarray) -> np.ndarray:
    return v / np.sqrt((v * v).sum(-1, keepdims=True))


def downsample(picture: np.ndarray, k: int) -> np.ndarray:
    h, w = picture.shape
    return picture.reshape(h // k, k, w // k, k).mean((1, 3))


# --- billiard ---------------------------------------------------------------------------------

# Place x, z on the table, grey, half width of the painted band of a striped ball (0: solid), and
# where its number disc looks (None: the cue ball).
BALLS = (
    (-0.55, 3.1, 0.16, 0.0, (0.35, 0.75)),
    (1.62, 3.3, 0.62, 0.0, (-0.7, 0.55)),
    (0.62, 4.75, 0.95, 0.0, None),
    (-2.55, 4.9, 0.42, 0.42, (0.5, 0.35)),
    (2.95, 5.6, 0.26, 0.42, (-0.2, 0.8)),
    (-0.95, 6.6, 0.55, 0.0, (-0.5, 0.5)),
    (1.15, 8.1, 0.2, 0.0, (0.1, 0.7)),
    (-3.6, 7.9, 0.8, 0.42, (0.6, 0.5)),
)
LIGHT = np.array([-5.0, 9.0, -1.0])
EYE = np.array([0.0, 4.6, -6.2])
TARGET = np.array([-0.1, 0.75, 4.9])
CUSHION_Z = 10.2


def balls_hit(origin: np.ndarray, towards: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Nearest ball (of radius 1) along each ray: its distance, infinite where none, and its number."""
    nearest = np.full(towards.shape[:-1], np.inf)
    which = np.full(towards.shape[:-1], -1)
    for number, (x, z, *_) in enumerate(BALLS):
        offset = origin - np.array([x, 1.0, z])
        b = (offset * towards).sum(-1)
        discriminant = b * b - (offset * offset).sum(-1) + 1.0
        t = -b - np.sqrt(np.maximum(discriminant, 0))
        hit = (discriminant > 0) & (t > 1e-4) & (t < nearest)
        nearest[hit], which[hit] = t[hit], number
    return nearest, which


def lit(point: np.ndarray) -> np.ndarray:
    """Share of a square lamp seen from each point, a penumbra between neighbouring points of the lamp."""
    seen = np.zeros(point.shape[:-1])
    grid = (np.arange(5) + 0.5) / 5 - 0.5
    offsets = [point - np.array([x, 1.0, z]) for x, z, *_ in BALLS]
    squares = [(o * o).sum(-1) - 1.0 for o in offsets]
    for dx in grid:
        for dz in grid:
            towards = unit(LIGHT + np.array([2.6 * dx, 0.0, 2.6 * dz]) - point)
            hidden = np.zeros(seen.shape)
            for offset, square in zip(offsets, squares):
                b = (offset * towards).sum(-1)
                # The discriminant's margin softens the step between neighbouring lamp points.
                hidden = np.maximum(hidden, np.clip((b * b - square) / 0.5 + 0.5, 0, 1) * (b < 0))
            seen += 1 - hidden
    return seen / grid.size**2


def paint_of(normal: np.ndarray, number: int) -> np.ndarray:
    """The ball's paint: solid or striped, with a white disc for its number."""
    _, _, grey, stripe, disc = BALLS[number]
    paint = np.full(normal.shape[:-1], grey)
    if stripe:
        paint = np.where(np.abs(normal[..., 1] * 0.8 + normal[..., 0] * 0.6) > stripe, 0.93, grey)
    if disc:
        axis = unit(np.array([disc[0], disc[1], -1.0]))
        up = unit(np.cross(axis, np.array([1.0, 0.0, 0.0])))
        u, v = normal @ np.cross(axis, up), normal @ up
        paint = np.where(normal @ axis > 0.92, 0.95, paint)
        paint = np.where((normal @ axis > 0.9) & (np.abs(u) < 0.05) & (np.abs(v) < 0.2), 0.08, paint)
    return paint


def billiard(width: int = 840, height: int = 630, k: int = 2) -> np.ndarray:
    forward = unit(TARGET - EYE)
    right = unit(np.cross(np.array([0.0, 1.0, 0.0]), forward))
    up = np.cross(forward, right)
    x = ((np.arange(width * k) + 0.5) / (width * k) * 2 - 1) * 0.4
    y = (1 - (np.arange(height * k) + 0.5) / (height * k) * 2) * 0.4 * height / width
    rays = unit(forward + x[None, :, None] * right + y[:, None, None] * up)
    picture = np.zeros(rays.shape[:2])
    rows = 60  # at a time, to bound memory
    for top in range(0, len(rays), rows):
        ray = rays[top : top + rows]
        distance, which = balls_hit(EYE, ray)
        table = np.where(ray[..., 1] < 0, -EYE[1] / np.minimum(ray[..., 1], -1e-9), np.inf)
        wall = np.where(ray[..., 2] > 0, (CUSHION_Z - EYE[2]) / np.maximum(ray[..., 2], 1e-9), np.inf)
        t = np.minimum(np.minimum(distance, table), wall)
        point = EYE + t[..., None] * ray
        on_table = (table <= distance) & (table <= wall)
        on_wall = (wall < distance) & (wall < table)
        normal = np.zeros_like(point)
        normal[on_table] = (0, 1, 0)
        normal[on_wall] = (0, 0.25, -1)
        paint = np.where(on_table, 0.62, np.where(point[..., 1] < 1.25, 0.4, 0.16))
        for number, (bx, bz, *_) in enumerate(BALLS):
            here = (which == number) & ~on_table & ~on_wall
            normal[here] = point[here] - np.array([bx, 1.0, bz])
            paint[here] = paint_of(normal[here], number)
        normal = unit(normal)
        lamp = unit(LIGHT - point)
        facing = np.maximum(0.0, (normal * lamp).sum(-1))
        shadow = lit(point + 1e-3 * normal)
        contact = np.ones(t.shape)  # below a ball the cloth is darker than the lamp's shadow alone makes it
        for bx, bz, *_ in BALLS:
            off = np.hypot(point[..., 0] - bx, point[..., 2] - bz)
            contact *= np.where(on_table, 1 - 0.55 * np.exp(-((off / 0.75) ** 2)), 1.0)
        grey = paint * contact * (0.28 + 0.24 * (0.5 + 0.5 * normal[..., 1]) + 0.72 * facing * shadow)
        mirrored = ray - 2 * (ray * normal).sum(-1, keepdims=True) * normal
        gloss = np.maximum(0.0, (mirrored * lamp).sum(-1)) ** 90
        window = (np.abs(mirrored[..., 0] - 0.45) < 0.16) & (np.abs(mirrored[..., 1] - 0.62) < 0.14)
        grey += (~on_table & ~on_wall) * (1.1 * gloss * shadow + 0.22 * (window & (mirrored[..., 2] < 0.6)))
        picture[top : top + rows] = np.clip(grey, 0, 1)
    return downsample(picture, k)


# --- keys -------------------------------------------------------------------------------------


def box(x: np.ndarray, y: np.ndarray, cx: float, cy: float, rx: float, ry: float, corner: float) -> np.ndarray:
    """Signed distance to a box with rounded corners, negative inside."""
    dx, dy = np.abs(x - cx) - rx + corner, np.abs(y - cy) - ry + corner
    return np.hypot(np.maximum(dx, 0), np.maximum(dy, 0)) + np.minimum(np.maximum(dx, dy), 0) - corner


def key(x: np.ndarray, y: np.ndarray, teeth: tuple[tuple[float, float, float], ...], round_bow: bool) -> np.ndarray:
    """Signed distance to a key whose bow is at the origin and whose blade runs 5.2 along +x."""
    if round_bow:
        bow = np.maximum(np.hypot(x, y) - 1.0, 0.42 - np.hypot(x + 0.35, y))
    else:
        bow = np.maximum(box(x, y, 0.0, 0.0, 0.95, 1.12, 0.5), 0.3 - np.hypot(x + 0.5, y))
    shape = np.minimum(bow, box(x, y, 2.9, 0.0, 2.3, 0.27, 0.1))
    shape = np.minimum(shape, box(x, y, 1.15, 0.0, 0.13, 0.45, 0.08))
    for at, reach, half in teeth:
        shape = np.minimum(shape, box(x, y, at, 0.27 + reach / 2, half, reach / 2 + 0.1, 0.03))
    return shape


def keys(size: int = 768, k: int = 3) -> tuple[np.ndarray, np.ndarray]:
    n = size * k
    step = 10 / n
    x = (np.arange(n) + 0.5)[None, :] * step - 5
    y = x.T

    def turned(cx: float, cy: float, degrees: float) -> tuple[np.ndarray, np.ndarray]:
        a = np.deg2rad(degrees)
        return (x - cx) * np.cos(a) + (y - cy) * np.sin(a), -(x - cx) * np.sin(a) + (y - cy) * np.cos(a)

    def thrown(shape: np.ndarray, dx: float, dy: float, blur: float) -> np.ndarray:
        return gaussian_filter(np.roll(shape.astype(float), (int(dy / step), int(dx / step)), (0, 1)), blur / step)

    first = key(
        *turned(-1.9, -1.2, 62), ((3.6, 0.45, 0.14), (4.1, 0.7, 0.16), (4.62, 0.5, 0.15), (5.0, 0.3, 0.1)), True
    )
    second = key(
        *turned(-1.1, -2.0, 20), ((3.5, 0.6, 0.16), (4.05, 0.4, 0.12), (4.5, 0.75, 0.18), (4.95, 0.35, 0.12)), False
    )
    ring = np.abs(np.hypot(x + 2.4, y + 2.4) - 1.15) - 0.09
    mask = np.minimum(np.minimum(first, second), ring) < 0
    paper = (0.97 - 0.045 * (x + y) / 10) * (
        1 - 0.72 * (0.62 * thrown(mask, 0.42, 0.55, 0.1) + 0.38 * thrown(mask, 0.42, 0.55, 0.3))
    )
    grey = paper
    light = unit(np.array([-0.55, -0.62, 0.75]))
    half_way = unit(np.array([-0.3, -0.4, 1.5]))
    # A round bevel rises from each outline to a flat top; each part throws a narrow shadow on those below it.
    for part, base, bevel in ((first, 0.58, 0.16), (second, 0.74, 0.16), (ring, 0.55, 0.09)):
        height = bevel * np.sqrt(np.maximum(0.0, 1 - (1 - np.clip(-part / bevel, 0, 1)) ** 2))
        gy, gx = np.gradient(height, step)
        normal = unit(np.stack([-gx, -gy, np.ones_like(gx)], -1))
        brushed = 0.05 * np.sin(9 * (0.8 * x + 0.6 * y) + 0.3 * np.sin(3 * y))
        sheen = np.maximum(0.0, normal @ half_way) ** 24
        shade = base * (0.2 + 0.75 * np.maximum(0.0, normal @ light)) + brushed + 0.24 * sheen
        below = np.where(mask, grey * (1 - 0.6 * thrown(part < 0, 0.07, 0.1, 0.05)), grey)
        grey = np.where(part < 0, shade, below)
    return downsample(np.clip(grey, 0, 1), k), downsample(mask.astype(float), k)


def save(picture: np.ndarray, path: Path) -> None:
    Image.fromarray(np.uint8(np.floor(picture * 255 + 0.5))).save(path)


def main() -> None:
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    names = sys.argv[2:] or ["billiard", "keys"]
    if "billiard" in names:
        save(billiard(), folder / "billiard.png")
    if "keys" in names:
        picture, mask = keys()
        save(picture, folder / "keys.png")
        save(np.where(mask >= 0.5, 1.0, 0.0), folder / "keys-mask.png")


if __name__ == "__main__":
    main()
