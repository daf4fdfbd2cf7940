"""The sheet of paper that a command is asked to draw on: which is too large, and which is most likely a mistake."""

from __future__ import annotations

from penink_cli.ground.errors import LimitError, ParameterError
from penink_cli.ground.units import MM
from penink_cli.options.common import is_given, warn

PIXELS_PER_PT = 2.0  # of the grey that a sheet is blasted from, along each axis
SHEET_PIXELS = 50_000_000  # of that grey, unless --max-pixels is given: 2400 square inches, 4 × 4 feet
MOST_PT2 = 9600 * 72 * 72  # the area of the largest sheet, square points
SMALL_PT = 18.0  # a quarter of an inch: with a smaller picture the unit has most likely been forgotten
THIN_PT = 2.0  # on a narrower picture even a few strokes have no room


def check_sheet(width_pt: float, height_pt: float, max_pixels: int | None = None) -> None:
    """Raise ParameterError for a sheet of no size or one that is too large; warn of one that shows little.

    max_pixels: the value of --max-pixels where strokes are laid all over the sheet, which takes memory and time by its
    area; None where they are not. Raises LimitError as `check_area` does.
    """
    if not (0.01 <= width_pt <= 144_000 and 0.01 <= height_pt <= 144_000):
        raise ParameterError(f"{width_pt:g} × {height_pt:g} pt on paper; from 0.01 to 144000 is allowed each way")
    if width_pt * height_pt > MOST_PT2:
        raise ParameterError(f"{width_pt:g} × {height_pt:g} pt on paper; {MOST_PT2 // 5184} square inches are allowed")
    if max_pixels is not None:
        check_area(width_pt, height_pt, max_pixels)
    if max(width_pt, height_pt) < SMALL_PT or min(width_pt, height_pt) < THIN_PT:
        size = f"{width_pt:.3g} × {height_pt:.3g} pt ({width_pt / MM:.2g} × {height_pt / MM:.2g} mm)"
        warn(f"the drawing is {size} on paper, which shows little; a bare number is points, 72 to the inch", "sheet")


def check_area(width_pt: float, height_pt: float, max_pixels: int) -> None:
    """Raise LimitError for a sheet that is blasted from too many pixels: --max-pixels if given, else SHEET_PIXELS."""
    if not is_given("max_pixels"):
        max_pixels = SHEET_PIXELS
    pixels = round(width_pt * height_pt * PIXELS_PER_PT**2)
    if pixels > max_pixels:
        size = f"{width_pt / 72:.4g} × {height_pt / 72:.4g} in"
        raise LimitError(f"{size} on paper needs {pixels} pixels; at most {max_pixels} are allowed (--max-pixels)")
