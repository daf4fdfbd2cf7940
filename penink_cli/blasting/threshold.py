"""The threshold rule: each stroke of a table is drawn wherever the tone exceeds its threshold.

It needs no coverage buffer, so a printer and a web page can follow it too; given the same table, the
same tone and the same edges, they and this module draw the same strokes. One feedback pass: the ink
that a first pass would lay is compared with the tone in blocks of 9 pt, and the difference, smoothed,
is added to the tone of the second.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import _threshold
from penink_cli.model import Floats, Ints
from penink_cli.textures.threshold import Screen, ThresholdTable

BLOCK_PT = 9.0
GAP, SHORT, DEEP = 3, 3.0, 24.0

Bytes = npt.NDArray[np.uint8]


def buckets(ends: Floats, columns: int, rows: int) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int32]]:
    """first (columns · rows + 1,) and items: which edges (m, 4) ax ay bx by, in sample units, are in which square."""
    lists: list[list[int]] = [[] for _ in range(columns * rows)]
    for e, (ax, ay, bx, by) in enumerate(ends.tolist()):
        for j in range(math.floor(min(ay, by)), math.floor(max(ay, by)) + 1):
            for i in range(math.floor(min(ax, bx)), math.floor(max(ax, bx)) + 1):
                if 0 <= i + 1 < columns and 0 <= j + 1 < rows:
                    lists[(j + 1) * columns + i + 1].append(e)
    first = np.cumsum([0] + [len(x) for x in lists]).astype(np.int32)
    items = np.array([e for x in lists for e in x] or [0], np.int32)
    return first, items


def _copies(screen: Screen, width: float, height: float) -> npt.NDArray[np.int32]:
    c, s = direction(screen.angle)
    corners = np.array([(0, 0), (width, 0), (0, height), (width, height)])
    u, v = corners[:, 0] * c + corners[:, 1] * s, corners[:, 1] * c - corners[:, 0] * s
    lo = np.floor(np.array([u.min() / screen.width, v.min() / screen.height]) - 1).astype(int)
    hi = np.ceil(np.array([u.max() / screen.width, v.max() / screen.height])).astype(int)
    a, b = np.meshgrid(np.arange(lo[0], hi[0] + 1), np.arange(lo[1], hi[1] + 1))
    return np.column_stack([a.ravel(), b.ravel()]).astype(np.int32)


def direction(angle: float) -> tuple[float, float]:
    """Cosine and sine of an angle in degrees, rounded so that every machine has the same."""
    return round(math.cos(math.radians(angle)), 12), round(math.sin(math.radians(angle)), 12)


def draw(
    tone: Bytes, ends: Floats, samples: tuple[int, int], table: ThresholdTable, width: float, height: float,
    magnification: float = 1.0, feedback: int = 1,
) -> list[tuple[Floats, Ints]]:  # fmt: skip
    """For each screen its runs on a page of width × height points: points (p, 2) of polylines, and where each ends.

    tone: (m, n) ink in 255ths on the grid that the reconstruction fills. ends: (e, 4) the edges, in units of
    the samples (w, h). magnification: of pen and tile, for devices too coarse for the table's pen.
    """
    magnification *= table.magnification
    w, h = width / magnification, height / magnification
    columns, rows = samples[0] + 1, samples[1] + 1
    first, items = buckets(ends, columns, rows)
    ax, ay, bx, by = (np.ascontiguousarray(ends[:, i], np.float64) if len(ends) else np.zeros(1) for i in range(4))
    wanted = tone
    for left in range(feedback, -1, -1):
        bare = np.ones((math.ceil(h / BLOCK_PT), math.ceil(w / BLOCK_PT)))
        tall = np.minimum(BLOCK_PT, h - BLOCK_PT * np.arange(bare.shape[0]))
        wide = np.minimum(BLOCK_PT, w - BLOCK_PT * np.arange(bare.shape[1]))
        area = np.outer(tall, wide)
        parts = []
        for screen in table.screens:
            c, s = direction(screen.angle)
            control = np.ascontiguousarray(screen.points.reshape(-1, 4, 2))
            copies = _copies(screen, w, h)
            ink = np.zeros_like(bare)
            room = 1 << 20
            while True:
                points, ends_of, count = np.zeros((room, 2)), np.zeros(room // 2, np.int64), np.zeros(2, np.int64)
                ink[:] = 0
                if _threshold.runs(
                    wanted, w, h, control, screen.enters * 255, screen.line, table.way, screen.level,
                    c, s, screen.width, screen.height, copies, columns, rows, ax, ay, bx, by, first, items,
                    table.pen_pt, table.whole, GAP, SHORT, DEEP, BLOCK_PT, ink, points, ends_of, count,
                ):  # fmt: skip
                    break
                room *= 4
            bare *= 1 - np.interp(ink / area, screen.lengths, screen.covers)
            parts.append((points[: count[0]] * magnification, ends_of[: count[1]]))
        if left:
            wanted = corrected(tone, bare, area, w, h)
    return parts


def corrected(tone: Bytes, bare: Floats, area: Floats, w: float, h: float) -> Bytes:
    """The tone with what a pass that leaves the blocks so `bare` lacks, smoothed over the blocks, added."""
    m, n = tone.shape
    by = np.minimum((np.arange(m) + 0.5) * h / m // BLOCK_PT, bare.shape[0] - 1).astype(int)
    bx = np.minimum((np.arange(n) + 0.5) * w / n // BLOCK_PT, bare.shape[1] - 1).astype(int)
    total = np.zeros_like(bare)
    cells = np.zeros_like(bare)
    np.add.at(total, (by[:, None], bx[None, :]), tone)
    np.add.at(cells, (by[:, None], bx[None, :]), 1)
    lack = total / np.maximum(cells, 1) - 255 * (1 - bare)
    for axis in (0, 1):
        padded = np.pad(lack, [(1, 1) if a == axis else (0, 0) for a in (0, 1)], "edge")
        before = np.take(padded, range(lack.shape[axis]), axis)
        after = np.take(padded, range(2, lack.shape[axis] + 2), axis)
        lack = (before + 2 * lack + after) / 4

    def spread(count: int, size: float, blocks: int) -> tuple[Ints, Ints, Floats]:
        at = (np.arange(count) + 0.5) * size / count / BLOCK_PT - 0.5
        low = np.clip(np.floor(at), 0, blocks - 1).astype(int)
        return low, np.minimum(low + 1, blocks - 1), np.clip(at - low, 0, 1)

    y0, y1, fy = spread(m, h, lack.shape[0])
    x0, x1, fx = spread(n, w, lack.shape[1])
    rows = lack[y0] * (1 - fy)[:, None] + lack[y1] * fy[:, None]
    more = rows[:, x0] * (1 - fx) + rows[:, x1] * fx
    return np.where(tone == 0, 0, np.clip(np.floor(tone + more + 0.5), 0, 255)).astype(np.uint8)
