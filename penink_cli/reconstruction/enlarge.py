"""Enlargement that stays sharp across discontinuity edges (section 2): grey images in, grey images out.

`enlarge` gives the whole image, `bands` its rows as they become ready, `reconstruct` numbers that are neither
clamped nor rounded. Rows are computed in bands by several threads; no byte depends on bands, threads or window.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from penink_cli.ground import threads as threading
from penink_cli.ground.errors import ParameterError
from penink_cli.ground.model import EdgeList, Floats, GreyImage
from penink_cli.reconstruction import lanes
from penink_cli.reconstruction._compiled import render as _render
from penink_cli.reconstruction._compiled import scratch as _scratch
from penink_cli.reconstruction._compiled import search as _search
from penink_cli.reconstruction._compiled import tile as _tile
from penink_cli.reconstruction._compiled import weights as _weights
from penink_cli.reconstruction.kernels import is_bspline, taps
from penink_cli.reconstruction.lattice import TILE, Axis, axis, centres
from penink_cli.reconstruction.paths import Paths, reach, spill
from penink_cli.reconstruction.soften import soften as soften_bands
from penink_cli.reconstruction.soften import source_window

Window = tuple[int, int, int, int]
Rows = npt.NDArray[Any]

BAND = 1 << 20  # pixels of one band: small enough to be done soon, large enough to be worth a task
SMALL = 1 << 22  # pixels without edges that one thread reconstructs sooner than a second one would have started


def enlarge(
    image: GreyImage,
    edges: EdgeList | None,
    width: int,
    height: int,
    *,
    radius: float = 1.0,
    kernel: str = "cubic",
    soften: bool = False,
    window: Window | None = None,
    maxval: int | None = None,
    threads: int | None = None,
) -> GreyImage:
    """Reconstruct an image of width × height pixels from grey samples and discontinuity edges (equations 1–9).

    edges: an arrangement in the frame of the same picture, None for none. They are taken to be valid.
    radius: r of equation 4, the detour in samples beyond which a sample has no effect.
    kernel: cubic (blended into the B-spline near edges) or bspline (alone).
    soften: reconstruct half the size and double that by plain cubic convolution, as the paper does (section 3).
    window: x, y, width, height of the output pixels wanted, the others are left out.
    maxval: of the result, the image's own unless given; values are clamped, and rounded half up.

    8-bit results are computed in single precision: one value in some ten thousand, within 10⁻⁴ of the middle between
    two, may be rounded the other way than in double.
    """
    maxval = image.maxval if maxval is None else maxval
    _, _, across, down = check_window(window, width, height)
    whole = np.empty((down, across), np.uint8 if maxval < 256 else np.uint16)
    row = 0
    for rows in bands(
        image, edges, width, height,
        radius=radius, kernel=kernel, soften=soften, window=window, maxval=maxval, threads=threads, into=whole,
    ):  # fmt: skip
        if rows.base is not whole:
            whole[row : row + len(rows)] = rows
        row += len(rows)
    return GreyImage(whole, maxval)


def bands(
    image: GreyImage,
    edges: EdgeList | None,
    width: int,
    height: int,
    *,
    radius: float = 1.0,
    kernel: str = "cubic",
    soften: bool = False,
    window: Window | None = None,
    maxval: int | None = None,
    threads: int | None = None,
    into: Rows | None = None,
) -> Iterator[Rows]:
    """The rows of `enlarge` from top to bottom, some at a time, as they become ready.

    into: an array of all rows, where they may be put; those that are put there are yielded as views of it.
    """
    maxval = image.maxval if maxval is None else maxval
    single = maxval < 256
    stored = np.dtype(np.uint8 if single else np.uint16)
    samples = image.values if maxval == image.maxval else image.values * np.float64(maxval) / image.maxval
    window = check_window(window, width, height)
    if not soften:
        work = _plan(samples[None], edges, width, height, radius, kernel, window, single, stored, maxval)
        for rows in work.run(threading.count(threads), into):
            yield rows[0]
        return
    half_width, half_height = -(-width // 2), -(-height // 2)
    inner = source_window(window, width, height, half_width, half_height)
    real = np.dtype(np.float64)
    work = _plan(samples[None], edges, half_width, half_height, radius, kernel, inner, single, real, maxval)
    halves = (rows[0] for rows in work.run(threading.count(threads)))
    yield from soften_bands(halves, inner, half_width, half_height, window, width, height, maxval, stored)


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
    """The same in floating point: (h, w) samples of any unit to (height, width), neither clamped nor rounded.

    Planes of one picture, (p, h, w), become (p, height, width), and what hides samples is looked for once.
    """
    samples = np.ascontiguousarray(samples, np.float64)
    planes = samples if samples.ndim == 3 else samples[None]
    window = check_window(window, width, height)
    work = _plan(planes, edges, width, height, radius, kernel, window, False, np.dtype(np.float64), 0)
    whole = np.concatenate(list(work.run(threading.count(threads))), axis=1)
    return whole if samples.ndim == 3 else whole[0]


def check_window(window: Window | None, width: int, height: int) -> Window:
    """The window, all of the output where none is given; ParameterError where it is not within the output."""
    x, y, across, down = (0, 0, width, height) if window is None else window
    if width < 1 or height < 1:
        raise ParameterError(f"an output of {width} x {height} pixels is empty")
    if x < 0 or y < 0 or across < 1 or down < 1 or x + across > width or y + down > height:
        raise ParameterError(f"window {x},{y},{across},{down} is not within the {width} x {height} pixels of output")
    return x, y, across, down


def _plan(
    planes: Rows,
    edges: EdgeList | None,
    width: int,
    height: int,
    radius: float,
    kernel: str,
    window: Window,
    single: bool,
    stored: np.dtype[Any],
    maxval: int,
) -> _Enlargement | _Reduction:
    _, h, w = planes.shape
    only_b = is_bspline(kernel)
    widening = max(1.0, w / width, h / height)
    paths = Paths(edges, w, h, reach(radius, widening))
    if widening > 1.0:
        planes = planes.astype(np.float64, order="C")
        return _Reduction(planes, paths, width, height, radius * widening, only_b, window, stored, maxval)
    left, top, across, down = window
    real = np.dtype(np.float32 if single else np.float64)
    x = axis(width, w, left, left + across)
    square = (height, h, top, down) == (width, w, left, across)
    y = x if square else axis(height, h, top, top + down)
    return _Enlargement(planes.astype(real, order="C"), paths, x, y, radius, only_b, window, real, stored, maxval)


class TileAxis(NamedTuple):
    """What `render.retouch` takes of one axis, the columns of tiles or their rows.

    where: (n,) positions of pixels, sample units; of columns (n + 8,). cubic, bspline: taps, (4, n + 8) of columns, (n,
    4) of rows. cell, first: (t,), (t + 1,) the cell of each tile and its first pixel.
    """

    where: Floats
    cubic: Rows
    bspline: Rows
    cell: npt.NDArray[np.intc]
    first: npt.NDArray[np.intc]


@dataclass(eq=False)
class _Enlargement:
    """Scale 1 and above in both directions: the separable pass, and tiles of one cell where edges are near."""

    planes: Rows
    paths: Paths
    x: Axis
    y: Axis
    radius: float
    only_b: bool
    window: Window
    real: np.dtype[Any]
    stored: np.dtype[Any]
    maxval: int

    def run(self, threads: int, into: Rows | None = None) -> Iterator[Rows]:
        """The rows of all planes, (p, rows, columns), by bands of tiles."""
        x, y = self.x, self.y
        # Whole tiles may be more than the window: then bands are cut out of arrays of their own.
        self.into = into if (x.begin, y.begin, x.count, y.count) == self.window else None
        self.x_taps = self._padded(x.taps.cubic), self._padded(x.taps.bspline)
        self.y_taps = y.taps.cubic.astype(self.real), y.taps.bspline.astype(self.real)
        if not self.paths.empty:
            where = np.concatenate([x.taps.where, x.taps.where[-1:].repeat(TILE)])
            self.columns = TileAxis(where, *self.x_taps, x.cell, x.first)
            cell = np.concatenate([x.cell.repeat(np.diff(x.first)), x.cell[-1:].repeat(TILE)])
            self.offset = ((where - cell) / float(self.real.type(self.radius))).astype(self.real)
            self.workers: list[tuple[_search.Finder, _tile.Tile, _scratch.Scratch]] = []
        if self.paths.empty and x.count * y.count < SMALL:
            threads = 1
        # Bands of whole tiles, as even as can be; where edges are near they take longer than elsewhere.
        share = 2 if self.paths.empty else 4
        rows = max(1, min(BAND // x.count, -(-y.count // (share * threads))))
        pieces = min(len(y.cell), -(-y.count // rows))
        cuts = [len(y.cell) * k // pieces for k in range(pieces + 1)]
        tasks = (partial(self.band, a, b) for a, b in pairwise(cuts))
        return threading.in_order(tasks, threads)

    def _padded(self, table: Floats) -> Rows:
        """A table of taps by columns; the arithmetic of the last tile has eight of them, whatever it has itself."""
        rows = np.zeros((4, len(table) + TILE), self.real)
        rows[:, : len(table)] = table.T
        return rows

    def band(self, a: int, b: int) -> Rows:
        """Tiles a … b from top to bottom, cut to the window."""
        x, y = self.x, self.y
        begin, end = int(y.first[a]), int(y.first[b])
        first = y.taps.first[begin:end]
        source, last = int(first[0]), int(first[-1]) + 4
        expanded = np.empty((last - source, x.count + TILE), self.real)
        count, h, _ = self.planes.shape
        out = np.empty((count, end - begin, x.count), self.stored) if self.into is None else self.into[None, begin:end]
        separable = lanes.kernel("separable")
        for plane, rows in zip(self.planes, out):
            separable.expand(plane, source, x.taps.first, self.x_taps[self.only_b], expanded)
            separable.combine(expanded, source, first, self.y_taps[self.only_b][begin:end], self.maxval, rows)
        if not self.paths.empty:
            try:
                worker = self.workers.pop()  # atomic, as giving it back is
            except IndexError:
                worker = self._worker()
            finder, tile, scratch = worker
            finder.move(min(max(source, 0), h - 1), max(1, min(last, h)))
            down = TileAxis(
                y.taps.where[begin:end], self.y_taps[0][begin:end], self.y_taps[1][begin:end],
                y.cell[a:b], y.first[a : b + 1] - y.first[a],
            )  # fmt: skip
            _render.retouch(tile, scratch, self.planes, self.columns, self.offset, down, out)
            self.workers.append(worker)
        if self.into is not None:
            return out
        left, top, width, height = self.window
        return out[
            :, max(0, top - y.begin - begin) : top + height - y.begin - begin, left - x.begin : left - x.begin + width
        ]

    def _worker(self) -> tuple[_search.Finder, _tile.Tile, _scratch.Scratch]:
        """What one thread at a time works with: a search, and room for a tile and for its numbers."""
        finder = self.paths.finder(closed=True, rows=(0, 0))
        tile = _tile.Tile(finder, self.x.step, self.y.step, 1 + spill(self.radius))
        scratch = _scratch.Scratch(self.real == np.float32, self.stored.itemsize, self.radius, self.only_b, self.maxval)
        lanes.bind(tile, scratch)
        return finder, tile, scratch


@dataclass(eq=False)
class _Reduction:
    """Below scale 1 in some direction: point by point, with the kernels widened to band-limit."""

    planes: Floats
    paths: Paths
    width: int
    height: int
    radius: float
    only_b: bool
    window: Window
    stored: np.dtype[Any]
    maxval: int

    def run(self, threads: int, into: Rows | None = None) -> Iterator[Rows]:
        """The rows of all planes, a few at a time."""
        _, h, w = self.planes.shape
        left, top, across, down = self.window
        self.x = taps(centres(self.width, w)[left : left + across], max(1.0, w / self.width))
        self.where = centres(self.height, h)[top : top + down]
        rows = max(1, min(32, -(-down // (4 * threads))))
        tasks: Iterator[Callable[[], Rows]] = (partial(self.band, k, min(k + rows, down)) for k in range(0, down, rows))
        return threading.in_order(tasks, threads)

    def band(self, begin: int, end: int) -> Rows:
        """Rows begin … end of the window."""
        count, h, _ = self.planes.shape
        x, y = self.x, taps(self.where[begin:end], max(1.0, h / self.height))
        first, last = int(y.first[0]), int(y.first[-1]) + y.cubic.shape[1]
        out = np.empty((count, end - begin, len(x.where)))
        for plane, rows in zip(self.planes, out):
            finder = self.paths.finder(rows=(min(max(first, 0), h - 1), max(1, min(last, h))))
            _weights.Points(finder, x, y, self.radius, self.only_b).lattice(plane, rows)
        if self.stored == np.float64:
            return out
        return np.floor(np.clip(out, 0.0, self.maxval) + 0.5).astype(self.stored)
