"""Where the grey changes fastest: edge points at sub-pixel positions, after Canny.

The paper finds its discontinuities with Canny's detector (section 3, reference [5]). A kernel says which pixels hold a
ridge of the gradient, those that scikit-image's detector finds (it takes longer to load than this to run); this module
then places a point on the ridge to a fraction of a pixel.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
import numpy.typing as npt

from penink_cli.arrangement._compiled import points as _points
from penink_cli.arrangement._compiled import ridges as _ridges
from penink_cli.ground import exact
from penink_cli.ground import threads as threading
from penink_cli.ground.gaussian import smoothed
from penink_cli.ground.model import Floats

Ints32 = npt.NDArray[np.int32]

_SOBEL_GAIN = 8.0  # ridges are told by the sum of Sobel's weights, not their mean
SURROUND_PX = 10
_SPACING = 0.5  # pixels; nearer points are one place found twice
_BAND_ROWS = 256  # 12 megapixels in one piece take 1.6 s and 430 MB, in bands that stay in cache 0.5 s


@dataclass(frozen=True, eq=False)
class EdgePoints:
    """Points on ridges of the gradient, in raster order of the pixels that hold them.

    pixel: (n, 2) int32 row, column.
    position: (n, 2) x, y in the image frame, within one pixel of the pixel's centre.
    gradient: (n, 2) grey per pixel of the smoothed image, along x and y.
    surround: (n,) mean steepness of the smoothed image in the window of 2 · `SURROUND_PX` around,
        where what is steeper than the point itself counts as equal.
    width: (n,) standard deviation (pixels) of the Gaussian whose shape the gradient has across
        the edge, smoothing included; 0 where the ridge is too flat or too noisy to tell.
    index: (h, w) the point of each pixel, -1 where there is none.
    """

    pixel: Ints32
    position: Floats
    gradient: Floats
    surround: Floats
    width: Floats
    index: Ints32

    @property
    def shape(self) -> tuple[int, int]:
        """Height and width of the picture."""
        return self.index.shape[0], self.index.shape[1]

    @property
    def magnitude(self) -> Floats:
        """Steepness (n,), grey per pixel."""
        return exact.length(self.gradient)

    def where(self, wanted: npt.NDArray[np.bool_]) -> EdgePoints:
        """The points for which wanted (n,) holds; the old points' index is used up."""
        return EdgePoints(
            self.pixel[wanted],
            self.position[wanted],
            self.gradient[wanted],
            self.surround[wanted],
            self.width[wanted],
            self.index,
        ).indexed()

    def indexed(self) -> EdgePoints:
        """The same points, their index made anew in place: that of 12 megapixels is 48 MB."""
        self.index.fill(-1)
        self.index[self.pixel[:, 0], self.pixel[:, 1]] = np.arange(len(self.pixel), dtype=np.int32)
        return self


def noise_level(grey: npt.NDArray[np.floating]) -> float:
    """Standard deviation of the noise in a picture (h, w), in its own grey units.

    The median of the absolute response to [[1, -2, 1], [-2, 4, -2], [1, -2, 1]] (Immerkær 1996),
    which is blind to straight edges; the median ignores corners and texture that covers
    less than half of the picture.
    """
    height, width = grey.shape
    if height < 3 or width < 3:
        return 0.0
    counts = np.zeros(4096, np.int64)
    scale = 4096 / 2.0
    for top in range(0, height - 2, _BAND_ROWS):
        band = np.ascontiguousarray(grey[top : min(height, top + _BAND_ROWS + 2)], np.float32)
        _ridges.unevenness(band, scale, counts)
    cumulated = np.cumsum(counts)
    half = cumulated[-1] / 2
    k = int(np.searchsorted(cumulated, half))
    below = cumulated[k - 1] if k else 0
    median = (k + (half - below) / max(1, counts[k])) / scale
    return float(median / (6 * 0.6745))


def edge_points(grey: npt.NDArray[np.floating], sigma: float, low: float) -> EdgePoints:
    """Find the points where the smoothed gradient is largest along its own direction.

    Args:
        grey: (h, w), 0 … 1.
        sigma: smoothing in pixels.
        low: least gradient, grey per pixel of the smoothed image.

    """
    height, width = grey.shape
    tops = range(0, height, _BAND_ROWS)
    bands = (partial(_band, grey, sigma, low, top) for top in tops)
    found = list(threading.in_order(bands, min(threading.count(None), len(tops))))
    pixel = np.concatenate([p for p, _ in found])
    values = np.concatenate([v for _, v in found])
    del found
    index = np.full((height, width), -1, np.int32)
    index[pixel[:, 0], pixel[:, 1]] = np.arange(len(pixel), dtype=np.int32)
    keep = np.zeros(len(pixel), np.uint8)
    keep[index[pixel[:, 0], pixel[:, 1]]] = 1
    _points.thin(pixel, np.ascontiguousarray(values[:, :2]), index, keep, _SPACING)
    kept = keep.astype(bool)
    position, gradient, width_, surround = (
        np.ascontiguousarray(values[kept, part]) for part in (slice(0, 2), slice(2, 4), 4, 5)
    )
    return EdgePoints(pixel[kept], position, gradient, surround, width_, index).indexed()


def _band(grey: npt.NDArray[np.floating], sigma: float, low: float, top: int) -> tuple[Ints32, Floats]:
    """Pixels and values, as of `points.locate` and `surround`, of the rows from top on."""
    halo = int(4 * sigma + 0.5) + 4 + SURROUND_PX
    first, last = max(0, top - halo), min(len(grey), top + _BAND_ROWS + halo)
    band = np.ascontiguousarray(grey[first:last], np.float32)
    smooth = smoothed(band, sigma)
    mask = np.zeros(band.shape, np.uint8)
    _ridges.ridges(smooth, low * _SOBEL_GAIN, mask)
    mask[: top - first] = 0
    mask[top - first + _BAND_ROWS :] = 0
    pixel = np.column_stack(np.nonzero(mask)).astype(np.int32)
    values = np.zeros((len(pixel), 6))
    if len(pixel):
        _points.locate(smooth, pixel, values)
        steepness = np.zeros_like(smooth)
        _points.steepness(smooth, steepness)
        _points.surround(steepness, pixel, values, SURROUND_PX)
    values[:, 1] += first
    pixel[:, 0] += first
    keep = values[:, 4] >= 0
    return pixel[keep], values[keep]
