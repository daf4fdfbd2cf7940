"""Smoothing and shrinking of pictures, the same numbers on every machine and for any number of threads.

This module alone imports the compiled kernel `filters`. Pictures are float32 (h, w) of any range. Beyond its frame a
picture goes on as its mirror image.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from penink_cli.composition._compiled import filters
from penink_cli.ground import threads as threading

Picture = npt.NDArray[np.float32]

_BAND = 64  # rows of a task
# Pixels of a task of `by_rows`: several arrays of so many stay in the processor's cache. With a quarter of them two
# threads take longer than one, since numpy lets go of Python's lock and takes it again for each step.
_NEAR = 1 << 17
# A Gaussian of σ above _COARSE pixels is taken in a smaller view, where its σ is about _KEPT pixels, and enlarged.
_COARSE, _KEPT = 4.0, 2.5


def shrunk(
    values: npt.NDArray[np.generic], width: int, height: int, scale: float = 1.0, threads: int = 1, whole: int = 1
) -> Picture:
    """A picture of width × height: means of values (h, w) or (h, w, channels) over each pixel's area, times scale.

    whole: divides values that are whole numbers first. A picture made of these beforehand takes four times the memory.
    """
    planes = np.ascontiguousarray(values if values.ndim == 3 else values[..., None])
    out = np.empty((height, width, planes.shape[2]), np.float32)
    _each(height, lambda top, bottom: filters.shrink(planes, scale, whole, out, top, bottom), threads)
    return out if values.ndim == 3 else out[..., 0]


def enlarged(values: Picture, width: int, height: int, threads: int = 1) -> Picture:
    """Values (h, w) at the pixels of a picture of width × height of the same frame, linear in between."""
    if values.shape == (height, width):
        return values
    values = np.ascontiguousarray(values)
    out = np.empty((height, width), np.float32)
    _each(height, lambda top, bottom: filters.enlarge(values, out, top, bottom), threads)
    return out


def blurred(values: Picture, sigma: float, threads: int = 1) -> Picture:
    """A Gaussian low-pass of sigma pixels; a wide one nearly so, through a smaller view."""
    height, width = values.shape
    factor = int(sigma / _KEPT)
    if sigma > _COARSE and factor > 1 and min(height, width) >= 4 * factor:
        across, down = -(-width // factor), -(-height // factor)
        step = width / across
        # Means over areas have a variance of 1/12, linear interpolation one of 1/6.
        rest = math.sqrt(max(0.0, (sigma / step) ** 2 - 1 / 12 - 1 / 6))
        return enlarged(blurred(shrunk(values, across, down, threads=threads), rest, threads), width, height, threads)
    weights = gaussian(sigma)
    if len(weights) == 1:
        return values.copy()
    values = np.ascontiguousarray(values)
    half, out = np.empty_like(values), np.empty_like(values)
    _each(height, lambda top, bottom: filters.across(values, weights, half, top, bottom), threads)
    _each(height, lambda top, bottom: filters.down(half, weights, out, top, bottom), threads)
    return out


@lru_cache
def gaussian(sigma: float) -> Picture:
    """Weights (n,) of a Gaussian from the middle outwards; with their mirror images they sum to 1. sigma: pixels."""
    if sigma < 0.2:
        return np.ones(1, np.float32)
    w = [round(math.exp(-0.5 * (k / sigma) ** 2), 9) for k in range(math.ceil(3 * sigma) + 1)]
    total = w[0] + 2 * math.fsum(w[1:])
    return np.array([v / total for v in w], np.float32)


def lowest(picture: Picture, reach: int, threads: int = 1) -> Picture:
    """The least value of picture (h, w) within so many pixels of each one, which is an octagon."""
    return _extreme(picture, reach, np.minimum, threads)


def closed(picture: Picture, reach: int, threads: int = 1) -> Picture:
    """The picture (h, w) without what is darker than all around it and nowhere broader than 2 · reach pixels."""
    return _extreme(_extreme(picture, reach, np.maximum, threads), reach, np.minimum, threads)


def opened(picture: Picture, reach: int, threads: int = 1) -> Picture:
    """The picture (h, w) without what is lighter than all around it and nowhere broader than 2 · reach pixels."""
    return _extreme(_extreme(picture, reach, np.minimum, threads), reach, np.maximum, threads)


def _extreme(picture: Picture, reach: int, pick: np.ufunc, threads: int) -> Picture:
    """The least or the greatest value of picture (h, w) within so many pixels of each one, which is an octagon."""
    slant = min(reach - math.floor(reach * 0.414 + 0.5), reach - 1)
    rows, columns = picture.shape
    result = np.empty((rows, columns), np.float32)

    def band(top: int, bottom: int) -> None:
        # Of some rows at a time all that comes in between stays in the processor's cache.
        near = np.clip(np.arange(top - reach, bottom + reach), 0, rows - 1)
        out = np.pad(picture[near], ((0, 0), (reach, reach)), mode="edge")
        for count, down, across in (
            (2 * (reach - slant), 1, 0), (2 * (reach - slant), 0, 1), (slant, 1, 1), (slant, 1, -1)
        ):  # fmt: skip
            have = 0  # steps that each value has looked ahead
            while have < count:
                by = min(have + 1, count - have)
                a, b = by * down, by * across
                h, w = out.shape
                out = pick(out[: h - a, max(0, -b) : w - max(0, b)], out[a:, max(0, b) : w - max(0, -b)])
                have += by
        result[top:bottom] = out

    threading.share(threading.ranges(band, rows, max(_BAND, 2 * reach)), threads)
    return result


def looked_up(values: Picture, table: npt.NDArray[np.float64], low: float = 0.0, high: float = 1.0) -> Picture:
    """A function of values (h, w), given by a table (n,) at even steps from low to high; linear in between."""
    scale = (len(table) - 1) / (high - low)
    rising = np.append(np.diff(table), 0.0).astype(np.float32)
    out = np.empty(values.shape, np.float32)
    filters.look_up(values, table.astype(np.float32), rising, low, scale, out, 0, len(out))
    return out


def histogram(values: Picture, weights: Picture | None, steps: int) -> npt.NDArray[np.int64]:
    """(steps,) the sum of the weights, in 4096ths, of the values in each of so many even steps from 0 to 1.

    values: (h, w). weights: (h, w), None for 1 each.
    """
    counts = np.zeros(steps, np.int64)
    filters.histogram(values, np.zeros((0, 0), np.float32) if weights is None else weights, counts)
    return counts


def by_rows(work: Callable[..., Picture], *pictures: npt.NDArray[Any], threads: int = 1) -> Picture:
    """What `work` makes of pictures or masks (h, w), each pixel of the pixels at its place; a few rows at a time.

    A few rows, and all that comes in between, stay in the processor's cache: that takes half as long.
    """
    rows, columns = pictures[0].shape
    out = np.empty((rows, columns), np.float32)

    def band(top: int, bottom: int) -> None:
        out[top:bottom] = work(*(picture[top:bottom] for picture in pictures))

    threading.share(threading.ranges(band, rows, max(1, _NEAR // columns)), threads)
    return out


def by_pixels(work: Callable[..., object], *pictures: Picture, threads: int = 1) -> Picture:
    """What `work`, a kernel of `tones` or an operation of numpy, makes of pictures (h, w) pixel by pixel.

    It is called with some rows of each, and those of the result, which it fills.
    """
    rows, columns = pictures[0].shape
    out = np.empty((rows, columns), np.float32)

    def band(top: int, bottom: int) -> None:
        work(*(picture[top:bottom] for picture in pictures), out[top:bottom])

    threading.share(threading.ranges(band, rows, max(1, _NEAR // columns)), threads)
    return out


def _each(rows: int, work: Callable[[int, int], object], threads: int) -> None:
    """Do the work, which takes the first row and one past the last, for all rows."""
    threading.share(threading.ranges(work, rows, _BAND), threads)
