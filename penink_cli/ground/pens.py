"""Finer pens for small prints: at an inch a hand takes another nib, and a face stays a face."""

from __future__ import annotations

import math

#: On a picture narrower than FULL points pens are finer, by the root of the width: what is drawn small needs a finer
#: pen, not fewer lines. No pen is finer than LEAST of its width, or than DOTS dots of the printer.
FULL, LEAST, DOTS = 288.0, 0.5, 1.5


def part(width_pt: float) -> float:
    """The part of their usual width that pens have on a print of that width; 1 from FULL on.

    >>> [round(part(72 * inches), 3) for inches in (0.5, 1, 2, 4, 8)]
    [0.5, 0.5, 0.707, 1.0, 1.0]
    """
    return min(max(math.sqrt(width_pt / FULL), LEAST), 1.0)


def finer(pen_pt: float, by: float, device_dpi: float | None) -> float:
    """The width of a pen times `by`, but no less than DOTS of the printer, and no more than the pen was, points."""
    least = DOTS * 72.0 / device_dpi if device_dpi else 0.0
    return min(max(by * pen_pt, least), pen_pt)
