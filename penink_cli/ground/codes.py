"""Colours by their codes."""

from __future__ import annotations

Colour = tuple[float, float, float]  # red, green, blue of sRGB, 0 … 1


def of_code(code: str) -> Colour:
    """Red, green and blue of ``#rrggbb``."""
    red, green, blue = (int(code[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return red, green, blue


def code_of(colour: Colour) -> str:
    """``#rrggbb`` of red, green and blue, 0 … 1.

    >>> code_of((1.0, 0.5, 0.0))
    '#ff8000'
    """
    return "#" + "".join(f"{round(255 * part):02x}" for part in colour)
