"""How far two drawings, or two pictures, are from being the same: in tone, and in place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from penink_cli.ground import exact
from penink_cli.ground.model import Floats, GreyImage, Strokes
from penink_cli.measuring import tone
from penink_cli.measuring.lines import places

STEP_PT = 1.0  # between the places of strokes that are looked at


@dataclass(frozen=True)
class Difference:
    """tone: the largest difference, percent of solid ink; tone_rms: the root mean square of all; place: the largest."""

    tone: float
    tone_rms: float
    place: float


def of_strokes(a: Strokes, b: Strokes, max_pixels: int, threads: int) -> Difference:
    """Of two drawings on sheets of one size: tone as the eye sees it; points by which a stroke of either lies apart."""
    apart = tone.seen(tone.printed([a], max_pixels, threads) - tone.printed([b], max_pixels, threads), threads)
    rms = 100 * float(np.sqrt(np.mean(apart * apart)))
    place = max(_farthest(a, b), _farthest(b, a))
    return Difference(100 * float(np.abs(apart).max()), rms, place)


def _farthest(strokes: Strokes, others: Strokes) -> float:
    """How far the place of the strokes is from the others' lines that is farthest from them."""
    if not len(strokes):
        return 0.0
    if not len(others):
        return float("inf")
    points, _, _ = places(strokes, STEP_PT)
    there, owner, _ = places(others, STEP_PT)
    away, nearest = cKDTree(there).query(points)
    for step in (-1, 1):  # the line from the nearest place to the one before it, and after it
        end = np.clip(nearest + step, 0, len(there) - 1)
        end = np.where(owner[end] == owner[nearest], end, nearest)
        away = np.minimum(away, _from_segment(points, there[nearest], there[end]))
    return float(away.max())


def _from_segment(points: Floats, begin: Floats, end: Floats) -> Floats:
    """Distances (n,) of points from segments."""
    way = end - begin
    square = np.maximum(way[:, 0] ** 2 + way[:, 1] ** 2, 1e-30)
    part = np.clip(((points - begin) * way).sum(axis=1) / square, 0, 1)
    distance: Floats = exact.length(points - begin - part[:, None] * way)
    return distance


def of_pictures(a: GreyImage, b: GreyImage, reach: int) -> Difference:
    """Of two pictures of one size: how far a pixel's grey is, in percent, from all greys of the other within reach."""
    one, other = a.values / float(a.maxval), b.values / float(b.maxval)
    apart = np.maximum(_outside(one, other, reach), _outside(other, one, reach))
    rms = float(np.sqrt(np.mean((one - other) ** 2)))
    return Difference(100 * float(apart.max()), 100 * rms, float(reach))


def _outside(values: Floats, others: Floats, reach: int) -> Floats:
    """How far values lie outside what the others have within so many pixels."""
    low = high = others
    for axis in (0, 1):
        padding = [(0, 0), (0, 0)]
        padding[axis] = (reach, reach)
        for pick in (np.minimum, np.maximum):
            source = np.pad(low if pick is np.minimum else high, padding, mode="edge")
            size = others.shape[axis]
            best = source.take(np.arange(size), axis)
            for k in range(1, 2 * reach + 1):
                best = pick(best, source.take(np.arange(k, k + size), axis))
            if pick is np.minimum:
                low = best
            else:
                high = best
    return np.maximum(np.maximum(low - values, values - high), 0)
