"""The sweep: one layer of hatching, laid line by line as densely as a tone asks.

A tile of strokes repeats, and the strokes chosen from it lie as unevenly as chance has it. Here
nothing is chosen. Along the hatch runs u, across it v. The tone that the layer owes, divided by
the width that the pen paints, is a number of lines per point; its integral over v is a phase.
A line is due wherever the phase has grown by one. A front moves over the sheet. Where a line is
due first, it begins, and runs on both ways for as long as the neighbouring places are due too. It
is cut into strokes of a hand's length, whose ends keep clear of the ends on the lines before. Then
every stroke is moved to the middle between its neighbours, a few times over. At last the hand's
own variation is added.

This module alone imports the compiled kernels `integral` and `sweep`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import curves
from penink_cli.blasting._compiled import integral as _integral
from penink_cli.blasting._compiled import sweep as _sweep
from penink_cli.blasting.sheet import Sheet
from penink_cli.ground.angles import direction
from penink_cli.ground.model import Floats, HatchLayer, Ints

COLUMN_PT = 2.0  # along the hatch
ROW_PT = 1.0  # across it
#: How far beyond the frame the hatch is laid, so that lines are as dense at the border as elsewhere.
PAD_PT = 24.0
#: The least length of a run, and the least and greatest length of a stroke, points.
SHORTEST_PT = 7.0
STROKE_PT = (34.0, 72.0)
#: A stroke that the hand ends, and neither tone nor wall, is laid this much longer, to reach a wall if there is one.
SLACK_PT = 4.0
#: Distance of the knots of a wandering stroke.
KNOT_PT = 9.0
#: The greatest turn of a stroke from its layer's direction (tangents): while it is laid, and while strokes are evened
#: out (two degrees). Laying with the second would let all strokes lean where the tone changes, and end in rows where
#: two such fields meet: on a dark gradient nine ends in ten stand in rows then, and one in five so.
STEEPEST, RELAXED = 0.003, 0.035
#: The part of a line's deviation from its due place that the next line keeps. Below 1 the density stays true; the less
#: it is, the longer a mismatch of neighbouring columns lives on as a seam.
MEMORY = 0.9
#: How far, in spacings, chance moves the next line. Without it a flat field is a ruled lattice.
DRIFT = 0.12
#: The part of a mismatch of phase, between a run and what lies beyond its end, that each line mends, and over what
#: length.
HEAL, HEAL_PT = 0.3, 60.0
#: Rounds in which strokes are moved to the middle between their neighbours.
ROUNDS = 8
#: Below this coverage a layer's lines are finer, down to the finest line at none. Lines of the full pen would be so far
#: apart there that the eye sees each of them: at 2 % the tone is off by 1.6 % RMS with the pen, by 0.8 with fine lines.
LIGHT = 0.1
#: The least angle between lines and the diagonal, degrees; see `heading`.
OFF_DIAGONAL = 1.5
#: What the kernel is told of these, in columns and rows.
TERMS = _sweep.Terms(
    shortest=round(SHORTEST_PT / COLUMN_PT),
    least=round(STROKE_PT[0] / COLUMN_PT),
    most=round(STROKE_PT[1] / COLUMN_PT),
    steepest=STEEPEST * COLUMN_PT / ROW_PT,
    memory=MEMORY,
    drift=DRIFT,
    heal=HEAL,
    reach=round(HEAL_PT / COLUMN_PT),
)
#: The hand's variation: of a stroke's place in parts of the spacing, of its bow, points.
WAVER = 0.07
BOW_PT = 0.3


@dataclass(frozen=True, eq=False)
class Hatch:
    """Strokes of one layer: straight lines with a bow, or wandering ones, over the frame and a little beyond it.

    points, first: control points of all of them, as in `Strokes`. joined: (n, 2) whether another stroke goes
        on from its start, its end.
    slack: (n, 2) which part of its length, at its start and at its end, is there only to reach an edge.
    widths: (n,) points.
    """

    points: Floats
    first: Ints
    joined: npt.NDArray[np.bool_]
    slack: Floats
    widths: Floats


def heading(layer_angle: float) -> tuple[float, float]:
    """Cosine and sine of the angle at which a layer's lines are laid: not just on the diagonal of a device's pixels.

    There a line is painted as so many whole diagonals of pixels, by where it lies, all along it: a flat 55 % in lines
    at 45° is off by 0.59 % RMS at 600 dpi, one degree aside by 0.33. Nobody sees the degree; lines along rows or
    columns that are not quite so are seen, and remain.
    """
    off = layer_angle % 90.0 - 45.0
    if abs(off) < OFF_DIAGONAL:
        layer_angle += OFF_DIAGONAL - off
    return direction(layer_angle)


def painted_width(layer_angle: float, pen_pt: float, gain_pt: float) -> float:
    """The width that a device paints for a stroke in this direction."""
    c, s = heading(layer_angle)
    return pen_pt + gain_pt * (abs(c) + abs(s))


def pressed(coverage: Floats, finest_pt: float, pen_pt: float) -> Floats:
    """The width of strokes that are to cover so much (any shape): finer where it is light."""
    return finest_pt + (pen_pt - finest_pt) * np.minimum(coverage * (1.0 / LIGHT), 1.0)


def hatch(
    sheet: Sheet, coverage: Floats, layer: HatchLayer, pen_pt: float, finest_pt: float, gain_pt: float, seed: int
) -> Hatch:
    """Strokes of `layer` that cover each cell of the sheet to coverage (rows, columns), 0 … 1.

    finest_pt: the finest line that the hand can draw; pen_pt where there is one pen for all.
    """
    c, s = heading(layer.angle)
    along, across = np.array([c, s]), np.array([-s, c])
    corners = np.array([[0, 0], [sheet.width, 0], [0, sheet.height], [sheet.width, sheet.height]], float)
    u_range, v_range = (corners[:, 0] * axis[0] + corners[:, 1] * axis[1] for axis in (along, across))
    u0, v0 = u_range.min() - PAD_PT, v_range.min() - PAD_PT
    columns = int((u_range.max() + PAD_PT - u0) / COLUMN_PT) + 1
    rows = int((v_range.max() + PAD_PT - v0) / ROW_PT) + 2
    gained = painted_width(layer.angle, 0.0, gain_pt)
    phase = np.empty((columns, rows))
    u, v = u0 + (np.arange(columns) + 0.5) * COLUMN_PT, v0 + (np.arange(rows - 1) + 0.5) * ROW_PT
    wander = wandering(layer, seed)
    most = 1.0 / layer.spacing_pt if layer.spacing_pt > 0 else np.inf
    pen, coverage = _integral.Pressed(finest_pt, pen_pt, 1.0 / LIGHT, gained, most), np.ascontiguousarray(coverage)
    for some in (slice(k, k + 64) for k in range(0, columns, 64)):
        aside = wander(u[some, None], v[None, :]) if layer.wave_pt > 0 else np.empty((0, 0))
        _integral.integrate(
            coverage, sheet.width, sheet.height, PAD_PT, c, s, u[some], v, aside, pen, ROW_PT, phase[some]
        )

    rng = np.random.default_rng([seed, 2])
    key = int(rng.integers(1 << 62))
    total = float(phase[:, -1].sum())
    room = int(total / (SHORTEST_PT / COLUMN_PT)) + columns + 16
    leaves = 1 << max(1, (columns - 1).bit_length())
    strokes, spans = np.empty((room, 3)), np.empty((room, 5), np.int64)
    front = _sweep.Front(
        phase, np.full(columns, float(rng.random())), np.empty(2 * leaves), np.zeros(columns, np.int64),
        np.full(columns, -1e9), np.zeros(columns, np.uint8),
    )  # fmt: skip
    n = _sweep.lay(front, TERMS, key, strokes, spans)
    strokes, spans = strokes[:n], spans[:n]
    length = int((spans[:, 1] - spans[:, 0] + 1).sum())
    crossed = np.empty(columns + 1, np.int64), np.empty(length, np.int64), np.empty(length, np.int64)
    laid = _sweep.Laid(strokes, spans, *crossed)
    laid.find()
    laid.relax(phase, ROUNDS, RELAXED * COLUMN_PT / ROW_PT)

    # from columns and rows to points, the hand's variation, and a small gap where one stroke follows another
    at_column, at_row = np.floor(strokes[:, 0]).astype(np.int64), np.floor(strokes[:, 1]).astype(np.int64)
    rate = np.diff(phase, axis=1)[at_column, np.clip(at_row, 0, rows - 2)] / ROW_PT
    spacing = np.minimum(1.0 / np.maximum(rate, 1e-3), 40.0)
    joined = spans[:, 2:4] == 1
    lift = 0.4 * (pen_pt + gained)
    half = (spans[:, 1] - spans[:, 0] + 1) * (COLUMN_PT / 2)
    start, end = -half + np.where(joined[:, 0], lift, 0.0), half - np.where(joined[:, 1], lift, 0.0)
    # a joint is not where a column ends but anywhere near, the same for both strokes
    middle_u = u0 + (strokes[:, 0] + 0.5) * COLUMN_PT
    middle_v = v0 + strokes[:, 1] * ROW_PT
    slope = strokes[:, 2] * ROW_PT / COLUMN_PT
    middle_v += rng.normal(0, WAVER, n) * np.minimum(spacing, 8.0)
    slope += rng.normal(0, WAVER, n) * np.minimum(spacing, 8.0) / np.maximum(half, 8.0) * 0.7
    bow = rng.normal(0, 1, n) * np.minimum(BOW_PT, 0.14 * spacing) * np.minimum(half / 20.0, 1.0)
    seen = np.zeros(n)
    for t in (-0.8, -0.4, 0.0, 0.4, 0.8):
        along_u, along_v = middle_u + t * half, middle_v + t * half * slope
        seen += density_at(sheet, coverage, (c, s), along_u, along_v + wander(along_u, along_v)) / 5
    widths = pressed(seen, finest_pt, pen_pt)
    slack = np.where(joined, 0.0, SLACK_PT)
    start, end = start - slack[:, 0], end + slack[:, 1]
    # knots along each stroke: one cubic does for a straight one, a wandering one has one every so often
    if layer.wave_pt > 0:
        count = np.maximum(2, np.ceil((end - start) / KNOT_PT).astype(np.int64)) + 1
    else:
        count = np.full(n, 2)
    who, k = np.repeat(np.arange(n), count), curves.ramp(count)
    t = k / (count[who] - 1)

    def at_parameter(t: Floats) -> Floats:
        du = start[who] + (end - start)[who] * t
        uu, vv = middle_u[who] + du, middle_v[who] + slope[who] * du + bow[who] * (4.0 * t * (1.0 - t) - 2 / 3)
        return uu[:, None] * along + (vv + wander(uu, vv))[:, None] * across

    # Hermite to Bézier: the tangents are chords over a small stretch, so that no function needs a derivative
    step = 1.0 / (count[who] - 1)
    lo, hi = np.maximum(t - 0.1 * step, 0.0), np.minimum(t + 0.1 * step, 1.0)
    knots, tangent = at_parameter(t), (at_parameter(hi) - at_parameter(lo)) * (step / (3.0 * (hi - lo)))[:, None]
    first = curves.starts(3 * (count - 1) + 1)
    points = np.empty((first[-1], 2))
    at = first[who] + 3 * k
    points[at] = knots
    inner = k < count[who] - 1
    points[at[inner] + 1] = knots[inner] + tangent[inner]
    points[at[k > 0] - 1] = knots[k > 0] - tangent[k > 0]
    return Hatch(points, first, joined, slack / (end - start)[:, None], widths)


def density_at(sheet: Sheet, coverage: Floats, along: tuple[float, float], u: Floats, v: Floats) -> Floats:
    """Coverage at (u, v); near the sheet that of its border, further off none."""
    c, s = along
    x, y = u * c - v * s, u * s + v * c
    column = np.clip((x * (sheet.columns / sheet.width)).astype(np.int64), 0, sheet.columns - 1)
    row = np.clip((y * (sheet.rows / sheet.height)).astype(np.int64), 0, sheet.rows - 1)
    near = np.abs(x - sheet.width / 2) < sheet.width / 2 + PAD_PT
    near &= np.abs(y - sheet.height / 2) < sheet.height / 2 + PAD_PT
    return np.where(near, coverage[row, column], 0.0)


def wandering(layer: HatchLayer, seed: int) -> Callable[[Floats, Floats], Floats]:
    """How far (points) the layer's lines are pushed across their direction at (u, v): smooth noise, or nothing.

    Values drawn at the corners of a grid are blended by cubics; the grid's cells are three times as long across the
    lines as along them, so that neighbours wander together.
    """
    if layer.wave_pt <= 0:
        return lambda u, v: np.zeros(np.broadcast_shapes(u.shape, v.shape))
    table = np.random.default_rng([seed & 0xFFFF, 6]).uniform(-1.0, 1.0, (64, 64))

    def at(u: Floats, v: Floats) -> Floats:
        x, y = u / (layer.wave_length_pt / 2), v / (1.5 * layer.wave_length_pt)
        i, j = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
        f, g = x - i, y - j
        f, g = f * f * (3.0 - 2.0 * f), g * g * (3.0 - 2.0 * g)
        i, j = i & 63, j & 63
        near = table[j, i] * (1 - f) + table[j, (i + 1) & 63] * f
        far = table[(j + 1) & 63, i] * (1 - f) + table[(j + 1) & 63, (i + 1) & 63] * f
        pushed: Floats = layer.wave_pt * (near * (1 - g) + far * g)
        return pushed

    return at
