"""Fewer samples, each of which speaks only for what it can reach (the paper's section 3, third step)."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.model import EdgeList, Floats
from penink_cli.reconstruction import _clean
from penink_cli.reconstruction.extraction import in_bands, segments

Ints32 = npt.NDArray[np.int32]

_CELL = 4.0
_WINDOW = 49


def reduce(samples: npt.NDArray[np.floating], edges: EdgeList, width: int, height: int) -> npt.NDArray[np.float32]:
    """Reduce samples (h, w), 0 … 1, to a grid of width × height over the same frame.

    Each new sample is the value, at its place, of a plane fitted to the old samples that it can
    reach without crossing an edge.
    """
    values = np.ascontiguousarray(samples, np.float32)
    old_height, old_width = values.shape
    lines = segments(edges, old_width, old_height)
    walls = np.zeros(values.shape, np.uint8)
    _clean.block(*lines, walls)
    first, items = _buckets(lines, old_width, old_height)
    out = np.empty((height, width), np.float32)
    factor = max(old_width / width, old_height / height)

    def rows(band: tuple[int, int]) -> None:
        seen, queue = np.zeros(_WINDOW**2, np.int32), np.zeros((_WINDOW**2 + 9, 2), np.int32)
        _clean.resample(
            values, walls, *lines, _CELL, first, items, *band, min(23, round(factor)), 0.4 * factor,
            (0.3 * factor) ** 2, seen, queue, out,
        )  # fmt: skip

    in_bands(rows, height, 16)
    return np.clip(out, 0, 1, out=out)


def _buckets(lines: tuple[Floats, Floats, Floats, Floats], width: int, height: int) -> tuple[Ints32, Ints32]:
    rows, columns = int(height // _CELL) + 2, int(width // _CELL) + 2
    counts = np.zeros((rows, columns), np.int32)
    none = np.zeros(1, np.int32)
    _clean.bucket(*lines, _CELL, counts, none, False)
    ends = np.cumsum(counts.ravel()).astype(np.int32)
    first = np.concatenate([ends, ends[-1:]])[: rows * columns].reshape(rows, columns).copy()
    items = np.zeros(max(1, int(ends[-1])), np.int32)
    _clean.bucket(*lines, _CELL, first, items, True)
    return first, items
