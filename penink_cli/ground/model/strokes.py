"""Pen strokes on a sheet, and what is done with them: joined, taken, rounded, cut to pieces of one width."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from penink_cli.ground.model.arrays import Floats, Ints, members

#: What the header of a strokes file may say besides the sheet.
HEADER = ("layer", "texture", "seed", "color", "device_dpi")


@dataclass(frozen=True, eq=False)
class Strokes:
    """Pen strokes on paper: chains of cubic Bézier segments, in points (1/72 inch).

    width, height: the sheet, points.
    points: (p, 2) control points of all strokes, one stroke after the other.
    first: (s + 1,) stroke i owns points[first[i] : first[i + 1]], 3k + 1 of them; one is a dot.
    widths: (s,) pen width of each stroke, points; of one that swells, the mean of its knots' widths.
    knot_widths: (n,) width at each knot, where a segment begins or ends, and linear along each segment's parameter
        between; stroke i owns knot_widths[knots[i] : knots[i + 1]], k + 1 of them. None where no stroke swells.
    layer, texture, seed: what the file's header says of the strokes, None where it does not.
    color: ``#rrggbb``, None for what the output chooses.
    device_dpi: resolution of the printer whose gain the strokes allow for (`ground/device.py`), None for no printer.
    """

    width: float
    height: float
    points: Floats = field(default_factory=lambda: np.zeros((0, 2)))
    first: Ints = field(default_factory=lambda: np.zeros(1, np.int64))
    widths: Floats = field(default_factory=lambda: np.zeros(0))
    layer: str | None = None
    texture: str | None = None
    seed: int | None = None
    knot_widths: Floats | None = None
    color: str | None = None
    device_dpi: float | None = None

    def __len__(self) -> int:
        return len(self.widths)

    def __getitem__(self, i: int) -> Floats:
        """Control points (3k + 1, 2) of stroke i."""
        return self.points[self.first[i] : self.first[i + 1]]

    @classmethod
    def of(
        cls, width: float, height: float, chains: Sequence[npt.ArrayLike], widths: Sequence[npt.ArrayLike] | Floats
    ) -> Strokes:
        """Strokes from one array of control points (3k + 1, 2) each, and one width each, or k + 1 for one that swells.

        >>> Strokes.of(9, 9, [[[1, 2]], [[0, 0], [1, 0], [2, 0], [3, 0]]], [2.0, [0.5, 1.5]]).widths.tolist()
        [2.0, 1.0]
        """
        parts = [np.asarray(chain, np.float64).reshape(-1, 2) for chain in chains]
        points = np.concatenate(parts) if parts else np.zeros((0, 2))
        first = np.zeros(len(parts) + 1, np.int64)
        np.cumsum([len(part) for part in parts], out=first[1:])
        given = [np.asarray(w, np.float64) for w in widths]
        even = cls(width, height, points, first, np.array([float(w) if w.ndim == 0 else 0.0 for w in given]))
        if all(w.ndim == 0 for w in given):
            return even
        knots = [np.broadcast_to(w, (n + 2) // 3) for w, n in zip(given, np.diff(first).tolist())]
        return even.swelling(np.concatenate(knots))

    @staticmethod
    def joined(parts: Sequence[Strokes]) -> Strokes:
        """The strokes of all parts, at least one, in their order and on the first one's sheet.

        Of layer, texture, seed, colour and device_dpi those are kept that all parts agree in.
        """
        first = np.zeros(1 + sum(map(len, parts)), np.int64)
        np.cumsum(np.concatenate([np.diff(part.first) for part in parts]), out=first[1:])
        whole = Strokes(
            parts[0].width,
            parts[0].height,
            np.concatenate([part.points for part in parts]),
            first,
            np.concatenate([part.widths for part in parts]),
        )
        if any(part.knot_widths is not None for part in parts):
            whole = replace(whole, knot_widths=np.concatenate([part.at_knots for part in parts]))
        agreed = {name: {getattr(part, name) for part in parts} for name in HEADER}
        return replace(whole, **{name: values.pop() for name, values in agreed.items() if len(values) == 1})

    @property
    def knots(self) -> Ints:
        """(s + 1,) where each stroke's knots begin among those of all strokes."""
        return (self.first + 2 * np.arange(len(self.first))) // 3

    @property
    def at_knots(self) -> Floats:
        """(n,) width at each knot, whether its stroke swells or not."""
        return np.repeat(self.widths, np.diff(self.knots)) if self.knot_widths is None else self.knot_widths

    @property
    def swells(self) -> npt.NDArray[np.bool_]:
        """(s,) whether a stroke's width changes on its way."""
        if self.knot_widths is None or not len(self):
            return np.zeros(len(self), bool)
        starts = self.knots[:-1]
        thinnest = np.minimum.reduceat(self.knot_widths, starts)
        swells: npt.NDArray[np.bool_] = thinnest < np.maximum.reduceat(self.knot_widths, starts)
        return swells

    @property
    def widest(self) -> Floats:
        """(s,) the largest width of each stroke."""
        if self.knot_widths is None or not len(self):
            return self.widths
        return np.maximum.reduceat(self.knot_widths, self.knots[:-1])

    def swelling(self, knot_widths: Floats) -> Strokes:
        """The same strokes with these widths at their knots (n,); a stroke's width is the mean of its knots' widths."""
        knots = self.knots
        if not len(self):
            return self
        means = np.add.reduceat(knot_widths, knots[:-1]) / np.diff(knots)
        swelling = replace(self, widths=means, knot_widths=knot_widths)
        return replace(swelling, widths=np.where(swelling.swells, means, knot_widths[knots[:-1]]))

    def by_segments(self, step: float = 0.15) -> Strokes:
        """Strokes that cover the same, each of one width: swelling strokes in pieces, whose widths are `step` apart."""
        if self.knot_widths is None:
            return self
        from penink_cli.ground._compiled import pieces as _pieces  # most filters do without

        swells = self.swells
        even, some = self.taken(~swells), self.taken(swells)
        counts = np.diff(some.first) // 3
        within = np.arange(int(counts.sum())) - np.repeat(np.cumsum(counts) - counts, counts)
        segment = np.repeat(some.first[:-1], counts) + 3 * within
        knot = np.repeat(some.knots[:-1], counts) + within
        begin, end = some.at_knots[knot], some.at_knots[knot + 1]
        n = np.maximum(np.ceil(np.abs(end - begin) / step), 1).astype(np.int64)
        total = int(n.sum())
        points, widths = np.empty((4 * total, 2)), np.empty(total)
        _pieces.split(some.points, segment, begin, end, n, points, widths)
        pieces = replace(some, points=points, first=4 * np.arange(total + 1), widths=widths, knot_widths=None)
        return Strokes.joined([replace(even, knot_widths=None), pieces])

    def taken(self, which: npt.NDArray[Any], turned: npt.NDArray[np.bool_] | None = None) -> Strokes:
        """The strokes with these numbers, in that order, or those where a mask (s,) is true.

        turned: one for each stroke taken, whether it is to be drawn from its end.
        """
        if which.dtype == bool:
            which = np.flatnonzero(which)
        index, first = members(self.first, which, turned)
        widths = None if self.knot_widths is None else self.knot_widths[members(self.knots, which, turned)[0]]
        return replace(self, points=self.points[index], first=first, widths=self.widths[which], knot_widths=widths)

    def rounded(self) -> Strokes:
        """The strokes as a strokes file holds them: thousandths of a point, widths in ten-thousandths, none 0."""
        widths = np.maximum(np.floor(self.widths * 10000 + 0.5), 1) / 10000
        knot_widths = self.knot_widths
        if knot_widths is not None:
            knot_widths = np.floor(knot_widths * 10000 + 0.5) / 10000
            swells = np.repeat(replace(self, knot_widths=knot_widths).swells, np.diff(self.knots))
            even = np.repeat(widths, np.diff(self.knots))
            knot_widths = np.where(swells, knot_widths, even) if swells.any() else None
        return replace(
            self,
            width=round(self.width, 3),
            height=round(self.height, 3),
            points=np.floor(self.points * 1000 + 0.5) / 1000,
            widths=widths,
            knot_widths=knot_widths,
        )
