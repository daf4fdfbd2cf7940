"""Oriented stroke sets: a few examples each, as a hand draws them from left to right, for strokes that follow a field.

An example's first point lies on a line of the field and +x leads along it, downwards where it is steep: fur and hair
are drawn from the root, blades of grass from the tip.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from penink_cli.ground.model import Floats, Strokes, Texture

#: Control points x, y of chains of cubics, points.
EXAMPLES: dict[str, tuple[tuple[float, ...], ...]] = {
    "fur": (
        (0, 0, 7, 0.2, 14, 1.0, 21, 2.4),
        (0, 0, 5, 0.9, 10, 1.2, 15, 0.7),
        (0, 0, 8, -0.5, 17, 0.4, 25, 2.5),
        (0, 0, 6, 1.3, 12, 1.7, 18, 0.9),
        (0, 0, 4, 0.3, 8, 0.6, 12, 1.5),
        (0, 0, 5, -0.3, 11, 0.2, 16, -0.4),
    ),
    "hair": (
        (0, 0, 12, 0.6, 26, 1.7, 38, 3.2),
        (0, 0, 10, -0.9, 20, -0.6, 31, 0.8),
        (0, 0, 10, 0.8, 19, 1.3, 27, 0.6, 35, -0.1, 42, -0.4, 50, 0.9),
        (0, 0, 9, 0.2, 17, 0.6, 25, 1.6),
        (0, 0, 8, -0.4, 17, -1.2, 24, -0.8, 31, -0.4, 36, 0.6, 42, 0.4),
    ),
    "grass-blades": (
        (0, 0, 3, 2.2, 10, 3.6, 24, 3.9),
        (0, 0, 5, 1.6, 12, 2.3, 19, 2.2),
        (0, 0, 2, 3.4, 11, 5.2, 29, 5.4),
        (0, 0, 6, 0.7, 11, 0.9, 16, 0.6),
        (0, 0, 7, 1.0, 16, 1.2, 27, 0.2),
    ),
    "barb": (
        (0, 0, 3, 0, 7, 0.6, 10, 2.5),
        (0, 0, 2.6, 0.4, 5.4, 1.2, 8.5, 2.9),
        (0, 0, 4, 0.3, 8.5, 0.4, 12, 1.7),
        (0, 0, 3, -0.2, 6.5, 0.1, 9.5, 1.4),
    ),
}
PEN_PT = {"fur": 0.4, "hair": 0.35, "grass-blades": 0.4, "barb": 0.4}
SHORTEST_PT = 1.0  # of what leads anywhere


def make_set(kind: str, pen_pt: float | None = None) -> Texture:
    """One of the sets that come with the program; pen_pt: another pen than its own."""
    examples = [np.array(points, np.float64).reshape(-1, 2) for points in EXAMPLES[kind]]
    return _texture(kind, examples, [pen_pt or PEN_PT[kind]] * len(examples))


def as_set(drawing: Texture) -> tuple[Texture, int]:
    """The strokes of a drawing as examples, from left to right, and how many were left out as leading nowhere."""
    strokes = drawing.strokes
    examples, widths = [], []
    for i in range(len(strokes)):
        points = strokes[i]
        if points[-1, 0] < points[0, 0]:
            points = points[::-1]
        if points[-1, 0] - points[0, 0] >= SHORTEST_PT:
            examples.append(points - points[0])
            widths.append(float(strokes.widths[i]))
    return _texture(drawing.name, examples, widths), len(strokes) - len(examples)


def _texture(name: str, examples: list[Floats], widths: list[float]) -> Texture:
    """Examples one below the other, so that they can be looked at."""
    laid, y, wide = [], 0.0, 0.0
    for points in examples:
        low, high = points.min(axis=0), points.max(axis=0)
        y += 4.0
        laid.append(points + np.array([4.0 - low[0], y - low[1]]))
        y += float(high[1] - low[1])
        wide = max(wide, float(high[0] - low[0]))
    strokes = Strokes.of(wide + 8.0, y + 4.0, laid, widths)
    return Texture(name, replace(strokes, texture=name), np.arange(len(laid), dtype=np.float64), oriented=True)
