"""Finding the directions of a photograph, by its tones, its lines and the user's own strokes."""

from __future__ import annotations

import numpy as np

from penink_cli.composition.filters import shrunk
from penink_cli.directions import evidence
from penink_cli.directions.polylines import crossed, of_lines, of_strokes
from penink_cli.directions.solving import solved
from penink_cli.ground.angles import direction
from penink_cli.ground.model import ColourImage, Directions, EdgeList, Floats, GreyImage, Lines, Strokes

ANGLE = -45.0  # degrees; for all four see `detect_directions`
FOLLOW = 0.5
NOISE = 0.006
SIZE = 96
_LINES = 2.0  # the weight of a telling line that crosses a sample
_STROKES = 6.0  # the weight of a stroke of the user's
_BESIDE = 2.5  # σ, samples: around the user's strokes the photo does not count
_PEAK = 0.16  # the greatest value of a line one sample wide that a Gaussian of that σ has blurred
_PULL, _LEAST = 0.1, 0.003  # the weight of the hatch's own angle is _LEAST where follow is 1, _PULL more where it is .5


def detect_directions(
    photo: GreyImage | ColourImage,
    edges: EdgeList | None = None,
    *,
    angle: float = ANGLE,
    follow: float = FOLLOW,
    across: bool = False,
    noise: float = NOISE,
    size: int = SIZE,
    strokes: Strokes | None = None,
    lines: Lines | None = None,
) -> Directions:
    """The direction field of a photograph, of `size` samples along its long side or as many as it has pixels.

    edges: its discontinuity edges, across which the field is not smooth. angle: degrees from x towards y, of strokes
    where nothing is known of the form. follow: 0 for that angle alone … 1 for the form wherever it leads. across:
    strokes run along the gradient of the tones instead of across it. noise: a mean gradient, in grey of 1 a pixel of
    the photo at 384 pixels; places with less gradient count less and less. strokes: the user's own, which hold whatever
    the photo says, on a sheet that stands for the photo. lines: its telling lines.

    Confidence is the part of a direction that comes from evidence, and not from the angle. It is at least 1/254, and 1
    where the user's strokes are.
    """
    edges = EdgeList(1, 1) if edges is None else edges
    height, width = photo.values.shape[:2]
    shrink = max(1.0, max(height, width) / size)
    rows, columns = max(1, round(height / shrink)), max(1, round(width / shrink))
    found = evidence.tangents(photo, edges, noise)
    vectors, weight = (_means(plane, rows, columns) for plane in (found.vectors, found.weight))
    if lines is not None:
        drawn, much = crossed(of_lines(lines), rows, columns)
        trust = _LINES * _means(found.trust, rows, columns)
        for k in range(2):
            vectors[..., k] += evidence.smooth(drawn[..., k] * trust, 1.0)
        weight += evidence.smooth(much * trust, 1.0)
    if across:
        vectors = -vectors
    fixed = np.zeros((rows, columns), bool)
    if strokes is not None:
        drawn, much = crossed(of_strokes(strokes), rows, columns)
        fixed = much > 0
        # Beside the user's strokes the photo does not count: it may say the contrary.
        heard = 1 - np.minimum(evidence.smooth(fixed.astype(np.float64), _BESIDE) / _PEAK, 1.0)
        vectors, weight = vectors * heard[..., None], weight * heard
        vectors[fixed] = drawn[fixed] * (_STROKES / much[fixed])[:, None]
        weight[fixed] = _STROKES
    pull = _LEAST + _PULL * (1 - follow) / max(follow, 1e-9)
    c, s = direction(2 * angle)
    x, confidence = solved(vectors, weight, fixed, evidence.links(edges, rows, columns), (c, s), pull)
    length = np.sqrt(x[..., 0] * x[..., 0] + x[..., 1] * x[..., 1])
    known = length > 1e-9
    divisor = np.where(known, length, 1.0)
    return Directions(
        np.where(known, x[..., 0] / divisor, c),
        np.where(known, x[..., 1] / divisor, s),
        np.where(fixed, 1.0, np.clip(confidence, 1 / 254, 1.0)),
    )


def _means(plane: Floats, rows: int, columns: int) -> Floats:
    """A plane (h, w) or (h, w, k) reduced to rows × columns."""
    return shrunk(plane.astype(np.float32), columns, rows).astype(np.float64)
