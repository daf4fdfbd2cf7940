"""The width and the density of strokes, measured on a picture of them as one would with a lens."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter, sobel


def crossings(shot: np.ndarray, patch: int = 48) -> tuple[float, float, int]:
    """Median width of single strokes, strokes crossed a pixel at a tone of 30 %, and how many patches tell.

    shot: (h, w) 0 … 255, 255 for paper. Looked at are square patches of middle tone (20 … 40 %) whose strokes have one
    direction, in rows or columns as these cross them the more steeply; a stroke is what lies between paper and paper,
    its width the ink of that run, seen across it.
    """
    ink = 1 - shot / 255.0
    soft = gaussian_filter(ink, 1.0)
    gx, gy = sobel(soft, 1), sobel(soft, 0)
    widths: list[float] = []
    densities: list[float] = []
    for y in range(0, ink.shape[0] - patch + 1, patch):
        for x in range(0, ink.shape[1] - patch + 1, patch):
            here = np.s_[y : y + patch, x : x + patch]
            tone = float(ink[here].mean())
            xx, yy, xy = (gx[here] ** 2).mean(), (gy[here] ** 2).mean(), (gx[here] * gy[here]).mean()
            if not 0.2 < tone < 0.4 or np.hypot(xx - yy, 2 * xy) < 0.8 * (xx + yy):
                continue
            across = 0.5 * np.arctan2(2 * xy, xx - yy)
            steep = max(abs(np.cos(across)), abs(np.sin(across)))
            lines = ink[here] if abs(np.cos(across)) >= abs(np.sin(across)) else ink[here].T
            found = [run * steep for line in lines for run in _runs(line)]
            if len(found) >= patch:
                widths += found
                densities.append(len(found) / (patch * patch * steep) * 0.3 / tone)
    return float(np.median(widths)), float(np.median(densities)), len(densities)


def _runs(line: np.ndarray) -> list[float]:
    """The ink of each run between paper and paper."""
    dark = np.concatenate([[False], line > 0.05, [False]])
    begins, ends = np.flatnonzero(dark[1:] & ~dark[:-1]), np.flatnonzero(~dark[1:] & dark[:-1])
    return [float(line[a:b].sum()) for a, b in zip(begins, ends, strict=True) if a > 0 and b < len(line)]
