"""Small dark things that are no lines: pupils, nostrils, beads, full stops.

Centres are extrema of a difference of Gaussians in place and scale (Lowe 2004, section 3). The connected pixels around
a centre that are darker than half way to the surroundings are the thing; its second moments tell how broad and long it
is.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np

from penink_cli.composition.filters import blurred
from penink_cli.ground import exact, masks
from penink_cli.ground.model import Floats
from penink_cli.lines.oriented import Picture

#: σ of the narrowest Gaussian, pixels; the ratio of each σ to the one before; how many differences there are.
FINEST, RATIO, SCALES = 1.1, 1.4, 7
DISC = 0.243  # the response of such a difference to a disc of contrast 1 and the radius that fits it best
FITS = 1.66  # that radius, in σ of the narrower Gaussian
CONTRAST = 0.2  # least grey step of a spot
LONGEST = 2.3  # a spot is at most so many times as long as broad
FILLED = 0.82  # least part of its ellipse that a spot covers
OPEN = 0.06  # largest part of a spot's surroundings that may be as dark
#: Things thinner than THICK of a spot's radius may be attached to it, as lashes are to a pupil: to a spot of at least
#: LEAST_ATTACHED pixels' radius, and along at most ATTACHED of its border.
THICK, LEAST_ATTACHED, ATTACHED = 0.5, 3.0, 0.4
PART = 2.5  # what is as dark and connected to a spot is at most so many times as large, or the spot is a part of it
HOLLOW = 0.2  # largest part of a spot that may be light, as an eye's catchlight is
CRISP = 0.35  # least part of a spot's contrast that lies in its border, within two pixels to either side
MOST = 600  # candidates that are looked at, those of the highest contrast


@dataclass(frozen=True)
class Spot:
    """A small dark thing: a disc, or what a disc covers on a straight way.

    x, y: its middle, pixel centres at whole numbers. dx, dy: from there to the middle of the disc at its end, 0 for a
    round spot. breadth: pixels. contrast: grey step to its surroundings. crisp: the part of the contrast that lies in
    its border. dark: how dark it is on the mean, from 0, as its surroundings, to 1, black.
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
    finest = last = blurred(picture, FINEST, threads)
    steps = []
    for times in wider[1:]:
        wide = blurred(picture, FINEST * times, threads)
        steps.append(wide - last)
        last = wide
    del last, wide
    candidates: list[tuple[float, int, int, int]] = []
    for k, step in enumerate(steps):
        for i, j in _maxima(steps, k, np.float32(CONTRAST * DISC)):
            candidates.append((-float(step[i, j]), k, i, j))
    del step, steps
    candidates.sort()
    taken = np.zeros(picture.shape, np.bool_)
    found = []
    for _, k, i, j in candidates[:MOST]:
        if not taken[i, j] and (spot := _spot(picture, finest, taken, i, j, FITS * FINEST * wider[k])):
            found.append(spot)
    return found


def _maxima(steps: list[Picture], k: int, least: np.float32) -> list[tuple[int, int]]:
    """Rows and columns at which difference k reaches `least` and is greater than its neighbours in place and scale."""
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
                # of equal values the first counts
                keep = value > beside if (di, dj) > (0, 0) or other is not step else value >= beside
                rows, columns = rows[keep], columns[keep]
    return list(zip(rows.tolist(), columns.tolist()))


def _spot(sharp: Picture, picture: Picture, taken: np.ndarray, i: int, j: int, radius: float) -> Spot | None:
    """The spot around (i, j), of about that radius; None where there is none. Its place in `taken` (h, w) is marked.

    sharp, picture: (h, w) before and after the first smoothing.
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
    # sums of whole numbers are exact in any order
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
    """The surroundings of a spot of that radius: a ring, as a mask (2 r + 1, 2 r + 1) around its centre."""
    y, x = np.ogrid[-r : r + 1, -r : r + 1]
    away = y * y + x * x
    return (away >= (2.0 * radius) ** 2) & (away <= (2.7 * radius) ** 2)


def _mean(values: np.ndarray) -> float:
    return math.fsum(values.tolist()) / max(len(values), 1)


def covered(spots: list[Spot], shape: tuple[int, ...], margin: float) -> np.ndarray:
    """(h, w) the length, pixels, of the spot that covers a place with a margin around it; 0 where there is none."""
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
