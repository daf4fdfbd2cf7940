"""Samples whose reconstruction, seen through the camera, is the photo (the paper's section 3, carried further).

A photo is the mean of the light over each pixel's area after the lens has blurred it. With R the
reconstruction (linear in the samples while the edges stay), B the area and the blur, and s₀ the
samples taken with care, the samples minimise

    ‖B R s − photo‖² + λ ‖s − s₀‖².

Without B the samples would be as blurred as the photo. Away from edges R is separable, and so is the fit: two banded
systems solved once (`fit_plain`). Where edges are near, blocks of samples are solved by conjugate gradients. Each block
is solved with a halo that is then thrown away: a sample's influence fades within three of its neighbours.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import numpy.typing as npt

from penink_cli.ground import exact
from penink_cli.ground import threads as threading
from penink_cli.ground.model import EdgeList, Floats
from penink_cli.reconstruction import lanes
from penink_cli.reconstruction._compiled import banded as _banded
from penink_cli.reconstruction._compiled import fit as _fit
from penink_cli.reconstruction._compiled import rows as _rows
from penink_cli.reconstruction._compiled import scratch as _scratch
from penink_cli.reconstruction._compiled import tile as _tile
from penink_cli.reconstruction.lattice import Axis, axis
from penink_cli.reconstruction.paths import Paths, spill

Grey32 = npt.NDArray[np.float32]

AREA = 2  # points along each axis that stand for a pixel's area
POINT = 1  # the same for a sample, which is the value at a place
HOLD = 0.2  # λ: holds samples that no pixel depends on; between 0.05 and 1 the result hardly changes
_STEPS = 5  # of conjugate gradients; four come within 0.02 dB of the end
_HALO = 3  # samples around a block that are solved with it and thrown away
_BLOCK_PX = 128  # pixels of the photo along a block's side
_NEAR = 3.0  # samples: an edge farther away changes no pixel that these samples are fitted to
_SPAN = 5  # samples along each axis that a pixel depends on
_CROWDED = 8  # edges a sample, in a block: among more no sample is determined, and the cost grows by their square
_PLAIN_HOLD = 0.01  # λ of the plain fit, away from edges


def blur_kernel(blur: float) -> Floats:
    """Half of a sampled Gaussian of that standard deviation (pixels), its centre first, summing to one when whole."""
    if blur < 0.05:
        return np.ones(1)
    reach = max(1, math.ceil(3.5 * blur))
    weights = [float(exact.exp(-0.5 * (d / blur) ** 2)) for d in range(reach + 1)]
    whole = weights[0] + 2 * math.fsum(weights[1:])
    return np.array([w / whole for w in weights])


def fit_plain(photo: Grey32, width: int, height: int, blur: float, fine: int = AREA) -> Floats:
    """The samples (height, width) of plain cubic convolution that fit a photo (h, w) best."""
    kernel = blur_kernel(blur)
    down = _along(photo, height, kernel, fine)
    return np.ascontiguousarray(_along(np.ascontiguousarray(down.T, np.float32), width, kernel, fine).T)


def _along(photo: Grey32, count: int, kernel: Floats, fine: int) -> Floats:
    """Least squares along the first axis: (n, m) to (count, m)."""
    pixels = len(photo)
    where = axis(pixels * fine, count, 0, pixels * fine)
    reach = len(kernel) - 1
    base = np.clip(where.taps.first[::fine].astype(int), 0, max(0, count - 1))
    # The blur widens a pixel's span to that of the pixels it mixes.
    low = base[np.maximum(0, np.arange(pixels) - reach)]
    high = np.clip(where.taps.first[fine - 1 :: fine].astype(int) + 3, 0, count - 1)
    span = int((high[np.minimum(pixels - 1, np.arange(pixels) + reach)] - low).max()) + 1
    low = np.minimum(low, max(0, count - span))
    span = min(span, count)
    weight = np.zeros((pixels, span))
    rows = np.arange(pixels)
    for d in range(-reach, reach + 1):
        source = np.arange(pixels) + d
        while ((source < 0) | (source >= pixels)).any():
            source = np.where(source < 0, -1 - source, source)
            source = np.where(source >= pixels, 2 * pixels - 1 - source, source)
        for k in range(fine):
            point = source * fine + k
            for t in range(4):
                sample = np.clip(where.taps.first[point] + t, 0, count - 1)
                weight[rows, sample - low] += kernel[abs(d)] / fine * where.taps.cubic[point, t]
    band = np.zeros((count, span))
    for t in range(span):
        for u in range(t, span):
            np.add.at(band[:, u - t], low + t, weight[:, t] * weight[:, u])
    low = low.astype(np.int32)
    # Held to the mean of what each sample touches, where blur has left the photo nothing to tell.
    touched = np.bincount((low[:, None] + np.arange(span)).ravel(), weight.ravel(), minlength=count)
    means = np.zeros((count, photo.shape[1]))
    _banded.transposed(low, weight, photo, means)
    means /= touched[:, None]
    rest = photo.copy()
    _banded.leave(low, weight, means, rest)
    out = np.zeros_like(means)
    _banded.transposed(low, weight, rest, out)
    band[:, 0] += _PLAIN_HOLD * pixels / count
    _banded.solve_banded(band, out)
    return out + means


def fit_samples(
    photo: Grey32,
    edges: EdgeList,
    start: Floats,
    blur: float,
    fine: int = AREA,
    *,
    hold: float = HOLD,
    threads: int | None = None,
) -> Floats:
    """Samples near edges, fitted to the photo; the others stay as they are, and so do those in a crowd of edges.

    Args:
        photo: (h, w), 0 … 1, at least as large as the grid of samples.
        edges: in the frame of both.
        start: (height, width) s₀.
        blur: standard deviation of the photo's blur beyond its pixels' area, pixels.
        fine: AREA where its pixels are means over their area, POINT where they are samples.
        hold: λ.
        threads: the bytes are the same for any number.

    """
    if not len(edges.edges):
        return start
    out = start.copy()
    _Fit(photo, edges, start, blur_kernel(blur), fine, hold).run(out, threading.count(threads))
    return out


class _Worker:
    """What one thread at a time works with: a search, room for a tile and its numbers, and for those of a block."""

    def __init__(self, paths: Paths, step_x: float, step_y: float) -> None:
        self.finder = paths.finder(closed=True, rows=(0, 0))
        self.tile = _tile.Tile(self.finder, step_x, step_y, 1 + spill(1.0))
        self.scratch = _scratch.Scratch(True)
        lanes.bind(self.tile, self.scratch)
        self.numbers = np.empty(0, np.float32)

    def room(self, *shapes: tuple[int, ...]) -> list[Grey32]:
        """Arrays to fill, the same memory for every block: fresh pages cost a seventh of the whole fit."""
        ends = np.cumsum([math.prod(shape) for shape in shapes])
        if len(self.numbers) < ends[-1]:
            self.numbers = np.empty(ends[-1], np.float32)
        return [part.reshape(shape) for part, shape in zip(np.split(self.numbers, ends), shapes)]


class _Fit:
    """The blocks of one fit."""

    def __init__(
        self,
        photo: Grey32,
        edges: EdgeList,
        start: Floats,
        kernel: Floats,
        fine: int,
        hold: float,
    ) -> None:
        self.height, self.width = start.shape
        h, w = photo.shape
        self.photo, self.start = photo, start
        self.kernel, self.fine, self.hold = kernel.astype(np.float32), fine, hold
        self.paths = Paths(edges, self.width, self.height)
        self.x, self.y = axis(w * fine, self.width, 0, w * fine), axis(h * fine, self.height, 0, h * fine)
        self.crowds = _crowds(edges, self.width, self.height)
        self.x_base, x_plain = _plain_rows(self.x, self.width, fine)
        self.y_base, y_plain = _plain_rows(self.y, self.height, fine)
        self.across, self.down = _points(self.x, self.x_base, x_plain), _points(self.y, self.y_base, y_plain)
        self.side = max(8, round(_BLOCK_PX * self.width / w))
        self.workers: list[_Worker] = []

    def run(self, out: Floats, threads: int) -> None:
        """Fit every block into out."""
        threading.share([partial(self.band, top, out) for top in range(0, self.height, self.side)], threads)

    def band(self, top: int, out: Floats) -> None:
        """Fit the blocks whose cores begin in a row of the samples, into out."""
        bottom = min(self.height, top + self.side)
        first, last = max(0, top - _HALO), min(self.height, bottom + _HALO)
        try:
            worker = self.workers.pop()  # atomic, as giving it back is
        except IndexError:
            worker = _Worker(self.paths, self.x.step, self.y.step)
        worker.finder.move(max(0, first - _HALO), min(self.height, last + _HALO))
        for left in range(0, self.width, self.side):
            self.block(worker, (top, bottom, first, last), left, min(self.width, left + self.side), out)
        self.workers.append(worker)

    def block(self, worker: _Worker, band: tuple[int, int, int, int], left: int, right: int, out: Floats) -> None:
        """Fit one block, if an edge is near it."""
        top, bottom, first, last = band
        begin, end = max(0, left - _HALO), min(self.width, right + _HALO)
        if _rows.clear(worker.tile, left - _NEAR, top - _NEAR, right + _NEAR, bottom + _NEAR):
            return
        if self.crowds[first:last, begin:end].sum() > _CROWDED * (last - first) * (end - begin):
            return
        rows, columns = _pixels(self.y_base, first, last, self.height), _pixels(self.x_base, begin, end, self.width)
        if rows[0] >= rows[1] or columns[0] >= columns[1]:
            return
        pixels = rows[1] - rows[0], columns[1] - columns[0]
        samples = max(_SPAN, last - first), max(_SPAN, end - begin)
        weight, values, steps, seen = worker.room((*pixels, _SPAN * _SPAN), samples, (3, *samples), (2, *pixels))
        tiles = np.array([*_tiles(self.y, *rows, self.fine), *_tiles(self.x, *columns, self.fine)], np.int32)
        begins = np.array([rows[0], columns[0]], np.int32)
        if not _rows.rows(worker.tile, worker.scratch, self.across, self.down, tiles, begins, self.fine, weight):
            return
        values[:] = 0
        values[: last - first, : end - begin] = self.start[first:last, begin:end]
        _fit.solve(
            weight,
            self.x_base[columns[0] : columns[1]] - np.int32(begin), self.y_base[rows[0] : rows[1]] - np.int32(first),
            self.kernel, np.ascontiguousarray(self.photo[rows[0] : rows[1], columns[0] : columns[1]]),
            self.hold, _STEPS, values, steps, seen,
        )  # fmt: skip
        out[top:bottom, left:right] = values[top - first : bottom - first, left - begin : right - begin]


def _crowds(edges: EdgeList, width: int, height: int) -> npt.NDArray[np.int64]:
    """How many edges begin in each cell (height, width) of the samples."""
    begins = edges.scaled(width, height)[edges.edges[:, 0]].astype(int)
    row, column = np.clip(begins[:, 1], 0, height - 1), np.clip(begins[:, 0], 0, width - 1)
    return np.bincount(row * width + column, minlength=width * height).reshape(height, width)


def _plain_rows(along: Axis, count: int, fine: int) -> tuple[npt.NDArray[np.int32], Grey32]:
    """First (n,) of the 5 samples that each pixel depends on, and their weights (n, 5) in plain convolution."""
    base = np.clip(along.taps.first[::fine], 0, max(0, count - _SPAN)).astype(np.int32)
    weight = np.zeros((len(base), _SPAN))
    pixel = np.arange(len(base))
    for k in range(fine):
        for t in range(4):
            sample = np.clip(along.taps.first[k::fine] + t, 0, count - 1)
            weight[pixel, sample - base] += along.taps.cubic[k::fine, t] / fine
    return base, weight.astype(np.float32)


def _points(along: Axis, base: npt.NDArray[np.int32], plain: Grey32) -> _rows.Axis:
    """What the kernel knows of one axis."""
    taps = along.taps
    return _rows.Axis(taps.where, taps.cubic, taps.bspline, along.cell, along.first, base, plain)


def _pixels(base: npt.NDArray[np.int32], first: int, last: int, count: int) -> tuple[int, int]:
    """The pixels (from, to) all of whose samples are first … last − 1."""
    begin = int(np.searchsorted(base, first, "left"))
    end = int(np.searchsorted(base, last - min(_SPAN, count), "right"))
    return begin, end


def _tiles(along: Axis, begin: int, end: int, fine: int) -> tuple[int, int]:
    """The tiles (from, to) that hold the points of pixels begin … end − 1."""
    first = int(np.searchsorted(along.first, begin * fine, "right")) - 1
    return first, int(np.searchsorted(along.first, end * fine, "left"))
