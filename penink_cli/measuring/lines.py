"""How strokes lie: how evenly beside one another, how long they are, how often a pen is lifted."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from penink_cli.blasting import curves
from penink_cli.ground import exact
from penink_cli.ground.model import Floats, Ints, Strokes
from penink_cli.travel.order import drawn_length, travel_length

STEP_PT = 1.5  # between the places along strokes that are looked at
REACH_PT = 9.0  # strokes farther apart are not seen as neighbours
PARALLEL = 0.966  # the cosine of 15 degrees
NEAREST_PT = 0.05  # strokes nearer than that are one line
PLACES = 10_000  # about as many places, spread over all strokes, tell evenness
LIFT_PT = 0.05  # a stroke that begins nearer than that to the end of the one before needs no lift


@dataclass(frozen=True)
class LineFigures:
    """How strokes lie. Lengths are in points.

    evenness: 1 where each stroke lies midway between its neighbours, 0 where it touches one; None where no stroke has
    neighbours on both sides. lifts, travel_pt: of the pen between strokes in their order; travel from layer to layer is
    left out.
    """

    evenness: float | None
    strokes: int
    length_pt: float
    mean_length_pt: float
    lifts: int
    travel_pt: float


def figures(layers: Sequence[Strokes]) -> LineFigures:
    """The figures of all layers, at least one, drawn one after the other."""
    count = sum(map(len, layers))
    drawn = [layer for layer in layers if len(layer)]
    length = math.fsum(drawn_length(layer) for layer in drawn)
    lifts = sum(map(_lifts, drawn)) + max(0, len(drawn) - 1)  # whole numbers
    travel = math.fsum(travel_length(layer) for layer in layers if len(layer) > 1)
    return LineFigures(evenness(Strokes.joined(layers)), count, length, length / max(1, count), lifts, travel)


def _lifts(strokes: Strokes) -> int:
    """How often the pen is lifted between strokes."""
    ends, starts = strokes.points[strokes.first[1:-1] - 1], strokes.points[strokes.first[1:-1]]
    return int(np.count_nonzero(exact.length(starts - ends) > LIFT_PT))


def places(strokes: Strokes, step: float) -> tuple[Floats, Ints]:
    """Points (p, 2) along all strokes, about `step` points apart, and the stroke of each (p,)."""
    lines = curves.sample(strokes.points, strokes.first, curves.pieces_of(strokes.points, strokes.first, step))
    return lines.points, np.repeat(np.arange(len(strokes)), np.diff(lines.first))


def evenness(strokes: Strokes) -> float | None:
    """How evenly strokes lie between neighbours that run the same way within 15 degrees; None where there are none.

    At a place on a stroke, a and b are the distances across it to the next strokes on either side. The result is the
    mean of 1 - |a - b| / (a + b). It says nothing of tone, and does not depend on direction or scale.
    """
    if len(strokes) < 3:
        return None
    points, owner = places(strokes, STEP_PT)
    after = np.minimum(np.arange(1, len(points) + 1), len(points) - 1)
    before = np.maximum(np.arange(-1, len(points) - 1), 0)
    forward = np.where(owner[after] == owner, after, np.arange(len(points)))
    backward = np.where(owner[before] == owner, before, np.arange(len(points)))
    way = points[forward] - points[backward]
    size = exact.length(way)
    usable = size > 0
    way[usable] /= size[usable, None]
    tree = cKDTree(points)
    chosen = np.flatnonzero(usable)[:: max(1, int(usable.sum()) // PLACES)]
    scores = []
    for begin in range(0, len(chosen), 1000):
        some = chosen[begin : begin + 1000]
        found = tree.query_ball_point(points[some], REACH_PT)
        counts = np.array([len(f) for f in found])
        here, there = np.repeat(some, counts), np.concatenate([np.asarray(f, np.int64) for f in found])
        offset = points[there] - points[here]
        along = offset[:, 0] * way[here, 0] + offset[:, 1] * way[here, 1]
        across = offset[:, 1] * way[here, 0] - offset[:, 0] * way[here, 1]
        parallel = np.abs(way[there, 0] * way[here, 0] + way[there, 1] * way[here, 1]) >= PARALLEL
        beside = (owner[there] != owner[here]) & parallel & (np.abs(along) <= STEP_PT) & (np.abs(across) > NEAREST_PT)
        row = np.repeat(np.arange(len(some)), counts)[beside]
        left, right = np.full(len(some), np.inf), np.full(len(some), np.inf)
        np.minimum.at(left, row, np.where(across[beside] < 0, -across[beside], np.inf))
        np.minimum.at(right, row, np.where(across[beside] > 0, across[beside], np.inf))
        both = np.isfinite(left) & np.isfinite(right)
        scores.append(1 - np.abs(left[both] - right[both]) / (left[both] + right[both]))
    all_scores = np.concatenate(scores) if scores else np.zeros(0)
    return float(all_scores.mean()) if len(all_scores) else None
