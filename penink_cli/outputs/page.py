"""The page that strokes are put on: its size, where the sheet of strokes lies, what room the ink takes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from penink_cli.ground.errors import ParameterError
from penink_cli.ground.model import Floats, Strokes
from penink_cli.ground.papers import LIMIT, PAPERS, paper_size, plain_name


@dataclass(frozen=True)
class Page:
    """A page of width × height points; the sheet's top-left corner lies at x, y (y down).

    paper: the name of the paper, None for a page that is as large as its sheet.
    """

    width: float
    height: float
    x: float = 0.0
    y: float = 0.0
    paper: str | None = None
    landscape: bool = False


def lay_out(
    layers: Sequence[Strokes], paper: str | None = None, margin: float = 0.0, landscape: bool = False,
    at: tuple[float, float] | None = None,
) -> Page:  # fmt: skip
    """Put the sheet, at its own size, in the middle of the paper, or on a page that leaves a margin around it.

    margin: points. landscape turns the paper's longer side across; without it a paper lies upright that has a name, and
    one of a size as that is written. at: x and y of the sheet's top-left corner on the page.
    Raises ParameterError where the sheet and the margins are larger than the paper.
    """
    width, height = max(s.width for s in layers), max(s.height for s in layers)
    x, y = at or (margin, margin)
    if paper is None:
        page = Page(x + width + margin, y + height + margin, x, y)
        if max(page.width, page.height) > LIMIT:
            size = f"{page.width:.0f} x {page.height:.0f}"
            raise ParameterError(f"a page of {size} points; up to {LIMIT:.0f} are possible")
        return page
    page_width, page_height = turned_paper(paper, landscape)
    room_x, room_y = page_width - 2 * margin, page_height - 2 * margin
    if at is not None:
        room_x, room_y = page_width - x - margin, page_height - y - margin
    if width > room_x + 0.01 or height > room_y + 0.01:
        scale = min(room_x / width, room_y / height)
        advice = f"blast it {width * scale / 72:.2f}in wide or less" if scale > 0.01 else "the margin leaves no room"
        size = f"{width / 72:.2f} x {height / 72:.2f} in"
        room = f"{max(room_x, 0) / 72:.2f} x {max(room_y, 0) / 72:.2f} in"
        raise ParameterError(f"the picture, {size}, is larger than {paper} less its margins, {room}: {advice}")
    if at is None:
        x, y = (page_width - width) / 2, (page_height - height) / 2
    return Page(page_width, page_height, x, y, plain_name(paper), landscape)


def turned_paper(paper: str, landscape: bool) -> tuple[float, float]:
    """Width and height of a paper as it is to lie."""
    width, height = paper_size(paper)
    if landscape:
        return max(width, height), min(width, height)
    return (width, height) if paper.lower() not in PAPERS else (min(width, height), max(width, height))


def ink_box(strokes: Strokes) -> tuple[float, float, float, float] | None:
    """x0, y0, x1, y1 of a box that holds all ink of these strokes (y down), by their control points."""
    if not len(strokes):
        return None
    half = _radii(strokes)[:, None]
    low, high = (strokes.points - half).min(axis=0), (strokes.points + half).max(axis=0)
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def _radii(strokes: Strokes) -> Floats:
    """Half the width at each control point (p,), those between two knots having their share of either's: as a Bézier
    curve lies within its control points, so do its discs within these.
    """
    if strokes.knot_widths is None:
        return np.repeat(strokes.widths / 2, np.diff(strokes.first))
    number = np.arange(len(strokes.points)) - np.repeat(strokes.first[:-1], np.diff(strokes.first))
    before = np.repeat(strokes.knots[:-1], np.diff(strokes.first)) + number // 3
    share = number % 3 / 3
    after = np.minimum(before + 1, len(strokes.knot_widths) - 1)
    return (strokes.knot_widths[before] * (1 - share) + strokes.knot_widths[after] * share) / 2
