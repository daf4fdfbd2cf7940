"""Whether two grids may be of the same picture."""

from __future__ import annotations


def same_shape(width: int, height: int, other_width: int, other_height: int) -> bool:
    """Whether some resizing, rounded to whole numbers on either side, leads from the one size to the other.

    >>> same_shape(451, 300, 96, 64), same_shape(451, 300, 300, 451)
    (True, False)
    """
    least = max((width - 1) / other_width, (height - 1) / other_height)
    most = min((width + 1) / other_width, (height + 1) / other_height)
    return least <= most
