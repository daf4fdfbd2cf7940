"""Telling lines as pen strokes for one size on paper, swelling and tapered."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from penink_cli.geometry import curves
from penink_cli.geometry.curves import lengths
from penink_cli.ground import pens
from penink_cli.ground.device import narrowed
from penink_cli.ground.median import median
from penink_cli.ground.model import Floats, LineChoice, Lines, Strokes
from penink_cli.lines.choice import chosen

#: Points: the distance of knots, and about the σ over which lines are smoothed.
KNOT_PT, SMOOTH_PT = 3.0, 0.6
#: The finest line that a pen draws, in parts of its broadest; the length of a tip, points; its width at the end, in
#: parts of the line's.
FINEST, TIP_PT, TIP = 0.25, 12.0, 0.45
#: A ruled line strays from the line it follows by at most RULED_PT. A line without a straight piece of STRAIGHT_PT is
#: drawn by hand. No piece goes beyond its corner by more than the part BEYOND of its length.
RULED_PT, STRAIGHT_PT, BEYOND = 1.2, 9.0, 0.25
#: A loose line strays anew every STRAYS_PT; the second line is finer by the factor SECOND; the lines begin and end up
#: to APART times as far apart as they stray.
STRAYS_PT, SECOND, APART = 16.0, 0.7, 4.0


def line_strokes(
    lines: Lines, width_pt: float, height_pt: float, choice: LineChoice, white: bool = False,
    device_dpi: float | None = None,
) -> Strokes:  # fmt: skip
    """Strokes along the dark lines, or the white ones, the most telling first, on a sheet of width_pt × height_pt.

    The strokes are as much finer as a printer of that resolution paints them broader, unless one pen draws them all.
    A small print, whose pens are finer, has room for the lines of a print that is as much larger.
    """
    by = 1.0 if choice.even else pens.part(width_pt)
    scale = np.array([width_pt / lines.width, height_pt / lines.height])
    chains: list[Floats] = []
    widths: list[Floats | float] = []
    for i in chosen(lines, width_pt / by, height_pt / by, choice, white).tolist():
        points, weight = lines[i] * scale, lines.weight[lines.first[i] : lines.first[i + 1]]
        if lines.breadth[i] > 0:
            breadth = float(lines.breadth[i]) * math.sqrt(float(scale[0] * scale[1]))
            chains.append(points if len(points) == 1 else curves.through(points, False))
            widths.append(choice.pen_pt if choice.even else max(breadth, FINEST * choice.pen_pt))
            continue
        knots, pressed, ring = _knots(points, weight)
        ruled = _ruled(points, choice.ruled_pt * by) if choice.ruled_pt and not ring else []
        if ruled:
            width = choice.pen_pt * (1.0 if choice.even else FINEST + (1 - FINEST) * float(median(pressed)))
            chains += ruled
            widths += [width] * len(ruled)
            continue
        strays = [knots] if not choice.loose_pt else _strays(knots, choice.loose_pt * by, i)
        for k, line in enumerate(strays):
            pen = choice.pen_pt if not k else SECOND * choice.pen_pt
            closed = ring and len(strays) == 1
            chains.append(curves.through(line, closed))
            widths.append(pen if choice.even else _widths(line, pressed, closed, pen))
    drawn = Strokes.of(width_pt, height_pt, chains, widths)
    if device_dpi and not choice.even:
        drawn = narrowed(drawn, device_dpi)
    return replace(drawn, device_dpi=device_dpi)


def _ruled(points: Floats, beyond: float) -> list[Floats]:
    """Straight cubics (4, 2) from corner to corner of a line (k, 2) and beyond; none where it has no straight piece.

    beyond: points that they go beyond the corners.
    """
    corners = [0, len(points) - 1]
    left = [(0, len(points) - 1)]
    while left:
        a, b = left.pop()
        chord = points[b] - points[a]
        inner = points[a + 1 : b] - points[a]
        if not len(inner):
            continue
        length = math.sqrt(float(chord[0] * chord[0] + chord[1] * chord[1]))
        off = np.abs(inner[:, 0] * chord[1] - inner[:, 1] * chord[0]) / max(length, 1e-9)
        k = int(np.argmax(off))
        if off[k] > RULED_PT:
            corners.append(a + 1 + k)
            left += [(a, a + 1 + k), (a + 1 + k, b)]
    ends = points[sorted(corners)]
    long = lengths(ends)
    if float(long.max()) < STRAIGHT_PT or float(long.max()) < 0.4 * math.fsum(long.tolist()):
        return []
    more = np.minimum(beyond, BEYOND * long)[:, None] * (ends[1:] - ends[:-1]) / np.maximum(long, 1e-9)[:, None]
    begin, end = ends[:-1] - more, ends[1:] + more
    return [a + (b - a) * (np.arange(4) / 3)[:, None] for a, b in zip(begin, end)]


def _strays(knots: Floats, by: float, seed: int) -> list[Floats]:
    """The line through knots (k, 2) as a hand draws it twice, loosely, each time straying by about `by` points."""
    rng = np.random.default_rng([seed, 17])
    run = np.concatenate([[0.0], np.cumsum(lengths(knots))])
    along = np.gradient(knots, axis=0)
    size = np.maximum(np.sqrt(along[:, 0] * along[:, 0] + along[:, 1] * along[:, 1]), 1e-9)[:, None]
    along = along / size
    across = np.column_stack([-along[:, 1], along[:, 0]])
    length = float(run[-1])
    at = np.arange(0.0, length + STRAYS_PT, STRAYS_PT)
    out = []
    for side in (-1.0, 1.0):
        aside = by * (rng.uniform(-0.7, 0.7, len(at)) + 0.5 * side)
        ends = rng.uniform(-0.5, 1.0, 2) * np.minimum(APART * by, length / 6)
        smooth = np.interp(run, at, aside)
        # towards its ends the stroke is stretched along itself, so that it goes on a little, or stops short
        moved = knots + across * smooth[:, None]
        share = np.clip(1 - np.minimum(run, length - run) / max(length / 3, 1e-9), 0, 1)[:, None]
        first = (run < length / 2)[:, None]
        out.append(moved + along * np.where(first, -ends[0], ends[1]) * share)
    return out


def _knots(points: Floats, weight: Floats) -> tuple[Floats, Floats, bool]:
    """Knots (k, 2) of a smooth curve through the points, the weight at each knot, and whether the curve is closed."""
    steps = lengths(points)
    gap = points[0] - points[-1]
    ring = len(points) > 5 and math.sqrt(float(gap[0] * gap[0] + gap[1] * gap[1])) < float(steps.max()) / 3
    if ring:
        points = np.concatenate([points[:-1], points[:1]])
    smooth, weight = _dense(points, weight, ring)
    run = np.concatenate([[0.0], np.cumsum(lengths(smooth))])
    spacing = float(run[-1]) / (len(smooth) - 1)
    for _ in range(min(40, round(2 * (SMOOTH_PT / spacing) ** 2))):
        inner = (smooth[:-2] + 2 * smooth[1:-1] + smooth[2:]) / 4
        ends = (smooth[-2:-1] + 2 * smooth[:1] + smooth[1:2]) / 4 if ring else smooth[:1]
        smooth = np.concatenate([ends, inner, ends if ring else smooth[-1:]])
    count = max(1, math.ceil(run[-1] / KNOT_PT))
    at = np.arange(count + 1) * (run[-1] / count)
    x, y, w = (np.interp(at, run, values) for values in (smooth[:, 0], smooth[:, 1], weight))
    return np.column_stack([x, y]), w, ring and count > 2


def _dense(points: Floats, weight: Floats, ring: bool) -> tuple[Floats, Floats]:
    """The curve through points (k, 2), as points no further apart than half of KNOT_PT, and their weights."""
    control = curves.through(points, ring)
    n = np.maximum(np.ceil(lengths(points) / (KNOT_PT / 2)), 1).astype(np.int64)
    leg = np.repeat(np.arange(len(n)), n)
    t = (np.arange(len(leg)) - np.repeat(np.cumsum(n) - n, n)) / n[leg]
    a, b, c, d = (control[3 * leg + k] for k in range(4))
    s, u = (1 - t)[:, None], t[:, None]
    dense = s * s * s * a + 3 * s * s * u * b + 3 * s * u * u * c + u * u * u * d
    weights = weight[leg] * (1 - t) + weight[leg + 1] * t
    return np.concatenate([dense, points[-1:]]), np.append(weights, weight[-1])


def _widths(knots: Floats, weight: Floats, ring: bool, pen_pt: float) -> Floats:
    """The width (k,) at each knot, points: by the weight, finer towards the tips, and finer all along a short line."""
    run = np.concatenate([[0.0], np.cumsum(lengths(knots))])
    length = float(run[-1])
    tip = np.ones(len(knots))
    if not ring:
        tip = np.clip(np.minimum(run, length - run) / min(TIP_PT, max(length / 2, 1e-9)), 0, 1)
        tip = TIP + (1 - TIP) * tip * (2 - tip)
    full = FINEST + (1 - FINEST) * weight
    return np.asarray(pen_pt * np.maximum(full * tip * (0.8 + 0.2 * min(1.0, length / 40.0)), 0.7 * FINEST))
