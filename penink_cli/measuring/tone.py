"""Tone as the eye sees it: the ink and the tone wanted, each low-passed, on one grid.

The eye is a Gaussian of 1/16 inch; the grid has 100 cells an inch. Figures are percent of solid ink.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from penink_cli.composition.filters import Picture, blurred, enlarged, shrunk
from penink_cli.formats.pgm import check_size
from penink_cli.ground.model import GreyImage, Strokes
from penink_cli.outputs.page import lay_out
from penink_cli.outputs.raster import cover

GRID = 100  # cells an inch
FINE = 3  # pixels a cell, along each axis, that ink is drawn with
EYE_INCH = 1 / 16
WHITE = 0.5 / 255  # tone below which paper is to stay white


@dataclass(frozen=True)
class ToneFigures:
    """Tone wanted less tone printed, percent of solid ink.

    rms: root mean square. bias: mean; above 0 the drawing is too light. worst: the largest, either way. stray: mean ink
    where the paper is to stay white.
    """

    rms: float
    bias: float
    worst: float
    stray: float


def grid_of(width_pt: float, height_pt: float, max_pixels: int) -> tuple[int, int]:
    """Columns and rows of cells over a sheet. Raises LimitError where its ink would take more pixels than allowed."""
    columns, rows = (max(1, round(side / 72 * GRID)) for side in (width_pt, height_pt))
    check_size(FINE * columns, FINE * rows, max_pixels)
    return columns, rows


def printed(layers: Sequence[Strokes], max_pixels: int, threads: int) -> Picture:
    """The share of each cell (rows, columns) that ink covers, all layers over one another; see `grid_of`."""
    page = lay_out(layers)
    columns, rows = grid_of(page.width, page.height, max_pixels)
    dpi = FINE * GRID
    pixels = np.concatenate(list(cover.bands(layers, page, dpi, 255, threads)))
    # a pixel that the sheet fills in part only is left out
    across, down = (max(1, int(side * dpi / 72 + 1e-6)) for side in (page.width, page.height))
    return 1 - shrunk(pixels[:down, :across], columns, rows, 1 / 255, threads)


def wanted(image: GreyImage, columns: int, rows: int, threads: int = 1) -> Picture:
    """The tone (rows, columns) of an image that fills the sheet."""
    height, width = image.values.shape
    if columns <= width and rows <= height:
        return 1 - shrunk(image.values, columns, rows, 1 / image.maxval, threads)
    return 1 - enlarged(image.grey, columns, rows, threads)


def figures(want: Picture, have: Picture, threads: int = 1) -> ToneFigures:
    """How far the tone that a drawing has is from the tone wanted, both (rows, columns)."""
    error = 100 * seen(want - have, threads)
    white = _inner(want <= WHITE)
    stray = 100 * float(have[white].mean(dtype=np.float64)) if white.any() else 0.0
    rms = float(np.sqrt(np.mean(error * error)))
    return ToneFigures(rms, float(error.mean()), float(np.abs(error).max()), stray)


def seen(tone: Picture, threads: int = 1) -> np.ndarray:
    """A picture (rows, columns) as the eye sees it."""
    return blurred(tone, EYE_INCH * GRID, threads).astype(np.float64)


def _inner(cells: np.ndarray) -> np.ndarray:
    """The cells of a mask whose eight neighbours are in it too: a stroke beside the mask may reach into the others."""
    padded = np.pad(cells, 1, mode="edge")
    rows, columns = cells.shape
    inner = np.ones_like(cells)
    for y in range(3):
        for x in range(3):
            inner &= padded[y : y + rows, x : x + columns]
    return inner
