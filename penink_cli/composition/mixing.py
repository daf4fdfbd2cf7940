"""The frame of a scan left out, and colours made grey by the weights of red, green and blue that keep most contrast.

Luma gives the same grey to many colours that differ to the eye: the red and the green of a parrot, say. So weights that
sum to 1 are tried in steps of a tenth, and those are taken that keep most of the differences between places near each
other (after Gooch et al., Color2Gray, 2005, and Lu et al., Contrast Preserving Decolorization, 2012).

This module alone imports the compiled kernel `mixing`.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.composition._compiled import mixing as _mixing
from penink_cli.composition.filters import Picture, looked_up, shrunk
from penink_cli.ground.colour import lab_of_light
from penink_cli.ground.median import median

Weights = tuple[float, float, float]

LUMA: Weights = (0.299, 0.587, 0.114)

_BORDER, _SEEN = 8, 48  # the most lines along a side that are a rim; the lines along a side that are looked at
# The step of grey at a rim's end is at least _RIM, _TYPICAL times the median step of the lines further in, and _STRONG
# times the 9th decile of these.
_RIM, _TYPICAL, _STRONG = 0.025, 2.5, 1.5

_EYE_PT, _CELLS = 3.0, 128  # side of a cell, which is what the eye takes in at a glance; the most cells along a side
_OFFSETS = ((0, 1), (1, 0), (2, 1), (-1, 2), (4, 0), (0, 4), (3, -3), (7, 2), (-2, 7), (8, -5))  # cells down, across
_UNSEEN = 0.05  # hundreds of units of Lab: a difference up to that is none
_LIGHT, _FAR, _NEGATIVE = 0.25, 0.0625, 0.3  # worth of a lighter grey; prices of weights far from luma's, and below 0
_WHOLE = 1 << 20  # of 1: differences are added up as whole numbers, whose sum is the same in any order


def without_rim(values: npt.NDArray[np.generic], maxval: int) -> npt.NDArray[np.generic]:
    """The photo (h, w) or (h, w, 3), 0 … maxval; where a scan has a rim, its lines are replaced by the next one.

    Of each side up to _BORDER lines are a rim, and one more may be mixed with it.
    """
    result = values
    for side in range(4):
        lines = np.rot90(values, side)[:_SEEN].astype(np.float32) / np.float32(maxval)
        if len(lines) < 2 * _BORDER:
            continue
        steps = np.abs(np.diff(lines, axis=0))
        if steps.ndim == 3:
            steps = (steps[..., 0] + steps[..., 1] + steps[..., 2]) / np.float32(3)
        step = median(steps, axis=1)
        inner = step[_BORDER + 2 :]
        least = max(_RIM, _TYPICAL * float(median(inner)), _STRONG * float(np.sort(inner)[len(inner) * 9 // 10]))
        found = [i for i in range(_BORDER) if step[i] > least]
        if found:
            if result is values:
                result = values.copy()
            turned = np.rot90(result, side)
            turned[: found[-1] + 2] = turned[found[-1] + 2]
    return result


def chosen_mix(colours: Picture, pixels_per_pt: float) -> Weights:
    """The weights of red, green and blue that keep most contrast.

    colours: (h, w, 3), 0 … 1. pixels_per_pt: pixels to a point on paper.
    """
    height, width = colours.shape[:2]
    cell = max(1.0, _EYE_PT * pixels_per_pt, max(height, width) / _CELLS)
    small = shrunk(colours, max(1, round(width / cell)), max(1, round(height / cell)))
    red, green, blue = (np.ascontiguousarray(small[..., k], np.float64) for k in range(3))
    seen = lab(small)
    pairs = [(a, b) for a, b in (_pair(red.shape, *by) for by in _OFFSETS) if red[a].size]
    wanted = [np.sqrt(_squares(seen[a] - seen[b])) / 100 for a, b in pairs]
    if not pairs:
        return LUMA
    kept = [w > _UNSEEN for w in wanted]
    worth_keeping = np.concatenate([w[k] for w, k in zip(wanted, kept)])
    number = np.arange(red.size, dtype=np.int32).reshape(red.shape)
    one, other = (np.concatenate([number[pair[end]][k] for pair, k in zip(pairs, kept)]) for end in (0, 1))
    whole = _total(worth_keeping)
    if not whole:
        return LUMA
    best: tuple[float, Weights] | None = None
    for r in range(-2, 13):
        for g in range(-2, 13):
            b = 10 - r - g
            if not -2 <= b <= 6:
                continue
            mix = (r / 10, g / 10, b / 10)
            grey = mix[0] * red + mix[1] * green + mix[2] * blue
            share = _mixing.kept(grey.ravel(), one, other, worth_keeping, float(_WHOLE))
            clipped = int(((grey < 0) | (grey > 1)).sum()) / grey.size
            worth = share / whole + _LIGHT * _total(np.clip(grey, 0, 1)) / (_WHOLE * grey.size) - clipped
            worth -= _FAR * (abs(mix[0] - LUMA[0]) + abs(mix[1] - LUMA[1]) + abs(mix[2] - LUMA[2]))
            worth -= _NEGATIVE * (max(0.0, -mix[0]) + max(0.0, -mix[1]) + max(0.0, -mix[2]))
            if best is None or worth > best[0]:
                best = worth, mix
    assert best is not None
    return best[1]


def mixed(colours: Picture, mix: Weights) -> Picture:
    """Grey (h, w), 0 … 1, of colours (h, w, 3), 0 … 1."""
    out = np.empty(colours.shape[:2], np.float32)
    _mixing.mix(np.ascontiguousarray(colours), *mix, out, 0, len(out))
    return out


def lab(colours: Picture) -> npt.NDArray[np.float64]:
    """CIE Lab (h, w, 3), white D65, of sRGB (h, w, 3), 0 … 1."""
    steps = [k / 1024 for k in range(1025)]  # rounded entries of a table are the same on every machine
    linear = np.array([round(v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4, 12) for v in steps])
    r, g, b = (looked_up(colours[..., k], linear).astype(np.float64) for k in range(3))
    return lab_of_light(np.stack([r, g, b], axis=-1))


def _pair(shape: tuple[int, ...], down: int, across: int) -> tuple[tuple[slice, slice], tuple[slice, slice]]:
    """The cells of a grid (h, w) from which an offset of so many cells leads to a cell of the grid, and those cells."""
    h, w = shape
    a = slice(max(0, -down), h - max(0, down)), slice(max(0, -across), w - max(0, across))
    b = slice(max(0, down), h - max(0, -down)), slice(max(0, across), w - max(0, -across))
    if max(abs(down), 0) >= h or abs(across) >= w:
        return (slice(0, 0), slice(0, 0)), (slice(0, 0), slice(0, 0))
    return a, b


def _squares(difference: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """(…,) squares of differences in Lab (…, 3), in which hue and saturation count less than lightness."""
    d = difference * difference
    squares: npt.NDArray[np.float64] = d[..., 0] + 0.6 * d[..., 1] + 0.6 * d[..., 2]
    return squares


def _total(values: npt.NDArray[np.float64]) -> int:
    """The sum of values, in _WHOLE to 1, each rounded down."""
    return int((values * _WHOLE).astype(np.int64).sum())
