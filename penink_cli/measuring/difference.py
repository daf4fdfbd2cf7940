"""How far two drawings, or two pictures, are from being the same: in tone, and in place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from penink_cli.ground import exact
from penink_cli.ground.model import Floats, GreyImage, Strokes
from penink_cli.measuring import tone
from penink_cli.measuring.lines import places

STEP_PT = 1.0  # between the places along strokes that are compared


@dataclass(frozen=True)
class Difference:
    """How far two drawings or pictures are apart.

    tone: the largest difference of tone, percent of solid ink. tone_rms: the root mean square of all, percent. place:
    of drawings the largest distance, points; of pictures the reach, pixels, within which tones were compared.
    """

    tone: float
    tone_rms: float
    place: float


def of_strokes(a: Strokes, b: Strokes, max_pixels: int, threads: int) -> Difference:
    """The difference of two drawings on sheets of one size, tones as the eye sees them.

    place: how far a place of a stroke of either is from the nearest stroke of the other. Raises LimitError for a sheet
    of more pixels than allowed.
    """
    apart = tone.seen(tone.printed([a], max_pixels, threads) - tone.printed([b], max_pixels, threads), threads)
    rms = 100 * float(np.sqrt(np.mean(apart * apart)))
    place = max(_farthest(a, b), _farthest(b, a))
    return Difference(100 * float(np.abs(apart).max()), rms, place)


def _farthest(strokes: Strokes, others: Strokes) -> float:
    """The largest distance of a place of the strokes from the others' lines, points; infinite where there are none."""
    if not len(strokes):
        return 0.0
    if not len(others):
        return float("inf")
    points, _ = places(strokes, STEP_PT)
    there, owner = places(others, STEP_PT)
    away, nearest = cKDTree(there).query(points)
    for step in (-1, 1):  # the line from the nearest place to the place before it, and after it
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
    """The difference of two pictures of one size: how far a pixel's grey is from all greys of the other within reach.

    reach: pixels, to each side.
    """
    one, other = a.values / float(a.maxval), b.values / float(b.maxval)
    apart = np.maximum(_outside(one, other, reach), _outside(other, one, reach))
    rms = float(np.sqrt(np.mean((one - other) ** 2)))
    return Difference(100 * float(apart.max()), 100 * rms, float(reach))


def _outside(values: Floats, others: Floats, reach: int) -> Floats:
    """How far values (h, w) lie below the least and above the greatest of the others within so many pixels."""
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
