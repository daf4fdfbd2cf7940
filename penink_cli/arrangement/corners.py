"""Corners that blur has rounded, given back their points. This module alone imports the compiled kernel `corners`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from penink_cli.arrangement._compiled import corners as _corners_kernel
from penink_cli.arrangement.chains import Chains
from penink_cli.arrangement.gradient import EdgePoints
from penink_cli.ground import exact
from penink_cli.ground.model import Floats

Ints32 = npt.NDArray[np.int32]

_STRETCHES = (16, 12, 8, 5)  # points on each side of a corner that tell where it lies: the more, the less noise
_TIP_STRETCHES = (12, 8)  # likewise, of an acute corner, which blur bends farther
_LEAST_TURN, _LEAST_TIP_TURN, _MOST_TURN = 0.7, 1.8, 2.6  # radians
_BOW = 0.3  # pixels by which a stretch may bend
_DOUBT = 0.7  # standard deviations of the turn that the stretches' own bend explains, held against a corner


@dataclass(frozen=True, eq=False)
class Sharpened:
    """Chains whose corners are single points.

    position: (n, 2) of all edge points; chains: without the points that blur has pulled inward; a
    ring with corners begins at one. pieces: the chains cut at their corners, which are in none.
    """

    position: Floats
    chains: Chains
    pieces: Chains


def sharpen(points: EdgePoints, chains: Chains, blur: float, error: Floats) -> Sharpened:
    """Where a chain turns sharply between two straight stretches, prolong the stretches to where they cross.

    blur: standard deviation (pixels) of the whole blur, which is how far a corner is rounded.
    error: (n,) standard deviation of the points' positions.
    """
    position = points.position.copy()
    p, unsure = position[chains.order], error[chains.order]
    owner = chains.owner
    first, length, ring = chains.first[:-1][owner], np.diff(chains.first)[owner], chains.ring[owner]
    place = np.arange(len(p)) - first
    is_corner, left_out = np.zeros(len(p), bool), np.zeros(len(p), bool)
    blunt, tip = round(1.5 * blur) + 1, round(3 * blur) + 1
    tries = [_Corner(blunt, stretch, _LEAST_TURN, 1.6 * blur) for stretch in _STRETCHES]
    tries += [_Corner(tip, stretch, _LEAST_TIP_TURN, float(tip)) for stretch in _TIP_STRETCHES]
    for wanted in tries:
        far = wanted.skip + wanted.stretch
        at = np.flatnonzero((length > 2 * far) & (ring | ((place >= far) & (place < length - far))))
        for k, corner, span in _corners(p, unsure[at], first[at], place[at], length[at], at, wanted, points.shape):
            if (left_out[span] | is_corner[span]).any():
                continue
            left_out[span] = True
            left_out[k], is_corner[k] = False, True
            position[chains.order[k]] = corner
    return _cut(position, chains, is_corner, left_out)


class _Corner(NamedTuple):
    """What a corner is: between two stretches of so many points that begin `skip` points from it, a turn (radians)
    of at least so much, no more than so far (pixels) from the chain.
    """

    skip: int
    stretch: int
    least_turn: float
    most_shift: float


def _corners(
    p: Floats,
    unsure: Floats,
    first: Ints32,
    place: npt.NDArray[np.intp],
    length: npt.NDArray[np.intp],
    at: npt.NDArray[np.intp],
    wanted: _Corner,
    shape: tuple[int, int],
) -> Iterator[tuple[int, Floats, npt.NDArray[np.intp]]]:
    """Each corner's chain entry, x and y, and the entries it stands for; those amid their bends first.

    p: (e, 2) places of all chain entries. at: (k,) entries that may be corners; of each the `unsure` place's standard
    deviation, the first entry of its chain, its place in that, and the chain's length.
    shape: height and width of the picture, within which corners lie.
    """
    skip, stretch, least_turn, most_shift = wanted
    t = np.arange(stretch) - (stretch - 1) / 2
    square = t * t - (t * t).mean()
    weights = np.stack([t / (t * t).sum(), square / (square * square).sum()])
    chain = tuple(np.ascontiguousarray(part, np.int64) for part in (first, place, length))

    def line(sign: int) -> tuple[Floats, Floats, Floats]:
        """Where the straight stretch that begins `skip` away begins, its direction towards the corner, its bow."""
        mean, slope, bend = found = np.empty((3, len(at), 2))
        _corners_kernel.stretches(p, *chain, sign * skip, sign, weights, found)
        size = np.maximum(1e-9, exact.length(slope))[:, None]
        return mean - slope * (stretch - 1) / 2, -slope / size, bend * (stretch - 1) ** 2 / 4

    before, back, bow_back = line(-1)
    after, on, bow_on = line(1)
    turn = exact.acos(np.clip(-(back * on).sum(axis=1), -1, 1))
    way = np.sign(cross(back, -on))
    bows = [way * cross(back, bow_back), way * cross(bow_on, on)]  # positive where they bend as the corner does
    # What a circle that bends as the stretches do would turn in between.
    steady = 4 * (bows[0] + bows[1]) / stretch**2 * (2 * skip + stretch)
    corner, ahead, behind = crossing(before, back, after, on)
    shift = exact.length(corner - p[at])
    inside = ((corner > 0) & (corner < shape[::-1])).all(axis=1)
    bow_error = unsure * np.sqrt(2 / (square * square).sum()) * (stretch - 1) ** 2 / 4
    doubt = 4 * bow_error / stretch**2 * (2 * skip + stretch)
    good = (turn - np.maximum(0, steady) - _DOUBT * doubt > least_turn) & (turn < _MOST_TURN) & inside
    good &= np.maximum(np.abs(bows[0]), np.abs(bows[1])) < _BOW
    good &= (ahead > 0) & (behind > 0) & (np.maximum(ahead, behind) < 2 * skip) & (shift < most_shift)
    # The middle of a corner is where both stretches are equally far from it.
    chosen = np.flatnonzero(good)
    for k in chosen[np.lexsort((at[chosen], np.abs(ahead[chosen] - behind[chosen])))]:
        yield at[k], corner[k], first[k] + (place[k] + np.arange(-skip + 1, skip)) % length[k]


def _cut(
    position: Floats, chains: Chains, is_corner: npt.NDArray[np.bool_], left_out: npt.NDArray[np.bool_]
) -> Sharpened:
    owner, length, begin = chains.owner, np.diff(chains.first), chains.first[:-1]
    touched = np.logical_or.reduceat(is_corner, begin)
    shift = np.zeros(len(chains), np.int64)
    corners = np.flatnonzero(is_corner)[::-1]
    shift[owner[corners]] = corners - begin[owner[corners]]  # the last to be written is each chain's first
    shift[~chains.ring] = 0
    turned = begin[owner] + (np.arange(len(owner)) - begin[owner] + shift[owner]) % length[owner]
    turned = turned[~left_out[turned]]
    order, owner, corner = chains.order[turned], owner[turned], is_corner[turned]
    starts = np.ones(len(order), bool)
    starts[1:] = (owner[1:] != owner[:-1]) | corner[:-1]
    counts = np.bincount(owner, minlength=len(chains))
    whole = Chains(order, np.concatenate([[0], np.cumsum(counts)]).astype(np.int32), chains.ring)
    piece = (np.cumsum(starts) - 1)[~corner]
    ring = (chains.ring & ~touched)[owner[~corner]]
    at = np.flatnonzero(np.diff(piece, prepend=-1))
    pieces = Chains(order[~corner], np.append(at, len(piece)).astype(np.int32), ring[at])
    return Sharpened(position, whole, pieces)


def cross(a: Floats, b: Floats) -> Floats:
    """Third component (n,) of vectors' (n, 2) cross product."""
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def crossing(p: Floats, d: Floats, q: Floats, e: Floats) -> tuple[Floats, Floats, Floats]:
    """Where lines p + s d and q + t e cross, with s and t; infinite where they are within 20 degrees of parallel."""
    across = cross(d, e)
    parallel = np.abs(across) < 0.35
    across = np.where(parallel, 1.0, across)
    between = q - p
    s, t = cross(between, e) / across, cross(between, d) / across
    s, t = np.where(parallel, np.inf, s), np.where(parallel, np.inf, t)
    return p + d * np.where(parallel, 0, s)[:, None], s, t
