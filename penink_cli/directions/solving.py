"""The smooth field that follows the evidence: a screened Poisson equation on a grid whose links edges cut.

(λ L + κ w + p) x = d + p f. L is the Laplacian of the grid, whose links are cut where strong edges pass. w is the
weight of the evidence, d its vectors, f the hatch's own direction, which everywhere has the small weight p. Evidence is
not smoothed before: that would leak across edges.

A line field cannot avoid singularities, places around which it makes half a turn. But it need not have more of them
than the picture has: the evidence around each is weakened, and the equation solved again. Knots and whorls of lines are
what the eye objects to most.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.composition.filters import blurred
from penink_cli.directions._compiled import field as kernel
from penink_cli.ground.model import Floats

SMOOTH = 5.0  # λ
_KEEP = 0.3  # κ: evidence pulls with its whole weight, and is held by a third of it
_CUT = 1e-4  # part of a link's weight that is left where an edge cuts it
_CALMED = 8  # how often evidence is weakened at the most
_AROUND = 2.2  # σ, samples: within it evidence around a singularity is weakened
_WEAKEN = 0.6  # part of the evidence that is taken away at a singularity
_PEAK = 0.0329  # the greatest value of a Gaussian of that σ
_CLOSE = 1e-5  # relative error of the solution: a thousandth of a degree
_MOST = 2000  # rounds of the solver; some 100 are usual


def solved(
    vectors: Floats,
    weight: Floats,
    fixed: npt.NDArray[np.bool_],
    cut: tuple[Floats, Floats],
    own: tuple[float, float],
    pull: float,
) -> tuple[Floats, Floats]:
    """The field x (h, w, 2), vectors of any length, and the part (h, w), 0 … 1, of each that comes from evidence.

    vectors, weight: evidence, (h, w, 2) and (h, w). fixed: (h, w) evidence that is never weakened.
    cut: as of `evidence.links`. own: the hatch's own direction, a double-angle unit vector. pull: p, above 0.
    """
    right, down = (SMOOTH * np.maximum(1 - plane, _CUT) for plane in cut)
    h, w = weight.shape
    keep = np.ones((h, w))
    planes = np.zeros((h, w, 3))  # x without the hatch's own direction, and the factor of that
    room = np.empty((4, h, w, 3))
    for calmed in range(_CALMED + 1):
        target = np.dstack([vectors * keep[..., None], np.full((h, w), pull)])
        kernel.solve(right, down, _KEEP * weight * keep + pull, target, planes, room, _CLOSE, _MOST)
        x = planes[..., :2] + planes[..., 2:] * np.array(own)
        knots = singular(x, cut) if calmed < _CALMED else np.zeros((h, w), bool)
        if not knots.any():
            break
        blob = np.minimum(blurred(knots.astype(np.float32), _AROUND).astype(np.float64) / _PEAK, 1.0)
        keep = np.where(fixed, 1.0, keep * (1 - _WEAKEN * blob))
    length = np.sqrt(planes[..., 0] * planes[..., 0] + planes[..., 1] * planes[..., 1])
    return x, length / (length + planes[..., 2])


def singular(x: Floats, cut: tuple[Floats, Floats]) -> npt.NDArray[np.bool_]:
    """Which samples (h, w) are the upper left of four around which x (h, w, 2) makes a turn, the line field half one.

    Four samples that edges part are left out. cut: as of `evidence.links`.
    """
    around = (x[:-1, :-1], x[:-1, 1:], x[1:, 1:], x[1:, :-1])
    turns = np.zeros((x.shape[0] - 1, x.shape[1] - 1), np.int64)
    for a, b in zip(around, around[1:] + around[:1], strict=True):
        # how often the side from a to b crosses the positive half of the first axis, upwards less downwards
        rises = (a[..., 1] < 0) & (b[..., 1] >= 0)
        falls = (a[..., 1] >= 0) & (b[..., 1] < 0)
        left = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
        turns += (rises & (left > 0)).astype(np.int64) - (falls & (left < 0))
    right, down = cut
    parted = right[:-1, :-1] + right[1:, :-1] + down[:-1, :-1] + down[:-1, 1:] > 1
    found = np.zeros(x.shape[:2], bool)
    found[:-1, :-1] = (turns != 0) & ~parted
    return found
