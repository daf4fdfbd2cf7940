"""The smallest grid that still serves: the paper's open question of the appropriate reduction factor.

A grid serves under two conditions. Its samples, reconstructed and seen through the camera, differ from the photo by no
more than a given error. And every region that edges enclose holds a sample. Where it is known how wide the drawing will
be, only the difference counts that a drawing of that width can show: it is blurred by a point on paper first. The error
falls as the grid grows, so the interval can be halved. Regions do not behave so, and sides are tried in turn.

What a grid is tried by is no finer than it has to be. A large photo is searched in a smaller view of it: one of a
megapixel tells as much of a grid of a hundred samples a side. The grid that is found is fitted to the photo itself and
judged again. Without a width every pixel's noise counts, and the photo judges. Where only what a drawing shows counts,
a second view does, which is blurred by SURE_PX of its pixels: of half a megapixel drawn 3 in wide it tells an error
lower by .6 to .9 % than the photo does, at 12 megapixels in a twentieth of the time.

Every try is a fit of its own. From grid to grid all samples move, so no tile stays as it was, and what hides samples
from pixels is the larger part of a fit, so to begin at the samples of the last one saves little. The error falls by
powers of .2 to 3 from one side of the ladder to the next, so one try bounds no other closely: it makes a guess.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass
from itertools import count

import numpy as np
import numpy.typing as npt

from penink_cli.geometry import walls
from penink_cli.ground import exact
from penink_cli.ground.errors import ParameterError
from penink_cli.ground.gaussian import smoothed
from penink_cli.ground.median import distinct
from penink_cli.ground.model import EdgeList, Floats
from penink_cli.reconstruction.camera import camera_blur
from penink_cli.reconstruction.enlarge import reconstruct
from penink_cli.reconstruction.fit import AREA, POINT
from penink_cli.reconstruction.reduction import Reduction
from penink_cli.reconstruction.shrinking import shrunk

Grey32 = npt.NDArray[np.float32]

MAX_ERROR = 8 / 255
MAX_SEEN_ERROR = 4.3 / 255  # of what a drawing at a size shows
#: A photo's detail is what a drawing shows of it, less its means over _AROUND times what a drawing blurs. Where detail
#: is fainter than FAINT (RMS), less error is allowed in proportion: in a faint photo the same error hides more.
FAINT, _AROUND = 28 / 255, 8
_LEAST_PART = 0.5  # of MAX_SEEN_ERROR
SEEN_PT = 1.0  # σ of the blur: hatching shows nothing finer
# Smaller regions are specks that no stroke can show: 4 x 4 pixels of 512 x 512, however finely the photo is resolved.
LEAST_REGION, LEAST_REGION_PX = 1 / 16384, 16  # of the picture, and at least so many pixels
VIEW_PX = 1_000_000
SEEN_PX = 1.0  # of the view: σ by which what is seen at a size is blurred; a finer view tells no more of it
SURE_PX = 3.0  # the same, where a grid is judged at last; at SEEN_PX the error is told within 2 %
_LEAST_SIDE = 32  # samples; below that a cell holds too much of the picture
_RUNG = 50  # the error is tried of grids that differ by a sample a side, or by 1/50 where that is more
# Of the side by which the error falls, where only one is known; and that of what is seen, which a grid of this spacing
# (points on paper) is about right for.
_POWER, _SEEN_POWER, _SEEN_SPACING_PT = 0.6, 2.0, 3.0
_GUESSES = 3  # are trusted, though they may all be too coarse, or too fine
# A grid fitted to the quick view leaves less of that than one fitted to the photo leaves of it: 1 % at the least where
# seven photos were measured, 2 or 3 mostly. What would fail by so much is not fitted to the photo at all.
_FLATTERED = 1.01
_AREA = 1 / 12  # variance of what a pixel's area blurs, in squares of its side


@dataclass(frozen=True, eq=False)
class _View:
    """What grids are judged by.

    picture: (h, w). blur: its own, pixels. fine: how many points along an axis make a pixel.
    seen: pixels by which differences are blurred before they count. area: of that a variance which is blurred already.
    """

    picture: Grey32
    blur: float
    fine: int
    seen: float = 0.0
    area: float = 0.0

    def to_blur(self, times: float = 1.0) -> float:
        """By what its differences are still to be blurred until it is `times` what is seen."""
        return math.sqrt(max(0.0, (times * self.seen) ** 2 - self.area))

    def smaller(self, most: int) -> _View:
        """The same of at most so many pixels, more or less, each the mean of those that it covers."""
        shrink = math.sqrt(self.picture.size / most)
        if shrink <= 1:
            return self
        # Its pixels blur by their area, as those of the photo did, whose area is a part of the lens's blur now. Left
        # out, errors were told 6 % too low.
        blur = math.sqrt(self.blur**2 + _AREA * (self.fine > POINT)) / shrink
        return _View(shrunk(self.picture, shrink), blur, AREA, self.seen / shrink, _AREA)


@dataclass(frozen=True, eq=False)
class Grid:
    """A grid: its samples (height, width), the error they leave (RMS, 0 … 1), regions without a sample."""

    samples: Grey32
    error: float
    empty_regions: int


def choose_grid(
    samples: Grey32,
    edges: EdgeList,
    max_error: float | None = None,
    *,
    seen_at: float | None = None,
    relative: bool = False,
    photo: Grey32 | None = None,
    fit: str = "lsq",
    threads: int | None = None,
    report: Callable[[str], None] = lambda line: None,
) -> Grid:
    """Reduce samples to the smallest grid whose reconstruction stays within max_error of the photo.

    Args:
        samples: (h, w) clean samples, 0 … 1.
        edges: in the frame of the image.
        max_error: RMS, grey 0 … 1; MAX_ERROR unless given, with seen_at MAX_SEEN_ERROR.
        relative: as much less for faint photos, down to half; with seen_at.
        seen_at: the width on paper, points, whose drawing is to show no more than that; None for every pixel.
        photo: what to compare with (and to fit to); the samples where None.
        fit: as of `reduce`.
        threads: the bytes are the same for any number.
        report: receives a line about each grid tried.

    Raises:
        ParameterError: where even the grid of the samples leaves a larger error.

    """
    height, width = samples.shape
    seen = samples if photo is None else photo
    shown = 0.0 if seen_at is None else SEEN_PT * seen.shape[1] / seen_at
    full = _View(seen, 0.0, POINT, shown)
    if photo is not None:
        full = _View(seen, camera_blur(seen, edges), AREA, shown)
    enough = math.ceil(seen.size / max(1.0, shown / SEEN_PX) ** 2)
    quick = full.smaller(min(VIEW_PX, enough if 2 * enough < seen.size else seen.size))  # else it does not pay
    judge = full if seen_at is None else full.smaller(math.ceil(seen.size / max(1.0, shown / SURE_PX) ** 2))
    if max_error is None:
        max_error = MAX_ERROR if seen_at is None else MAX_SEEN_ERROR
    if relative and seen_at is not None:
        max_error *= min(1.0, max(_detail(quick) / FAINT, _LEAST_PART))
    regions = _Regions(edges, *seen.shape)
    long = max(width, height)
    ladder = _ladder(-(-_LEAST_SIDE * long // min(width, height)), long)
    likely = None if seen_at is None else seen_at / _SEEN_SPACING_PT * long / width
    power = _POWER if seen_at is None else _SEEN_POWER
    reduction = Reduction(samples, edges, fit, threads)
    tried: dict[tuple[int, bool], Grid] = {}
    errors: dict[int, float] = {}  # in the quick view

    def size(side: int) -> tuple[int, int]:
        return max(1, round(width * side / long)), max(1, round(height * side / long))

    def attempt(side: int, view: _View) -> Grid:
        """The grid fitted to a view of the photo."""
        by = judge if view is full else view
        if size(side)[0] > by.picture.shape[1] or size(side)[1] > by.picture.shape[0]:
            view = by = full  # a grid finer than what judges it could not be fitted
        key = side, view is full
        if key not in tried:
            reduced = reduction.to(*size(side), photo if view is full else view.picture, view.blur)
            error = remaining_error(reduced, edges, by.picture, by.blur, by.fine, threads, by.to_blur())
            tried[key] = Grid(reduced, error, regions.without_sample(*size(side)))
            report(
                f"{reduced.shape[1]} x {reduced.shape[0]}: error {255 * error:.2f} of 255, "
                f"{tried[key].empty_regions} regions without a sample"
            )
        return tried[key]

    def search(limit: float, least: int = 0) -> int:
        """The least side of the ladder, from `least` on, whose error in the quick view stays within the limit."""
        sides = [side for side in ladder if side >= least] or [long]
        return _least_within(limit, sides, lambda side: attempt(side, quick).error, errors, power, likely)

    def serving(side: int) -> int:
        """The least side from there on that leaves no region empty."""
        while side < long and regions.without_sample(*size(side)):
            side += 1
        return side

    side = serving(search(max_error if quick is full else max_error / _FLATTERED))
    chosen = attempt(side, full)
    while chosen.error > max_error and side < long:
        # the photo's noise, most of which a smaller view does not have, leaves that much less to the grid
        unseen = max(0.0, chosen.error**2 - attempt(side, quick).error ** 2)
        side = serving(search(math.sqrt(max(0.0, max_error**2 - unseen)), side + 1))
        chosen = attempt(side, full)
    if chosen.error > max_error:
        raise ParameterError(
            f"even {width} x {height} samples leave an error of {255 * chosen.error:.2f} of 255; "
            f"{255 * max_error:.2f} are allowed (--max-error)"
        )
    return chosen


def _detail(view: _View) -> float:
    """RMS, grey 0 … 1, of what a drawing shows of a photo besides its broad tones."""
    fine, broad = (smoothed(view.picture, view.to_blur(times)) for times in (1, _AROUND))
    # summed as whole numbers: the order of the sum is not the same on every machine
    squares = int((np.rint((fine - broad) * 65536).astype(np.int64) ** 2).sum())
    return math.sqrt(squares / view.picture.size) / 65536


def remaining_error(
    samples: Grey32, edges: EdgeList, photo: Grey32, blur: float, fine: int = AREA, threads: int | None = None,
    seen: float = 0.0,
) -> float:  # fmt: skip
    """RMS difference (0 … 1) between a photo and the reconstruction of samples, seen through the camera.

    seen: σ, pixels of the photo, by which the difference is blurred first.
    """
    height, width = photo.shape
    halo = int(4 * (blur + seen) + 1)
    rows = max(64, 4_000_000 // width)
    total = 0.0
    for top in range(0, height, rows):
        first, last = max(0, top - halo), min(height, top + rows + halo)
        window = 0, fine * first, fine * width, fine * (last - first)
        grey = reconstruct(samples.astype(float), edges, fine * width, fine * height, window=window, threads=threads)
        grey = _means(np.clip(grey, 0, 1, out=grey), fine)
        off = (smoothed(grey, blur) if blur else grey.astype(np.float32)) - photo[first:last]
        if seen:
            off = smoothed(off, seen)
        bottom = min(height, top + rows)
        total += float(np.square(off[top - first : bottom - first], dtype=np.float64).sum())
    return float(np.sqrt(total / photo.size))


def _means(points: Floats, fine: int) -> Floats:
    """Means (h, w) of fine × fine points each; by slices, five times as fast as over axes of a reshaped array."""
    rows = points[::fine]
    for k in range(1, fine):
        rows = rows + points[k::fine]
    pixels = rows[:, ::fine]
    for k in range(1, fine):
        pixels = pixels + rows[:, k::fine]
    return pixels / (fine * fine)


def _ladder(least: int, most: int) -> list[int]:
    """Sides from coarse to that of the samples: the same for any error, so that more of it never takes a finer grid."""
    ladder = []
    while least < most:
        ladder.append(least)
        least += 1 + least // _RUNG
    return [*ladder, most]


def _least_within(
    limit: float, sides: list[int], error: Callable[[int], float], known: dict[int, float], usual: float = _POWER,
    likely: float | None = None,
) -> int:  # fmt: skip
    """The first of the sides whose error stays within the limit; that of the last is not tried.

    The error falls about as a power of the side, which finds the place in two to five tries instead of eight.

    sides: ascending. known: errors of some sides, added to. usual: the power where only one is known; likely: a side
    to begin with.
    """
    low, high = -1, len(sides) - 1
    for tries in count():
        for at, side in enumerate(sides):
            if side in known and known[side] <= limit:
                high = min(high, at)
            elif side in known:
                low = max(low, at)
        if high - low <= 1:
            return sides[high]
        coarse, fine = sides[max(0, low)], sides[high]
        between = coarse in known and fine in known
        guess = math.sqrt(coarse * fine) if known or likely is None else likely
        if known and limit > 0 and not (between and tries % 4 == 3):  # a guess may do little to narrow the range
            power = usual
            if between:
                power = max(0.1, float(exact.log(known[coarse] / max(known[fine], 1e-9)) / exact.log(fine / coarse)))
            told = coarse if coarse in known else fine if fine in known else _nearest(known, limit)
            guess = told * float(exact.power(known[told] / limit, 1 / power))
        at = bisect_left(sides, guess, low + 1, high - 1)
        if not between and tries > _GUESSES:  # nor does it when all are on one side: each goes twice as far then
            leap = 1 << (tries - _GUESSES)
            at = min(at, max(low + 1, high - leap)) if fine in known else max(at, min(high - 1, low + leap))
        known[sides[at]] = error(sides[at])
    raise AssertionError


def _nearest(errors: dict[int, float], limit: float) -> int:
    """The side whose error is nearest to the limit."""
    return min(errors, key=lambda side: abs(errors[side] - limit))


class _Regions:
    """The regions that edges enclose, as far as pixels of the photo tell."""

    def __init__(self, edges: EdgeList, height: int, width: int) -> None:
        first = walls.regions(walls.walls(edges, width, height))
        begins = np.flatnonzero(first[1:] != first[:-1]) + 1  # runs of pixels: to count those takes little memory
        begins = np.concatenate([[0], begins])
        length, of = np.diff(begins, append=len(first)), first[begins]
        regions = distinct(of)
        sizes = np.bincount(np.searchsorted(regions, of), length)
        least = max(LEAST_REGION_PX, LEAST_REGION * height * width)
        self.known = regions[sizes >= least]  # by the first pixel of each, the specks left out
        self.region = first.reshape(height, width)

    def without_sample(self, width: int, height: int) -> int:
        """How many regions hold no sample of a grid of width × height."""
        rows = ((np.arange(height) + 0.5) * self.region.shape[0] / height).astype(int)
        columns = ((np.arange(width) + 0.5) * self.region.shape[1] / width).astype(int)
        held = np.zeros(len(self.known), bool)
        sampled = self.region[np.ix_(rows, columns)].ravel()
        place = np.minimum(np.searchsorted(self.known, sampled), max(0, len(self.known) - 1))
        if len(self.known):
            held[place[self.known[place] == sampled]] = True
        return len(held) - int(held.sum())
