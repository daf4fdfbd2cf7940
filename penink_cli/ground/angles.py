"""Directions on the sheet."""

from __future__ import annotations

import math


def direction(angle: float) -> tuple[float, float]:
    """Cosine and sine of an angle in degrees, rounded to 12 decimals so that every machine has the same."""
    return round(math.cos(math.radians(angle)), 12), round(math.sin(math.radians(angle)), 12)
