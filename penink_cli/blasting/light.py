"""Small light things in the dark: a star, a white letter, a catchlight. Strokes end where they begin.

What is finer than its strokes no texture leaves out: they lie across it. So strokes are cut there, by half of what is
painted before its border; the black around it is filled by `solids`.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from penink_cli.blasting import curves, marks
from penink_cli.blasting.sheet import resample
from penink_cli.ground.masks import distance, near
from penink_cli.ground.model import Floats, Strokes

#: The tone is looked at so finely, pixels in a point, and strokes at such steps.
FINE, STEP_PT = 4.0, 0.25
#: What is left of a stroke must be so long, in parts of what is painted, or it was a fleck.
SHORTEST = 1.5


class LightThings:
    """Small light things in the black of a tone (h, w), on a sheet of that size.

    there: (rows, columns) what is in one, `px` pixels to a point. none: whether there are none.
    """

    def __init__(self, tone: Floats, width_pt: float, height_pt: float):
        h, w = tone.shape
        self.there = np.zeros((h, w), np.bool_)
        self.px = math.sqrt(w * h / (width_pt * height_pt))
        if (tone > 1 - marks.PAPER).any() and (tone < marks.LEVEL).any():
            for top, left, mine, _ in marks.things(1 - tone, self.px):
                rows, columns = mine.shape
                self.there[top : top + rows, left : left + columns] |= mine
        self.none = not self.there.any()
        if self.none:
            return
        part = resample(self.there.astype(np.float64), *(math.ceil(FINE * side) for side in (height_pt, width_pt)))
        fine = resample(tone, *part.shape)
        # half way between light and dark, more exactly than the tone's own pixels have it
        self.away: Floats = distance(~((part > 0.0) & (fine < marks.LEVEL))) / FINE

    def within(self, reach_pt: float) -> marks.Mask:
        """(h, w) of the tone: what is no further from one than this."""
        return near(~self.there, reach_pt * self.px)

    def kept_out(self, strokes: Strokes, gain_pt: float) -> Strokes:
        """The strokes, cut where a device that paints them wider by gain_pt would ink a light thing."""
        if self.none or not len(strokes):
            return strokes
        pieces = curves.pieces_of(strokes.points, strokes.first, STEP_PT)
        lines = curves.sample(strokes.points, strokes.first, pieces)
        count = np.diff(lines.first)
        who = np.repeat(np.arange(len(strokes)), count)
        x, y = (np.clip(v * FINE, 0, n - 1).astype(np.int64) for v, n in zip(lines.points.T, self.away.shape[::-1]))
        widths = self._widths(strokes, pieces, lines.first)
        free = self.away[y, x] >= (widths + gain_pt) / 2 - 0.5 / FINE
        touched = np.zeros(len(strokes), np.bool_)
        touched[who[~free]] = True
        if not touched.any():
            return strokes
        key = np.concatenate([[-1], np.where(free & touched[who], who, -1), [-1]])
        change = np.flatnonzero(key[1:] != key[:-1])
        begin = change[key[change + 1] >= 0]
        end = change[np.searchsorted(change, begin) + 1] - 1
        curve = who[begin]
        long = (end - begin) * STEP_PT >= SHORTEST * (strokes.widths[curve] + gain_pt)
        begin, end, curve = begin[long], end[long], curve[long]
        a, b = begin - lines.first[curve], end - lines.first[curve]
        points, first = curves.cut(strokes.points, strokes.first, pieces, curve, a.astype(float), b.astype(float))
        cut = Strokes(strokes.width, strokes.height, points, first, strokes.widths[curve])
        if strokes.knot_widths is not None:
            cut = cut.swelling(self._knots(cut, widths, begin, end, pieces, strokes, curve))
        return Strokes.joined([strokes.taken(~touched), replace(cut, device_dpi=strokes.device_dpi)])

    @staticmethod
    def _widths(strokes: Strokes, pieces: np.ndarray, first: np.ndarray) -> Floats:
        """The width at each sample of the strokes."""
        if strokes.knot_widths is None:
            return np.repeat(strokes.widths, np.diff(first))
        k = curves.segments_of(strokes.first)
        left = np.repeat(strokes.knots[:-1], k) + curves.ramp(k)
        part = np.repeat(np.arange(len(pieces)), pieces)
        t = curves.ramp(pieces) / pieces[part]
        inner = strokes.knot_widths[left][part] * (1 - t) + strokes.knot_widths[left + 1][part] * t
        out = np.empty(int(first[-1]))
        last = first[1:] - 1
        rest = np.ones(len(out), np.bool_)
        rest[last] = False
        out[rest] = inner
        out[last] = strokes.knot_widths[strokes.knots[1:] - 1]
        return out

    @staticmethod
    def _knots(
        cut: Strokes, widths: Floats, begin: np.ndarray, end: np.ndarray, pieces: np.ndarray, strokes: Strokes,
        curve: np.ndarray,
    ) -> Floats:  # fmt: skip
        """The width at each knot of what has been cut: of the samples that they were."""
        out = []
        where = curves.starts(pieces)
        segment = curves.starts(curves.segments_of(strokes.first))
        samples = where[segment] + np.arange(len(segment))  # a sample more than pieces for each stroke
        for i, (a, b, c) in enumerate(zip(begin.tolist(), end.tolist(), curve.tolist())):
            inner = where[segment[c] : segment[c + 1] + 1] - where[segment[c]] + samples[c]
            at = [a, *(v for v in inner.tolist() if a < v < b), b]
            assert len(at) == int(cut.knots[i + 1] - cut.knots[i])
            out.append(widths[at])
        return np.concatenate(out) if out else np.zeros(0)
