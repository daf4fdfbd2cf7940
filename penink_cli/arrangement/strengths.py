"""How strong each edge is: the grey step across it, measured between what lies on its two sides.

The slope at an edge's points tells it too, but at junctions, on thin lines and where the blur varies it is off by more
than .02 of grey on four edges of ten. Measured so, it is on 1.3 to 2 of a hundred. As many stand at junctions where the
truth itself is not one number. Under four levels of noise and 1.5 pixels of blur 12 are off, and another draw of the
noise moves 23. A longer reach averages more noise out on scenes of planes, but reads other things on photographs
(`python -m tests.benchmarks.edges strengths reaches`).
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from penink_cli.arrangement._compiled import steps as _steps
from penink_cli.geometry import edge_index, walls
from penink_cli.ground import exact
from penink_cli.ground import threads as threading
from penink_cli.ground.model import EdgeList, Floats

_CELL_PX = 4.0
_TASK = 1000  # edges
_OWN = 0.2  # variance, pixels², that a pixel's area adds to the blur, and edges a little off their places
_CLEAN = 1.6  # blurs from an edge a pixel has little of the other side, which is reckoned out
_MIXED = 2.6  # beyond so many it has none
_BEYOND = 4.5  # pixels farther: fewer do not average the noise out, more are not the edge's own
_LONG_PX = 12.0  # longer edges are looked at in three places
_PARTS = 32  # of a pixel, and of the bell curve's deviation, in tables


def strengths(grey: npt.NDArray[np.floating], edges: EdgeList, lens: float) -> Floats:
    """The grey step (m,) across each edge, 0 … 1; below 0 where one side has no pixel, as along the frame.

    Args:
        grey: (h, w) the photo, 0 … 1.
        edges: in its frame.
        lens: standard deviation, pixels, of the blur that the photo was taken with.

    """
    height, width = grey.shape
    blur = min(float(exact.hypot(lens, np.sqrt(_OWN))), (_steps.MAX_REACH - _BEYOND) / _MIXED)
    ends = np.column_stack(walls.segments(edges, width, height))
    columns, rows = math.ceil(width / _CELL_PX) + 2, math.ceil(height / _CELL_PX) + 2
    photo = _steps.Photo(
        np.ascontiguousarray(grey, np.float32),
        walls.distances(edges, width, height, _MIXED * blur),
        walls.walls(edges, width, height),
        ends,
        _CELL_PX,
        columns,
        *edge_index.lists(*edge_index.cells(ends, _CELL_PX), columns, rows),
        _mixed(blur),
        _PARTS,
        _CLEAN * blur,
        _CLEAN * blur + _BEYOND,
    )
    step = np.empty(len(ends))

    def some(first: int, last: int) -> None:
        photo.measure(first, last, _LONG_PX, step)

    threading.share(threading.ranges(some, len(ends), _TASK), threading.count(None))
    return np.minimum(step, 1)


def _mixed(blur: float) -> Floats:
    """The part of a blurred step's one side that is the other's, by the distance from it in parts of a pixel."""
    z = (np.arange(8 * _PARTS) + 0.5) / _PARTS  # of the bell curve's deviation
    bell = exact.exp(-0.5 * z * z)
    above = np.append(np.cumsum(bell[::-1])[::-1], 0.0)
    at = np.arange(math.ceil(_MIXED * blur * _PARTS) + 1) / _PARTS / blur
    return np.interp(at, np.arange(len(above)) / _PARTS, 0.5 * above / above[0])
