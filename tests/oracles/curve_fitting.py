"""An independent fit of smooth curves, in numpy: what `blasting.curve_fitting` must give, to rounding."""

from __future__ import annotations

import math

import numpy as np

from penink_cli.ground.model import Floats

ROUNDS = 4  # of moving points along the curve before it is given up and split
WORTH = 16.0  # squared error, in squared tolerances, from which those rounds are not tried


def fit(points: Floats, tolerance: float, ring: bool = False) -> Floats:
    """Control points (3k + 1, 2) of k cubic Bézier segments that pass all of points (n, 2) within tolerance.

    The curve begins and ends at the first and last point and is smooth in between. A ring's last point is
    its first, and the curve is smooth there too.
    """
    if len(points) < 2:
        return points[:1].copy()
    begin = _direction(points[: _REACH + 1])
    end = _direction(points[: -_REACH - 2 : -1])
    if ring and len(points) > 2 * _REACH:
        begin = _direction(np.concatenate([points[-_REACH:-1], points[:_REACH]]))
        end = -begin
    pieces = [points[:1]]
    todo = [(0, len(points) - 1, begin, end)]
    while todo:
        i, j, leaving, arriving = todo.pop()
        control, worst = _piece(points[i : j + 1], leaving, arriving, tolerance)
        if worst is None:
            pieces.append(control[1:])
            continue
        k = i + worst
        across = _direction(points[max(i, k - _REACH) : min(j, k + _REACH) + 1])
        todo.append((k, j, across, arriving))
        todo.append((i, k, leaving, -across))
    return np.concatenate(pieces)


_REACH = 4  # points to each side that tell a direction


def _direction(points: Floats) -> Floats:
    """Unit vector from the first towards the last of these points, the mean of all steps weighted to the middle."""
    step = points[-1] - points[0]
    length = _length(step)
    if length == 0:
        step = points[len(points) // 2] - points[0]
        length = _length(step) or 1.0
    return np.asarray(step / length)


def _length(step: Floats) -> float:
    return math.sqrt(step[0] * step[0] + step[1] * step[1])


def _piece(points: Floats, leaving: Floats, arriving: Floats, tolerance: float) -> tuple[Floats, int | None]:
    """One segment's control points (4, 2), and the worst point to split it at or None where it serves."""
    chord = points[-1] - points[0]
    if len(points) == 2:
        return np.stack([points[0], points[0] + chord / 3, points[1] - chord / 3, points[1]]), None
    steps = np.sqrt(((points[1:] - points[:-1]) ** 2).sum(axis=1))
    t = np.concatenate([[0.0], np.cumsum(steps)])
    t /= t[-1]
    for attempt in range(ROUNDS + 1):
        control = _least_squares(points, t, leaving, arriving)
        off = _at(control, t) - points
        error = (off * off).sum(axis=1)
        worst = int(np.argmax(error))
        if error[worst] <= tolerance * tolerance:
            return control, None
        if error[worst] > WORTH * tolerance * tolerance or attempt == ROUNDS:
            break
        t = _nearer(control, t, off)
    return control, min(max(worst, 1), len(points) - 2)


def _least_squares(points: Floats, t: Floats, leaving: Floats, arriving: Floats) -> Floats:
    """The cubic with these ends and end directions whose handles fit the points best at parameters t."""
    s = 1 - t
    b0, b1, b2, b3 = s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t
    rest = points - (b0 + b1)[:, None] * points[0] - (b2 + b3)[:, None] * points[-1]
    # Sums, whose order is fixed, and not products of BLAS, whose order is the machine's.
    c00, c01, c11 = (b1 * b1).sum(), (b1 * b2).sum() * (leaving * arriving).sum(), (b2 * b2).sum()
    x0 = (b1 * (rest * leaving).sum(axis=1)).sum()
    x1 = (b2 * (rest * arriving).sum(axis=1)).sum()
    chord = points[-1] - points[0]
    length = _length(chord)
    determinant = c00 * c11 - c01 * c01
    if determinant > 1e-12 * c00 * c11:
        first, second = (x0 * c11 - x1 * c01) / determinant, (c00 * x1 - c01 * x0) / determinant
    else:
        first = second = -1.0
    along = max(length, 1e-12)
    path = np.sqrt(((points[1:] - points[:-1]) ** 2).sum(axis=1)).sum()
    if not (1e-3 * along < first < path and 1e-3 * along < second < path):  # a loop, or handles turned round
        first = second = length / 3
    return np.stack([points[0], points[0] + leaving * first, points[-1] + arriving * second, points[-1]])


def _at(control: Floats, t: Floats) -> Floats:
    """Points (n, 2) of one cubic at parameters t (n,)."""
    s = 1 - t
    weights = np.stack([s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t], axis=1)
    return np.asarray((weights[:, :, None] * control).sum(axis=1))


def _nearer(control: Floats, t: Floats, off: Floats) -> Floats:
    """Parameters one step of Newton's nearer to those of the curve's points nearest to the given ones."""
    s = 1 - t
    d = 3 * (control[1:] - control[:-1])
    dd = 2 * (d[1:] - d[:-1])
    first = (s * s)[:, None] * d[0] + (2 * s * t)[:, None] * d[1] + (t * t)[:, None] * d[2]
    second = s[:, None] * dd[0] + t[:, None] * dd[1]
    slope = (first * first).sum(axis=1) + (off * second).sum(axis=1)
    step = np.where(np.abs(slope) > 1e-12, (off * first).sum(axis=1) / np.where(slope == 0, 1, slope), 0)
    return np.maximum.accumulate(np.clip(t - step, 0, 1))
