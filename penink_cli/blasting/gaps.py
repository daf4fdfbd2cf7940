"""Lines that are left white when black is filled: tapered, each with a stroke to either side of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from penink_cli.blasting import curve_fitting, curves, polylines
from penink_cli.ground.device import MEAN
from penink_cli.ground.model import Floats, Strokes

#: How far a stroke may stray from its place, points.
TOLERANCE_PT = 0.02
#: By how much the strokes to the two sides of a line pass its middle beyond its ends, points.
OVERLAP_PT = 0.03


@dataclass(frozen=True, eq=False)
class Gaps:
    """lines: their middles. half: (p,) half their width at each point, points."""

    lines: curves.Polylines
    half: Floats

    def __len__(self) -> int:
        return len(self.lines.first) - 1

    def strokes(self, width_pt: float, height_pt: float) -> Strokes:
        """As white strokes on a sheet of that size, straight from point to point."""
        counts = np.diff(self.lines.first)
        first = curves.starts(3 * counts - 2)
        points = np.repeat(self.lines.points, 3, axis=0)
        inner = np.ones((len(self.half), 3), bool)
        inner[self.lines.first[:-1], 0] = inner[self.lines.first[1:] - 1, 2] = False
        strokes = Strokes(width_pt, height_pt, points[inner.ravel()], first, np.ones(len(counts)))
        return strokes.swelling(2 * self.half)

    def sides(self, half: float, gain_pt: float, beyond: float, overlap: float = 0.0) -> list[tuple[Floats, Floats]]:
        """Polylines (n, 2) to either side of each gap, in its own order, and so far beyond its ends.

        They are half a pen's width beside it and what the device adds to that in this direction, so that strokes along
        them are painted up to it; beyond its ends they overlap.
        """
        points, first = self.lines.points, self.lines.first
        ahead = polylines.ahead(points, first)
        painted = half + gain_pt / (2 * MEAN) * np.abs(ahead).sum(axis=1)
        beside = np.column_stack([-ahead[:, 1], ahead[:, 0]])
        away = beside * (self.half + painted)[:, None]
        tip = beside * (painted - overlap)[:, None]
        out = []
        for i, j in zip(first[:-1].tolist(), first[1:].tolist()):
            before, after = points[i] - beyond * ahead[i], points[j - 1] + beyond * ahead[j - 1]
            whole = np.concatenate([before[None], points[i:j], after[None]])
            aside = np.concatenate([tip[i : i + 1], away[i:j], tip[j - 1 : j]])
            out.append((whole + aside, whole - aside))
        return out

    def flanks(self, pen_pt: float, gain_pt: float) -> list[Floats]:
        """Control points (3k + 1, 2) of strokes of a pen to either side, which a device paints wider by gain_pt."""
        beyond = (pen_pt + gain_pt) / 2
        sides = [side for pair in self.sides(pen_pt / 2, gain_pt, beyond, OVERLAP_PT) for side in pair]
        first = curves.starts(np.array([len(side) for side in sides]))
        points, begin = curve_fitting.over_chords(np.concatenate(sides), first, TOLERANCE_PT)
        return np.split(points, begin[1:-1])

    def rims(self, half: float, gain_pt: float, beyond: float) -> list[Floats]:
        """Rings (n, 2) around each gap through the same places, so far beyond its ends; dark on the normals' side."""
        return [np.concatenate([one, other[::-1]]) for one, other in self.sides(half, gain_pt, beyond)]

    def direction(self) -> Floats:
        """Cosine and sine of their mean direction."""
        legs = np.diff(self.lines.points, axis=0)
        legs[self.lines.first[1:-1] - 1] = 0.0
        x, y = legs.T
        cos2, sin2 = np.cumsum(np.stack([x * x - y * y, 2 * x * y]), axis=1)[:, -1]
        half = np.sqrt(np.maximum(0.5 + 0.5 * cos2 / max(np.sqrt(cos2 * cos2 + sin2 * sin2), 1e-9), 0.0))
        return np.array([half, np.copysign(np.sqrt(np.maximum(1.0 - half * half, 0.0)), sin2)])
