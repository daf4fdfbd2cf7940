"""Enlargement that stays sharp across discontinuity edges (section 2): grey images in, grey images out."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from penink_cli.errors import ParameterError
from penink_cli.model import EdgeList, Floats, GreyImage
from penink_cli.reconstruction import _weights
from penink_cli.reconstruction import threads as threading
from penink_cli.reconstruction.kernels import is_bspline, taps
from penink_cli.reconstruction.paths import Paths, reach

Window = tuple[int, int, int, int]


def centres(count: int, samples: int) -> Floats:
    """Where the centres of `count` output pixels lie along an axis of so many samples, in sample units."""
    return (np.arange(count) + 0.5) * samples / count - 0.5


def enlarge(
    image: GreyImage,
    edges: EdgeList | None,
    width: int,
    height: int,
    *,
    radius: float = 1.0,
    kernel: str = "cubic",
    window: Window | None = None,
    maxval: int | None = None,
    threads: int | None = None,
) -> GreyImage:
    """Reconstruct an image of width × height pixels from grey samples and discontinuity edges (equations 1–9).

    edges: an arrangement in the frame of the same picture, None for none. They are taken to be valid.
    radius: r of equation 4, the detour in samples beyond which a sample has no effect.
    kernel: cubic (blended into the B-spline near edges) or bspline (alone).
    window: x, y, width, height of the output pixels wanted, the others are left out.
    maxval: of the result, the image's own unless given; values are clamped, and rounded half up.
    """
    maxval = image.maxval if maxval is None else maxval
    rows = bands(
        image, edges, width, height,
        radius=radius, kernel=kernel, window=window, maxval=maxval, threads=threads,
    )  # fmt: skip
    return GreyImage(np.concatenate(list(rows)), maxval)


def bands(
    image: GreyImage,
    edges: EdgeList | None,
    width: int,
    height: int,
    *,
    radius: float = 1.0,
    kernel: str = "cubic",
    window: Window | None = None,
    maxval: int | None = None,
    threads: int | None = None,
) -> Iterator[np.ndarray]:
    """The rows of `enlarge` from top to bottom, some at a time, as they become ready."""
    maxval = image.maxval if maxval is None else maxval
    samples = image.values.astype(np.float64) * maxval / image.maxval
    kind = np.uint8 if maxval < 256 else np.uint16

    for rows in _float_bands(samples, edges, width, height, radius, kernel, window, threads):
        yield np.floor(np.clip(rows, 0.0, maxval) + 0.5).astype(kind)


def reconstruct(
    samples: Floats,
    edges: EdgeList | None,
    width: int,
    height: int,
    *,
    radius: float = 1.0,
    kernel: str = "cubic",
    window: Window | None = None,
    threads: int | None = None,
) -> Floats:
    """The same in floating point: (h, w) samples of any unit to (height, width), neither clamped nor rounded."""
    samples = np.ascontiguousarray(samples, np.float64)
    return np.concatenate(list(_float_bands(samples, edges, width, height, radius, kernel, window, threads)))


def _float_bands(
    samples: Floats,
    edges: EdgeList | None,
    width: int,
    height: int,
    radius: float,
    kernel: str,
    window: Window | None,
    threads: int | None,
) -> Iterator[Floats]:
    h, w = samples.shape
    only_b = is_bspline(kernel)
    left, top, across, down = (0, 0, width, height) if window is None else window
    if left < 0 or top < 0 or across < 1 or down < 1 or left + across > width or top + down > height:
        raise ParameterError(f"window {left},{top},{across},{down} is not within the {width}x{height} pixels of output")
    wide_x, wide_y = max(1.0, w / width), max(1.0, h / height)
    r = radius * max(wide_x, wide_y)
    paths = Paths(edges, w, h, reach(radius, max(wide_x, wide_y)))
    x = taps(centres(width, w)[left : left + across], wide_x)
    where = centres(height, h)[top : top + down]

    def run(begin: int, end: int) -> Floats:
        y = taps(where[begin:end], wide_y)
        out = np.empty((end - begin, across))
        room = np.empty(x.cubic.shape[1] * y.cubic.shape[1])
        first = int(max(0, y.first.min()))
        last = int(min(h, y.first.max() + y.cubic.shape[1]))
        _weights.lattice(
            paths.finder(rows=(min(first, h - 1), max(1, last))), samples,
            x.where, x.first, x.cubic, x.bspline, y.where, y.first, y.cubic, y.bspline,
            r, only_b, room, out,
        )  # fmt: skip
        return out

    tasks: Iterator[Callable[[], Floats]] = (partial(run, k, min(k + 16, down)) for k in range(0, down, 16))
    yield from threading.in_order(tasks, threading.count(threads))
