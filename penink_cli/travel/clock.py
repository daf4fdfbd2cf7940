"""How long a plotter takes: lifts, acceleration and corners count.

The pen has a constant acceleration a and a top speed. It may pass a corner only so fast that a round corner with this
acceleration would leave it by no more than the distance δ (`Motion.corner`)::

    v² = a · δ · s / (1 − s)        s = sin(φ / 2), φ the angle between the two legs: 1 straight on, 0 back again

This is the cornering rule of Grbl; the constants are those that the plotter program saxi has for an AxiDraw. Between
corners the pen speeds up and slows down: its speed at each place is the greatest from which all that follows can be
obeyed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from penink_cli.ground import exact
from penink_cli.ground.model import Floats, Ints, Strokes
from penink_cli.ground.units import POINT_MM

STILL = 1e-6  # points: a shorter leg is left out
FLAT_MM = 0.02  # how far the chords by which a curve is drawn may be from it


@dataclass(frozen=True)
class Motion:
    """Top speed in mm/s, acceleration in mm/s², and how far a corner may be cut, in mm."""

    speed: float
    acceleration: float
    corner: float = 0.127


@dataclass(frozen=True)
class Plotter:
    """down, up: the motion with the pen down and up. lift: seconds for raising the pen, and as many for lowering it."""

    down: Motion = Motion(50.0, 200.0)
    up: Motion = Motion(200.0, 400.0, 0.0)
    lift: float = 0.12


def seconds(layers: Sequence[Strokes], plotter: Plotter, x: float = 0.0, y: float = 0.0) -> float:
    """Seconds from the page's corner, where the pen rests, over all strokes in their order, and back.

    x, y: the sheet's corner on the page, points.
    """
    return seconds_by_speeds([(layer, None) for layer in layers], plotter, x, y)


def seconds_by_speeds(
    layers: Sequence[tuple[Strokes, float | None]], plotter: Plotter, x: float = 0.0, y: float = 0.0
) -> float:
    """As `seconds`, each layer with the speed of its pen when it is down, points a second; None for the plotter's."""
    total = 0.0
    at = np.zeros((1, 2))
    for layer, speed in layers:
        if not len(layer):
            continue
        place = np.array((x, y))
        starts, ends = ((layer.points[i] + place) * POINT_MM for i in (layer.first[:-1], layer.first[1:] - 1))
        ways = starts - np.concatenate([at, ends[:-1]])
        total += _added(from_rest(exact.length(ways), plotter.up)) + 2 * plotter.lift * len(layer)
        down = plotter.down if speed is None else replace(plotter.down, speed=speed * POINT_MM)
        total += _added(drawn_seconds(layer, down))
        at = ends[-1:]
    return total + _added(from_rest(exact.length(at), plotter.up))


def _added(values: Floats) -> float:
    """The sum of values, each rounded to millionths: sums of whole numbers are the same on every machine."""
    return int(np.rint(values * 1e6).astype(np.int64).sum()) / 1e6


def from_rest(length: Floats, motion: Motion) -> Floats:
    """Seconds (n,) for straight ways of that length (n,), mm, from rest to rest."""
    v, a = motion.speed, motion.acceleration
    return np.asarray(np.where(length * a >= v * v, length / v + v / a, 2.0 * np.sqrt(length / a)))


def drawn_seconds(strokes: Strokes, motion: Motion) -> Floats:
    """Seconds (s,) for each stroke from rest to rest, its curves drawn as chords."""
    points, first = chords(strokes)
    points = points * POINT_MM
    count = np.diff(first)
    order = np.argsort(-count, kind="stable")  # most chords first: strokes that have a k-th chord stand together
    begins, count = first[:-1][order], count[order]
    most = int(count.max(initial=1)) - 1
    if most < 1:
        return np.zeros(len(strokes))
    legs = np.diff(points, axis=0)
    length = exact.length(legs)
    limit = _corners(legs, length, motion)  # squared, at the beginning of each leg but the first
    twice = 2.0 * motion.acceleration
    speed = np.zeros(len(points))  # squared, at each point
    having = [int(np.searchsorted(-count, -(k + 1), side="left")) for k in range(most)]  # how many have a k-th leg
    for k in range(1, most):  # speeding up: no faster than the way so far allows
        at = begins[: having[k]] + k
        speed[at] = np.minimum(limit[at - 1], speed[at - 1] + twice * length[at - 1])
    for k in range(most - 1, 0, -1):  # slowing down in time for what lies ahead
        at = begins[: having[k]] + k
        speed[at] = np.minimum(speed[at], speed[at + 1] + twice * length[at])
    total = np.zeros(len(strokes))
    top = motion.speed * motion.speed
    for k in range(most):
        at = begins[: having[k]] + k
        one, other, way = speed[at], speed[at + 1], length[at]
        peak = np.minimum((one + other + twice * way) / 2, top)
        fast, root = np.sqrt(peak), np.sqrt(one) + np.sqrt(other)
        cruise = np.maximum(way - (2 * peak - one - other) / twice, 0.0)
        total[: having[k]] += (2 * fast - root) / motion.acceleration + cruise / np.where(fast > 0, fast, 1.0)
    result = np.zeros(len(strokes))
    result[order] = total
    return result


def _corners(legs: Floats, length: Floats, motion: Motion) -> Floats:
    """Squared speed (n - 1,) at which the corner between each leg and the next may be passed."""
    product = length[:-1] * length[1:]
    dot = legs[:-1, 0] * legs[1:, 0] + legs[:-1, 1] * legs[1:, 1]
    cosine = np.clip(dot / np.where(product > 0, product, 1.0), -1.0, 1.0)
    sine = np.sqrt((1.0 + cosine) / 2)
    bend = np.maximum(1.0 - sine, 1e-9)
    allowed = np.minimum(motion.acceleration * motion.corner * sine / bend, motion.speed * motion.speed)
    return np.asarray(np.where(product > 0, allowed, 0.0))


def chords(strokes: Strokes) -> tuple[Floats, Ints]:
    """Points (p, 2) of the polylines as which strokes are drawn, and where each stroke's points begin (s + 1,).

    A segment is cut evenly into so many chords that none is farther than FLAT_MM from the curve.
    """
    counts = np.diff(strokes.first)
    segments = (counts - 1) // 3
    inner = np.arange(len(strokes.points)) - np.repeat(strokes.first[:-1], counts)
    begins = np.flatnonzero((inner % 3 == 0) & (inner < np.repeat(counts, counts) - 1))
    control = strokes.points[begins[:, None] + np.arange(4)]
    second = np.maximum(
        exact.length(control[:, 0] - 2 * control[:, 1] + control[:, 2]),
        exact.length(control[:, 1] - 2 * control[:, 2] + control[:, 3]),
    )
    pieces = np.maximum(np.ceil(np.sqrt(second * (6 * POINT_MM / (8 * FLAT_MM)))), 1).astype(np.int64)
    which = np.repeat(np.arange(len(pieces)), pieces)
    t = ((np.arange(len(which)) - np.repeat(np.cumsum(pieces) - pieces, pieces) + 1) / pieces[which])[:, None]
    p = control[which]
    for _ in range(3):
        p = p[:, :-1] + (p[:, 1:] - p[:, :-1]) * t[:, :, None]
    per_stroke = np.zeros(len(strokes), np.int64)
    owner = np.repeat(np.arange(len(strokes)), segments)
    np.add.at(per_stroke, owner, pieces)
    first = np.zeros(len(strokes) + 1, np.int64)
    np.cumsum(per_stroke + 1, out=first[1:])
    points = np.empty((int(first[-1]), 2))
    points[first[:-1]] = strokes.points[strokes.first[:-1]]
    rest = np.ones(len(points), bool)
    rest[first[:-1]] = False
    points[rest] = p[:, 0]
    kept = ~rest  # first points, and those to which the pen moves
    kept[1:] |= exact.length(points[1:] - points[:-1]) > STILL
    return points[kept], np.concatenate([[0], np.cumsum(kept)])[first]


def drawn_by_stroke(strokes: Strokes) -> Floats:
    """Length (s,) of each stroke, points, by its chords."""
    points, first = chords(strokes)
    legs = exact.length(np.diff(points, axis=0))
    legs[first[1:-1] - 1] = 0.0  # from one stroke to the next
    whole = np.rint(legs * 1e6).astype(np.int64)
    up_to = np.concatenate([[0], np.cumsum(whole)])
    last = np.append(first[1:-1], len(points)) - 1
    return np.asarray((up_to[last] - up_to[first[:-1]]) / 1e6)


def split(strokes: Strokes, most: float) -> list[Strokes]:
    """The strokes in their order, in groups of at most `most` points; a longer stroke is a group by itself."""
    groups, begin, used = [], 0, 0.0
    for i, length in enumerate(drawn_by_stroke(strokes).tolist()):
        if used and used + length > most + 1e-3:
            groups.append(strokes.taken(np.arange(begin, i)))
            begin, used = i, 0.0
        used += length
    return [*groups, strokes.taken(np.arange(begin, len(strokes)))]


def with_one_pen(strokes: Strokes, width: float) -> Strokes:
    """The strokes as a pen of that width draws them, along their middles."""
    return replace(strokes, widths=np.full(len(strokes), width), knot_widths=None)
