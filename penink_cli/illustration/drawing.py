"""The stages between an illustration, or a photograph, and its strokes: what `render`, `draw` and the filters share."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from penink_cli.ground.device import narrowed
from penink_cli.ground.model import EdgeList, Floats, GreyImage, LineChoice, Lines, OutlineChoice, Strokes

PIXELS_PER_PT = 2.0  # of the grey that is blasted: a pixel is half the distance between the closest strokes

Advance = Callable[[int], None]


def grey_size(width_pt: float, aspect: float) -> tuple[int, int]:
    """Width and height in pixels of the grey to blast for a picture of that width; aspect is height over width."""
    width = max(2, math.floor(width_pt * PIXELS_PER_PT + 0.5))
    return width, max(1, math.floor(width * aspect + 0.5))


def tone_curve(image: GreyImage, gamma: float) -> Floats:
    """Ink coverage (h, w) of the image, its grey (0 … 1) raised to gamma."""
    if gamma == 1.0:
        return image.tone
    # by a table, and rounded, so that the power is the same on every machine
    table = np.array([round(1.0 - (v / image.maxval) ** gamma, 12) for v in range(image.maxval + 1)])
    return table[image.values]


def enlarged(
    samples: GreyImage, edges: EdgeList | None, size: tuple[int, int], threads: int | None
) -> GreyImage:
    """Samples at the size, width and height in pixels, at which they are blasted.

    Half of the size is reconstructed, and doubled by the separable filter. Samples of few grey levels are eased first,
    so that these show no steps.
    """
    from penink_cli.reconstruction.easing import eased
    from penink_cli.reconstruction.enlarge import bands

    rows = bands(eased(samples, edges), edges, *size, soften=True, maxval=255, threads=threads)
    return GreyImage(np.concatenate(list(rows)).astype(np.uint8), 255)


def outlined(
    edges: EdgeList, width_pt: float, height_pt: float, choice: OutlineChoice, ink: Strokes | None = None,
    device_dpi: float | None = None,
) -> Strokes:  # fmt: skip
    """The strokes of `outline_strokes`, rounded as a strokes file holds them."""
    return outline_strokes(edges, width_pt, height_pt, choice, ink, device_dpi).rounded()


def lined(
    lines: Lines, width_pt: float, height_pt: float, choice: LineChoice, device_dpi: float | None = None
) -> Strokes:
    """Strokes of the telling lines that there is room for, rounded as a strokes file holds them."""
    from penink_cli.lines.strokes import line_strokes

    return line_strokes(lines, width_pt, height_pt, choice, device_dpi=device_dpi).rounded()


def outline_strokes(
    edges: EdgeList, width_pt: float, height_pt: float, choice: OutlineChoice, ink: Strokes | None = None,
    device_dpi: float | None = None,
) -> Strokes:  # fmt: skip
    """Outline strokes of the edges chosen.

    ink: strokes that are on the sheet already; outlines along them are left out. device_dpi: of the printer, None for
    none. The strokes are as much finer as the printer paints them broader, unless a technical pen draws them.

    Raises ArrangementError for a region's point outside the frame.
    """
    from penink_cli.blasting import outlines

    around = None
    if choice.regions:
        from penink_cli.geometry import regions

        around = regions.edges_around(edges, np.array(choice.regions, np.float64))
    drawn = outlines.outline(edges, width_pt, height_pt, choice, around, ink)
    if device_dpi and not choice.even:
        drawn = narrowed(drawn, device_dpi)
    return replace(drawn, device_dpi=device_dpi)
