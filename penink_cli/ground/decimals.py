"""Numbers as text, the same everywhere: a fixed number of decimals, without needless zeros."""

from __future__ import annotations


def plain(value: float, decimals: int) -> str:
    """A number rounded to so many decimals, without zeros at the end, and never "-0".

    >>> plain(1.5, 3), plain(2.0, 3), plain(-0.0001, 3)
    ('1.5', '2', '0')
    """
    text = f"{value:.{decimals}f}"
    text = text.rstrip("0").rstrip(".") if decimals else text
    return "0" if text == "-0" else text
