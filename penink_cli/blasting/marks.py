"""Marks: small dark things on bare paper, drawn as themselves before any hatching.

A full stop, a letter or a leg is smaller than the strokes of a hatching: these would lie across it and stick out, or
leave it pale. Here such a thing is filled, row by row, with short strokes of a fine pen that end where it ends.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from penink_cli.blasting.sheet import Cells, resample
from penink_cli.ground.masks import distance, labelled
from penink_cli.ground.model import Floats, Ints, Strokes

Mask = npt.NDArray[np.bool_]

#: A thing is where the tone exceeds LEVEL. Somewhere in it the tone reaches CORE, as does the mean of what is deeper
#: in it than NEAR_PT. From NEAR_PT to FAR_PT around it nothing is darker than PAPER. No place in it is further than
#: HALF_PT from its border.
LEVEL, CORE, PAPER, NEAR_PT, FAR_PT, HALF_PT = 0.5, 0.75, 0.12, 1.0, 2.5, 7.0
#: The distance of the rows of strokes, in painted widths.
PITCH = 0.8
#: A thing no larger than DOT_PT is one dot, if it is at most ROUND times as long as broad and fills at least FULL of
#: the box around it.
DOT_PT, ROUND, FULL = 3.2, 1.4, 0.6
#: The part of a thing that ink on the sheet covers from which on it counts as drawn already.
INKED = 0.6
#: Pixels a point at which the tone is examined.
FINE = 2.0


def marks(
    tone: Floats, width_pt: float, height_pt: float, pen_pt: float, gain_pt: float, fixed: bool, ink: Cells
) -> Strokes:
    """Strokes that fill every small dark thing of the tone (h, w) on a sheet of that size.

    pen_pt: their width, that of dots too where it is `fixed`; gain_pt: how much wider the device paints them.
    ink: (rows, columns) what is on the sheet already: what that covers is drawn.
    """
    none = Strokes(width_pt, height_pt)
    h, w = tone.shape
    if not (tone > LEVEL).any():
        return none
    if w < FINE * width_pt or h < FINE * height_pt:
        h, w = max(h, round(FINE * height_pt)), max(w, round(FINE * width_pt))
        tone = resample(tone, h, w)
    px = math.sqrt(w * h / (width_pt * height_pt))  # pixels in a point
    chains: list[Floats] = []
    widths: list[float] = []
    scale = np.array([width_pt / w, height_pt / h])
    for top, left, mine, off in things(tone, px):
        around = tone[top : top + mine.shape[0], left : left + mine.shape[1]]
        rows, columns = np.nonzero(mine)
        at = (rows + top) * ink.shape[0] // h, (columns + left) * ink.shape[1] // w
        if math.fsum(ink[at].tolist()) > INKED * len(rows):
            continue
        area = math.fsum(np.minimum(around[off <= 1.0], 1.0).tolist()) / (px * px)
        sides = (rows.max() - rows.min() + 1) / px, (columns.max() - columns.min() + 1) / px
        size = 2 * math.sqrt(area / math.pi)
        rounded = max(sides) <= ROUND * min(sides) and area >= FULL * sides[0] * sides[1]
        if not fixed and size <= DOT_PT and rounded:
            weight = np.where(off <= 1.0, around, 0.0)
            total = math.fsum(weight.ravel().tolist())
            x = math.fsum((weight * (np.arange(weight.shape[1]) + 0.5)).ravel().tolist()) / total + left
            y = math.fsum((weight * (np.arange(weight.shape[0]) + 0.5)[:, None]).ravel().tolist()) / total + top
            chains.append(np.array([[x, y]]) * scale)
            widths.append(max(size - gain_pt, 0.1))
            continue
        fill(np.where(off <= 1.0, around, 0.0), np.array([left, top]), scale, pen_pt, gain_pt, chains, widths, fixed)
    return Strokes.of(width_pt, height_pt, chains, widths)


def things(tone: Floats, px: float) -> Iterator[tuple[int, int, Mask, Floats]]:
    """Small dark things on bare paper: row and column of a window, what is the thing in it, how far all is off.

    tone: (h, w), px pixels a point.
    """
    part, boxes = labelled(tone > LEVEL)
    reach = math.ceil(FAR_PT * px) + 1
    most = 2 * math.ceil(40 * px)
    for k, (first_row, last_row, first_column, last_column) in enumerate(boxes.tolist(), 1):
        if last_row - first_row > most or last_column - first_column > most:
            continue
        top, left = max(0, first_row - reach), max(0, first_column - reach)
        window = (slice(top, last_row + reach), slice(left, last_column + reach))
        mine = part[window] == k
        around = tone[window]
        if float(around[mine].max()) < CORE:
            continue
        off = distance(~mine) / px
        others = distance(part[window] == 0) / px  # letters stand close
        ring = (off >= NEAR_PT) & (off <= FAR_PT) & (others >= NEAR_PT)
        if ring.any() and float(around[ring].max()) > PAPER:
            continue
        depth = distance(np.pad(mine, 1))[1:-1, 1:-1] / px
        if float(depth.max()) > HALF_PT:
            continue
        inner = around[depth > NEAR_PT]
        if len(inner) and math.fsum(inner.tolist()) < CORE * len(inner):  # an iris around its pupil
            continue
        yield top, left, mine, off


def fill(
    tone: Floats, corner: Floats, scale: Floats, pen_pt: float, gain_pt: float, chains: list[Floats],
    widths: list[float], fixed: bool,
) -> None:  # fmt: skip
    """Strokes along the rows of a thing, in points: tone (h, w) with nothing else in it, corner its place, pixels."""
    painted = pen_pt + gain_pt
    h, w = tone.shape
    pitch = PITCH * painted / scale[1]
    inset = painted / 2
    ys = np.arange(pitch / 2, h, pitch)
    # rows between pixel centres
    at = np.clip(ys - 0.5, 0, h - 1)
    i = np.minimum(at.astype(np.int64), max(h - 2, 0))
    dark = tone > LEVEL
    # most of a picture is none of the thing
    there, used = np.asarray(dark.any(axis=1)), np.flatnonzero(dark.any(axis=0))
    some = there[i] | there[np.minimum(i + 1, h - 1)]
    if not some.any():
        return
    ys, i, f = ys[some], i[some], (at - i)[some, None]
    left, right = max(0, int(used[0]) - 1), min(w, int(used[-1]) + 2)
    part = tone[:, left:right]
    lines = part[i] * (1 - f) + part[np.minimum(i + 1, h - 1)] * f
    inked = np.zeros((len(ys), right - left + 2), np.bool_)
    inked[:, 1:-1] = lines > LEVEL
    row, a = np.nonzero(inked[:, 1:] & ~inked[:, :-1])
    b = np.nonzero(inked[:, :-1] & ~inked[:, 1:])[1]
    begin, end = _crossing(lines, row, a, left), _crossing(lines, row, b, left)
    x0, x1 = (begin + corner[0]) * scale[0], (end + corner[0]) * scale[0]
    y = (ys[row] + corner[1]) * scale[1]
    dot = x1 - x0 < 2 * inset
    drawn = straight(np.where(dot, (x0 + x1) / 2, x0 + inset), x1 - inset, y)
    chains.extend(line[:1] if short else line for line, short in zip(drawn, dot.tolist()))
    width = np.where(dot & (not fixed), np.maximum(np.minimum(pen_pt, x1 - x0 - gain_pt), 0.1), pen_pt)
    widths.extend(width.tolist())


def straight(x0: Floats, x1: Floats, y: Floats) -> list[Floats]:
    """Level lines from x0 to x1 (n,) at y as cubics: n arrays (4, 2)."""
    across = x0[:, None] + (x1 - x0)[:, None] * np.arange(4) / 3
    return list(np.stack([across, np.broadcast_to(y[:, None], across.shape)], axis=2))


def _crossing(lines: Floats, row: Ints, b: Ints, left: int) -> Floats:
    """Where rows reach LEVEL before the middle of pixel b (n,) of lines, which begin at pixel `left`: from that of 0.

    Before the first pixel and after the last one at their sides.
    """
    result = (b + left).astype(np.float64)
    inner = (b > 0) & (b < lines.shape[1])
    row, b = row[inner], b[inner]
    a = b - 1
    result[inner] = a + left + 0.5 + (LEVEL - lines[row, a]) / (lines[row, b] - lines[row, a])
    return result
