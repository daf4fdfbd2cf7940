"""Lines along borders, within the dark side: along the frame, and along strong edges.

Lines that meet a border at an angle end in points or in round ends. The white left between them makes a saw of the
border. A line within the border, as wide as the tone is dark, fills that. So an engraver cuts the outline of what is
dark.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import curves, polylines
from penink_cli.blasting.sheet import Cells
from penink_cli.blasting.walls import BESIDE_PT, Walls
from penink_cli.geometry.trails import trails
from penink_cli.ground.model import Floats

#: How far within the frame, and within an edge, a line runs.
FRAME_PT, EDGE_PT = 0.4, 0.42
#: How wide it is at the most, points, and between which tones it becomes so.
FRAME, EDGE = (2 * FRAME_PT, 0.6, 1.0), (2 * EDGE_PT, 0.35, 0.65)
#: An edge has one on its darker side, where that is darker than the other by so much.
DARKER = 0.2
#: A line along an edge has more samples than this: a shorter stretch is darker for what lies beyond a thin thing.
SHORTEST = 6
#: Distance of a line's samples.
STEP_PT = 1.0


def along_frame(width: float, height: float) -> list[Floats]:
    """The four lines, each in samples (k, 2)."""
    d = FRAME_PT
    corners = np.array([[d, d], [width - d, d], [width - d, height - d], [d, height - d], [d, d]])
    return [_sampled(np.array(side)) for side in pairwise(corners)]


def along_edges(borders: Walls, tone: Cells, within: float = EDGE_PT, darkest_from: float = 0.0) -> list[Floats]:
    """Lines along strong edges on their dark side, so far within, each in samples (k, 2).

    tone: (rows, columns) of the whole sheet; it is darker there than `darkest_from`.
    """
    segments = borders.segments[borders.inside > 0]
    if not len(segments):
        return []
    vertices, number = np.unique(segments.reshape(-1, 2), axis=0, return_inverse=True)
    out = []
    for trail, _ in trails(vertices, number.reshape(-1, 2), 0.0):
        middle = _smoothed(_sampled(vertices[trail]))
        normal = polylines.normals(middle, np.array([0, len(middle)]))
        left, right = (_at(borders, tone, middle + side * BESIDE_PT * normal) for side in (-1.0, 1.0))
        for side, own, other in ((-1.0, left, right), (1.0, right, left)):
            for low, high in _runs((own - other > DARKER) & (own > darkest_from)):
                if high - low > SHORTEST:
                    out.append(middle[low:high] + side * within * normal[low:high])
    return out


def _sampled(corners: Floats) -> Floats:
    """The polyline in steps of about `STEP_PT`, its corners among them."""
    legs = np.sqrt((np.diff(corners, axis=0) ** 2).sum(axis=1))
    steps = np.maximum(1, np.rint(legs / STEP_PT)).astype(np.int64)
    which = np.repeat(np.arange(len(steps)), steps)
    part = curves.ramp(steps) / steps[which]
    points = corners[which] + (corners[which + 1] - corners[which]) * part[:, None]
    return np.concatenate([points, corners[-1:]])


def _smoothed(points: Floats) -> Floats:
    """Without the corners of a polyline that stands for a curve, its ends as they are."""
    for _ in range(2):
        points = points.copy()
        points[1:-1] = (points[:-2] + 2 * points[1:-1] + points[2:]) / 4
    return points


def _at(borders: Walls, tone: Cells, points: Floats) -> Floats:
    """The tone at points (k, 2)."""
    rows, columns = tone.shape
    left, top, right, bottom = borders.box
    size = np.array([left + right, top + bottom])  # the box lies as far within on all sides
    at = np.clip(np.floor(points / size * (columns, rows)).astype(np.int64), 0, [columns - 1, rows - 1])
    return tone[at[:, 1], at[:, 0]].astype(np.float64)


def _runs(wanted: npt.NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Where runs of what is wanted begin and end."""
    change = np.flatnonzero(np.diff(np.concatenate([[0], wanted.astype(np.int8), [0]])))
    return list(zip(change[::2].tolist(), change[1::2].tolist()))
