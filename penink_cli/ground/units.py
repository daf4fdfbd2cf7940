"""Lengths on paper: points, millimetres, centimetres, inches and, with a resolution, pixels."""

from __future__ import annotations

import math
import re

from penink_cli.ground.errors import ParameterError, in_quotes

#: Points in a millimetre, and millimetres in a point.
MM, POINT_MM = 72 / 25.4, 25.4 / 72
POINTS = {"": 1.0, "pt": 1.0, "mm": MM, "cm": 720 / 25.4, "in": 72.0}

_LENGTH = re.compile(r"([0-9]+(?:\.[0-9]*)?|\.[0-9]+)(pt|mm|cm|in|px|)", re.ASCII)


def parse_length(text: str, dpi: float | None = None) -> float:
    """A length in points (1/72 in). A bare number is points; ``px`` needs a resolution.

    >>> parse_length("4in"), parse_length("0.4"), parse_length("25.4mm")
    (288.0, 0.4, 72.0)
    >>> parse_length("300px", dpi=300)
    72.0

    Raises ParameterError for any other text, and for a length that is no finite number.
    """
    match = _LENGTH.fullmatch(text.strip())
    if not match:
        raise ParameterError(f"{in_quotes(text)} is not a length such as 4in, 100mm, 10cm or 288pt")
    number, unit = match.groups()
    if unit == "px" and dpi is None:
        raise ParameterError(f"{in_quotes(text)}: px needs a resolution")
    points = float(number) * (72.0 / dpi if unit == "px" and dpi is not None else POINTS[unit])
    if not math.isfinite(points):
        raise ParameterError(f"{in_quotes(text)} is out of range")
    return points
