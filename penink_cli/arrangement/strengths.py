"""How strong each edge is: the grey step across it, measured between what lies on its two sides.

Near pixels tell it, and where noise or another edge nearby hides it from them, farther ones and the neighbours along
the line: each only as far as the picture itself shows that they tell of the same step. Flat pictures are averaged
widely, photographs hardly (`_farther`, `_change`). On 20 rendered scenes 1.1 to 1.7 of a hundred edges are off by more
than .02 of grey; with four levels of noise and 1.5 pixels of blur it was 12. Another draw of the noise moves at most
.9. The rest is in the edges: of their places a scene without noise and blur tells no better, as near junctions they lie
up to a pixel off (`python -m tests.benchmarks.edges strengths noisy`).
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from penink_cli.arrangement._compiled import steps as _steps
from penink_cli.geometry import edge_index, walls
from penink_cli.ground import exact
from penink_cli.ground import threads as threading
from penink_cli.ground.model import EdgeList, Floats, Ints

_CELL_PX = 4.0
_TASK = 1000  # edges
_OWN = 0.2  # variance, pixels², that a pixel's area adds to the blur, and edges a little off their places
_CLEAN = 1.6  # blurs from an edge a pixel has little of the other side, which is reckoned out
_MIXED = 2.6  # beyond so many it has none
_ASTRAY = 0.1  # pixels that an edge may be off its place: what is reckoned out is unsure by that
_MOST_DOUBT = 0.02  # grey: the most that this adds to a step's deviation
_BEYOND = (4.5, 7.0, 11.0)  # pixels farther are asked: the first always, the others where noise leaves it unsure
_SURE = 0.003  # grey: the deviation of a step that is sure enough
_BELIEVED = 2.0  # deviations that far pixels may differ by from near ones, and tell of the same thing
_ALIKE = 3.5  # deviations that neighbours may differ by, and have the same step
_NEIGHBOURS = 6  # to either side, along a line
_PIECE_PX = 12.0  # an edge is looked at once in so much of its length
_LEAST_NOISE = 0.0005  # grey: no step is known better
_TELLING = 20  # places: fewer do not tell what the picture is like
_MOST, _OF_MOST = 0.9, 2.706  # a part of all, and what it of a standard normal's squares does not exceed
_PARTS = 32  # of a pixel, and of the bell curve's deviation, in tables


def strengths(grey: npt.NDArray[np.floating], edges: EdgeList, lens: float, noise: float = 0.0) -> Floats:
    """The grey step (m,) across each edge, 0 … 1; below 0 where one side has no pixel, as along the frame.

    Args:
        grey: (h, w) the photo, 0 … 1.
        edges: in its frame.
        lens: standard deviation, pixels, of the blur that the photo was taken with.
        noise: standard deviation of its pixels' noise, grey.

    """
    height, width = grey.shape
    blur = min(float(exact.hypot(lens, np.sqrt(_OWN))), (_steps.MAX_REACH - _BEYOND[-1]) / _CLEAN)
    ends = np.column_stack(walls.segments(edges, width, height))
    photo = _steps.Photo(
        np.ascontiguousarray(grey, np.float32),
        walls.distances(edges, width, height, _MIXED * blur),
        walls.walls(edges, width, height),
        edge_index.grid(ends, _CELL_PX, width, height),
        _mixed(blur),
        _PARTS,
        _CLEAN * blur,
    )
    length = exact.length(ends[:, 2:] - ends[:, :2])
    pieces = np.maximum(1, np.ceil(length / _PIECE_PX)).astype(np.int64)
    edge = np.repeat(np.arange(len(ends)), pieces)
    which = np.arange(len(edge)) - np.repeat(np.cumsum(pieces) - pieces, pieces)

    def seen(some: Ints, reach: float) -> tuple[Floats, Floats]:
        told = np.empty((len(some), 3))
        on, at = edge[some].astype(np.int32), (which[some] + 1) / (pieces[edge[some]] + 1)

        def part(first: int, last: int) -> None:
            photo.measure(on, at, reach, first, last, told)

        threading.share(threading.ranges(part, len(some), _TASK), threading.count(None))
        step, noisy, mixed = told.T
        # _CLEAN blurs from an edge, a mixture becomes less by twice itself in a blur
        doubt = np.minimum(np.abs(2 * _ASTRAY / blur * mixed * step), _MOST_DOUBT)
        variance = noisy * noise * noise + doubt * doubt + _LEAST_NOISE * _LEAST_NOISE
        return step, np.where(noisy >= 0, variance, np.inf)

    step, variance = _farther(seen, len(edge), _CLEAN * blur)
    known = np.isfinite(variance)
    onward = _onward(edges.edges, edge, which, pieces)
    each = (length / pieces)[edge]
    change = _change(step, variance, each, onward)
    step = _agreed(*_unblended(step, variance, each, onward, change), each, onward, change)
    return np.minimum(_middles(np.where(known, np.abs(step), np.inf), edge, len(ends)), 1)


def _farther(seen: Callable[[Ints, float], tuple[Floats, Floats]], count: int, near: float) -> tuple[Floats, Floats]:
    """The steps (count,) and their variances, by pixels as far away as noise asks for and the picture allows.

    What far pixels tell differs from what near ones do by noise, and by what else the picture shows there. The second
    is told by all places together. Where it is less than what noise gains, the far ones are believed.

    Args:
        seen: steps and variances by places' numbers and a reach; infinite where a side is not seen.
        count: of places.
        near: how far from an edge clean pixels begin.

    """
    step, variance = seen(np.arange(count), near + _BEYOND[0])
    unsure = np.flatnonzero(np.isfinite(variance) & (variance > _SURE * _SURE))
    for beyond in _BEYOND[1:]:
        if len(unsure) < _TELLING:
            break
        farther, less = seen(unsure, near + beyond)
        apart = (farther - step[unsure]) ** 2
        gain = np.maximum(variance[unsure] - less, 0)
        strange = max(0.0, _quantile(apart - _OF_MOST * gain, _MOST) / _OF_MOST)
        better = (gain > strange) & (apart <= _BELIEVED * _BELIEVED * (gain + strange))
        unsure = unsure[better]
        step[unsure], variance[unsure] = farther[better], less[better] + strange
        unsure = unsure[variance[unsure] > _SURE * _SURE]
    return step, variance


def _onward(ends: Ints, edge: Ints, which: Ints, pieces: Ints) -> Ints:
    """What follows (2 n,) each of n pieces walked along (k) or back (n + k), told likewise; -1 at junctions."""
    n = len(edge)
    first = np.cumsum(pieces) - pieces
    last = first + pieces - 1
    along = np.where(which < pieces[edge] - 1, np.arange(n) + 1, -1)
    back = np.where(which > 0, np.arange(n) - 1 + n, -1)
    onward = np.concatenate([along, back])
    vertex = np.concatenate([ends[:, 1], ends[:, 0]])
    leaving = np.concatenate([last, n + first])  # for that vertex
    entering = np.concatenate([n + last, first])  # from it
    order = np.argsort(vertex, kind="stable")
    begins = np.flatnonzero(np.diff(vertex[order], prepend=-1))
    pairs = begins[np.diff(np.append(begins, len(order))) == 2]
    a, b = order[pairs], order[pairs + 1]
    onward[leaving[a]] = entering[b]
    onward[leaving[b]] = entering[a]
    return onward


def _unblended(
    step: Floats, variance: Floats, length: Floats, onward: Ints, change: float
) -> tuple[Floats, Floats]:
    """The steps and their variances (n,), where a line passes from one thing to another those of the nearer of both.

    If no edge parts the two things just there, pixels tell of both, and the step lies between those before and behind.
    These are believed where each is like the next one on its side.
    """
    n = len(step)
    own = step, variance, length
    sides = []
    for back in (False, True):
        state = np.arange(n) + n * back
        for _ in range(2):
            state = np.where(state >= 0, onward[state], -1)
            piece = state % n
            there = np.where((state >= n) == back, step[piece], -step[piece])
            sides.append((there, np.where(state >= 0, variance[piece], np.inf), length[piece]))
    before, far_before, behind, far_behind = sides

    def alike(a: tuple[Floats, Floats, Floats], b: tuple[Floats, Floats, Floats]) -> npt.NDArray[np.bool_]:
        noise = a[1] + b[1]
        spread = noise + 0.5 * change * (a[2] + b[2])
        same: npt.NDArray[np.bool_] = np.isfinite(noise) & ((a[0] - b[0]) ** 2 <= _ALIKE * _ALIKE * spread)
        return same

    blend = alike(before, far_before) & alike(behind, far_behind) & np.isfinite(variance)
    blend &= ~alike(own, before) & ~alike(own, behind) & ((step - before[0]) * (step - behind[0]) < 0)
    nearer = np.abs(step - before[0]) < np.abs(step - behind[0])
    step = np.where(blend, np.where(nearer, before[0], behind[0]), step)
    return step, np.where(blend, np.where(nearer, before[1], behind[1]), variance)


def _agreed(step: Floats, variance: Floats, length: Floats, onward: Ints, change: float) -> Floats:
    """The steps (n,), each averaged with those along its line as far as noise and the picture make them alike.

    Each counts by how sure it is and how near, and by how much steps change along lines, which all lines together tell.
    What lies beyond one that differs by more counts no more.
    """
    n = len(step)
    total, weights = step / variance, 1 / variance
    for back in (False, True):
        state = np.arange(n) + n * back
        piece, away, on = np.arange(n), np.zeros(n), np.isfinite(variance)
        for _ in range(_NEIGHBOURS):
            state = onward[state]
            on &= state >= 0
            if not on.any():
                break
            before, piece = piece, state % n
            away += 0.5 * (length[before] + length[piece])
            there = np.where((state >= n) == back, step[piece], -step[piece])
            spread = variance[piece] + change * away
            on &= (there - step) ** 2 <= _ALIKE * _ALIKE * (variance + spread)
            weight = np.where(on, 1 / spread, 0)
            total += weight * there
            weights += weight
    return np.where(weights > 0, total / np.where(weights > 0, weights, 1), step)


def _change(step: Floats, variance: Floats, length: Floats, onward: Ints) -> float:
    """By how much steps change along lines: variance a pixel, beyond that of noise.

    Most lines change little and some a lot, so what nine of ten do not exceed counts, not the median.
    """
    n = len(step)
    piece = np.flatnonzero((onward[:n] >= 0) & np.isfinite(variance))
    state = onward[piece]
    piece, state = piece[np.isfinite(variance[state % n])], state[np.isfinite(variance[state % n])]
    if len(piece) < _TELLING:
        return np.inf
    then = state % n
    apart = np.where(state < n, step[then], -step[then]) - step[piece]
    beyond = apart * apart - _OF_MOST * (variance[piece] + variance[then])
    return max(0.0, 2 * _quantile(beyond / (0.5 * (length[piece] + length[then])), _MOST))


def _quantile(values: Floats, part: float) -> float:
    return float(np.partition(values, at := int(part * (len(values) - 1)))[at])


def _middles(values: Floats, group: Ints, count: int) -> Floats:
    """The median (count,) of each group's finite values; -1 for none."""
    order = np.lexsort((values, group))
    finite = np.bincount(group[np.isfinite(values)], minlength=count)
    first = np.searchsorted(group, np.arange(count))
    low, high = (order[np.minimum(first + k, len(order) - 1)] for k in (np.maximum(finite - 1, 0) // 2, finite // 2))
    return np.where(finite > 0, 0.5 * (values[low] + values[high]), -1)


def _mixed(blur: float) -> Floats:
    """The part of a blurred step's one side that is the other's, by the distance from it in parts of a pixel."""
    z = (np.arange(8 * _PARTS) + 0.5) / _PARTS  # of the bell curve's deviation
    bell = exact.exp(-0.5 * z * z)
    above = np.append(np.cumsum(bell[::-1])[::-1], 0.0)
    at = np.arange(math.ceil(_MIXED * blur * _PARTS) + 1) / _PARTS / blur
    return np.interp(at, np.arange(len(above)) / _PARTS, 0.5 * above / above[0])
