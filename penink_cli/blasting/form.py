"""Hatching along the form: the strokes of a layer follow a field of directions instead of one angle.

Lines are level lines of a phase (see `phase`), over the frame and a little beyond it, cut to strokes of a hand's length
(`pen_lines`). They stand in for those of the straight sweep: what trims, corrects and presses these does so with them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import candidates, pen_lines, sweep, walls
from penink_cli.blasting.level_lines import LevelLines, level_lines
from penink_cli.blasting.phase import Field, Nodes, Plane, solve
from penink_cli.blasting.shares import box_mean
from penink_cli.blasting.sheet import SPREAD_PT, Cells, Sheet, resample
from penink_cli.ground.angles import direction
from penink_cli.ground.device import MEAN
from penink_cli.ground.model import Floats, HatchLayer, Ints

#: Least and greatest length of a stroke, points. A bent stroke looks shorter than a straight one, and many strokes end
#: early because their line does; so these are more than those of the straight sweep.
STROKE_PT = (38.0, 82.0)
#: How many cells beyond the frame lines are laid.
PAD = 12
#: Where a layer covers less than FAINT, its lines are as dense as within AROUND_PT points, and at least SPARSEST lines
#: a point: lines whose density fell to nothing would turn aside there.
FAINT, SPARSEST = 0.08, 0.05
AROUND_PT = 9.0
#: The coverage from which on a layer is active: only there does it fill gaps.
ACTIVE = 0.04
#: A line begins and ends where the layer's coverage passes a threshold between these, drawn for each line by itself:
#: one threshold for all would have the ends draw a contour.
RAGGED = (0.004, 0.03)
#: Short strokes: least and greatest length, points; distance of the places tried, points; the cosine of the greatest
#: angle that they turn in a quarter of their length.
FILLER_PT, FILLER_STEP_PT, STRAIGHT_ON = (10.0, 18.0), 2.0, 0.8
#: Places along each stroke at which the sheet is looked up.
SAMPLES = 5
#: The hand's variation in parts of the distance of the lines: of a stroke's place, and its greatest bow. It is less
#: than on straight lines, because lines along a field are less even to begin with.
WAVER, BOW = 0.06, 0.14


@dataclass(frozen=True, eq=False)
class Laid:
    """What the lines of one layer were made of.

    density: lines a point at each node. phase: turns there. active: (rows, columns) the cells of the sheet in which the
    layer covers more than `ACTIVE`. near: the same, and what is within a few cells of them.
    """

    density: Plane
    phase: Plane
    active: npt.NDArray[np.bool_]
    near: npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class DrawnStrokes:
    """Strokes as `candidates.between_walls` takes them, and samples (n × SAMPLES, 2) of the lines under them."""

    points: Floats
    first: Ints
    joined: npt.NDArray[np.bool_]
    slack: Floats
    samples: Floats


NO_STROKES = DrawnStrokes(
    np.zeros((0, 2)), np.zeros(1, np.int64), np.zeros((0, 2), bool), np.zeros((0, 2)), np.zeros((0, 2))
)


class Form:
    """A field of directions on a sheet, and what has been laid along it.

    cos2, sin2: (rows, columns) of the sheet's cells, cosine and sine of twice the angle at which strokes run.
    """

    #: The least length of a fine stroke, points.
    fine_shortest_pt = 20.5
    #: By how much of tone the eye must see a place too light for short strokes to fill it.
    filler_seen = 0.15
    #: How many times short strokes count their own ink at the least.
    caution = 1.0
    #: Whether it lays lines, which cross as shares of the tone tell.
    lays_lines = True

    def __init__(self, sheet: Sheet, cos2: Cells, sin2: Cells, layers: tuple[HatchLayer, ...], borders: walls.Walls):
        self.sheet = sheet
        self.borders = borders
        self.layers = layers
        self._cos2, self._sin2 = cos2, sin2
        dx, dy = sheet.width / sheet.columns, sheet.height / sheet.rows
        self.nodes = Nodes((0.5 - PAD) * dx, (0.5 - PAD) * dy, dx, dy, sheet.rows + 2 * PAD, sheet.columns + 2 * PAD)
        self._walls = borders.segments[borders.inside > 0]
        self._laid: dict[int, Laid] = {}

    def turned(self, i: int) -> tuple[Cells, Cells]:
        """Cosine and sine of twice the angle at which layer i's strokes run, (rows, columns)."""
        layer = self.layers[i]
        c, s = (np.float32(part) for part in direction(2.0 * turn_of(self.layers, i)))
        if layer.wave_pt > 0:
            # the greatest slope of a wave of that height and length, times noise from -1 to 1
            slope = np.float32(4 * layer.wave_pt / layer.wave_length_pt) * self._noise(layer.wave_length_pt / 2)
            length = 1 + slope * slope
            wave_c, wave_s = (1 - slope * slope) / length, 2 * slope / length
            c, s = c * wave_c - s * wave_s, s * wave_c + c * wave_s
        return self._cos2 * c - self._sin2 * s, self._sin2 * c + self._cos2 * s

    def _noise(self, cell_pt: float) -> Cells:
        """Smooth noise from -1 to 1 (rows, columns): values drawn at the corners of a grid, blended by cubics."""
        table = np.random.default_rng(6).uniform(-1.0, 1.0, (64, 64)).astype(np.float32)
        blends = []
        for side, count in ((self.sheet.height, self.sheet.rows), (self.sheet.width, self.sheet.columns)):
            at = (np.arange(count) + 0.5) * (side / count / cell_pt)
            k = np.floor(at).astype(np.int64)
            f = (at - k).astype(np.float32)
            blends.append((k & 63, (k + 1) & 63, f * f * (3 - 2 * f)))
        (j, below, g), (i, after, f) = blends
        rows = table[j] * (1 - g)[:, None] + table[below] * g[:, None]
        return rows[:, i] * (1 - f) + rows[:, after] * f

    def normals(self, i: int) -> tuple[Plane, Plane]:
        """The unit normal at each node, either way, of layer i's strokes."""
        cos2, sin2 = (np.pad(plane, PAD, mode="edge") for plane in self.turned(i))
        return normal(cos2, sin2)

    def swept(self, i: int, coverage: Floats, pen: float, finest: float, seed: int) -> candidates.Candidates:
        """The strokes of layer i that cover each cell (rows, columns) as coverage asks, in no order."""
        sheet, layer = self.sheet, self.layers[i]
        self._laid.pop(i, None)
        if not (coverage > 0).any():
            return self._candidates(NO_STROKES, np.zeros(0), pen, np.zeros(0))
        cover: Plane = np.pad(coverage.astype(np.float32), PAD, mode="edge")
        nx, ny = self.normals(i)
        gained = np.float32(sheet.gain_pt) * (np.abs(nx) + np.abs(ny))
        density = _carried_on(cover / (_pressed(cover, finest, pen) + gained), cover, AROUND_PT / self.nodes.dx)
        if layer.spacing_pt > 0:
            density = np.minimum(density, np.float32(1.0 / layer.spacing_pt))
        field = Field(self.nodes, nx, ny, density)
        phase = solve(field, self._walls, seed * 7 + 1, sheet.each)
        active = coverage > ACTIVE
        self._laid[i] = Laid(density, phase, active, _grown(active))
        lines = self._lines(field, phase, 0.0, _grown(cover > RAGGED[0]), seed)
        thresholds = np.random.default_rng([seed, 8]).uniform(*RAGGED, len(lines.ring))
        seen = self._at(cover, lines.points)
        lines, _ = pen_lines.live(lines, seen > np.repeat(thresholds, np.diff(lines.first)))
        strokes = self._strokes(lines, density, STROKE_PT, pen, seed)
        cells = self._at(cover, strokes.samples).reshape(-1, SAMPLES)
        total: Floats = cells[:, 0].astype(np.float64)
        for k in range(1, SAMPLES):
            total = total + cells[:, k]
        widths = sweep.pressed(total / SAMPLES, finest, pen)
        rank = np.random.default_rng([seed, 3]).random(len(widths))
        return self._candidates(strokes, widths, pen, rank)

    def between(
        self, i: int, pen: float, length: float, least: float, error: Cells, seed: int
    ) -> candidates.Candidates:
        """Strokes about so long half way between the lines of layer i, those where most is due first.

        least: they must pass a place where so many times as much is due as the stroke itself adds,
        error: (rows, columns) and where this is positive.
        """
        sheet, laid = self.sheet, self._laid.get(i)
        if laid is None:
            return self._candidates(NO_STROKES, np.zeros(0), pen, np.zeros(0))
        owed = sheet.residual > least * self._painted(pen) / SPREAD_PT
        wanted = np.pad(laid.active & (error > 0) & owed, PAD)
        field = Field(self.nodes, *self.normals(i), laid.density)
        lines = self._lines(field, laid.phase, 0.5, _grown(wanted, round(length / 2 / self.nodes.dx)), seed)
        if i:  # one of a layer that is begun for a small dark thing would stick out on both sides
            lines, _ = pen_lines.live(lines, self._at(np.pad(laid.near, PAD).astype(np.float32), lines.points) > 0.5)
        due = self._due(i, lines.points, error)
        lines, _ = pen_lines.live(
            lines, self._near(lines, due > least * self._painted(pen) / SPREAD_PT, length)
        )
        strokes = self._strokes(lines, laid.density, (0.7 * length, 1.3 * length), pen, seed)
        due = self._due(i, strokes.samples, error).reshape(-1, SAMPLES).max(axis=1)
        return self._candidates(strokes, np.full(len(due), pen), pen, -due)

    def _due(self, i: int, points: npt.NDArray[np.floating], error: Cells) -> Floats:
        """What is due at points (n, 2) where layer i is active and the error (rows, columns) positive."""
        sheet, laid = self.sheet, self._laid.get(i)
        if laid is None:
            return np.zeros(len(points))
        at = np.floor(points * (sheet.columns / sheet.width, sheet.rows / sheet.height)).astype(np.int64)
        inside = (at >= 0).all(axis=1) & (at[:, 0] < sheet.columns) & (at[:, 1] < sheet.rows)
        x, y = np.clip(at, 0, [sheet.columns - 1, sheet.rows - 1]).T
        active = inside & laid.active[y, x] & (error[y, x] > 0)
        return np.where(active, sheet.residual[y, x], 0.0)

    def _near(self, lines: LevelLines, wanted: npt.NDArray[np.bool_], length: float) -> npt.NDArray[np.bool_]:
        """Whether one of the points on the same line within half such a length is wanted."""
        reach = max(1, round(length / 2 / pen_lines.STEP_PT))
        total = np.concatenate([[0], np.cumsum(wanted)])
        who = np.repeat(np.arange(len(lines.ring)), np.diff(lines.first))
        at = np.arange(len(wanted))
        low = np.maximum(at - reach, lines.first[who])
        high = np.minimum(at + reach + 1, lines.first[who + 1])
        return np.asarray(total[high] > total[low])

    def fillers(self, i: int, pen: float, error: Cells, seed: int) -> candidates.Candidates:
        """Short strokes along the field where layer i is active and the error (rows, columns) positive."""
        sheet, rng = self.sheet, np.random.default_rng([seed, 11])
        x, y = np.meshgrid(
            *(np.arange(FILLER_STEP_PT / 2, side, FILLER_STEP_PT) for side in (sheet.width, sheet.height))
        )
        middle = np.column_stack([x.ravel(), y.ravel()])
        middle = middle + rng.uniform(-0.25, 0.25, middle.shape) * FILLER_STEP_PT
        due = self._due(i, middle, error)
        middle, due = middle[due > 0], due[due > 0]
        half = rng.uniform(*FILLER_PT, len(middle)) / 2
        planes = self.turned(i)
        knots = [middle]
        for sign in (-1.0, 1.0):
            at, ahead = middle, sign * self._ahead(planes, middle)
            for _ in range(2):
                # to where it breaks, and no further
                at = at + ahead * (half / 2)[:, None]
                knots = [at, *knots] if sign < 0 else [*knots, at]
                here = self._ahead(planes, at)
                along = here[:, 0] * ahead[:, 0] + here[:, 1] * ahead[:, 1]
                here = here * np.where(along < 0, -1.0, 1.0)[:, None]
                ahead = np.where((np.abs(along) > STRAIGHT_ON)[:, None], here, 0.0)
        start, before, _, after, end = knots
        # the cubic that passes where the line is at its thirds
        p, q = before + (middle - before) / 3, middle + (after - middle) * (2 / 3)
        inner = (18 * p - 9 * q - 5 * start + 2 * end) / 6, (18 * q - 9 * p - 5 * end + 2 * start) / 6
        points = np.stack([start, *inner, end], axis=1)
        none = np.zeros((len(middle), 2))
        strokes = DrawnStrokes(
            points.reshape(-1, 2), np.arange(len(middle) + 1) * 4, none.astype(bool), none, middle
        )  # fmt: skip
        return self._candidates(strokes, np.full(len(middle), pen), pen, -due)

    def _ahead(self, planes: tuple[Cells, Cells], points: Floats) -> Floats:
        """Unit vectors (n, 2) along the field of these planes at points (n, 2), either way."""
        sheet = self.sheet
        at = np.floor(points * (sheet.columns / sheet.width, sheet.rows / sheet.height)).astype(np.int64)
        x, y = np.clip(at, 0, [sheet.columns - 1, sheet.rows - 1]).T
        nx, ny = normal(planes[0][y, x], planes[1][y, x])
        return np.column_stack([ny, -nx]).astype(np.float64)

    def _lines(self, field: Field, phase: Plane, level: float, wanted: npt.NDArray[np.bool_], seed: int) -> LevelLines:
        """Level lines where they are wanted (rows, columns of the nodes), smooth and in equal steps."""
        found = level_lines(field, phase, level, self.sheet.each, wanted)
        lines = pen_lines.evened(found, sweep.SHORTEST_PT)
        spacing = 1 / self._at(field.density, lines.points)
        pen_lines.smooth(lines, spacing)
        pen_lines.turn_rings(lines, seed)
        return lines

    def _strokes(
        self, lines: LevelLines, density: Plane, stroke_pt: tuple[float, float], pen: float, seed: int
    ) -> DrawnStrokes:
        """Lines cut into strokes as a hand draws them."""
        middle = lines.points[(lines.first[:-1] + lines.first[1:]) // 2]
        spacing = 1.0 / self._at(density, middle).astype(np.float64)
        parts = pen_lines.cut(lines, spacing, stroke_pt, sweep.SHORTEST_PT, seed)
        n = len(parts.line)
        length = pen_lines.lengths(lines)[parts.line]
        steps = np.diff(lines.first)[parts.line] - 1
        t = (np.arange(SAMPLES) + 0.5) / SAMPLES
        at = parts.span[:, :1] + (parts.span[:, 1:] - parts.span[:, :1]) * t
        at = np.clip(np.floor(at / length[:, None] * steps[:, None] + 0.5), 0, steps[:, None]).astype(np.int64)
        samples = lines.points[(lines.first[parts.line][:, None] + at).ravel()]
        apart = np.minimum(1.0 / self._at(density, samples[SAMPLES // 2 :: SAMPLES]).astype(np.float64), 40.0)
        # the hand's variation, and a small gap where one stroke follows another
        rng = np.random.default_rng([seed, 2])
        drawn = parts.span[:, 1] - parts.span[:, 0]
        hand = rng.normal(0, 1, (n, 3))
        waver = WAVER * np.minimum(apart, 8.0)
        hand[:, 0] *= waver
        hand[:, 1] *= 0.7 * waver
        hand[:, 2] *= np.minimum(sweep.BOW_PT, BOW * apart) * np.minimum(drawn / 40.0, 1.0)
        lift = 0.4 * self._painted(pen)
        slack = np.where(parts.joined, 0.0, sweep.SLACK_PT)
        ends = np.where(parts.joined, lift, -slack) * np.array([1.0, -1.0])
        span = parts.span + np.where((drawn > 2.5 * lift)[:, None], ends, 0.0)
        points, first = pen_lines.drawn(lines, pen_lines.Parts(parts.line, span, parts.joined), hand)
        return DrawnStrokes(points, first, parts.joined, slack / (span[:, 1] - span[:, 0])[:, None], samples)

    def _candidates(self, strokes: DrawnStrokes, widths: Floats, pen: float, rank: Floats) -> candidates.Candidates:
        return candidates.between_walls(
            strokes.points, strokes.first, widths, self._painted(pen), self.borders, rank, strokes.joined, strokes.slack
        )  # fmt: skip

    def _painted(self, pen: float) -> float:
        """How wide a device paints a stroke of the pen, whatever its direction."""
        return pen + MEAN * self.sheet.gain_pt

    def _at(self, values: Plane, points: npt.NDArray[np.floating]) -> Plane:
        """Values (rows, columns of the nodes) at points (n, 2)."""
        return pen_lines.look_up(values, self.nodes, points)


def turn_of(layers: tuple[HatchLayer, ...], i: int) -> float:
    """Degrees of layer i from the field: what the layer says, else what it has from the first one."""
    own = layers[i].turn
    return layers[i].angle - layers[0].angle if own is None else own


def _grown(mask: npt.NDArray[np.bool_], by: int = 3) -> npt.NDArray[np.bool_]:
    """What lies within so many cells, each way, of what is set."""
    for _ in range(2):
        total = np.cumsum(np.pad(mask, ((by + 1, by), (0, 0))), axis=0, dtype=np.int32)
        mask = (total[2 * by + 1 :] > total[: -2 * by - 1]).T
    return np.ascontiguousarray(mask)


def normal(cos2: Plane, sin2: Plane) -> tuple[Plane, Plane]:
    """x and y of the unit normal, either way, of lines at half the angle that has this cosine and sine."""
    # by whichever of the half angle's sine and cosine is the greater
    half = np.sqrt(np.float32(0.5) * (1 + np.abs(cos2)))
    other = np.float32(0.5) * sin2 / half
    flat = cos2 >= 0
    return np.where(flat, -other, -np.copysign(half, sin2)), np.where(flat, half, np.abs(other))


def _pressed(coverage: Plane, finest: float, pen: float) -> Plane:
    """`sweep.pressed` in single precision."""
    return np.float32(finest) + np.float32(pen - finest) * np.minimum(coverage * np.float32(1 / sweep.LIGHT), 1)


def _carried_on(density: Plane, cover: Plane, sigma: float) -> Plane:
    """Densities, and where next to nothing is covered those of the surroundings (σ in nodes)."""
    known = density * np.minimum(cover * np.float32(1 / FAINT), 1)
    weight = box_blurred(known, sigma)
    around = np.maximum(
        box_blurred(known * density, sigma) / np.maximum(weight, np.float32(1e-6)), np.float32(SPARSEST)
    )  # fmt: skip
    t = np.clip((cover - np.float32(FAINT / 4)) * np.float32(4 / (3 * FAINT)), 0, 1)
    t = t * t * (3 - 2 * t)
    return np.where(density > around, density, density * t + around * (1 - t)).astype(np.float32)


def box_blurred(values: Plane, sigma: float) -> Plane:
    """Values (rows, columns) blurred by about a Gaussian: means over boxes, three times, of means of 4 × 4 cells."""
    rows, columns = values.shape
    padded = np.pad(values, ((0, -rows % 4), (0, -columns % 4)), mode="edge")
    small = padded.reshape(padded.shape[0] // 4, 4, -1, 4).mean(axis=(1, 3), dtype=np.float64)
    radius = max(1, round(sigma / 4))
    for _ in range(3):
        small = box_mean(small, radius)
    return resample(small, rows, columns).astype(np.float32)
