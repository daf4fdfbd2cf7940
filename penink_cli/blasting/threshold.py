"""The threshold rule: each stroke of a table is drawn wherever the tone exceeds its threshold.

It needs no coverage buffer, so a printer and a web page can follow it too. Of the same table, the same
tone and the same edges they and this module draw the same strokes. There are two passes. The ink that
the first would lay is compared with the tone in blocks of 9 pt. The difference, smoothed, is added to
the tone of the second.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import curves
from penink_cli.blasting._compiled import threshold as _threshold
from penink_cli.blasting.constants import BLOCK, LEAST_PIXELS, PIXEL, TAKEN_UP, WIDENED
from penink_cli.blasting.screens import Screen, ThresholdTable, at_size, table
from penink_cli.blasting.sheet import resample
from penink_cli.geometry import edge_index
from penink_cli.ground import device, pens
from penink_cli.ground.angles import direction
from penink_cli.ground.model import EdgeList, Floats, Ints, Strokes, Texture

Bytes = npt.NDArray[np.uint8]


def buckets(ends: Floats, columns: int, rows: int) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int32]]:
    """first (columns · rows + 1,) and items: which edges (m, 4) ax ay bx by, in sample units, are in which square."""
    low, high = edge_index.cells(np.asarray(ends, np.float64).reshape(-1, 4), 1.0)
    first, items = edge_index.lists(low + 1, high + 1, columns, rows)
    return first.astype(np.int32), np.append(items, 0).astype(np.int32)


def _copies(screen: Screen, width: float, height: float) -> npt.NDArray[np.int32]:
    c, s = direction(screen.angle)
    corners = np.array([(0, 0), (width, 0), (0, height), (width, height)])
    u, v = corners[:, 0] * c + corners[:, 1] * s, corners[:, 1] * c - corners[:, 0] * s
    lo = np.floor(np.array([u.min() / screen.width, v.min() / screen.height]) - 1).astype(int)
    hi = np.ceil(np.array([u.max() / screen.width, v.max() / screen.height])).astype(int)
    a, b = np.meshgrid(np.arange(lo[0], hi[0] + 1), np.arange(lo[1], hi[1] + 1))
    return np.column_stack([a.ravel(), b.ravel()]).astype(np.int32)




@dataclass(eq=False)
class Paper:
    """What the layers of a sheet share: blocks, side_pt square, in which ink is compared with tone.

    bare: (rows, columns) the part of each that is still paper; changed by those who draw.
    """

    width_pt: float
    height_pt: float
    side_pt: float

    def __post_init__(self) -> None:
        self.bare = np.ones((math.ceil(self.height_pt / self.side_pt), math.ceil(self.width_pt / self.side_pt)))
        tall = np.minimum(self.side_pt, self.height_pt - self.side_pt * np.arange(self.bare.shape[0]))
        wide = np.minimum(self.side_pt, self.width_pt - self.side_pt * np.arange(self.bare.shape[1]))
        self.area = np.outer(tall, wide)  # square points

    def cover(self, ink: Strokes) -> None:
        """Take the ink of outlines from what is bare, as broad as the printer paints them that they are for."""
        if ink.device_dpi:
            ink = device.widened(ink, ink.device_dpi)
        lines = curves.sample(ink.points, ink.first, curves.pieces_of(ink.points, ink.first, 1.0))
        begin = np.setdiff1d(np.arange(len(lines.points)), lines.first[1:] - 1)
        a, b = lines.points[begin], lines.points[np.minimum(begin + 1, len(lines.points) - 1)]
        owner = np.searchsorted(lines.first, begin, side="right") - 1
        covered = np.sqrt(((b - a) ** 2).sum(axis=1)) * ink.widths[owner]
        middle = (a + b) / 2
        inside = (middle >= 0).all(axis=1) & (middle < (self.width_pt, self.height_pt)).all(axis=1)
        x, y = (middle[inside] / self.side_pt).astype(np.int64).T
        total = np.zeros_like(self.bare)
        np.add.at(total, (y, x), covered[inside])
        self.bare *= 1 - np.minimum(total / self.area, 1.0)


def paper(
    layers: Sequence[tuple[Texture, float | None]], width_pt: float, height_pt: float, dpi: float | None,
    by: float = 1.0,
) -> Paper:  # fmt: skip
    """A sheet for layers of these textures and pens; by: the part of their width that textures' pens have."""
    return Paper(width_pt, height_pt, BLOCK * max(_unit_of(texture, pen, dpi, by) for texture, pen in layers))


def in_255ths(tone: Floats) -> Bytes:
    """Tone 0 … 1 as a device has it."""
    return np.floor(np.clip(tone, 0.0, 1.0) * 255 + 0.5).astype(np.uint8)


def add_up(tones: Sequence[Bytes], families: Sequence[int]) -> list[tuple[Bytes, Bytes]]:
    """For layers, bottom first, tone (h, w) in 255ths to be hatched, and of each the sum with those below.

    families: equal for layers of one texture and pen. Where a layer lies over one of its family its strokes stand for
    both; over others it is hatched the more densely, the more of its ink will fall on theirs.
    """
    own = [tone.copy() for tone in tones]
    for i, tone in enumerate(own):
        for k in range(i):
            if families[k] == families[i]:
                under, over = _looked(own[k], tone.shape), _looked(tone, own[k].shape)
                tone[:] = np.where(tone > 0, np.minimum(255, tone.astype(int) + under), 0)
                own[k][over > 0] = 0
    out: list[tuple[Bytes, Bytes]] = []
    for tone in own:
        below = _looked(out[-1][1], tone.shape).astype(int) if out else np.zeros(tone.shape, int)
        total = tone + below
        room = np.floor(tone / np.maximum(255 - below, 1) * 255.0 + 0.5)
        wanted = np.where(tone == 0, 0, np.where(total >= 255, 255, room))
        out.append((wanted.astype(np.uint8), np.minimum(total, 255).astype(np.uint8)))
    return out


def _looked(values: Bytes, shape: tuple[int, ...]) -> Bytes:
    """The values (h, w) that lie at the middles of the cells of a grid of another shape."""
    y, x = (((np.arange(n) + 0.5) * m / n).astype(int) for n, m in zip(shape, values.shape, strict=True))
    return values[y[:, None], x[None, :]]


def blast_by_threshold(
    tone: Floats, width_pt: float, height_pt: float, edges: EdgeList | None, texture: Texture, pen_pt: float | None,
    device_dpi: float | None, outlines: Strokes | None = None, natural_pt: float | None = None,
) -> Strokes:  # fmt: skip
    """Strokes for a sheet of width_pt × height_pt, as `blast` describes them.

    tone: (h, w) 0 … 1. A device asks for one value a unit; finer ones are taken as they are, up to four.
    """
    n, m = grid(texture, pen_pt, device_dpi, width_pt, height_pt)
    rows, columns = tone.shape
    if rows < m or columns < n or rows > 4 * m or columns > 4 * n:
        tone = resample(tone, m, n)
    sheet = paper([(texture, pen_pt)], width_pt, height_pt, device_dpi)
    if outlines is not None:
        sheet.cover(outlines)
    ink = in_255ths(tone)
    return blast_on(sheet, ink, ink, edges, texture, pen_pt, device_dpi, natural_pt)


def blast_on(
    sheet: Paper, ink: Bytes, total: Bytes, edges: EdgeList | None, texture: Texture, pen_pt: float | None,
    device_dpi: float | None, natural_pt: float | None = None, by: float = 1.0,
) -> Strokes:  # fmt: skip
    """Strokes of one layer. ink, total: (m, n) as `add_up` has them; natural_pt: as in `blast`; by: as in `paper`."""
    width_pt, height_pt = sheet.width_pt, sheet.height_pt
    sizes = table(texture, pen_pt)
    gain = 72.0 / device_dpi if device_dpi else 0.0
    unit = _unit(sizes, pen_pt, device_dpi, by)
    if texture.scales is not None:
        sizes = at_size(sizes, width_pt / (natural_pt or texture.scales.natural_pt), unit)
    n, m = grid(texture, pen_pt, device_dpi, width_pt, height_pt, by)
    squares = max(1, n // 4), max(1, m // 4)
    ends = np.zeros((0, 4))
    if edges is not None and len(edges.edges):
        ends = (edges.scaled(*squares) - 0.5)[edges.edges].reshape(-1, 4)
    parts = []
    for screen, (points, stops) in zip(
        sizes.screens, draw(ink, total, ends, squares, sizes, sheet, unit, gain), strict=True
    ):
        pen = pen_pt or max(sizes.pen_pt * unit - gain * screen.widens, 0.02)
        parts.append(_smooth(*_within(points, stops, width_pt, height_pt, pen / 2), pen))
    control = np.concatenate([points for points, _, _ in parts])
    counts = np.concatenate([count for _, count, _ in parts])
    return Strokes(width_pt, height_pt, control, curves.starts(counts), np.concatenate([w for _, _, w in parts]))


def grid(
    texture: Texture, pen_pt: float | None, device_dpi: float | None, width_pt: float, height_pt: float, by: float = 1.0
) -> tuple[int, int]:
    """How many values of tone a device wants, across and down: one a unit, which is about a point."""
    unit = _unit_of(texture, pen_pt, device_dpi, by)
    return max(1, math.floor(width_pt / unit + 0.5)), max(1, math.floor(height_pt / unit + 0.5))


def _unit_of(texture: Texture, pen_pt: float | None, device_dpi: float | None, by: float) -> float:
    return _unit(table(texture, pen_pt), pen_pt, device_dpi, by)


def _unit(sizes: ThresholdTable, pen_pt: float | None, device_dpi: float | None, by: float) -> float:
    """The magnification of pen and tile, in points, for a pen if one is given, on such a device."""
    gain_pt = 72.0 / device_dpi if device_dpi else 0.0
    if pen_pt is not None:  # the table takes a printer of 600 dpi for granted
        return (pen_pt + gain_pt * WIDENED / PIXEL) / sizes.pen_pt
    pen = pens.finer(sizes.magnification * sizes.pen_pt - WIDENED, by, device_dpi)
    return max((pen + WIDENED) / sizes.pen_pt, LEAST_PIXELS * gain_pt / sizes.pen_pt)


def _within(points: Floats, stops: Ints, width: float, height: float, rim: float) -> tuple[Floats, Ints]:
    """The parts of polylines that lie on the page and no nearer than rim to its border: a device clips ink to it."""
    least = np.minimum(rim, (width / 2, height / 2))
    most = (width, height) - least
    begin = np.setdiff1d(np.arange(len(points)), stops - 1)
    a, step = points[begin], points[np.minimum(begin + 1, len(points) - 1)] - points[begin]
    with np.errstate(divide="ignore", invalid="ignore"):
        cross = np.stack([(least - a) / step, (most - a) / step])
    # along an axis on which a segment does not move it is inside for good, or never
    still = np.where((a >= least) & (a <= most), np.inf, -np.inf)
    enters = np.where(step == 0, -still, np.minimum(*cross)).max(axis=1).clip(0.0, None)
    leaves = np.where(step == 0, still, np.maximum(*cross)).min(axis=1).clip(None, 1.0)
    # a dot has no length to be inside with
    on = (leaves > enters) | ((step == 0).all(axis=1) & (still > 0).all(axis=1))
    enters, leaves = np.where(on, enters, 0.0), np.where(on, leaves, 1.0)
    follows = np.zeros(len(begin), bool)
    follows[1:] = (begin[1:] == begin[:-1] + 1) & on[:-1] & (leaves[:-1] >= 1) & (enters[1:] <= 0)
    fresh = on & ~follows
    begin, a, step, enters, leaves, fresh = (v[on] for v in (begin, a, step, enters, leaves, fresh[: len(on)]))
    # each segment gives its end, the first of a run its start as well
    out = np.stack([a + enters[:, None] * step, a + leaves[:, None] * step], axis=1)
    keep = np.column_stack([fresh, np.ones(len(fresh), bool)])
    count = np.cumsum(keep.sum(axis=1))
    last = np.append(fresh[1:], True) if len(fresh) else fresh
    return out[keep], count[last]


def _smooth(points: Floats, stops: Ints, pen: float) -> tuple[Floats, Ints, Floats]:
    """Control points, how many each stroke has, and widths, of smooth curves through polylines that end at stops."""
    if len(stops) == 0:
        return np.zeros((0, 2)), np.zeros(0, np.int64), np.zeros(0)
    start = np.concatenate([[0], stops[:-1]])
    at = np.arange(len(points))
    first, last = np.zeros(len(points), bool), np.zeros(len(points), bool)
    first[start], last[stops - 1] = True, True
    before = points - points[np.where(first, at, at - 1)]
    after = points[np.where(last, at, (at + 1) % len(at))] - points
    near, far = np.sqrt((before**2).sum(axis=1)), np.sqrt((after**2).sum(axis=1))
    across = before + after
    along = across / np.maximum(np.sqrt((across**2).sum(axis=1)), 1e-9)[:, None]
    control = np.stack([points - along * near[:, None] / 3, points, points + along * far[:, None] / 3], axis=1)
    # a chain begins and ends with a point itself
    keep = np.ones((len(points), 3), bool)
    keep[first, 0], keep[last, 2] = False, False
    return control[keep], 3 * (stops - start) - 2, np.full(len(stops), pen)


def draw(
    tone: Bytes, total: Bytes, ends: Floats, samples: tuple[int, int], table: ThresholdTable, sheet: Paper, unit: float,
    gain_pt: float,
) -> list[tuple[Floats, Ints]]:
    """For each screen its runs: points (p, 2) of polylines, and where each ends.

    tone, total: (m, n) as `add_up` has them. ends: (e, 4) the edges, on a grid of samples (w, h)
    whose first lies at 0, 0. unit: magnification of pen and tile.
    gain_pt: what the device adds to an upright stroke. The sheet is left as bare as it will be.
    """
    w, h, block = sheet.width_pt / unit, sheet.height_pt / unit, sheet.side_pt / unit
    columns, rows = samples[0] + 1, samples[1] + 1
    first, items = buckets(ends, columns, rows)
    near = _threshold.Edges(np.ascontiguousarray(ends, np.float64).reshape(-1, 4), first, items, columns, rows)
    wanted = tone
    for painting in (False, True):
        parts = []
        for screen in table.screens:
            copies = _copies(screen, w, h)
            ink = np.zeros_like(sheet.bare)
            room = 1 << 20
            while True:
                ink[:] = 0
                blocks = _threshold.Blocks(ink, w, h, block, gain_pt / unit / table.pen_pt)
                runs = _threshold.Runs(np.zeros((room, 2)), np.zeros(room // 2, np.int64))
                if _threshold.runs(wanted, screen, table, copies, near, blocks, runs):
                    break
                room *= 4
            if not painting:
                sheet.bare *= 1 - np.minimum(ink * unit * unit / sheet.area, 1.0)
            points, stops = np.asarray(runs.points), np.asarray(runs.ends)
            parts.append((points[: runs.points_used] * unit, stops[: runs.runs_used]))
        if not painting:
            wanted = corrected(tone, total, sheet, 1.0 if table.screens[0].layer else TAKEN_UP)
    return parts


def corrected(tone: Bytes, total: Bytes, sheet: Paper, taken_up: float) -> Bytes:
    """The tone with what a pass that leaves the sheet so bare lacks of the total, smoothed over the blocks, added.

    taken_up: how much of it is.

    The sheet is then as bare as what is added will leave it.
    """
    m, n = tone.shape
    across, down = sheet.width_pt / n / sheet.side_pt, sheet.height_pt / m / sheet.side_pt  # blocks a cell
    by = np.minimum((np.arange(m) + 0.5) * down, sheet.bare.shape[0] - 1).astype(int)
    bx = np.minimum((np.arange(n) + 0.5) * across, sheet.bare.shape[1] - 1).astype(int)
    tones = np.zeros_like(sheet.bare)
    cells = np.zeros_like(sheet.bare)
    np.add.at(tones, (by[:, None], bx[None, :]), total)
    np.add.at(cells, (by[:, None], bx[None, :]), 1)
    lack = tones / np.maximum(cells, 1) - 255 * (1 - sheet.bare)
    for axis in (0, 1):
        padded = np.pad(lack, [(1, 1) if a == axis else (0, 0) for a in (0, 1)], "edge")
        before = np.take(padded, range(lack.shape[axis]), axis)
        after = np.take(padded, range(2, lack.shape[axis] + 2), axis)
        lack = (before + 2 * lack + after) / 4

    lack *= taken_up
    sheet.bare = np.clip(sheet.bare - lack / 255, 0.0, 1.0)

    def spread(count: int, per: float, blocks: int) -> tuple[Ints, Ints, Floats]:
        at = (np.arange(count) + 0.5) * per - 0.5
        low = np.clip(np.floor(at), 0, blocks - 1).astype(int)
        return low, np.minimum(low + 1, blocks - 1), np.clip(at - low, 0, 1)

    y0, y1, fy = spread(m, down, lack.shape[0])
    x0, x1, fx = spread(n, across, lack.shape[1])
    rows = lack[y0] * (1 - fy)[:, None] + lack[y1] * fy[:, None]
    more = rows[:, x0] * (1 - fx) + rows[:, x1] * fx
    return np.where(tone == 0, 0, np.clip(np.floor(tone + more + 0.5), 0, 255)).astype(np.uint8)
