"""Whether two grids may be of the same picture."""

from __future__ import annotations


def same_shape(width: int, height: int, other_width: int, other_height: int) -> bool:
    """Whether both sizes may be resizings of one picture, each rounded to whole numbers.

    Each rounding is half a pixel at most, and that of the smaller size tells the most: it may be a pixel off in all.

    >>> same_shape(451, 300, 96, 64), same_shape(451, 300, 300, 451)
    (True, False)
    >>> same_shape(400, 328, 58, 48), same_shape(58, 48, 400, 328), same_shape(58, 48, 400, 360)
    (True, True, False)
    """
    if width * height > other_width * other_height:
        width, height, other_width, other_height = other_width, other_height, width, height
    least = max((width - 1) / other_width, (height - 1) / other_height)
    most = min((width + 1) / other_width, (height + 1) / other_height)
    return least <= most
