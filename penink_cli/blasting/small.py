"""Small dark things on any ground: pupils, the frame of glasses, a dark gap. They are black as a whole.

Hatching is coarser than they are and tells where they are, not what they are. On bare paper they are marks (`marks`);
here their ground may be a tone, and what counts is how much of the way from it to black a place is.
"""

from __future__ import annotations

import numpy as np

from penink_cli.blasting.sheet import Cells
from penink_cli.composition.filters import Picture, blurred, by_rows, opened
from penink_cli.ground.masks import Mask, near, parts, sizes

#: Half the breadth of the broadest thing, and the σ that its ground is smoothed by, points.
HALF_PT, GROUND_PT = 4.5, 0.5
#: The tone of the darkest ground.
GROUND = 0.75
#: OFTEN times as much as is usual over a Gaussian of σ AROUND_PT does not count: in fur and leaves there is such a
#: thing at every place, and black ones would be blots.
AROUND_PT, OFTEN = 14.0, 1.5
#: A thing ends where a place has gone the first part of the way to black, if it has gone the second on CORE of the
#: thing, and is as dark as DARK there. What stands on a darker ground is told apart by the later ones.
PARTS, CORE, DARK = ((0.5, 0.7), (0.65, 0.8)), 0.3, 0.85
#: A thing this part of which has so much ink is drawn already: a pupil among the telling lines.
DRAWN, INKED = 0.3, 0.35


def black_from(tone: Picture, ink: Cells, px: float, threads: int) -> Picture:
    """The tone from which on small dark things are black, (h, w); more than a pixel beside them it is beyond all tones.

    tone: (h, w) ink coverage, 0 … 1, px pixels in a point. ink: (h, w) what lies there already.
    """
    ground = blurred(opened(tone, round(HALF_PT * px), threads), GROUND_PT * px, threads)

    def root(tone: Picture, ground: Picture) -> Picture:
        return np.sqrt(np.sqrt(np.maximum(tone - ground, 0)))

    def way(tone: Picture, ground: Picture, usual: Picture) -> Picture:
        usual = usual * usual
        part = (np.maximum(tone - ground, 0) - np.float32(OFTEN) * (usual * usual)) / _room(ground)
        part[ground > np.float32(GROUND)] = 0
        return part

    usual = blurred(by_rows(root, tone, ground, threads=threads), AROUND_PT * px, threads)
    part = by_rows(way, tone, ground, usual, threads=threads)
    del usual
    found = np.full(tone.shape, 2.0, np.float32)
    for ends, core in PARTS:
        some = part > np.float32(ends)
        thing, count = parts(some)
        deep = (part > np.float32(core)) & (tone > np.float32(DARK))
        size, dark, inked = (sizes(thing, count, each) for each in (some, deep, ink > INKED))
        chosen = (dark >= CORE * size) & (inked < DRAWN * size)
        chosen[0] = False
        beside = near(~chosen[thing], 1.5, threads=threads)

        def less(
            found: Picture, tone: Picture, part: Picture, ground: Picture, beside: Mask, ends: float = ends
        ) -> Picture:
            begins = tone - (part - np.float32(ends)) * _room(ground)
            return np.minimum(found, begins, out=found, where=beside)

        found = by_rows(less, found, tone, part, ground, beside, threads=threads)
    return found


def _room(ground: Picture) -> Picture:
    """How far it is from the ground to black, a little at the least."""
    return np.maximum(1 - ground, np.float32(0.1))
