"""Noise averaged along chains: neighbours tell the position of an edge point too."""

from __future__ import annotations

import numpy as np

from penink_cli.arrangement._compiled import smoothing as _smoothing
from penink_cli.arrangement.chains import Chains
from penink_cli.arrangement.gradient import EdgePoints
from penink_cli.ground import exact
from penink_cli.ground.median import median
from penink_cli.ground.model import Floats

_OWN_ERROR = 0.01  # pixels: of a point in a picture without noise
_SMOOTHEST, _ROUGHEST = 0.03, 2.0  # pixels: third difference of neighbouring points, on drawn curves and in fur
_MOST_MOVED = 0.3  # of their error, by which half of the points may be moved: 0.17 on drawn curves at any noise
_OVERLAP = 24  # points by which a ring runs on into itself


def position_error(points: EdgePoints, noise: float, sigma: float, blur: float) -> Floats:
    """Standard deviation (n,) of the points' positions across the edge, pixels.

    The second derivative of white noise under a Gaussian of standard deviation σ has the variance
    3 noise² / 16 π σ⁶; an edge of gradient g whose whole blur is b has the slope g / b² there.
    Neighbouring points share a stretch of 2 σ of noise, which counts as if each had that much more.
    """
    unrest = noise * np.sqrt(3 / (16 * np.pi)) / (sigma * sigma * sigma)
    return exact.hypot(_OWN_ERROR, np.sqrt(2 * sigma) * unrest * blur * blur / np.maximum(points.magnitude, 1e-6))


def smooth(position: Floats, chains: Chains, error: Floats) -> Floats:
    """Positions (n, 2) with those of each chain on a smooth curve, as smooth as their errors (n,) ask for.

    The picture tells how smooth its things are. Curves are as stiff as they can be without moving points
    by more than their errors explain (the discrepancy principle).
    """
    if not len(chains):
        return position
    count = np.diff(chains.first)
    over = np.where(chains.ring, np.minimum(count, _OVERLAP), 0)
    length = count + 2 * over
    first = np.concatenate([[0], np.cumsum(length)]).astype(np.int32)
    run = np.repeat(np.arange(len(chains)), length)
    own = np.arange(len(run)) - first[run] - over[run]
    order = chains.order[chains.first[run] + own % count[run]]
    inner = (own >= 0) & (own < count[run])
    room = np.empty((len(run), 4))
    roughness = _SMOOTHEST
    while True:
        places = np.ascontiguousarray(position[order])
        _smoothing.smooth(places, roughness**2 / error[order] ** 2, first, room)
        moved = exact.length(places - position[order]) / error[order]
        if roughness > _ROUGHEST or median(moved[inner]) <= _MOST_MOVED:
            break
        roughness *= 2
    smoothed = position.copy()
    smoothed[order[inner]] = places[inner]
    return smoothed


def unbend(points: EdgePoints, chains: Chains, blur: float) -> Floats:
    """Positions (n, 2) of all edge points with what blur has shifted on curves undone.

    Under a Gaussian of standard deviation s, the steepest place on the rim of a disc of radius R
    lies s²/2R inside the rim. So each point of a chain moves against its curvature by that much.
    At a corner the curvature is the blur's own, and this gives back a part of the corner's point.
    """
    position = points.position.copy()
    if not len(chains):
        return position
    p = points.position[chains.order]
    owner = chains.owner
    first, length = chains.first[:-1][owner], np.diff(chains.first)[owner]
    ring = chains.ring[owner]
    step = max(3, round(2 * blur))
    place = np.arange(len(p)) - first
    middle = np.where(ring, place, np.clip(place, step, length - 1 - step))
    here = p[first + np.clip(middle, 0, length - 1)]
    before = p[first + (middle - step) % length]
    after = p[first + (middle + step) % length]
    back, on = here - before, after - here
    far, near = exact.length(back)[:, None], exact.length(on)[:, None]
    bend = 2 * (on / np.maximum(near, 1e-9) - back / np.maximum(far, 1e-9)) / np.maximum(far + near, 1e-9)
    bend[length < 2 * step + 1] = 0
    shift = -0.5 * blur * blur * bend
    size = exact.length(shift)[:, None]
    position[chains.order] += shift * np.minimum(1, 0.5 * blur / np.maximum(size, 1e-9))
    return position
