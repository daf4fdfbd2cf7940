"""Small dark things that are no lines: pupils, nostrils, beads, full stops.

Centres are extrema of a difference of Gaussians in place and scale (Lowe 2004, section 3); what hangs together around
one and is darker than half way to its surroundings is the thing, and its second moments tell how broad and long it is.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np

from penink_cli.composition.filters import blurred
from penink_cli.ground import exact, masks
from penink_cli.ground.model import Floats
from penink_cli.lines.oriented import Picture

FINEST, RATIO, SCALES = 1.1, 1.4, 7  # σ of the narrowest Gaussian, pixels; from one to the next; differences of them
DISC = 0.243  # what such a difference answers to a disc of contrast 1 and the radius it fits best
FITS = 1.66  # that radius, in σ of its narrower Gaussian
CONTRAST = 0.2  # least grey step of a spot
LONGEST = 2.3  # times as long as broad
FILLED = 0.82  # the part of its ellipse that it covers
OPEN = 0.06  # the part of its surroundings that may be as dark
#: Things thinner than THICK of a spot's radius may be attached to it, as lashes are to a pupil: to a spot of at least
#: LEAST_ATTACHED pixels' radius, and along at most ATTACHED of its border.
THICK, LEAST_ATTACHED, ATTACHED = 0.5, 3.0, 0.4
PART = 2.5  # times its area, the most that hangs together with it: more of that and it is the end of another thing
HOLLOW = 0.2  # the part of it that may be light, as an eye's catchlight is
CRISP = 0.35  # the part of its contrast that its border, two pixels wide to each side, makes up
MOST = 600  # candidates looked at, those of the highest contrast


@dataclass(frozen=True)
class Spot:
    """A small dark thing.

    x, y: its middle, pixel centres at whole numbers. dx, dy: from there to the middle of its rounded end. breadth:
    pixels. contrast: grey step to its surroundings.
    crisp: the part of it that its border makes up.
    dark: how dark it is on the mean, in parts of the way from its surroundings to black.
    """

    x: float
    y: float
    dx: float
    dy: float
    breadth: float
    contrast: float
    crisp: float
    dark: float


def spots(picture: Picture, threads: int) -> list[Spot]:
    """Dark spots of a picture (h, w), those of the highest contrast first; none overlaps another."""
    wider = [float(exact.power(RATIO, k)) for k in range(SCALES + 1)]
    blurs = [blurred(picture, FINEST * times, threads) for times in wider]
    steps = [wide - narrow for narrow, wide in pairwise(blurs)]
    candidates: list[tuple[float, int, int, int]] = []
    for k, step in enumerate(steps):
        for i, j in _maxima(steps, k, np.float32(CONTRAST * DISC)):
            candidates.append((-float(step[i, j]), k, i, j))
    candidates.sort()
    taken = np.zeros(picture.shape, np.bool_)
    found = []
    for _, k, i, j in candidates[:MOST]:
        if not taken[i, j] and (spot := _spot(picture, blurs[0], taken, i, j, FITS * FINEST * wider[k])):
            found.append(spot)
    return found


def _maxima(steps: list[Picture], k: int, least: np.float32) -> list[tuple[int, int]]:
    """Where a difference reaches `least` and is greater than around it in place and scale."""
    step = steps[k]
    h, w = step.shape
    rows, columns = np.nonzero(step >= least)
    inside = (rows > 1) & (columns > 1) & (rows < h - 2) & (columns < w - 2)
    rows, columns = rows[inside], columns[inside]
    for other in steps[max(0, k - 1) : k + 2]:
        for di in (-1, 0, 1):
            for dj in (-1, 0, 1):
                if other is step and not di and not dj:
                    continue
                value, beside = step[rows, columns], other[rows + di, columns + dj]
                # of equals the first one
                keep = value > beside if (di, dj) > (0, 0) or other is not step else value >= beside
                rows, columns = rows[keep], columns[keep]
    return list(zip(rows.tolist(), columns.tolist()))


def _spot(sharp: Picture, picture: Picture, taken: np.ndarray, i: int, j: int, radius: float) -> Spot | None:
    """What lies around (i, j), of about that radius, if it is a spot; its place is then taken.

    sharp, picture: before and after the first smoothing.
    """
    r = math.ceil(2.8 * radius) + 1
    top, left = max(0, i - r), max(0, j - r)
    window = picture[top : i + r + 1, left : j + r + 1]
    rim = _rim(radius, r)[top - i + r :, left - j + r :][: window.shape[0], : window.shape[1]]
    ring = np.sort(window[rim])
    if len(ring) < 8:
        return None
    core = float(picture[i - 1 : i + 2, j - 1 : j + 2].min())
    ground = float(ring[len(ring) // 2])
    contrast = ground - core
    if contrast < CONTRAST:
        return None
    bare = window < core + 0.5 * contrast
    if np.count_nonzero(bare & rim) > (ATTACHED if radius >= LEAST_ATTACHED else OPEN) * len(ring):
        return None
    filled = masks.filled(bare)  # a catchlight is part of the pupil
    thick = masks.opened(filled, max(1.0, THICK * radius))
    mine = masks.part_at(thick, i - top, j - left)
    if not thick[i - top, j - left] or (mine & taken[top : i + r + 1, left : j + r + 1]).any():
        return None
    if (thick & rim).any() or np.count_nonzero(mine & ~bare) > HOLLOW * np.count_nonzero(mine):
        return None
    outer = masks.grown(mine, 3) & ~masks.grown(mine, 2) & ~filled
    inner = mine & masks.grown(~mine, 1)
    if not outer.any():
        return None
    crisp = (_mean(window[outer]) - _mean(window[inner])) / contrast
    if crisp < CRISP:
        return None
    rows, columns = np.nonzero(mine)
    n = len(rows)
    if np.count_nonzero(masks.part_at(filled, i - top, j - left)) > PART * n:
        return None
    # whole numbers: exact sums in any order
    my, mx = int(rows.sum()), int(columns.sum())
    yy = int((rows * rows).sum()) / n - (my / n) ** 2 + 1 / 12
    xx = int((columns * columns).sum()) / n - (mx / n) ** 2 + 1 / 12
    xy = int((rows * columns).sum()) / n - my * mx / n / n
    root = math.sqrt((xx - yy) ** 2 + 4 * xy * xy)
    major, minor = math.sqrt((xx + yy + root) / 2), math.sqrt(max((xx + yy - root) / 2, 1 / 12))
    if major > LONGEST * minor or n < FILLED * 4 * math.pi * major * minor:
        return None
    taken[top : i + r + 1, left : j + r + 1] |= mine
    middle = left + mx / n, top + my / n
    dark = min(max(1 - _mean(sharp[top : i + r + 1, left : j + r + 1][mine]) / max(ground, 0.01), 0.0), 1.0)
    if major < 1.3 * minor:
        return Spot(*middle, 0.0, 0.0, 2 * math.sqrt(n / math.pi), contrast, crisp, dark)
    ex, ey = (xx - yy + root, 2 * xy) if xx > yy else (2 * xy, yy - xx + root)
    size = 2 * (major - minor) / math.sqrt(ex * ex + ey * ey)
    return Spot(*middle, ex * size, ey * size, 4 * minor, contrast, crisp, dark)


@cache
def _rim(radius: float, r: int) -> np.ndarray:
    """What surrounds a spot of that radius: a ring in a window of r pixels to each side."""
    y, x = np.ogrid[-r : r + 1, -r : r + 1]
    away = y * y + x * x
    return (away >= (2.0 * radius) ** 2) & (away <= (2.7 * radius) ** 2)


def _mean(values: np.ndarray) -> float:
    return math.fsum(values.tolist()) / max(len(values), 1)


def covered(spots: list[Spot], shape: tuple[int, ...], margin: float) -> np.ndarray:
    """(h, w) how long the spot is that lies there, the margin around it included; 0 for none."""
    out = np.zeros(shape, np.float32)
    for spot in spots:
        half = math.sqrt(spot.dx * spot.dx + spot.dy * spot.dy)
        r = spot.breadth / 2 + margin
        reach = math.ceil(half + r)
        i, j = round(spot.y), round(spot.x)
        top, left = max(0, i - reach), max(0, j - reach)
        window = out[top : i + reach + 1, left : j + reach + 1]
        y, x = np.ogrid[top : top + window.shape[0], left : left + window.shape[1]]
        near: Floats = (x - spot.x) ** 2 + (y - spot.y) ** 2
        if half:
            along = ((x - spot.x) * spot.dx + (y - spot.y) * spot.dy) / half
            along = np.clip(along, -half, half)
            near = (x - spot.x - along * spot.dx / half) ** 2 + (y - spot.y - along * spot.dy / half) ** 2
        window[near <= r * r] = 2 * (r + half)
    return out
