"""A photograph's colours taken apart into inks that print over one another.

An ink covers a part a of the paper, 0 … 1. Where it lies it lets through a part T of the light, in each of red, green
and blue; its colour on white says which. Hatching of several inks crosses at random, so the light that comes back is
the product of the paper's and of what each ink lets through (Demichel and Neugebauer, 1937, with overprints that
multiply)::

    light = paper · Π (1 − aᵢ (1 − Tᵢ))

The amounts a whose colour comes nearest to a given one in CIE Lab are found by the Gauss-Newton method within 0 … 1, on
a grid of colours; between its nodes amounts are interpolated. Of amounts that come equally near the least ink is taken.
Of black ink that share is aimed at that is asked for, of all that black could print.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from penink_cli.ground import colour
from penink_cli.ground.codes import Colour
from penink_cli.ground.colour import XYZ, lab_of_light, linear, root
from penink_cli.ground.model import Floats

WHITE: Colour = (1.0, 1.0, 1.0)

_SIDE = 33  # nodes of the grid along each of red, green and blue, at even steps of the stored values
_NODES = _SIDE * _SIDE * _SIDE
_DARKEST, _NEUTRAL = 35.0, 15.0  # lightness and chroma up to which an ink is black
LEAST = 0.004  # the least part of the light that an ink lets through: no ink is perfect
#: Prices, as squared distances in Lab: of one ink solid everywhere; of black that is off its aim by a solid layer.
_INK, _BLACK = 0.05, 4.0
#: The amount from which on an ink is laid solid. Less of it is a tint: other inks, and the paper, show through.
SOLID = 0.985
_TRIES = 30  # steps of the search
_STARTS = (0.1, 0.5, 0.95)  # amounts of all inks that the search begins with, in turn


def amounts(
    values: npt.NDArray[np.unsignedinteger],
    maxval: int,
    inks: Sequence[Colour],
    paper: Colour = WHITE,
    black: float = 0.8,
) -> Floats:
    """How much of each ink (n, h, w), 0 … 1, prints a picture.

    values: (h, w, 3) or (h, w) grey, 0 … maxval, sRGB's. inks, paper: red, green and blue, 0 … 1. black: the share, of
    the grey in a colour that black ink could print, that it is to print.
    """
    places, cells = _places(values, maxval)
    corners = np.unique(np.unique(cells)[None] + _CORNERS[:, None])
    table = np.zeros((len(inks), _NODES))
    table[:, corners] = _at_nodes(tuple(corners.tolist()), tuple(inks), paper, black)
    found = np.zeros((len(inks), *cells.shape))
    for i, corner in enumerate(_CORNERS.tolist()):
        weight = np.ones(cells.shape)
        for channel in range(3):
            share = places[..., channel]
            weight *= share if i >> channel & 1 else 1.0 - share
        found += table[:, cells + corner] * weight
    return np.clip(found, 0.0, 1.0)


#: From the first node of a cell to all eight: bit 0 a step of red, bit 1 of green, bit 2 of blue.
_CORNERS = np.array([(k & 1) + _SIDE * (k >> 1 & 1) + _SIDE * _SIDE * (k >> 2) for k in range(8)])


def _places(values: npt.NDArray[np.unsignedinteger], maxval: int) -> tuple[Floats, npt.NDArray[np.int64]]:
    """Where each colour lies in its cell of the grid (h, w, 3), 0 … 1, and the number of its first node (h, w)."""
    if values.ndim == 2:
        values = np.repeat(values[..., None], 3, axis=2)
    scaled = values * ((_SIDE - 1) / maxval)
    whole = np.minimum(np.floor(scaled), _SIDE - 2).astype(np.int64)
    return scaled - whole, whole[..., 0] + _SIDE * (whole[..., 1] + _SIDE * whole[..., 2])


@lru_cache(4)
def _at_nodes(nodes: tuple[int, ...], inks: tuple[Colour, ...], paper: Colour, black: float) -> Floats:
    """Amounts (n, m) at nodes of the grid. They are kept: each plate of a picture asks for the same nodes."""
    number = np.array(nodes, np.int64)
    stored = np.stack([number % _SIDE, number // _SIDE % _SIDE, number // (_SIDE * _SIDE)], axis=1) / (_SIDE - 1)
    return solved(linear(stored), inks, paper, black)


def printed(amount: Floats, inks: Sequence[Colour], paper: Colour = WHITE) -> Floats:
    """The light (…, 3), linear, 0 … 1, of inks that cover so much (n, …), 0 … 1."""
    light = np.broadcast_to(linear(paper), (*amount.shape[1:], 3)).copy()
    for share, passed in zip(amount, _passed(inks), strict=True):
        light *= 1.0 - share[..., None] * (1.0 - passed)
    return light


def _passed(inks: Sequence[Colour]) -> Floats:
    """The part (n, 3) of red, green and blue light that each ink lets through."""
    return np.asarray(np.maximum(linear(np.array(inks)), LEAST))


def is_black(ink: Colour) -> bool:
    """Whether an ink is dark and nearly without hue."""
    lightness, a, b = lab_of_light(linear(np.array(ink))).tolist()
    return bool(lightness <= _DARKEST and a * a + b * b <= _NEUTRAL**2)


def solved(light: Floats, inks: Sequence[Colour], paper: Colour = WHITE, black: float = 0.8) -> Floats:
    """Amounts (n, m), 0 … 1, that come nearest to colours of that light (m, 3), linear; as `amounts`."""
    passed = _passed(inks)
    wanted = lab_of_light(light)
    keys = [i for i, ink in enumerate(inks) if is_black(ink)][:1] if len(inks) > 1 else []
    aim = np.zeros(len(light))
    if keys:  # all that black could print: the most of it that leaves red, green and blue no darker than the colour
        over = 1.0 - light / linear(paper)
        aim = over[:, 0] / (1.0 - passed[keys[0], 0])
        for channel in (1, 2):
            aim = np.minimum(aim, over[:, channel] / (1.0 - passed[keys[0], channel]))
        aim = black * np.clip(aim, 0.0, 1.0)
    best = np.zeros((len(inks), len(light)))
    least = np.full(len(light), np.inf)
    for start in _STARTS:
        amount = np.full((len(inks), len(light)), start)
        if keys:
            amount[keys[0]] = aim
        amount, cost = _descended(amount, passed, linear(paper), wanted, keys, aim)
        better = cost < least
        best[:, better], least[better] = amount[:, better], cost[better]
    return best


def _descended(
    amount: Floats, passed: Floats, paper: Floats, wanted: Floats, keys: list[int], aim: Floats
) -> tuple[Floats, Floats]:
    """Amounts (n, m) after _TRIES steps down the cost, by Levenberg and Marquardt's method, and the cost (m,).

    passed: (n, 3), as of `_passed`. paper: (3,) light. wanted: (m, 3) Lab. keys: the number of the black ink, if any.
    aim: (m,) the amount of black aimed at.
    """
    n, m = amount.shape
    damping = np.full(m, 1.0)
    cost = _cost(amount, passed, paper, wanted, keys, aim)
    for _ in range(_TRIES):
        rises = slopes(amount, passed, paper)
        off = lab_of_light(_light(amount, passed, paper)) - wanted
        gradient = [_INK / 2 + _dot(rises[i], off) for i in range(n)]
        square = [[_dot(rises[i], rises[k]) for k in range(i + 1)] for i in range(n)]
        for k in keys:
            gradient[k] = gradient[k] + _BLACK * (amount[k] - aim)
            square[k][k] = square[k][k] + _BLACK
        held = [((amount[i] <= 0) & (gradient[i] > 0)) | ((amount[i] >= 1) & (gradient[i] < 0)) for i in range(n)]
        step = _equations(square, gradient, held, damping)
        tried = np.clip(amount - step, 0.0, 1.0)
        tried_cost = _cost(tried, passed, paper, wanted, keys, aim)
        better = tried_cost < cost
        amount = np.where(better, tried, amount)
        cost = np.where(better, tried_cost, cost)
        damping = np.clip(np.where(better, damping / 4, damping * 6), 1e-4, 1e9)
    return amount, cost


def _cost(amount: Floats, passed: Floats, paper: Floats, wanted: Floats, keys: list[int], aim: Floats) -> Floats:
    """(m,) the squared distance in Lab and the prices of ink and of black; as `_descended`."""
    total = np.zeros(len(wanted))
    for share in amount:
        total += _INK * share
    for k in keys:
        total += _BLACK * (amount[k] - aim) * (amount[k] - aim)
    off = lab_of_light(_light(amount, passed, paper)) - wanted
    return total + _dot(off, off)


def _light(amount: Floats, passed: Floats, paper: Floats | float = 1.0) -> Floats:
    """The light (m, 3), linear, of amounts (n, m)."""
    light = np.ones((amount.shape[1], 3)) * paper
    for share, through in zip(amount, passed, strict=True):
        light *= 1.0 - share[:, None] * (1.0 - through)
    return light


def slopes(amount: Floats, passed: Floats, paper: Floats | float = 1.0) -> list[Floats]:
    """Of each ink the derivatives of Lab (m, 3) by its amount; passed: (n, 3), as of `_passed`."""
    light = _light(amount, passed, paper)
    tristimulus = [r * light[:, 0] + g * light[:, 1] + b * light[:, 2] for r, g, b in XYZ]
    rise = []
    for t in tristimulus:
        f = root(t)
        rise.append(np.where(t > colour.LEAST, 1.0 / (3.0 * f * f), 24389 / 27 / 116))
    found = []
    for share, through in zip(amount, passed, strict=True):
        change = -light / (1.0 - share[:, None] * (1.0 - through)) * (1.0 - through)
        x, y, z = (
            rise[k] * (r * change[:, 0] + g * change[:, 1] + b * change[:, 2]) for k, (r, g, b) in enumerate(XYZ)
        )
        found.append(np.stack([116 * y, 500 * (x - y), 200 * (y - z)], axis=-1))
    return found


def _equations(
    square: list[list[Floats]], right: list[Floats], held: list[npt.NDArray[np.bool_]], damping: Floats
) -> Floats:
    """Solutions (n, m) of m systems of n symmetric equations, by Cholesky's method; unknowns that are held are 0.

    square: the lower triangle, (m,) each. right: n right sides (m,). held: n masks (m,). damping: (m,) added to the
    diagonal.
    """
    n = len(right)
    low = [[np.where(held[i] | held[k], 0.0, square[i][k]) for k in range(i + 1)] for i in range(n)]
    right = [np.where(held[i], 0.0, right[i]) for i in range(n)]
    for i in range(n):
        low[i][i] = np.where(held[i], 1.0, square[i][i] + damping)
    for i in range(n):
        for k in range(i + 1):
            for j in range(k):
                low[i][k] = low[i][k] - low[i][j] * low[k][j]
            low[i][k] = np.sqrt(np.maximum(low[i][i], 1e-12)) if i == k else low[i][k] / low[k][k]
        for k in range(i):
            right[i] = right[i] - low[i][k] * right[k]
        right[i] = right[i] / low[i][i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            right[i] = right[i] - low[k][i] * right[k]
        right[i] = right[i] / low[i][i]
    return np.stack(right)


def _dot(a: Floats, b: Floats) -> Floats:
    """(m,) scalar products of rows (m, 3)."""
    return np.asarray(a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2])


def turns(apart: Sequence[float], n: int) -> list[float]:
    """Degrees by which each of n inks' hatching is turned, so that no two of all directions are near each other.

    apart: degrees by which each layer of the hatching is turned from the first one. One ink after the other takes, of
    72 angles, the one whose directions are farthest from those of the inks before it. Where the best one is nearer than
    15°, only the first layers' directions count.
    """
    found = [0.0]
    others = [0.0, *(a for a in apart if a % 180)]
    while len(found) < n:
        best = max((2.5 * k for k in range(72)), key=lambda t: (_gap(t, found, others), -t))
        if _gap(best, found, others) < 15:
            best = max((2.5 * k for k in range(72)), key=lambda t: (_gap(t, found, [0.0]), -t))
        found.append(best)
    return found


def _gap(turn: float, found: list[float], others: list[float]) -> float:
    """The least angle, modulo 180°, between a direction of an ink with that turn and one of the inks found."""
    angles = [(turn + a - b - c) % 180 for a in others for b in others for c in found]
    return min(min(a, 180 - a) for a in angles)


def lightest_first(inks: Sequence[Colour]) -> list[int]:
    """Numbers of the inks, the lightest first. Drawn first, its pen is not soiled by darker inks."""
    lightness = [lab_of_light(linear(np.array(ink))).tolist()[0] for ink in inks]
    return sorted(range(len(inks)), key=lambda i: -lightness[i])
