"""Oriented stroke sets: a few examples of strokes, drawn from left to right, that are bent along a field.

An example's first point lies on a line of the field and +x leads along that line, downwards where it is steep. Fur and
hair are drawn from the root, blades of grass from the tip.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from penink_cli.ground.model import Floats, Strokes, Texture

SHORTEST_PT = 1.0  # a stroke that leads less far along x cannot be an example


def oriented(name: str, examples: Iterable[Sequence[float]], pen_pt: float) -> Texture:
    """A set of examples drawn with one pen, each x, y, x, y … of the control points of a chain of cubics, points."""
    chains = [np.array(points, np.float64).reshape(-1, 2) for points in examples]
    return _texture(name, chains, [pen_pt] * len(chains))


def as_set(drawing: Texture) -> tuple[Texture, int]:
    """The strokes of a drawing as examples, each from left to right, and how many lead too little and are left out."""
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
    """The texture of these examples, which lie one below the other in its tile, so that they can be looked at."""
    laid, y, wide = [], 0.0, 0.0
    for points in examples:
        low, high = points.min(axis=0), points.max(axis=0)
        y += 4.0
        laid.append(points + np.array([4.0 - low[0], y - low[1]]))
        y += float(high[1] - low[1])
        wide = max(wide, float(high[0] - low[0]))
    strokes = Strokes.of(wide + 8.0, y + 4.0, laid, widths)
    return Texture(name, replace(strokes, texture=name), np.arange(len(laid), dtype=np.float64), oriented=True)
