"""Values along polylines whose samples lie close together: directions, means, what is between two samples.

Polylines lie one after the other: `first` (n + 1,) says where each begins among the samples (p,), as in
`curves.Polylines`.
"""

from __future__ import annotations

import numpy as np

from penink_cli.ground.model import Floats, Ints


def ahead(points: Floats, first: Ints) -> Floats:
    """Unit vectors along polylines at their samples."""
    chord = np.zeros_like(points)
    if len(points) > 2:
        np.subtract(points[2:], points[:-2], out=chord[1:-1])
    start, end = first[:-1], first[1:] - 1
    chord[start] = points[np.minimum(start + 1, end)] - points[start]
    chord[end] = points[end] - points[np.maximum(end - 1, start)]
    x, y = chord[:, 0], chord[:, 1]
    chord /= np.maximum(np.sqrt(x * x + y * y), 1e-9)[:, None]
    return chord


def normals(points: Floats, first: Ints) -> Floats:
    """Unit vectors at right angles to polylines at their samples."""
    along = ahead(points, first)
    return np.column_stack([-along[:, 1], along[:, 0]])


def smoothed(values: Floats, first: Ints) -> Floats:
    """Means with weights 1 2 1 along each polyline."""
    before, after = np.arange(len(values)) - 1, np.arange(len(values)) + 1
    before[first[:-1]] = first[:-1]
    after[first[1:] - 1] = first[1:] - 1
    return (values[before] + 2 * values + values[after]) / 4


def mean_along(values: Floats, first: Ints, reach: int) -> Floats:
    """Means over so many samples each way along each polyline, as far as it goes."""
    total = np.concatenate([[0.0], np.cumsum(values)])
    who = np.repeat(np.arange(len(first) - 1), np.diff(first))
    at = np.arange(len(values))
    low, high = np.maximum(at - reach, first[who]), np.minimum(at + reach + 1, first[who + 1])
    return np.asarray((total[high] - total[low]) / (high - low), np.float64)


def between(points: Floats, origin: Ints, at: Floats, last: Ints) -> Floats:
    """Points at places `at` (n,), in samples from the sample `origin` on, up to the sample `last`."""
    low = np.minimum(origin + np.maximum(np.floor(at), 0).astype(np.int64), np.maximum(last - 1, origin))
    part = np.clip(at - (low - origin), 0.0, 1.0)[:, None]
    return points[low] * (1 - part) + points[np.minimum(low + 1, last)] * part
