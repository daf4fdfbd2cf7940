"""Thin dark things: a stroke along each, drawn before any hatching.

Hatching samples the tone at its spacing, and what is thinner than two spacings (a wire, a whisker, the leg of a
tripod) comes out as a row of stubs, or not at all. Here it is found as a ridge of the tone, its crest followed
from cell to cell, and drawn along. Light things on dark ground need nothing: there the hatching leaves out what
it would cover. This module alone imports the compiled kernel.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import curves, walls
from penink_cli.blasting._compiled import thin as _thin
from penink_cli.blasting.sheet import Cells, Sheet
from penink_cli.ground.model import Floats, Ints, Strokes

#: How much darker than both its sides a crest must be: in each cell, and in the mean along a line.
CONTRAST, MEAN_CONTRAST = 0.05, 0.09
#: How far away, in cells, its sides are.
BESIDE = 3.0
#: The greatest tone of the sides: in the dark one line more is not seen.
DARKEST_GROUND = 0.6
#: The least length of a line, and the distance of a stroke's knots, points.
SHORTEST_PT = 6.0
KNOT_PT = 7.0
#: The most strokes side by side along one thing.
MOST = 4
#: Strokes side by side taper: each begins and ends further in than its neighbour towards the middle, by so many painted
#: widths at the start and at the end. Strokes of one length would be a bar.
TAPER = (2.0, 3.0)
#: The most that a stroke is shortened by this, in parts of a leg between knots: small dark things, such as pupils, keep
#: their weight.
MOST_OF_LEG = 0.3
#: A thing fainter than a line of the pen is drawn with a finer one: its least width in parts of the pen's.
FINEST = 0.55


def crests(tone: Cells) -> tuple[npt.NDArray[np.bool_], Floats, Floats, Floats]:
    """Where the tone has a crest (rows, columns), its contrast, and the unit normal (x, y) across it."""
    t = tone.astype(np.float64)
    # a light blur, and the second derivatives of what it leaves
    p = np.pad(t, 2, mode="edge")
    p = (p[:-2] + 2 * p[1:-1] + p[2:]) / 4
    p = (p[:, :-2] + 2 * p[:, 1:-1] + p[:, 2:]) / 4
    centre = p[1:-1, 1:-1]
    xx = p[1:-1, 2:] - 2 * centre + p[1:-1, :-2]
    yy = p[2:, 1:-1] - 2 * centre + p[:-2, 1:-1]
    xy = (p[2:, 2:] - p[2:, :-2] - p[:-2, 2:] + p[:-2, :-2]) / 4
    root = np.sqrt((xx - yy) ** 2 + 4 * xy * xy)
    bend = (xx + yy - root) / 2
    # the eigenvector of the stronger, negative curvature
    nx, ny = np.where(xx > yy, 2 * xy, xx - yy - root), np.where(xx > yy, yy - xx - root, 2 * xy)
    length = np.sqrt(nx * nx + ny * ny)
    nx, ny = (
        np.where(length > 1e-12, nx / np.maximum(length, 1e-12), 1.0),
        np.where(length > 1e-12, ny / np.maximum(length, 1e-12), 0.0),
    )
    rows, columns = np.nonzero(bend < -0.02)
    mask, contrast = np.zeros(t.shape, bool), np.zeros(t.shape)
    at = centre[rows, columns]
    ax, ay = nx[rows, columns], ny[rows, columns]

    def look(d: float) -> Floats:
        return bilinear(centre, columns + ax * d, rows + ay * d)

    near = (look(-0.8), look(0.8))
    beside = (look(-BESIDE), look(BESIDE))
    drop = at - np.maximum(*beside)
    keep = (at >= np.maximum(*near)) & (drop > CONTRAST) & (np.minimum(*beside) < DARKEST_GROUND)
    mask[rows[keep], columns[keep]] = True
    contrast[rows[keep], columns[keep]] = drop[keep]
    return mask, contrast, nx, ny


def bilinear(values: Floats, x: Floats, y: Floats) -> Floats:
    """Values at (x, y) in cells, those at the border beyond it."""
    h, w = values.shape
    x, y = np.clip(x, 0, w - 1), np.clip(y, 0, h - 1)
    i, j = np.minimum(y.astype(np.int64), max(h - 2, 0)), np.minimum(x.astype(np.int64), max(w - 2, 0))
    g, f = y - i, x - j
    i1, j1 = np.minimum(i + 1, h - 1), np.minimum(j + 1, w - 1)
    top = values[i, j] * (1 - f) + values[i, j1] * f
    low = values[i1, j] * (1 - f) + values[i1, j1] * f
    mixed: Floats = top * (1 - g) + low * g
    return mixed


def follow(mask: npt.NDArray[np.bool_], contrast: Floats, nx: Floats, ny: Floats) -> list[Ints]:
    """Lines of crest cells (n, 2), row and column, the strongest first; each cell is in one line at most."""
    cells = np.column_stack(np.nonzero(mask))
    order = np.argsort(-contrast[mask], kind="stable")
    lines: list[Ints] = _thin.follow(mask.astype(np.uint8), cells[order], nx, ny)
    return lines


def breadth(tone: Floats, where: Ints, nx: Floats, ny: Floats, cell_pt: float) -> float:
    """How broad a line of solid ink would be (points) that is as dark as the crest over its ground, on the mean."""
    rows, columns = where[:, 0], where[:, 1]
    x, y = columns.astype(np.float64), rows.astype(np.float64)
    ax, ay = nx[rows, columns], ny[rows, columns]
    away = np.arange(-4.0, 4.25, 0.5)[:, None]
    across = bilinear(tone, x + ax * away, y + ay * away)
    ground = np.maximum(across[:5].min(axis=0), across[-5:].min(axis=0))
    return float(np.mean(np.maximum(across - ground, 0.0).sum(axis=0) * 0.5 / np.maximum(1.0 - ground, 0.2))) * cell_pt


def strokes_along(
    sheet: Sheet, pen_pt: float, painted_pt: float, fixed: bool, told: npt.NDArray[np.bool_] | None = None
) -> Strokes:
    """Strokes along each thin dark thing of the sheet: one, or several side by side where it is broader than a pen.

    pen_pt: width of the strokes, the greatest unless `fixed`. painted_pt: how wide the device paints one. told: where,
    for each cell, a line is drawn already.
    """
    mask, contrast, nx, ny = crests(sheet.tone)
    if told is not None:
        mask &= ~told
    tone = sheet.tone.astype(np.float64)
    cell = np.array([sheet.width / sheet.columns, sheet.height / sheet.rows])
    parts: list[Floats] = []
    sizes: list[int] = []
    pens: list[float] = []
    for where in follow(mask, contrast, nx, ny):
        if len(where) * float(cell.min()) < 0.8 * SHORTEST_PT:
            continue
        if float(contrast[where[:, 0], where[:, 1]].mean()) < MEAN_CONTRAST:
            continue
        p = (where[:, ::-1] + 0.5) * cell
        # the steps from cell to cell smoothed away, the ends kept
        for _ in range(3):
            p[1:-1] = (p[:-2] + 2 * p[1:-1] + p[2:]) / 4
        legs = np.diff(p, axis=0)
        run = np.concatenate([[0.0], np.cumsum(np.sqrt((legs * legs).sum(axis=1)))])
        if run[-1] < SHORTEST_PT:
            continue
        broad = breadth(tone, where, nx, ny, float(cell.min()))
        side_by_side = int(min(max(round(broad / (1.1 * painted_pt)), 1), MOST))
        pen = pen_pt if fixed else min(max(pen_pt * broad / painted_pt, FINEST * pen_pt, 1.5 * sheet.gain_pt), pen_pt)
        n = max(1, round(run[-1] / KNOT_PT))
        s = np.linspace(0.0, run[-1], n + 1)
        knots = np.column_stack([np.interp(s, run, p[:, 0]), np.interp(s, run, p[:, 1])])
        slope = np.gradient(knots, axis=0) / 3 if n > 1 else np.repeat(knots[1:] - knots[:1], 2, axis=0) / 3
        length = np.maximum(np.sqrt((slope * slope).sum(axis=1)), 1e-9)[:, None]
        ahead = slope / length
        normal = np.column_stack([-ahead[:, 1], ahead[:, 0]])
        for k in range(side_by_side):
            aside = k - (side_by_side - 1) / 2
            further = min(abs(aside) * painted_pt, MOST_OF_LEG * run[-1] / n / max(TAPER))
            moved = knots + normal * (aside * broad / side_by_side)
            moved[0] += ahead[0] * (further * TAPER[0])
            moved[-1] -= ahead[-1] * (further * TAPER[1])
            inner = np.stack([moved[:-1] + slope[:-1], moved[1:] - slope[1:], moved[1:]], axis=1).reshape(-1, 2)
            parts.append(np.concatenate([moved[:1], inner]))
            sizes.append(3 * n + 1)
            pens.append(pen)
    first: Ints = curves.starts(np.array(sizes, np.int64))
    points = np.concatenate(parts) if parts else np.zeros((0, 2))
    d = walls.margin(pen_pt, sheet.width, sheet.height)
    points = np.clip(points, d, (sheet.width - d, sheet.height - d))
    return Strokes(sheet.width, sheet.height, points, first, np.array(pens, np.float64))
