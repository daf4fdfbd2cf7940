"""The outlines of strokes that swell, for formats that can only fill a shape.

What a disc covers on its way along a curve B(t) while its radius r(t) changes lies between two curves::

          L = B + r·m          m leans back where the disc grows: with r' the growth by length and T, n the
       B ─────────►            directions along and to the left, m = −r'·T + √(1 − r'²)·n on the left,
          R                    −r'·T − √(1 − r'²)·n on the right

Each side is approximated, a segment at a time, by the Bézier curve that has the same ends and the same derivatives
there: L' = |B'|·(√(1 − r'²) − r·κ)·(m turned right), κ the curvature. `gentle` halves segments until they turn little;
then the curve leaves the true outline by less than a hundredth of the width. (Tiller and Hanson, Offsets of
two-dimensional profiles, 1984, move the control points instead, which is no simpler and less near.)

A stroke is cut into pieces where its outline would meet itself: at corners, where it bends as tightly as it is wide,
and at half turns. The pieces have round ends, so the cuts do not show.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from penink_cli.ground.model import Floats, Ints, Strokes

Mask = npt.NDArray[np.bool_]

#: A segment is halved, at most HALVINGS times, until the legs of its control polygon turn little: the cosine of the
#: angle from one leg to the next is at least STEP_TURN, that from the first to the last at least WHOLE_TURN.
HALVINGS, STEP_TURN, WHOLE_TURN = 6, 0.93, 0.85
#: It is halved, too, while a leg is more than this many times as long, or short, as a third of all three.
UNEVEN = 3.0
#: A piece ends where the cosine of the angle between two segments is less than this.
CORNER = 0.985
#: A piece ends before and after a segment whose outline on the inner side is shorter than this part of the segment.
TIGHT = 0.25
#: A piece ends before the sum of its turns (their sines) exceeds this: what turns less cannot cross itself.
HALF_TURN = 2.8
TINY = 1e-9  # points: a vector that is shorter has no direction


@dataclass(frozen=True, eq=False)
class Segments:
    """Segments of strokes: control points (m, 4, 2), width at both ends (m, 2), and the stroke of each (m,)."""

    points: Floats
    widths: Floats
    owner: Ints

    def halved(self, which: Mask) -> Segments:
        """The segments, those of the mask (m,) in two halves each, by de Casteljau."""
        p, w = self.points[which], self.widths[which]
        ab, bc, cd = (p[:, :-1] + p[:, 1:]).transpose(1, 0, 2) / 2
        abc, bcd = (ab + bc) / 2, (bc + cd) / 2
        middle, width = (abc + bcd) / 2, w.mean(axis=1)
        times = 1 + which.astype(np.int64)
        points, widths = np.repeat(self.points, times, axis=0), np.repeat(self.widths, times, axis=0)
        second = np.cumsum(times)[which] - 1
        points[second - 1] = np.stack([p[:, 0], ab, abc, middle], axis=1)
        points[second] = np.stack([middle, bcd, cd, p[:, 3]], axis=1)
        widths[second - 1, 1] = widths[second, 0] = width
        return Segments(points, widths, np.repeat(self.owner, times))


def gentle(strokes: Strokes, also: Callable[[Floats], Mask] | None = None) -> Segments:
    """The segments of all strokes, halved until each turns little and its parameter goes along at an even pace.

    also: a further condition (m,) on the control points (m, 4, 2) of segments.
    """
    counts = np.diff(strokes.first)
    segments = (counts - 1) // 3
    begins = np.repeat(strokes.first[:-1], segments) + 3 * _within(segments)
    knot = np.repeat(strokes.knots[:-1], segments) + _within(segments)
    at_knots = strokes.at_knots
    found = Segments(
        strokes.points[begins[:, None] + np.arange(4)],
        np.stack([at_knots[knot], at_knots[knot + 1]], axis=1),
        np.repeat(np.arange(len(strokes)), segments),
    )
    for _ in range(HALVINGS):
        rough = ~_even(found.points)
        if also is not None:
            rough |= ~also(found.points)
        if not rough.any():
            break
        found = found.halved(rough)
    # where the disc at one end holds the disc at the other, the segment is a dot: the larger disc
    p, w = found.points, found.widths
    held = _length(p[:, 3] - p[:, 0]) <= np.abs(w[:, 1] - w[:, 0]) / 2
    wider = np.where(w[:, 0] >= w[:, 1], 0, 1)[held]
    p[held] = p[held, 3 * wider][:, None]
    w[held] = w[held, wider][:, None]
    return found


def _within(counts: Ints) -> Ints:
    """0, 1, … within each group of these sizes."""
    return np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)


def _even(points: Floats) -> Mask:
    """Whether a segment turns little and its control points lie at about a third and two thirds of the way."""
    a, b, c = np.diff(points, axis=1).transpose(1, 0, 2)
    long = [_length(leg) for leg in (a, b, c)]
    third = (long[0] + long[1] + long[2]) / 3
    even = (_dot(a, b) >= STEP_TURN * long[0] * long[1]) & (_dot(b, c) >= STEP_TURN * long[1] * long[2])
    even &= _dot(a, c) >= WHOLE_TURN * long[0] * long[2]
    even &= (np.maximum.reduce(long) <= UNEVEN * third) & (np.minimum.reduce(long) * UNEVEN >= third)
    return even | (third < TINY)


def _dot(a: Floats, b: Floats) -> Floats:
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1]


def _cross(a: Floats, b: Floats) -> Floats:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _length(vectors: Floats) -> Floats:
    return np.sqrt(_dot(vectors, vectors))


def _unit(vectors: Floats, otherwise: Floats) -> Floats:
    """Vectors (m, 2) of length 1; `otherwise` where they have none."""
    length = _length(vectors)[:, None]
    return np.where(length > TINY, vectors / np.where(length > TINY, length, 1.0), otherwise)


@dataclass(frozen=True, eq=False)
class SwollenEnds:
    """The course of each segment at its start and its end; along is (m, 2, 2), the others are (m, 2).

    along: direction, a unit vector. bend: |B'| · κ, positive where the curve turns from x towards y. pace: |B'|.
    growth: r', of the radius by length, within ±.95.
    """

    along: Floats
    bend: Floats
    pace: Floats
    growth: Floats


def ends_of(segments: Segments) -> SwollenEnds:
    """Directions, curvatures and growths at both ends of segments."""
    a, b, c = np.diff(segments.points, axis=1).transpose(1, 0, 2)
    chord = _unit(segments.points[:, 3] - segments.points[:, 0], np.array((1.0, 0.0)))
    middle = _unit(b, chord)
    start, end = _unit(a, middle), _unit(c, middle)
    first, last = _length(a), _length(c)
    # |B'|·κ is B' × B'' / |B'|²: at the start 2 (a × b) / |a|², at the end 2 (b × c) / |c|²
    bend = np.stack(
        [
            2 * _cross(a, b) / np.where(first > TINY, first * first, np.inf),
            2 * _cross(b, c) / np.where(last > TINY, last * last, np.inf),
        ],
        axis=1,
    )
    pace = 3 * np.stack([first, last], axis=1)
    grows = (segments.widths[:, 1] - segments.widths[:, 0])[:, None] / 2
    growth = np.clip(grows / np.where(pace > TINY, pace, np.inf), -0.95, 0.95)
    return SwollenEnds(np.stack([start, end], axis=1), bend, pace, growth)


def cuts(segments: Segments, ends: SwollenEnds) -> Mask:
    """(m + 1,) whether a piece begins before each segment, or ends after the last: see the top of this module."""
    m = len(segments.owner)
    cut = np.ones(m + 1, bool)
    if m:
        cut[1:-1] = segments.owner[1:] != segments.owner[:-1]
        cut[1:-1] |= _dot(ends.along[:-1, 1], ends.along[1:, 0]) < CORNER
        inner = ends.pace - segments.widths / 2 * np.abs(ends.bend)
        tight = (inner < TIGHT * ends.pace).any(axis=1) | ~_even(segments.points)
        cut[:-1] |= tight
        cut[1:] |= tight
        turned = np.floor(np.cumsum(np.abs(_cross(ends.along[:, 0], ends.along[:, 1]))) / HALF_TURN)
        cut[1:-1] |= turned[1:] != turned[:-1]
    return cut


def outlines(strokes: Strokes) -> tuple[Floats, Ints]:
    """Closed outlines of all strokes, to be filled by either rule: points (p, 2), and where each begins (n + 1,).

    An outline is a chain of cubic segments, 3k + 1 points whose last is the first again. It goes along the left side,
    which is on the y side of a stroke that runs along x, and back along the right. Outlines of one stroke may overlap.
    """
    segments = gentle(strokes)
    if not len(segments.owner):
        return np.zeros((0, 2)), np.zeros(1, np.int64)
    ends = ends_of(segments)
    cut = cuts(segments, ends)
    along, growth = _shared(ends, ~cut[1:-1])
    radius = segments.widths / 2
    left, right = (_side(segments, ends, along, growth, radius, hand) for hand in (1.0, -1.0))
    return _contours(np.flatnonzero(cut), left, right, segments.points[:, (0, 3)], radius, along, growth)


def _shared(ends: SwollenEnds, inner: Mask) -> tuple[Floats, Floats]:
    """Directions (m, 2, 2) and growths (m, 2), averaged where a piece goes on (m - 1,), so that the sides meet."""
    along, growth = ends.along.copy(), ends.growth.copy()
    along[:-1, 1][inner] = along[1:, 0][inner] = _unit(along[:-1, 1] + along[1:, 0], along[1:, 0])[inner]
    growth[:-1, 1][inner] = growth[1:, 0][inner] = ((growth[:-1, 1] + growth[1:, 0]) / 2)[inner]
    return along, growth


def _side(segments: Segments, ends: SwollenEnds, along: Floats, growth: Floats, radius: Floats, hand: float) -> Floats:
    """Control points (m, 4, 2) of one side, hand 1 for the left and -1 for the right; see `outlines`."""
    normal = np.stack([-along[..., 1], along[..., 0]], axis=-1)
    across = np.sqrt(1 - growth * growth)
    m = -growth[..., None] * along + hand * across[..., None] * normal
    onward = across[..., None] * along + hand * growth[..., None] * normal
    lean = np.maximum(ends.pace * across - hand * radius * ends.bend, 0.0)[..., None] * onward / 3
    at = segments.points[:, (0, 3)] + radius[..., None] * m
    return np.stack([at[:, 0], at[:, 0] + lean[:, 0], at[:, 1] - lean[:, 1], at[:, 1]], axis=1)


def pieces(strokes: Strokes, also: Callable[[Floats], Mask], longest: int) -> Strokes:
    """The strokes in pieces as of `cuts`, of at most `longest` segments each. also: see `gentle`."""
    segments = gentle(strokes, also)
    cut = cuts(segments, ends_of(segments))
    begins = np.flatnonzero(cut)
    cut[:-1] |= _within(np.diff(begins)) % longest == 0
    first = np.flatnonzero(cut)
    whole = _chained(segments.points, first, strokes)
    widths = np.empty(whole.knots[-1])
    widths[np.delete(np.arange(len(widths)), whole.knots[1:] - 1)] = segments.widths[:, 0]
    widths[whole.knots[1:] - 1] = segments.widths[first[1:] - 1, 1]
    return whole.swelling(widths)


def passes(strokes: Strokes, pen: float) -> Strokes:
    """Strokes of one pen: a stroke that swells is covered by a line in its middle and pairs of lines parallel to it.

    pen: width, points. Pair i, from 1, is drawn where the stroke is wider than 2i − 1 pens. It lies a pen further out
    than the pair before, or as far out as the edge of the stroke allows; so it branches off the pair before.
    """
    swells = strokes.swells
    thin = strokes.taken(~swells)
    wide = strokes.taken(swells)
    out = [replace(thin, knot_widths=None), replace(wide, knot_widths=None, widths=np.full(len(wide), pen))]
    segments = gentle(wide)
    if len(segments.owner):
        ends = ends_of(segments)
        cut = cuts(segments, ends)
        along, growth = _shared(ends, ~cut[1:-1])
        for pair in range(1, int(np.ceil(float(segments.widths.max()) / pen / 2 + 0.5))):
            drawn = segments.widths.max(axis=1) > (2 * pair - 1) * pen
            offset = np.clip((segments.widths - pen) / 2, 0.0, pair * pen)
            begins = np.flatnonzero(drawn & (cut[:-1] | ~np.concatenate([[False], drawn[:-1]])))
            first = np.append(np.cumsum(drawn)[begins] - 1, drawn.sum())
            for hand in (1.0, -1.0):
                side = _side(segments, ends, along, 0 * growth, offset, hand)[drawn]
                out.append(replace(_chained(side, first, wide), widths=np.full(len(first) - 1, pen)))
    return Strokes.joined(out)


def _chained(segments: Floats, first: Ints, sheet: Strokes) -> Strokes:
    """Strokes of segments (m, 4, 2) on a sheet like that of `sheet`; stroke i begins with segment first[i] (s + 1,)."""
    begins = np.zeros(len(first), np.int64)
    np.cumsum(3 * np.diff(first) + 1, out=begins[1:])
    points = np.empty((int(begins[-1]), 2))
    points[begins[:-1]] = segments[first[:-1], 0]
    piece, j = np.repeat(np.arange(len(first) - 1), np.diff(first)), _within(np.diff(first))
    points[(begins[piece] + 1 + 3 * j)[:, None] + np.arange(3)] = segments[:, 1:]
    return replace(sheet, points=points, first=begins, widths=np.ones(len(first) - 1), knot_widths=None)


def _contours(
    begins: Ints, left: Floats, right: Floats, knots: Floats, radius: Floats, along: Floats, growth: Floats
) -> tuple[Floats, Ints]:
    """Closed outlines, as of `outlines`: of each piece the left side, a round end, the right side, a round end.

    begins: (n + 1,) the first segment of each piece. left, right: (m, 4, 2) control points of the sides. knots: (m, 2,
    2) both ends of the segments; radius, along, growth: there.
    """
    start, end = begins[:-1], begins[1:] - 1
    k = end - start + 1
    first = np.zeros(len(k) + 1, np.int64)
    np.cumsum(3 * (2 * k + 4) + 1, out=first[1:])
    points = np.empty((int(first[-1]), 2))
    points[first[:-1]] = left[start, 0]
    piece, j = np.repeat(np.arange(len(k)), k), _within(k)
    there = (first[piece] + 1 + 3 * j)[:, None] + np.arange(3)
    points[there] = left[:, 1:]
    back = (first[piece] + 1 + 3 * (k[piece] + 2) + 3 * (k[piece] - 1 - j))[:, None] + np.arange(3)
    points[back] = right[:, 2::-1]
    for at, segment, which, where in (
        (first[:-1] + 1 + 3 * k, end, 1, 1.0),
        (first[:-1] + 1 + 3 * (2 * k + 2), start, 0, -1.0),
    ):
        ahead = where * along[segment, which]
        lean = where * growth[segment, which]
        points[at[:, None] + np.arange(6)] = _round_end(knots[segment, which], radius[segment, which], ahead, lean)
    points[first[1:] - 1] = points[first[:-1]]
    return points, first


def _round_end(centre: Floats, radius: Floats, ahead: Floats, growth: Floats) -> Floats:
    """Two cubic segments (n, 6, 2), without their first points, from the left side of a piece's end to the right.

    ahead: (n, 2) the direction in which the piece ends.
    """
    left = np.stack([-ahead[:, 1], ahead[:, 0]], axis=1)
    sine, lean = np.sqrt(1 - growth * growth)[:, None], -growth[:, None]  # of the angle from ahead to the side
    half = np.sqrt((1 - lean) / 2) / (1 + np.sqrt((1 + lean) / 2))  # tan of a quarter of the angle
    reach = 4 / 3 * half
    r = radius[:, None]
    one, other = lean * ahead + sine * left, lean * ahead - sine * left
    return np.stack(
        [
            centre + r * (one + reach * (sine * ahead - lean * left)),
            centre + r * (ahead + reach * left),
            centre + r * ahead,
            centre + r * (ahead - reach * left),
            centre + r * (other + reach * (sine * ahead + lean * left)),
            centre + r * other,
        ],
        axis=1,
    )
