"""The page that strokes are put on: its size, where the sheet of strokes lies on it, how far the ink reaches."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from penink_cli.ground.errors import ParameterError
from penink_cli.ground.median import distinct
from penink_cli.ground.model import Floats, Strokes
from penink_cli.ground.papers import LIMIT, PAPERS, paper_size, plain_name


@dataclass(frozen=True)
class Page:
    """A page of width × height points; the sheet's top-left corner lies at x, y (y down).

    paper: the name or size of the paper, None for a page as large as the sheet and its margins. landscape: the paper's
    longer side lies across.
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

    layers: at least one; the sheet is as large as the largest of theirs. paper: a name or a size, None for a page of
    the sheet's size. margin: points. landscape: the paper's longer side lies across; else a paper given by name stands
    upright, and one given by size is as wide and high as the size says. at: x and y, in points, of the sheet's top-left
    corner on the page.

    Raises ParameterError for a paper that is not known, and where sheet and margins are larger than the paper.
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
        # rounded down, so that a picture of that width fits
        most = math.floor(width * scale / 72 * 100 + 1e-6) / 100
        advice = f"blast it {most:.2f}in wide or less" if scale > 0.01 else "the margin leaves no room"
        size = f"{width / 72:.2f} x {height / 72:.2f} in"
        room = f"{max(room_x, 0) / 72:.2f} x {max(room_y, 0) / 72:.2f} in"
        raise ParameterError(f"the picture, {size}, is larger than {paper} less its margins, {room}: {advice}")
    if at is None:
        x, y = (page_width - width) / 2, (page_height - height) / 2
    return Page(page_width, page_height, x, y, plain_name(paper), landscape)


def turned_paper(paper: str, landscape: bool) -> tuple[float, float]:
    """Width and height, points, of a paper as it is to lie; see `lay_out`. Raises ParameterError."""
    width, height = paper_size(paper)
    if landscape:
        return max(width, height), min(width, height)
    return (width, height) if paper.lower() not in PAPERS else (min(width, height), max(width, height))


def ink_box(strokes: Strokes) -> tuple[float, float, float, float] | None:
    """x0, y0, x1, y1 of the least box that holds all ink of the strokes (y down); None for no strokes.

    Where widths change, the box may be larger than the ink by part of a width.
    """
    if not len(strokes):
        return None
    half = _radii(strokes)[:, None]
    number = np.arange(len(strokes.points)) - np.repeat(strokes.first[:-1], np.diff(strokes.first))
    knot = number % 3 == 0
    low, high = (strokes.points - half)[knot].min(axis=0), (strokes.points + half)[knot].max(axis=0)
    # Most curves lie within the box of all knots' discs. Only those that reach beyond it are looked at closely.
    beyond = ((strokes.points - half < low) | (strokes.points + half > high)).any(axis=1) & ~knot
    last = distinct(np.flatnonzero(beyond) + 3 - number[beyond] % 3)
    if len(last):
        segments = last[:, None] + np.arange(-3, 1)
        reach = _turning_points(strokes.points[segments])
        wide = half[segments].max(axis=1)[:, None]
        low = np.minimum(low, (reach - wide).min(axis=(0, 1)))
        high = np.maximum(high, (reach + wide).max(axis=(0, 1)))
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def _turning_points(curves: Floats) -> Floats:
    """Points (n, 4, 2) of cubic curves (n, 4, 2): where they turn back along x or y, and both ends."""
    p0, p1, p2, p3 = np.moveaxis(curves, 1, 0)
    a, b, c = p3 - p0 + 3 * (p1 - p2), 2 * (p0 - 2 * p1 + p2), p1 - p0  # a t² + b t + c = 0
    root = np.sqrt(np.maximum(b * b - 4 * a * c, 0.0))
    q = -(b + np.copysign(root, b)) / 2  # without cancellation: the roots are q / a and c / q
    with np.errstate(divide="ignore", invalid="ignore"):
        t = np.clip(np.nan_to_num(np.stack([q / a, c / q]), posinf=0.0, neginf=0.0), 0.0, 1.0)
    u = 1 - t
    turns = u * u * u * p0 + 3 * u * u * t * p1 + 3 * u * t * t * p2 + t * t * t * p3
    return np.concatenate([np.moveaxis(turns, 0, 1), curves[:, ::3]], axis=1)


def _radii(strokes: Strokes) -> Floats:
    """Half the width at each control point (p,), interpolated between knots.

    A Bézier curve lies within the hull of its control points. So do the discs along it within the hull of these discs.
    """
    if strokes.knot_widths is None:
        return np.repeat(strokes.widths / 2, np.diff(strokes.first))
    number = np.arange(len(strokes.points)) - np.repeat(strokes.first[:-1], np.diff(strokes.first))
    before = np.repeat(strokes.knots[:-1], np.diff(strokes.first)) + number // 3
    share = number % 3 / 3
    after = np.minimum(before + 1, len(strokes.knot_widths) - 1)
    return (strokes.knot_widths[before] * (1 - share) + strokes.knot_widths[after] * share) / 2
