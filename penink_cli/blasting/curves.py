"""Chains of cubic Béziers: cutting them at parameters and sampling them, many at a time.

The curves of a set lie one after the other, `points` and `first` as in `ground.model.Strokes`:
curve i owns points[first[i] : first[i + 1]], 3k + 1 of them, or one for a dot.

This module alone imports the compiled kernel `curves`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from penink_cli.blasting._compiled import curves as _curves
from penink_cli.ground.model import Floats, Ints


def ramp(counts: Ints) -> Ints:
    """0 … counts[0]-1, 0 … counts[1]-1, … as one array.

    >>> ramp(np.array([2, 0, 3])).tolist()
    [0, 1, 0, 1, 2]
    """
    ends = np.cumsum(counts)
    return np.arange(int(ends[-1]) if len(ends) else 0) - np.repeat(ends - counts, counts)


def starts(counts: Ints) -> Ints:
    """(n + 1,) where each of n consecutive groups begins, and the end of the last."""
    out = np.zeros(len(counts) + 1, np.int64)
    np.cumsum(counts, out=out[1:])
    return out


@dataclass(frozen=True, eq=False)
class Polylines:
    """points: (p, 2); first: (n + 1,) polyline i owns points[first[i] : first[i + 1]]."""

    points: Floats
    first: Ints


def take(lines: Polylines, which: Ints, shift: Floats) -> Polylines:
    """Copies of some of the polylines (or curves), each moved by shift (n, 2)."""
    sizes = np.diff(lines.first)[which]
    begin = starts(sizes)
    at = np.repeat(lines.first[which] - begin[:-1], sizes) + np.arange(begin[-1])
    return Polylines(lines.points[at] + np.repeat(shift, sizes, axis=0), begin)


def segments_of(first: Ints) -> Ints:
    """Number of cubic segments of each curve; none for a dot."""
    return (np.diff(first) - 1) // 3


def begins_of(first: Ints) -> Ints:
    """(m,) at which of the points each cubic segment of all curves begins."""
    k = segments_of(first)
    return np.asarray(np.repeat(first[:-1], k) + 3 * ramp(k), np.int64)


def pieces_of(points: Floats, first: Ints, step: float) -> Ints:
    """Into how many pieces of about step each cubic segment is sampled, by its control polygon."""
    legs = np.diff(points, axis=0)
    length = np.sqrt(legs[:, 0] ** 2 + legs[:, 1] ** 2)
    at = begins_of(first)
    total = length[at] + length[at + 1] + length[at + 2]
    return np.maximum(1, np.ceil(total / step - 1e-9)).astype(np.int64)


def sample(points: Floats, first: Ints, pieces: Ints) -> Polylines:
    """Each segment's start and inner samples, and the last point of each curve; a dot is one point."""
    owner = np.repeat(np.arange(len(first) - 1), segments_of(first))
    begin = starts(np.bincount(owner, weights=pieces, minlength=len(first) - 1).astype(np.int64) + 1)
    out = np.empty((begin[-1], 2))
    _curves.sample(np.ascontiguousarray(points), first, pieces, begin, out)
    return Polylines(out, begin)


def blossom(control: Floats, a: Floats, b: Floats) -> Floats:
    """The cubics (m, 4, 2) cut to parameters a … b (m,): the polar form at aaa, aab, abb, bbb."""

    def at(r: Floats, s: Floats, t: Floats) -> Floats:
        rr, ss, tt = r[:, None], s[:, None], t[:, None]
        p = control[:, :3] + rr[..., None] * (control[:, 1:] - control[:, :3])
        p = p[:, :2] + ss[..., None] * (p[:, 1:] - p[:, :2])
        return p[:, 0] + tt * (p[:, 1] - p[:, 0])

    return np.stack([at(a, a, a), at(a, a, b), at(a, b, b), at(b, b, b)], axis=1)


def cut(points: Floats, first: Ints, pieces: Ints, curve: Ints, a: Floats, b: Floats) -> tuple[Floats, Ints]:
    """Parts of curves: part i is curve[i] from a[i] to b[i], counted in samples (see `sample`), whole or not.

    Returns points and first of the parts. A part of a dot is the dot.
    """
    segments, run = starts(segments_of(first)), starts(pieces)
    points, curve = np.ascontiguousarray(points), np.ascontiguousarray(curve, np.int64)
    a, b = np.array(a, np.float64), np.array(b, np.float64)  # which are clipped
    within = np.empty((len(curve), 2), np.int64)
    _curves.extents(segments, run, curve, a, b, within)
    begin = starts(3 * (within[:, 1] - within[:, 0]) + 1)
    out = np.empty((begin[-1], 2))
    _curves.cut(points, first, segments, run, curve, a, b, within, begin, out)
    return out, begin
