"""Transparent inks that lie over one another: what colour a pixel has where several cover parts of it.

Each ink is a filter. Where it lies, it lets through a part of the red, the green and the blue light: its colour on
white paper says which. What it does not cover of a pixel lets all light through. Inks cover parts of a pixel that know
nothing of each other (Demichel), so the light of all is the product of what each lets through (after Neugebauer, 1937).
Light adds up in linear values; sRGB's curve leads there and back.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from penink_cli.ground.codes import Colour
from penink_cli.ground.colour import linear

BLACK: Colour = (0.0, 0.0, 0.0)


def overprint(colours: Sequence[Colour]) -> bool:
    """Whether the colours are of several inks, so that it matters that inks are transparent."""
    return len(set(colours)) > 1


def pixels(
    covers: Sequence[Iterator[npt.NDArray[np.uint8]]], colours: Sequence[Colour], maxval: int
) -> Iterator[npt.NDArray[np.uint8]]:
    """Bands (rows, width, 3) of sRGB, 8 bits, of inks printed over one another, from the top.

    covers: of each ink bands (rows, width) of the paper that it leaves bare, 0 … maxval. colours: of the inks.
    """
    bare = np.arange(maxval + 1)[:, None] / maxval
    passed = [bare + (1.0 - bare) * linear(colour) for colour in colours]
    between = linear((np.arange(255) + 0.5) / 255)
    for bands in zip(*covers, strict=True):
        light = passed[0][bands[0]]
        for table, band in zip(passed[1:], bands[1:], strict=True):
            light *= table[band]
        yield np.searchsorted(between, light).astype(np.uint8)
