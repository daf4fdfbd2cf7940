"""How dark things are drawn: one monotone curve for the whole picture, part of the way to an illustrator's tones.

A photograph's tones crowd in the middle; a drawing spends paper and black deliberately. A target says how light the
picture is to be, by quantiles of grey, 0 ink and 1 paper.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from penink_cli.composition import filters
from penink_cli.composition.filters import Picture, gaussian
from penink_cli.ground.errors import ParameterError
from penink_cli.ground.model import Floats

Quantiles = tuple[tuple[float, float], ...]  # a share of the picture, the darkest, and the lightest grey in that share

#: The tone distributions known by name.
TARGETS: dict[str, Quantiles] = {
    "house": ((0, 0), (0.09, 0.07), (0.20, 0.34), (0.38, 0.68), (0.57, 0.92), (0.64, 0.99), (1, 1)),
    "high-key": ((0, 0), (0.04, 0.2), (0.12, 0.5), (0.26, 0.78), (0.42, 0.98), (1, 1)),
    "spot": ((0, 0), (0.20, 0.02), (0.27, 0.5), (0.44, 0.72), (0.52, 1), (1, 1)),
}

STEPS = 256  # of grey, in the curve
_LEAST_SLOPE, _MOST_SLOPE = 0.35, 2.0
_SMOOTH = 8.0  # σ of the Gaussian that smooths the full curve, steps
_ENDS, _BLACK, _PAPER = 0.03, 0.06, 0.97  # a share of the picture at each end, and the greys that these are to reach
_DOWN, _UP = 1.8, 1.6  # the most by which the curve's dark and light half are stretched to reach them


def check_quantiles(quantiles: Sequence[tuple[float, float]]) -> None:
    """Raise ParameterError unless shares and greys both rise from 0 to 1."""
    shares, greys = [s for s, _ in quantiles], [g for _, g in quantiles]
    if len(shares) < 2 or (shares[0], greys[0], shares[-1], greys[-1]) != (0, 0, 1, 1):
        raise ParameterError("a target begins at 0:0 and ends at 1:1")
    if any(a >= b for a, b in pairwise(shares)) or any(a > b for a, b in pairwise(greys)):
        raise ParameterError("a target's shares must rise, and its greys must not fall")


def inks(target: Quantiles) -> float:
    """How much ink a picture takes by a target, in parts of what it takes by the target "house"."""

    def ink(quantiles: Quantiles) -> float:
        return 1 - math.fsum((b - a) * (c + d) / 2 for (a, c), (b, d) in pairwise(quantiles))

    return ink(target) / ink(TARGETS["house"])


def histogram(grey: Picture, weight: Picture | None, steps: int = STEPS) -> Floats:
    """(steps + 1,) the share of the picture, 0 … 1, up to each even step of grey; weight: (h, w), None for 1 each."""
    upto = np.zeros(steps + 1)
    np.cumsum(filters.histogram(grey, weight, steps), out=upto[1:])
    return upto / upto[-1] if upto[-1] else np.linspace(0, 1, steps + 1)


def quantile(upto: Floats, share: float) -> float:
    """The grey below which that share of the picture lies; upto: its histogram, as of `histogram`."""
    i = min(max(int(np.searchsorted(upto, share)) - 1, 0), len(upto) - 2)
    rise = float(upto[i + 1] - upto[i])
    inside = (share - float(upto[i])) / rise if rise > 0 else 0.0
    return (i + min(max(inside, 0.0), 1.0)) / (len(upto) - 1)


def curve(upto: Floats, target: Quantiles, strength: float) -> tuple[Floats, Floats]:
    """The curve (STEPS + 1,) over greys at even steps, and its slope (STEPS,).

    upto: the picture's histogram, as of `histogram`. strength: 0 leaves tones as they are, 1 brings them to the target,
    as far as the least and the most slope let them.
    """
    shares, greys = (np.array(v, np.float64) for v in zip(*target))
    full = _smoothed(interpolated(upto, shares, greys), _SMOOTH)
    steps = np.arange(STEPS + 1) / STEPS
    wanted = (1 - strength) * steps + strength * full
    slope = np.clip(np.diff(wanted) * STEPS, _LEAST_SLOPE, _MOST_SLOPE)
    result = np.zeros(STEPS + 1)
    np.cumsum(slope / STEPS, out=result[1:])
    middle = quantile(upto, 0.5)
    result += at(wanted, middle) - at(result, middle)
    pivot = at(result, middle)
    dark, light = (at(result, quantile(upto, q)) for q in (_ENDS, 1 - _ENDS))
    down = min(max((pivot - _BLACK) / max(0.05, pivot - dark), 1.0), _DOWN)
    up = min(max((_PAPER - pivot) / max(0.05, light - pivot), 1.0), _UP)
    result = np.where(result < pivot, pivot - (pivot - result) * down, pivot + (result - pivot) * up)
    return result, _smoothed(slope, 6.0)


def at(table: Floats, grey: float) -> float:
    """The value at one grey of a table over even steps of grey from 0 to 1."""
    place = min(max(grey, 0.0), 1.0) * (len(table) - 1)
    i = min(int(place), len(table) - 2)
    return float(table[i] + (place - i) * (table[i + 1] - table[i]))


def interpolated(x: Floats, xs: Floats, ys: Floats) -> Floats:
    """The polygon through xs, ys at x. numpy's own may fuse a product and a sum, which changes the last bit."""
    i = np.clip(np.searchsorted(xs, x, side="right") - 1, 0, len(xs) - 2)
    share = (x - xs[i]) / (xs[i + 1] - xs[i])
    return np.asarray(ys[i] + share * (ys[i + 1] - ys[i]))


def _smoothed(values: Floats, sigma: float) -> Floats:
    """A Gaussian low-pass of a table, its ends held."""
    weights = gaussian(sigma).astype(np.float64)
    n = len(weights) - 1
    padded = np.concatenate([np.full(n, values[0]), values, np.full(n, values[-1])])
    result = weights[0] * padded[n : n + len(values)]
    for k in range(1, n + 1):
        result = result + weights[k] * (padded[n - k : n - k + len(values)] + padded[n + k : n + k + len(values)])
    return np.asarray(result)
