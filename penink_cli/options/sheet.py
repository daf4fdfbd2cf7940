"""The sheet of paper that a command is asked to draw on: what is too large, and what is most likely a mistake."""

from __future__ import annotations

import click
from click.core import ParameterSource

from penink_cli.ground.errors import LimitError, ParameterError
from penink_cli.ground.papers import MM
from penink_cli.options.common import warn

PIXELS_PER_PT = 2.0  # of the grey that a sheet is blasted from
SHEET_PIXELS = 50_000_000  # of that grey, unless --max-pixels says otherwise: 2400 square inches, 4 × 4 feet
SMALL_PT = 18.0  # a quarter of an inch: who asks for less has most likely forgotten the unit
THIN_PT = 2.0  # a few strokes have no room on less


def check_sheet(width_pt: float, height_pt: float, max_pixels: int | None = None) -> None:
    """Raise ParameterError for a sheet of no size, and for one that no memory holds; warn of one that shows little.

    max_pixels: --max-pixels, where strokes are to be laid all over the sheet, which takes memory and time by its area.
    """
    if not (0.01 <= width_pt <= 144_000 and 0.01 <= height_pt <= 144_000):
        raise ParameterError(f"{width_pt:g} × {height_pt:g} pt on paper; from 0.01 to 144000 is allowed each way")
    if width_pt * height_pt > 60 * 40 * 5184 * 4:
        raise ParameterError(f"{width_pt:g} × {height_pt:g} pt on paper; 9600 square inches are allowed")
    if max_pixels is not None:
        check_area(width_pt, height_pt, max_pixels)
    if max(width_pt, height_pt) < SMALL_PT or min(width_pt, height_pt) < THIN_PT:
        size = f"{width_pt:.3g} × {height_pt:.3g} pt ({width_pt / MM:.2g} × {height_pt / MM:.2g} mm)"
        warn(f"the drawing is {size} on paper, which shows little; a bare number is points, 72 to the inch", "sheet")


def check_area(width_pt: float, height_pt: float, max_pixels: int) -> None:
    """Raise LimitError for a sheet whose area takes too much memory and time: by --max-pixels, else `SHEET_PIXELS`."""
    context = click.get_current_context(silent=True)
    if context and context.get_parameter_source("max_pixels") is ParameterSource.DEFAULT:
        max_pixels = SHEET_PIXELS
    pixels = round(width_pt * height_pt * PIXELS_PER_PT**2)
    if pixels > max_pixels:
        size = f"{width_pt / 72:.4g} × {height_pt / 72:.4g} in"
        raise LimitError(f"{size} on paper needs {pixels} pixels; at most {max_pixels} are allowed (--max-pixels)")
