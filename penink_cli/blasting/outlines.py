"""Outline strokes (section 3): chains of discontinuity edges as smooth strokes of the pen.

Edges are followed as a pen would, straight on at junctions. Runs that are strong and long enough are
chosen, the most telling first. A run that comes too close to ink already there is left out: double
edges, small prints and layers that share an outline would clog. What remains is fitted with curves,
which break at corners only. This module alone imports the compiled kernel.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import curve_fitting, curves
from penink_cli.blasting._compiled import outlines as _outlines
from penink_cli.blasting.constants import CLEAR, PIECE, PRESSURE, PRESSURE_LONG, SHORTEST, TAPER, THIN
from penink_cli.geometry.trails import trails
from penink_cli.ground.model import EdgeList, Floats, Ints, OutlineChoice, Strokes

TOLERANCE = 0.5  # pixels of the edge list that a curve may stray from its chain: about what edges are found to
TOLERANCE_PT = 0.12  # or so much on paper, if that is more
STEP = 1.0  # pixels between the points that curves are fitted to
ARM = 3.0  # pixels to each side that tell whether a vertex is a corner
CORNER = 0.64  # cosine of the bend, 50°, from which it is one
ONWARD = 0.5  # cosine of the sharpest bend that a stroke takes at a junction
LIGHT = 0.5  # of the pen's width, for the faintest edges
FULL = 0.4  # strength from which an edge gets all of it


@dataclass(frozen=True, eq=False)
class Run:
    """Part of a chain: vertices (n, 2) in pixels of the edge list, whether it closes on itself.

    trail, edges: the numbers of its n vertices and n - 1 edges.
    strength: the mean along it, 0 … 1. weight: how telling it is, strength times length.
    """

    vertices: Floats
    trail: list[int]
    edges: list[int]
    ring: bool
    strength: float
    weight: float

    @property
    def pressure(self) -> float:
        """Of the pen's width, how much it gets: less the fainter it is."""
        return LIGHT + (1 - LIGHT) * min(1.0, self.strength / FULL)


def outline(
    edges: EdgeList,
    width_pt: float,
    height_pt: float,
    choice: OutlineChoice,
    around: npt.NDArray[np.bool_] | None = None,
    ink: Strokes | None = None,
) -> Strokes:
    """Outline strokes for a sheet of width_pt × height_pt.

    around: (m,) the edges to choose from (those around the regions of the choice), None for all.
    ink: strokes that are on the sheet already and are not to be doubled.
    """
    scale = np.array([width_pt / edges.width, height_pt / edges.height])
    pixel_pt = float(min(scale))
    clear = Clearance(width_pt, height_pt, CLEAR * choice.pen_pt)
    if ink is not None and len(ink):
        clear.take(_dots(ink, clear.cell))
    controls: list[Floats] = []
    pens: list[float] = []
    for run in runs(edges, choice, around):
        points = _outlines.resampled(run.vertices, STEP)
        for part, ring in clear.free(points * scale, run.ring, SHORTEST * choice.pen_pt):
            tolerance = max(TOLERANCE, TOLERANCE_PT / pixel_pt)
            controls.append(_smooth(points[part], ring, tolerance) * scale)
            pens.append(choice.pen_pt if choice.even else run.pressure * choice.pen_pt)
        clear.take(points * scale)
    if choice.even:
        return _strokes([(control, np.array([pen])) for control, pen in zip(controls, pens)], width_pt, height_pt)
    return _strokes(_swelling(controls, pens), width_pt, height_pt)


# ------------------------------------------------------------------- which edges


def runs(edges: EdgeList, choice: OutlineChoice, around: npt.NDArray[np.bool_] | None) -> list[Run]:
    """Chains, or the parts of them that are strong enough, the most telling first.

    Those are all above half of min_strength that reach it somewhere. around: as in `outline`.
    """
    chosen = np.arange(len(edges.edges)) if around is None else np.flatnonzero(around)
    ends, strength = edges.edges[chosen], None if edges.strength is None else edges.strength[chosen]
    lengths = np.sqrt(((edges.vertices[ends[:, 0]] - edges.vertices[ends[:, 1]]) ** 2).sum(axis=1))
    chains = trails(edges.vertices, ends, ONWARD)
    if not chains:
        return []
    along = np.concatenate([chain for _, chain in chains])  # all chains, one after another
    first = curves.starts(np.array([len(chain) for _, chain in chains]))
    of = np.repeat(np.arange(len(chains)), np.diff(first))
    mean = np.ones(len(along)) if strength is None else _smoothed(strength[along], lengths[along], of)
    strong = mean >= 0.5 * choice.min_strength
    found = []
    for i, j in _stretches(strong, first[1:-1]):
        if mean[i:j].max() < choice.min_strength:
            continue
        here = lengths[along[i:j]]
        length = float(here.sum())
        if length < choice.min_length:
            continue
        weight = float((mean[i:j] * here).sum())
        vertices, begin = chains[of[i]][0], i - int(first[of[i]])
        trail = vertices[begin : begin + j - i + 1]
        ring = j - i == len(vertices) - 1 and vertices[0] == vertices[-1]
        found.append(Run(edges.vertices[trail], trail, chosen[along[i:j]].tolist(), ring, weight / length, weight))
    return sorted(found, key=lambda run: (-run.weight, *run.vertices[0]))


def _smoothed(strength: Floats, lengths: Floats, of: Ints, reach: int = 2) -> Floats:
    """Strength along chains, averaged over its neighbours by length; of: (n,) which chain each is in."""
    total, weight = np.zeros(len(strength)), np.zeros(len(strength))
    for shift in range(-reach, reach + 1):
        here = slice(max(0, shift), len(strength) + min(0, shift))
        there = slice(max(0, -shift), len(strength) + min(0, -shift))
        counts = np.where(of[here] == of[there], lengths[there], 0.0)
        total[here] += strength[there] * counts
        weight[here] += counts
    return total / weight


def _stretches(wanted: npt.NDArray[np.bool_], cuts: Ints | None = None) -> list[tuple[int, int]]:
    """First and one past the last of each stretch of True; none goes on over a cut."""
    edge = np.diff(wanted.astype(np.int8), prepend=0, append=0)
    begins, ends = edge == 1, edge == -1
    if cuts is not None:
        over = cuts[wanted[cuts] & wanted[cuts - 1]]
        begins[over] = ends[over] = True
    return list(zip(np.flatnonzero(begins).tolist(), np.flatnonzero(ends).tolist()))


class Clearance:
    """Which places of a sheet are close to ink, on cells of half the distance to keep."""

    def __init__(self, width_pt: float, height_pt: float, distance_pt: float):
        self.cell = max(distance_pt / 2, math.sqrt(width_pt * height_pt / 5e7))
        self._taken = np.zeros((int(height_pt / self.cell) + 6, int(width_pt / self.cell) + 6), np.uint8)

    def take(self, points: Floats) -> None:
        """There is ink at points (n, 2)."""
        _outlines.take(points, self.cell, self._taken)

    def free(self, points: Floats, ring: bool, shortest_pt: float) -> list[tuple[slice, bool]]:
        """The parts of a run of points (n, 2) that are clear of ink, each with whether it is the whole ring."""
        clear = np.empty(len(points), np.bool_)
        if _outlines.free(points, self.cell, self._taken, clear.view(np.uint8)):
            return [(slice(0, len(points)), ring)]
        steps = np.concatenate([[0.0], np.cumsum(np.sqrt(((points[1:] - points[:-1]) ** 2).sum(axis=1)))])
        long_enough = [(i, j) for i, j in _stretches(clear) if j - i > 1 and steps[j - 1] - steps[i] >= shortest_pt]
        return [(slice(i, j), False) for i, j in long_enough]


def _dots(strokes: Strokes, step: float) -> Floats:
    """Points along strokes, no further apart than step."""
    pieces = curves.pieces_of(strokes.points, strokes.first, step)
    return curves.sample(strokes.points, strokes.first, pieces).points


# ------------------------------------------------------------------- smooth curves


def _smooth(points: Floats, ring: bool, tolerance: float) -> Floats:
    """Control points (3k + 1, 2) through points (n, 2), with corners where the chain has them."""
    corners = _outlines.corners(points, ring, max(1, round(ARM / STEP)), CORNER)
    if ring and corners:
        begin = corners[0]
        points = np.concatenate([points[begin:-1], points[: begin + 1]])
        corners, ring = [corner - begin for corner in corners[1:]], False
    cuts = [0, *corners, len(points) - 1]
    pieces = [curve_fitting.fit(points[i : j + 1], tolerance, ring) for i, j in pairwise(cuts) if j > i]
    return np.concatenate([pieces[0], *(piece[1:] for piece in pieces[1:])])


# ------------------------------------------------------------------- the pen's pressure


def _swelling(controls: list[Floats], pens: list[float]) -> list[tuple[Floats, Floats]]:
    """Curves in short pieces, each a segment, and the width of each: thin tips, a slow waver between.

    All are cut together, and wavered together; only what adds up along a curve is reckoned curve by curve.
    """
    if not controls:
        return []
    sizes = np.array([len(control) // 3 for control in controls])
    segments = np.concatenate([
        np.stack([control[:-1:3], control[1::3], control[2::3], control[3::3]], axis=1) for control in controls
    ])  # fmt: skip
    rough = np.sqrt(((segments[:, 1:] - segments[:, :-1]) ** 2).sum(axis=2)).sum(axis=1)
    counts = np.maximum(1, np.ceil(rough / PIECE)).astype(np.int64)
    which = np.repeat(np.arange(len(counts)), counts)
    k = curves.ramp(counts)
    pieces = curves.blossom(segments[which], k / counts[which], (k + 1) / counts[which])
    lengths = rough[which] / counts[which]
    ends = np.cumsum(counts)[np.cumsum(sizes) - 1].tolist()  # of each curve, one past its last piece
    spans = [slice(i, j) for i, j in zip([0, *ends], ends)]
    middle = np.concatenate([np.cumsum(lengths[span]) - lengths[span] / 2 for span in spans])
    each = np.diff([0, *ends])
    total = np.repeat([float(lengths[span].sum()) for span in spans], each)
    first, last = (np.array([control[i] for control in controls]) for i in (0, -1))
    ring = np.repeat((np.abs(first - last) < 1e-9).all(axis=1), each)
    t = np.where(ring, 1.0, np.clip(np.minimum(middle, total - middle) / np.minimum(TAPER, total / 2), 0, 1))
    taper = THIN + (1 - THIN) * t * (2 - t)
    pen = np.repeat(pens, each)
    width = pen * taper * (1 + PRESSURE * _noise(middle / PRESSURE_LONG, np.repeat(first, each, axis=0)))
    width = np.maximum(np.round(width / pen * 20) / 20, 0.3) * pen
    return [(pieces[span].reshape(-1, 2), width[span]) for span in spans]


def _noise(at: Floats, place: Floats) -> Floats:
    """Smooth noise -1 … 1 at places (n,) along lines, from hashes of the places (n, 2) where these begin."""
    x, y = np.floor(place * 16).astype(np.int64).T
    key = (((x * 73856093) ^ (y * 19349663)) & 0xFFFFFFFF).astype(np.uint64)
    i = np.floor(at).astype(np.int64)

    def value(knot: Ints) -> Floats:
        hashed = knot.astype(np.uint64) * np.uint64(2654435761) + key
        hashed = (hashed ^ (hashed >> np.uint64(15))) * np.uint64(2246822519) & np.uint64(0xFFFFFFFF)
        hashed = (hashed ^ (hashed >> np.uint64(13))) * np.uint64(3266489917) & np.uint64(0xFFFFFFFF)
        return (hashed >> np.uint64(8)).astype(np.float64) / (1 << 23) - 1

    before, after, t = value(i), value(i + 1), at - i
    return np.asarray(before + (after - before) * t * t * (3 - 2 * t))


def _strokes(parts: list[tuple[Floats, Floats]], width_pt: float, height_pt: float) -> Strokes:
    """Curves with one width each, or pieces (4 points each) with a width each; equal neighbours are one stroke."""
    points: list[Floats] = []
    counts: list[int] = []
    widths: list[float] = []
    for control, width in parts:
        if len(width) == 1:
            points.append(control)
            counts.append(len(control))
            widths.append(float(width[0]))
            continue
        pieces = control.reshape(-1, 4, 2)
        change = np.flatnonzero(np.diff(width) != 0) + 1
        for i, j in zip([0, *change.tolist()], [*change.tolist(), len(width)]):
            points.append(np.concatenate([pieces[i, :1], pieces[i:j, 1:].reshape(-1, 2)]))
            counts.append(3 * (j - i) + 1)
            widths.append(float(width[i]))
    first = np.zeros(len(counts) + 1, np.int64)
    np.cumsum(counts, out=first[1:])
    at = np.concatenate(points) if points else np.zeros((0, 2))
    return Strokes(width_pt, height_pt, at, first, np.array(widths))
