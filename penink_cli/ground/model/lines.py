"""Telling lines, and which of them a layer draws."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from penink_cli.ground.model.arrays import Floats, Ints, members


@dataclass(frozen=True, eq=False)
class Lines:
    """Telling lines: what a pen would draw of a picture besides its tone, in pixels of the photo it was found in.

    width, height: the image frame [0, width] × [0, height], whole photo pixels.
    points: (p, 2) x, y of all lines, one line after the other.
    first: (n + 1,) line i owns points[first[i] : first[i + 1]].
    weight: (p,) how much the pen is pressed at each point, 0 the finest line it draws … 1 the broadest.
    rank: (n,) what each line is worth, from 0; a print has room for those of the highest rank.
    white: (n,) bool: a light line on dark ground, along which hatching is left away.
    breadth: (n,) how broad the thing itself is, pixels, where it is drawn as broad as it is (a pupil, a full stop);
        0 for a line, which is as broad as the pen draws it. A thing with breadth may have but one point: a spot.

    One list serves every size on paper: the rank says what to leave out.
    """

    width: int
    height: int
    points: Floats = field(default_factory=lambda: np.zeros((0, 2)))
    first: Ints = field(default_factory=lambda: np.zeros(1, np.int64))
    weight: Floats = field(default_factory=lambda: np.zeros(0))
    rank: Floats = field(default_factory=lambda: np.zeros(0))
    white: npt.NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, np.bool_))
    breadth: Floats = field(default_factory=lambda: np.zeros(0))

    def __len__(self) -> int:
        return len(self.rank)

    def __getitem__(self, i: int) -> Floats:
        """Points (k, 2) of line i."""
        return self.points[self.first[i] : self.first[i + 1]]

    def chosen(self, which: Ints) -> Lines:
        """These lines alone, in this order."""
        at, first = members(self.first, which)
        return Lines(
            self.width, self.height, self.points[at], first, self.weight[at], self.rank[which], self.white[which],
            self.breadth[which],
        )  # fmt: skip


@dataclass(frozen=True)
class LineChoice:
    """Which telling lines of a layer are drawn, and how.

    pen_pt: width of the broadest strokes. even: one width from end to end, as a technical pen draws.
    density: points of line in a square point that there is room for. per_inch2: inches of line in a square inch
    that all lines may come to. min_rank: the least rank, None for one that suits the size.
    ruled_pt: how far lines go beyond their corners, straight in between as along a ruler; 0 for a free hand.
    loose_pt: how far each line and a second one beside it stray from it, as in a sketch; 0 for one line that does not.
    """

    pen_pt: float = 1.3
    even: bool = False
    density: float = 0.13
    per_inch2: float = 6.0
    min_rank: float | None = None
    ruled_pt: float = 0.0
    loose_pt: float = 0.0
