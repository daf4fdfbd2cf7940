"""From a photograph to its telling lines.

1. The photo is reduced, or enlarged a little, to a working size: what a drawing of about 6 inches can show.
2. Its local contrast is evened out, and a bank of oriented filters responds to pieces of dark and of light lines, at a
   fine scale and at a coarse one. A place that responds in every direction is no line; what is as strong all around is
   texture.
3. Lines are followed from the strongest responses on. Coarse lines stay where no fine line is near. 4. Each line gets a
rank. It is high for lines that are long, clear, even, alone, and along the field of directions or on
   light ground. Faint short lines that run across the form would spoil faces and skies.
5. Small dark things that are no lines, such as pupils, are spots. Lines that were traced in them are left out.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from penink_cli.composition.filters import blurred, enlarged, shrunk
from penink_cli.ground.model import Directions, Floats, Lines
from penink_cli.lines import oriented, tracing
from penink_cli.lines.oriented import Picture
from penink_cli.lines.spots import Spot, covered, spots
from penink_cli.lines.tracing import Traces

#: The working size: the root of its area, pixels; the most that a smaller photo is enlarged; the longest side, pixels.
SIDE, MOST_ENLARGED, LONGEST = 760.0, 2.0, 20_000
#: Working pixels to a point of a picture of usual size, in which the lengths that make a rank are measured.
PIXELS_PER_PT = 1.76
#: Contrast is evened out over a Gaussian of σ LOCAL (pixels): where the deviation is s, it is multiplied by
#: EVEN / (s + FLOOR), within the bounds GAINS.
LOCAL, EVEN, FLOOR, GAINS = 24.0, 0.10, 0.035, (0.4, 1.8)
#: Grain is not to be amplified: so many of its deviations are added to FLOOR.
GRAIN = 5.0
#: σ across and along, pixels, of the fine bank, and of the coarse one on a view of half the size.
FINE, COARSE = (0.75, 2.0), (1.0, 3.5)
#: Responses: a dark line begins at HIGH and ends at LOW; FULL is that of a line which the broadest pen draws.
HIGH, LOW, FULL = 0.005, 0.00175, 0.022
#: The response at which a light line begins.
WHITE_HIGH = 0.006
#: The part of the surroundings' response that is subtracted: texture answers everywhere.
INHIBITION = 0.25
#: A line whose response is less than this part of its own and its surroundings' is one of a texture, and worth less.
ALONE = 0.4
#: A light line must be lighter, by RIDGE, than what lies BESIDE pixels from it on either side.
BESIDE, RIDGE = 3.0, 0.03
#: A spot's rank is SPOT times the cube of its contrast, times LONG_SPOT where it is longer than broad. Three things
#: make it less. Lines around it answer more than CALM: a spot in lettering is a letter. It is broader than SMALL
#: pixels: hatching can show it. Its border has less than CRISP of the contrast.
SPOT, LONG_SPOT, CALM, SMALL, CRISP = 12.0, 0.6, 0.004, 12.0, 0.45
#: The darkness from which on a spot is drawn as broad as it is; a lighter one is drawn smaller.
DARK = 0.75
#: A line in or along a spot is a part of the spot, unless it is longer than so many times the spot.
AROUND = 4.0
#: How far from a spot, pixels, a fine line and a coarse one may still be a part of it: the filters' reach.
BESIDE_SPOT = (1.5, 6.0)
#: A coarse line stays where at least FAR of it is further than NEAR pixels from all fine lines of a rank above
#: FAR_RANK.
FAR, NEAR, FAR_RANK = 0.7, 5.0, 0.45
#: σ, pixels, over which the field of directions is pooled where none is given, and over which the ground's tone is.
FIELD, GROUND = 8.0, 4.0
#: A line whose points all lie within so many pixels of the frame is a scan's rim.
RIM = 5.0
#: On white ground a line is finer by the part FADED; the darker the ground, the less; from the tone LIGHT_GROUND on not
#: at all. On light ground there is no hatching to make room for it, and a full line on skin would look like a scar.
FADED, LIGHT_GROUND = 0.8, 0.8
#: The least rank of a line, and its least length, pixels.
LEAST_RANK, SHORTEST = 0.5, 5.0
#: Every so many steps, of about a pixel, a point is kept: a smooth curve through these strays by a fifth of a pixel.
STEP = 6.0


def detect_lines(
    grey: npt.NDArray[np.generic],
    *,
    maxval: int = 1,
    black: bool = True,
    white: bool = True,
    min_length: float | None = None,
    directions: Callable[[int, int], Directions] | None = None,
    threads: int = 1,
) -> Lines:
    """Telling lines of a photo, those of the highest rank first.

    grey: (h, w) 0 black … maxval white, as a photo stores it, or 0 … 1. black, white: whether dark and light lines are
    looked for. min_length: pixels of the photo. directions: called with rows and columns, gives a field of that size
    that stands in for the photo's own.
    """
    rows, columns = grey.shape
    width, height = working_size(columns, rows)
    picture = resized(grey, maxval, width, height, threads)
    # A bank takes more room than all else together: spots come before it, and the second bank after the first.
    things = spots(picture, threads) if black else []
    shortest = SHORTEST if min_length is None else min_length * math.sqrt(width * height / (columns * rows))
    even = normalised(picture, threads)
    tone = 1 - blurred(picture, GROUND, threads)
    if directions is None:
        cos2, sin2 = field(picture, threads)
    else:
        given = directions(height, width)
        cos2, sin2 = (np.ascontiguousarray(part, np.float32) for part in (given.cos2, given.sin2))
    fine = oriented.responses(even, *FINE, threads)
    sides = _weighed(fine, threads)
    dark = _lines(_traced(fine, 1.0, HIGH, tone, cos2, sin2, sides), shortest) if black else []
    light = _lines(_traced(fine, -1.0, WHITE_HIGH, 1 - tone, cos2, sin2, sides), shortest) if white else []
    del fine
    found: list[_Line] = []
    if black:
        strong = blurred(sides.most[0], 16.0, threads)
        inside, about = (covered(things, picture.shape, margin) for margin in BESIDE_SPOT)
        strokes = [line for line in dark if not _within(line.points, inside)]
        half, tone2, cos, sin = (halved(part, threads) for part in (even, tone, cos2, sin2))
        coarse = oriented.responses(half, *COARSE, threads)
        of_coarse = _weighed(coarse, threads)
        broad = _lines(_traced(coarse, 1.0, HIGH, tone2, cos, sin, of_coarse).doubled(), 2 * shortest)
        near = _near([line.points for line in strokes if line.rank >= FAR_RANK], picture.shape)
        found += strokes
        found += [line for line in broad if _far(line.points, near) and not _within(line.points, about)]
        found += [_spot_line(spot, strong) for spot in things]
    found += [line.made_white() for line, ridge in zip(light, _ridges(light, picture)) if ridge >= RIDGE]
    found = [line for line in found if line.rank >= LEAST_RANK and not _at_rim(line, picture.shape)]
    found.sort(key=lambda line: -line.rank)
    return _assembled(found, tone, columns, rows, width, height)


@dataclass(frozen=True)
class _Line:
    """A line in working pixels, centres at whole numbers: points (k, 3) x, y, response; for the rest see Lines."""

    points: Floats
    rank: float
    white: bool = False
    breadth: float = 0.0

    def made_white(self) -> _Line:
        return _Line(self.points, self.rank, True, self.breadth)


def working_size(width: int, height: int) -> tuple[int, int]:
    """Width and height of the picture in which lines of a photo of that size are looked for."""
    scale = min(SIDE / math.sqrt(width * height), MOST_ENLARGED)
    return min(max(12, round(width * scale)), LONGEST), min(max(12, round(height * scale)), LONGEST)


def resized(grey: npt.NDArray[np.generic], maxval: int, width: int, height: int, threads: int) -> Picture:
    """The picture (h, w), 0 … maxval, as 0 … 1 at width × height pixels."""
    h, w = grey.shape
    if grey.dtype.kind != "u":
        grey, maxval = np.ascontiguousarray(grey, np.float32), 1
    if width <= w and height <= h:
        return shrunk(grey, width, height, threads=threads, whole=maxval)
    return enlarged(np.divide(grey, maxval, dtype=np.float32), width, height, threads)


def halved(values: Picture, threads: int) -> Picture:
    """Values (h, w) at half the size, rounded up."""
    h, w = values.shape
    return shrunk(values, (w + 1) // 2, (h + 1) // 2, threads=threads)


def normalised(picture: Picture, threads: int) -> Picture:
    """The picture less its local mean, its local contrast evened out."""
    off = picture - blurred(picture, LOCAL, threads)
    spread = np.sqrt(np.maximum(blurred(off * off, LOCAL, threads), np.float32(0)))
    gain = np.float32(EVEN) / (spread + np.float32(FLOOR + GRAIN * _grain(picture, threads)))
    return off * np.clip(gain, np.float32(GAINS[0]), np.float32(GAINS[1]))


def _grain(picture: Picture, threads: int) -> float:
    """The deviation of the noise in the picture's quiet parts."""
    fine = np.abs(picture - blurred(picture, 1.0, threads)).ravel()
    k = len(fine) // 5
    return float(np.partition(fine, k)[k]) / 0.2533  # a fifth of normal deviates are smaller than .2533 deviations


def field(picture: Picture, threads: int) -> tuple[Picture, Picture]:
    """cos 2θ and sin 2θ (h, w) of the direction along which the picture changes least, pooled over FIELD."""
    soft = blurred(picture, 1.5, threads)
    gx, gy = np.zeros_like(soft), np.zeros_like(soft)
    gx[:, 1:-1] = soft[:, 2:] - soft[:, :-2]
    gy[1:-1] = soft[2:] - soft[:-2]
    size = np.sqrt(gx * gx + gy * gy) + np.float32(1e-4)  # a place counts by its gradient, not by the square of it
    square, product = (gy * gy - gx * gx) / size, -(gx * gy + gx * gy) / size
    cos2, sin2 = (blurred(part.astype(np.float32), FIELD, threads) for part in (square, product))
    length = np.sqrt(cos2 * cos2 + sin2 * sin2) + np.float32(1e-9)
    return cos2 / length, sin2 / length


@dataclass(frozen=True)
class _Sides:
    """The responses of a bank by their signs, first those of dark lines, then those of light ones.

    most: (h, w) the strongest in any direction. around: (h, w) how strong they are in the surroundings.
    """

    most: tuple[Picture, Picture]
    around: tuple[Picture, Picture]


def _weighed(bank: oriented.Bank, threads: int) -> _Sides:
    """Weigh the responses of a bank, in place, by those around; returns what they were before."""
    sides = oriented.strongest(bank, threads)
    # a dot responds in every direction, a line in few
    factors = [
        np.clip((1 - mean / (most + np.float32(1e-6))) / np.float32(0.35), 0, 1).astype(np.float32)
        for most, mean in sides
    ]
    around = [
        np.maximum(blurred(most, 16.0, threads) - blurred(most, 4.0, threads) / np.float32(32), np.float32(0))
        for most, _ in sides
    ]
    less = [np.float32(2 * INHIBITION) * values for values in around]
    oriented.weigh(bank, (factors[0], less[0]), (factors[1], less[1]), threads)
    return _Sides((sides[0][0], sides[1][0]), (around[0], around[1]))


def _traced(
    bank: oriented.Bank, sign: float, high: float, ground: Picture, cos2: Picture, sin2: Picture, sides: _Sides
) -> Traces:
    """Lines of one sign, 1 for dark and -1 for light ones, in a bank that has been weighed.

    high: the response at which lines begin. ground: (h, w) tone around. sides: as of `_weighed`.
    """
    around = sides.around[0 if sign > 0 else 1]
    return tracing.traces(bank, sign, high, high * LOW / HIGH, around, ground, cos2, sin2)


def _lines(traces: Traces, shortest: float) -> list[_Line]:
    """The lines of at least `shortest` pixels, with their ranks.

    rank = n^¾ · contrast · alone · min(own, 1) · min(own, 1.1) / (1 + bend²) · max(|cos Δ|, 2 clear², 2 light), where

    - n is the length in points of a picture of usual size, at most 60, and contrast the response in parts of FULL, at
      most 1;
    - alone is the response by the sum of itself and three times the surroundings': 1 on even ground, little in texture;
      own is alone in parts of ALONE, below 1 for a line that wanders through grass;
    - bend is the turning in parts of a quarter of a radian a point; - Δ is the angle to the field of directions: a line
    along the form tells of it; - clear is contrast · alone in parts of .55, at most 1, and light is 1 on ground lighter
    than a tone of .2, 0 from .3
      on: a line that is clear, or on light ground, counts though it runs across the form.
    """
    length = traces.length / PIXELS_PER_PT
    keep = np.flatnonzero(traces.length >= shortest)
    n = np.minimum(length, 60.0)
    contrast = np.minimum(traces.response / FULL, 1.0)
    bend = traces.turning / np.maximum(length, 1e-6) / 0.25
    alone = traces.response / (traces.response + 3 * traces.around + 1e-9)
    own = alone / ALONE
    salience = np.sqrt(n * np.sqrt(n)) * contrast / (1 + bend * bend) * alone
    salience = salience * np.minimum(own, 1.0) * np.minimum(own, 1.1)
    along = np.sqrt(np.maximum(0.5 + 0.5 * traces.agreement, 0))
    clear = np.minimum(contrast * alone / 0.55, 1.0)
    light = np.clip((0.3 - traces.ground) / 0.1, 0, 1)
    rank = salience * np.maximum(along, 2 * np.maximum(clear * clear, light))
    return [_Line(traces[i], float(rank[i])) for i in keep.tolist()]


def _ridges(lines: list[_Line], picture: Picture) -> Floats:
    """By how much each line (n,) is on the mean lighter than the lighter of the places beside it, BESIDE pixels off."""
    if not lines:
        return np.zeros(0)
    sizes = np.array([len(line.points) for line in lines])
    first = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    at = np.concatenate([line.points[:, :2] for line in lines])
    whose = np.repeat(np.arange(len(lines)), sizes)
    before, after = np.arange(len(at)) - 2, np.arange(len(at)) + 2
    ahead = at[np.minimum(after, (first + sizes - 1)[whose])] - at[np.maximum(before, first[whose])]
    length = np.sqrt(ahead[:, 0] * ahead[:, 0] + ahead[:, 1] * ahead[:, 1]) + 1e-9
    normal = np.column_stack([-ahead[:, 1], ahead[:, 0]]) * (BESIDE / length)[:, None]
    beside = np.maximum(_at(picture, at + normal), _at(picture, at - normal))
    off = (_at(picture, at) - beside).astype(np.float64)
    return np.asarray(np.add.reduceat(off, first) / sizes)


def _spot_line(spot: Spot, strong: Picture) -> _Line:
    """A spot as a line with breadth: of one point where it is round, else of two.

    The less dark the spot, the less broad the line: an iris is no hole. strong: (h, w) how much lines around each place
    respond.
    """
    ends = [(spot.x, spot.y, FULL)]
    rank = SPOT * spot.contrast * spot.contrast * spot.contrast
    if spot.dx or spot.dy:
        ends = [(spot.x - spot.dx, spot.y - spot.dy, FULL), (spot.x + spot.dx, spot.y + spot.dy, FULL)]
        rank *= LONG_SPOT
    points = np.array(ends)
    calm = min(1.0, CALM / max(float(_at(strong, points)[0]), 1e-9))
    sure = calm * min(1.0, SMALL / spot.breadth) * spot.crisp / CRISP
    full = min(1.0, spot.dark / DARK)
    return _Line(points, rank * sure * sure, False, spot.breadth * full * full)


def _at(values: npt.NDArray[np.generic], points: Floats) -> npt.NDArray[np.generic]:
    """Values (h, w) at the pixels that points (k, ≥ 2) lie in."""
    x = np.clip((points[:, 0] + 0.5).astype(np.int64), 0, values.shape[1] - 1)
    y = np.clip((points[:, 1] + 0.5).astype(np.int64), 0, values.shape[0] - 1)
    return values[y, x]


def _within(points: Floats, inside: Picture) -> bool:
    """Whether a line is no more than a part of a spot, or of its outline. inside: as of `spots.covered`."""
    there = _at(inside, points)
    n = np.count_nonzero(there)
    return bool(2 * n > len(points) and len(points) < AROUND * float(there.max()))


def _near(lines: list[Floats], shape: tuple[int, ...]) -> npt.NDArray[np.bool_]:
    """Which places (h, w) are within NEAR pixels of a line, along x and along y."""
    mask = np.zeros(shape, np.bool_)
    for points in lines:
        x = np.clip((points[:, 0] + 0.5).astype(np.int64), 0, shape[1] - 1)
        y = np.clip((points[:, 1] + 0.5).astype(np.int64), 0, shape[0] - 1)
        mask[y, x] = True
    r = int(NEAR)
    for axis in (0, 1):
        padded = np.pad(mask, [(r, r) if a == axis else (0, 0) for a in (0, 1)])
        n = mask.shape[axis]
        wide = mask.copy()
        for k in range(2 * r + 1):
            wide |= padded[k : k + n] if axis == 0 else padded[:, k : k + n]
        mask = wide
    return mask


def _far(points: Floats, near: npt.NDArray[np.bool_]) -> bool:
    """Whether at least FAR of a line lies off the mask."""
    return bool(np.count_nonzero(_at(near, points)) <= (1 - FAR) * len(points))


def _at_rim(line: _Line, shape: tuple[int, ...]) -> bool:
    """Whether all points of a line lie within RIM pixels of the frame."""
    x, y = line.points[:, 0], line.points[:, 1]
    off = np.minimum(np.minimum(x, shape[1] - 1 - x), np.minimum(y, shape[0] - 1 - y))
    return bool(off.max() <= RIM)


def _thinned(points: Floats) -> Floats:
    """About one point every STEP, the first and the last among them; archives keep even spacing in the fewest bytes."""
    if len(points) < 3:
        return points
    count = max(3, math.ceil((len(points) - 1) / STEP) + 1)
    return points[[(len(points) - 1) * k // (count - 1) for k in range(count)]]


def _assembled(found: list[_Line], tone: Picture, columns: int, rows: int, width: int, height: int) -> Lines:
    """The lines in pixels of a photo of columns × rows, dark ones finer on light ground.

    tone: (height, width) of the ground in working pixels.
    """
    parts = [_thinned(line.points) for line in found]
    first = np.zeros(len(parts) + 1, np.int64)
    np.cumsum([len(part) for part in parts], out=first[1:])
    points = np.concatenate(parts) if parts else np.zeros((0, 3))
    scale = np.array([columns / width, rows / height])
    at = np.clip((points[:, :2] + 0.5) * scale, 0, (columns, rows))
    light = np.clip((LIGHT_GROUND - _at(tone, points[:, :2]).astype(np.float64)) / LIGHT_GROUND, 0, 1)
    dark_line = np.array([not line.white and not line.breadth for line in found], np.bool_)
    points[:, 2] *= 1 - FADED * light * np.repeat(dark_line, np.diff(first))
    return Lines(
        columns, rows, at, first, np.clip(points[:, 2] / FULL, 0, 1), np.array([line.rank for line in found]),
        np.array([line.white for line in found], np.bool_),
        np.array([line.breadth for line in found]) * math.sqrt(float(scale[0] * scale[1])),
    )  # fmt: skip
