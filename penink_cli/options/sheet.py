"""The sheet of paper that a command is asked to draw on: what is too large, and what is most likely a mistake."""

from __future__ import annotations

from penink_cli.ground.errors import ParameterError
from penink_cli.ground.papers import MM
from penink_cli.options.common import warn

SMALL_PT = 18.0  # a quarter of an inch: who asks for less has most likely forgotten the unit


def check_sheet(width_pt: float, height_pt: float) -> None:
    """Refuse sheets of no size, and those that no memory holds; warn of one that is smaller than a stamp."""
    if not (0.01 <= width_pt <= 144_000 and 0.01 <= height_pt <= 144_000):
        raise ParameterError(f"{width_pt:g} × {height_pt:g} pt on paper; from 0.01 to 144000 is allowed each way")
    if width_pt * height_pt > 60 * 40 * 5184 * 4:
        raise ParameterError(f"{width_pt:g} × {height_pt:g} pt on paper; 9600 square inches are allowed")
    if max(width_pt, height_pt) < SMALL_PT:
        size = f"{width_pt:.3g} × {height_pt:.3g} pt ({width_pt / MM:.2g} × {height_pt / MM:.2g} mm)"
        warn(f"the drawing is {size} on paper, which shows little; a bare number is points, 72 to the inch")
