"""The sheet of paper while it is being drawn on: its tone wanted, its ink so far, and what is still due.

The sheet is divided into square cells of about 0.96 pt, 8 × 8 subpixels each (0.12 pt,
600 dpi), one bit a subpixel. Ink already there is never counted twice, so the tone of
crossing strokes is exact, and the cost is the same whatever the picture's resolution.

What is due is kept low-passed: ``residual = G * (tone - ink)``. G is a Gaussian of σ 2.5 pt,
cut off where the tone steps strongly: ink on one side of an edge never pays for tone on the
other. Ink a, added at p, changes the squared error (t - c)ᵀ G (t - c) by -a (2 residual(p) - own);
own is what the stroke itself adds at p. So a trial costs one look-up a sample.

A device paints every pixel that a stroke touches. It thereby widens a stroke of direction
θ by (|cos θ| + |sin θ|) of its pixels; `gain_pt` is the size of that pixel, 0 for none.

This module alone imports the compiled kernels `ink`, `placing`, `press`, `resampling` and `swelling`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import numpy.typing as npt

from penink_cli.blasting._compiled import ink as _ink
from penink_cli.blasting._compiled import placing as _placing
from penink_cli.blasting._compiled import press as _press
from penink_cli.blasting._compiled import resampling as _resampling
from penink_cli.blasting._compiled import swelling as _swelling
from penink_cli.blasting.curves import Polylines, pieces_of, sample
from penink_cli.blasting.low_pass import Cells, LowPass
from penink_cli.ground import threads as threading
from penink_cli.ground.model import Floats, Ints, Strokes

CELL_PT = 0.96
#: σ of the low-pass of what is due. Narrower than what the eye (and the measure) blurs,
#: so that tone is right in small things too.
SIGMA_PT = 2.5
#: A long thin stroke that is painted w points wide darkens its middle by w / SPREAD_PT under that Gaussian: √(2π) σ.
SPREAD_PT = 2.5066 * SIGMA_PT
#: σ for the paper's rule, which does not say what is near a stroke. The narrower, the lighter: at 2.5 a ramp is
#: 4.8 % too light, at 1.95 it is 7.3 and photographs 8 to 11, at 1.6 they are 9.7 and 11 to 14.
STRICT_SIGMA_PT = 1.95
#: σ of what the eye sees at arm's length, 1/16 inch: errors are measured, and fed back, through this.
EYE_PT = 4.5
#: A step of tone (0 … 1) over which ink is not credited.
STEP = 0.25
#: Candidates are tried in blocks of this size, those of every second block at the same time,
#: so no stroke longer than this less the kernel may be tried in parallel.
BLOCK_PT = 144.0
#: Rows of cells that a thread paints at the least.
LEAST_BAND = 64


#: Runs that one polyline is drawn in at the most.
MOST_RUNS = 4


@dataclass(frozen=True)
class Terms:
    """On what terms a polyline is drawn: normally the best runs of it.

    whole: all of it, if that lowers the squared error. strict: all of it, unless that makes any place darker than it
    is due: the paper's rule.
    cost: what a run must gain, in cells × tone. caution: how many times the stroke's own ink counts
    against it; 1 is where the squared error is least. lenience: the part of the tone that is taken to be due
    besides, so that mere noise cuts no stroke.
    shortest_pt: the least length of a run; shortest_wall_pt: of one that ends at a wall.
    shifts: sideways moves to try, in units of spacing_pt.
    """

    whole: bool = False
    strict: bool = False
    cost: float = 0.0
    caution: float = 1.0
    lenience: float = 0.0
    shortest_pt: float = 7.0
    shortest_wall_pt: float = 2.0
    shifts: tuple[float, ...] = (0.0,)
    spacing_pt: float = 0.0


def halve(values: Cells) -> Cells:
    """Means of 2 × 2 cells, the last row and column repeated where there is an odd one."""
    if values.shape[0] & 1:
        values = np.concatenate([values, values[-1:]])
    if values.shape[1] & 1:
        values = np.concatenate([values, values[:, -1:]], axis=1)
    quarter = np.float32(0.25)
    return ((values[::2, ::2] + values[1::2, ::2]) + (values[::2, 1::2] + values[1::2, 1::2])) * quarter


def cells(width_pt: float, height_pt: float) -> tuple[int, int]:
    """Rows and columns of the cells of a sheet of width × height points."""
    return max(1, round(height_pt / CELL_PT)), max(1, round(width_pt / CELL_PT))


class Sheet:
    """A sheet of width × height points that wants `tone` ((h, w) ink coverage 0 … 1, any size)."""

    def __init__(self, tone: Floats, width_pt: float, height_pt: float, gain_pt: float, threads: int = 1):
        self.width = width_pt
        self.height = height_pt
        self.rows, self.columns = cells(width_pt, height_pt)
        #: subpixels per point, x and y; they differ by less than a percent save on tiny sheets
        self.scale = np.array([8.0 * self.columns / width_pt, 8.0 * self.rows / height_pt])
        self.pitch = float(self.scale[0] + self.scale[1]) / 2.0
        self.gain_pt = gain_pt
        self.gain = gain_pt * self.pitch
        self.threads = max(1, threads)
        self.tone: Cells = resample(tone, self.rows, self.columns).astype(np.float32)
        self.bits = np.zeros((self.rows, (self.columns + 7) // 8, 8), np.uint64)
        self._kept: npt.NDArray[np.uint64] | None = None
        self.residual: Cells = np.zeros((self.rows, self.columns), np.float32)
        self.low_pass = LowPass(SIGMA_PT / CELL_PT, self.tone, STEP, self.threads)
        #: how much of the kernel about each cell counts
        self.weight = self.low_pass(np.ones_like(self.tone))
        # what the eye sees is kept for cells of twice the size
        self._coarse_tone = halve(self.tone)
        self._eye = LowPass(EYE_PT / CELL_PT / 2, self._coarse_tone, STEP, self.threads)
        self._seen_weight = self._eye(np.ones_like(self._coarse_tone))

    def clear(self) -> None:
        """Take all ink away but what is there for good."""
        self.bits[:] = 0 if self._kept is None else self._kept

    def keep(self) -> None:
        """What is inked by now is there for good."""
        self._kept = self.bits.copy()

    @property
    def ink(self) -> Cells:
        """Coverage so far (rows, columns), 0 … 1."""
        out = np.empty((self.rows, self.columns), np.float32)
        _ink.cover(self.bits, out)
        return out

    def error(self) -> Cells:
        """Tone less ink as the eye sees it: the mean over what lies near on this side of strong steps of tone.

        For cells of twice the size, (⌈rows / 2⌉, ⌈columns / 2⌉).
        """
        return self.seen(self.tone - self.ink)

    def seen(self, values: Cells) -> Cells:
        """The mean of values (rows, columns) over what the eye takes in at once, on this side of strong steps of tone.

        For cells of twice the size, (⌈rows / 2⌉, ⌈columns / 2⌉).
        """
        return self._eye(halve(values)) / self._seen_weight

    def crowd(self, single: float, wide: Cells) -> Cells:
        """How far the strokes in each cell (rows, columns) are many that make its tone together, 0 … 1.

        single: the tone from which on they are. wide: the low-passed tone.
        """
        return np.minimum(wide / self.weight * np.float32(1 / single), np.float32(1))

    def spread(self, error: Cells) -> Cells:
        """Values for cells of twice the size as values (rows, columns)."""
        return np.repeat(np.repeat(error, 2, axis=0), 2, axis=1)[: self.rows, : self.columns]

    def owe(self, tone: Cells) -> None:
        """Set what is due: `tone` less the ink so far, low-passed."""
        self.residual = self.low_pass(tone - self.ink)

    def owe_strictly(self) -> None:
        """Set what is due by the paper's rule, near each place and whatever steps there are: tone less the ink so far.

        Both low-passed alike: held against the bare tone, the drawing would be the lighter the noisier a photograph is.
        """
        self.low_pass = LowPass(STRICT_SIGMA_PT / CELL_PT, self.tone, 2.0, self.threads)
        self.weight = self.low_pass(np.ones_like(self.tone))
        self.residual = self.low_pass(self.tone - self.ink)

    def paint(self, lines: Polylines, widths: Floats) -> None:
        """Ink polylines (points), whatever is due."""
        points = np.ascontiguousarray(lines.points * self.scale)
        _painted(self.bits, self.columns, points, lines.first, widths * self.pitch, self.gain, self.threads)

    def newly_inked(self, lines: Polylines, widths: Floats) -> Ints:
        """Ink polylines (points) one after the other; (n,) how many subpixels each newly inks."""
        fresh = np.zeros(len(widths), np.int64)
        points = np.ascontiguousarray(lines.points * self.scale)
        _ink.paint(self.bits, self.columns, points, lines.first, widths * self.pitch, self.gain, fresh)
        return fresh

    def swell(self, strokes: Strokes) -> None:
        """Ink strokes that swell, as straight from knot to knot."""
        if not len(strokes):
            return
        counts = np.diff(strokes.knots)
        at = np.repeat(strokes.first[:-1] - 3 * strokes.knots[:-1], counts) + 3 * np.arange(strokes.knots[-1])
        knots = np.ascontiguousarray(strokes.points[at] * self.scale)
        _swelling.swell(self.bits, self.columns, knots, strokes.knots, strokes.at_knots * self.pitch, self.gain)

    def place(
        self,
        lines: Polylines,
        widths: Floats,
        batches: Sequence[Ints],
        terms: Terms,
        walls: npt.NDArray[np.uint8] | None = None,
        enters: Floats | None = None,
    ) -> tuple[Ints, Floats]:
        """Try polylines, batch by batch, and draw of each what is worth drawing.

        batches: indices of polylines, in the order in which they are tried.
        walls: (n,) bit 0: the polyline's start is at a wall (an edge, the frame), bit 1: its end.
        enters: (n,) the tone at which each is known to belong where it is
        light: there the low-pass is too narrow to tell. Returns the runs (r, 3): polyline, first and last of
        its points, and how far each run was moved (r, 2) in points.

        Polylines of one batch are tried in blocks; those of every second block each way at the
        same time, for they are too far apart to meet. The result depends on neither threads nor chance.
        """
        n = len(widths)
        points = np.ascontiguousarray(lines.points * self.scale)
        walls = np.zeros(n, np.uint8) if walls is None else walls
        belongs = np.full(n, np.inf) if enters is None else np.ascontiguousarray(enters)
        runs = np.full((n, 1 if terms.whole or terms.strict else MOST_RUNS, 2), -1, np.int64)
        moved = np.zeros((n, 2))
        against = _placing.Target(self.bits, self.residual, self.tone, self.weight, self.low_pass, self.gain)
        tried = _placing.Tried(points, lines.first, widths * self.pitch, walls, belongs)
        asked = _placing.Terms(terms, self.pitch)

        def run(order: Ints) -> None:
            _placing.place(against, tried, asked, order, runs, moved)

        for group in coloured(batches, self._blocks(lines)):
            group.sort(key=len, reverse=True)  # so that threads end together
            self.each(run, group)
        who, which = np.nonzero(runs[:, :, 0] >= 0)
        found = np.column_stack([who, runs[who, which]])
        found[:, 1:] -= lines.first[who][:, None]
        return found, moved[who] / self.scale

    def press(
        self, lines: Polylines, widths: Floats, lightest: Floats, heaviest: Floats, order: Ints, rounds: int
    ) -> Floats:
        """Widths (n,) for polylines that are drawn already with `widths`, such that less is due.

        Each lies between lightest and heaviest (n,), points: the pressure of the hand on the pen. In each round the
        error that the eye sees is reckoned with to first order; then all is painted anew.
        """
        points = np.ascontiguousarray(lines.points * self.scale)
        pressed = np.ascontiguousarray(widths * self.pitch)
        low, high = np.ascontiguousarray(lightest * self.pitch), np.ascontiguousarray(heaviest * self.pitch)
        drawn = _press.Drawn(points, lines.first, pressed, low, high)
        groups = coloured([order], self._blocks(lines))
        for turn in range(rounds):
            if turn:
                self.clear()
                self.paint(lines, pressed / self.pitch)
            residual = self._eye(halve(self.tone - self.ink))

            seen = _press.Seen(self.bits, self.columns, self.gain, residual, self._coarse_tone, self._eye)
            for group in groups:
                self.each(partial(_press.press, seen, drawn), group)
        return pressed / self.pitch

    def _blocks(self, lines: Polylines) -> Ints:
        """(n, 2) column and row of the block that each polyline's middle is in."""
        lo = np.minimum.reduceat(lines.points, lines.first[:-1]) if len(lines.first) > 1 else np.zeros((0, 2))
        hi = np.maximum.reduceat(lines.points, lines.first[:-1]) if len(lines.first) > 1 else np.zeros((0, 2))
        size: float = BLOCK_PT
        if len(lo):
            reach = float((hi - lo).max()) + 2 * 2.5 * EYE_PT + 8.0
            size = max(size, reach)
        return np.floor((lo + hi) / (2 * size)).astype(np.int64)

    def each(self, work, items) -> None:  # type: ignore[no-untyped-def]
        """Run work over each of the items, on threads if there are to be any."""
        threading.share([partial(work, item) for item in items], self.threads)


def coverage(strokes: Strokes, rows: int, columns: int, wider_pt: float = 0.0, threads: int = 1) -> Cells:
    """Coverage (rows, columns), 0 … 1, of the strokes' sheet by them, each so much wider."""
    bits = np.zeros((rows, (columns + 7) // 8, 8), np.uint64)
    out = np.zeros((rows, columns), np.float32)
    if len(strokes):
        strokes = strokes.by_segments()
        scale = np.array([8.0 * columns / strokes.width, 8.0 * rows / strokes.height])
        lines = sample(strokes.points, strokes.first, pieces_of(strokes.points, strokes.first, CELL_PT))
        widths = (strokes.widths + wider_pt) * (float(scale[0] + scale[1]) / 2)
        points = np.ascontiguousarray(lines.points * scale)
        _painted(bits, columns, points, lines.first, widths, 0.0, threads)
        _ink.cover(bits, out)
    return out


def _painted(
    bits: npt.NDArray[np.uint64], columns: int, points: Floats, first: Ints, widths: Floats, gain: float, threads: int
) -> None:
    """Ink polylines, each piece by the thread whose rows of cells it lies in; last those that lie in two bands."""
    rows = len(bits)
    height = -(-rows // max(1, min(threads, rows // LEAST_BAND)))

    def band(which: int) -> None:
        _ink.paint_band(bits, columns, points, first, widths, gain, which, height)

    count = -(-rows // height)
    threading.share([partial(band, k) for k in range(count)], threads)
    if count > 1:
        band(-1)


def coloured(batches: Sequence[Ints], block: Ints) -> list[list[Ints]]:
    """Batches in their order, each as groups of one colour of a 2 × 2 board: an array for each block of that colour.

    batches: indices of polylines; block: (n, 2) column and row of each polyline's.
    """
    if not sum(map(len, batches)):
        return []
    members = np.concatenate(batches)
    x, y = block[members].T
    colour = np.repeat(4 * np.arange(len(batches)), [len(batch) for batch in batches]) + (x & 1) + 2 * (y & 1)
    key = (colour << 48) + ((y - y.min()) << 24) + (x - x.min())
    order = np.argsort(key, kind="stable")
    key = key[order]
    cuts = np.flatnonzero(np.diff(key)) + 1
    groups: dict[int, list[Ints]] = {}
    for part, group in zip(np.split(members[order], cuts), (key[np.append(0, cuts)] >> 48).tolist()):
        groups.setdefault(group, []).append(part)
    return list(groups.values())


def look_up(values: npt.NDArray[np.floating], points: Floats, width: float, height: float) -> Floats:
    """Values (rows, columns) that fill width × height at points (n, 2), bilinear."""
    rows, columns = values.shape
    out = np.empty(len(points))
    points = np.ascontiguousarray(points, np.float64)
    _resampling.look_up(np.ascontiguousarray(values), points, columns / width, rows / height, out)
    return out


def resample(tone: Floats, rows: int, columns: int, *, least: float = 0.0) -> Floats:
    """`tone` stretched to rows × columns: the mean over each cell where it shrinks, bilinear where it grows.

    least: of its values, which are 1 at the most; -1 for differences of tones. Rounding does not pass either.
    """
    tone = np.ascontiguousarray(tone, None if tone.dtype == np.float32 else np.float64)
    h, w = tone.shape
    down, across = _stretched(h, rows), _stretched(w, columns)
    if rows != h:
        out = np.empty((rows, w))
        if rows < h:
            _resampling.means_down(tone, *down, least, np.empty((2, w)), out)
        else:
            _resampling.blends_down(tone, *down, out)
        tone = out
    if columns != w:
        out = np.empty((rows, columns))
        if columns < w:
            _resampling.means_across(tone, *across, least, out)
        else:
            _resampling.blends_across(tone, *across, out)
        return out
    return tone if rows != h else tone.copy()


def _stretched(have: int, n: int) -> tuple[Ints, Floats]:
    """In which of so many values each of n cells begins, and the end of the last, and how far in; or, of more cells,
    which value is before the middle of each, and how much of the next one there is."""
    if n < have:
        bounds = np.arange(n + 1) * (have / n)
        at = np.minimum(bounds.astype(np.int64), have - 1)
        return at, np.asarray(bounds - at, np.float64)
    where: Floats = np.clip((np.arange(n) + 0.5) * have / n - 0.5, 0, have - 1)
    at = np.minimum(where.astype(np.int64), max(0, have - 2))
    return at, np.asarray(where - at, np.float64)
