"""The threshold table of a texture: for each of its strokes the tone at which it enters.

A renderer without a coverage buffer – a printer, a web page, `blast --rule threshold` – needs nothing
but this: *each stroke is drawn wherever the tone exceeds its threshold*. All of them share one table,
so they draw the same strokes.

A table consists of screens, a word from halftoning: each has an angle, a tile of its own in the
directions along (u) and across (v) that angle, and strokes with thresholds. Hatching is a screen of
*lines* for each layer. A line is as long as the tile and has one threshold for all of it, so light tones
are long lines and not scattered dashes. It is laid as strokes of a hand's length that bow and tilt a
little. Lines enter in the order of the reversed bits of their number, so that every prefix is spread
evenly. Any other texture is one screen at angle 0 whose strokes are those of its tile.

A texture that grows with the picture has one screen of strokes that are moved apart as much as the picture is larger
(`at_size`). Their thresholds fall as the tile's area grows beside their length. Screens of lines follow them.

Thresholds are meant for one effective width of pen, `PEN_PT`: what the device paints, its gain included. A pen
or a device that cannot paint so fine gets the pen and the tile magnified together.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from penink_cli.blasting.constants import (
    ACROSS,
    ALONG,
    BOW,
    CHAIN_FACTOR,
    CHAIN_STEP,
    COVERS,
    LINES,
    LONG,
    LONG_REST,
    PARTS,
    PIXEL,
    SEED,
    SEED_STEP,
    TILT,
    WAY_STEPS,
    WIDENED,
)
from penink_cli.blasting.scaling import FILLS
from penink_cli.blasting.tile import thresholds
from penink_cli.ground import exact
from penink_cli.ground.angles import direction
from penink_cli.ground.errors import ParameterError
from penink_cli.ground.median import median
from penink_cli.ground.model import Floats, HatchLayer, Ints, Strokes, Texture

Bytes = npt.NDArray[np.uint8]
Integers = npt.NDArray[np.int32]

#: The effective width of all strokes of a table, points.
PEN_PT = 0.54
@dataclass(frozen=True, eq=False)
class Screen:
    """Strokes with thresholds, on a tile that repeats.

    angle: of the u axis in degrees, from x towards y (clockwise on paper).
    width, height: of the tile, points.
    points, first: control points (p, 2) in points and where each stroke begins, as in `Strokes`.
    enters: (s,) tone above which each stroke is drawn.
    covers, fresh: (k,) the strokes that enter until the screen by itself covers covers[i], in ascending order, add
        fresh[i] square points of ink for each point of their length: the more there is, the more they overlap.
    line: (s,) the number of the line that a stroke is part of, -1 for none.
    level: (256,) of lines only: the row of `way` for a tone in 255ths.
    widens: mean of |cos| + |sin| over the strokes' directions: by so many of its pixels a device widens them.
    layer: of a screen of lines, what a renderer makes it from.
    again: of a screen that repeats the first one's strokes, half a tile away, in what those leave bare: the tone from
        which on it does; else None.
    spans: (s, 2) of a screen that grows, 16ths: each stroke is there where the tile is from so many to less than so
        many times as large as by nature; enters are then 16ths of 255ths for a tile of that size. None for others.
    """

    angle: float
    width: float
    height: float
    points: Floats
    first: Ints
    enters: Floats
    covers: Floats
    fresh: Floats
    line: Integers
    level: Bytes
    widens: float
    layer: HatchLayer | None = None
    again: float | None = None
    spans: Ints | None = None

    @property
    def control(self) -> Floats:
        """(s, 4, 2) the control points of each stroke."""
        return np.ascontiguousarray(self.points.reshape(-1, 4, 2))

    @property
    def fresh_of_each(self) -> Floats:
        """(s,) the fresh ink of a point of each stroke, square points."""
        low = self.again if self.again is not None else self.layer.low if self.layer else 0.0
        own = (self.enters - low) / (1 - low)
        return self.fresh[np.minimum(np.searchsorted(self.covers, own, side="right"), len(self.fresh) - 1)]

    @property
    def wave(self) -> float:
        """How far lines wander sideways, points."""
        return self.layer.wave_pt if self.layer else 0.0

    @property
    def turn(self) -> float:
        """By how much their wave turns along a point, radians."""
        return round(2 * math.pi / self.layer.wave_length_pt, 6) if self.layer and self.layer.wave_length_pt else 0.0


@dataclass(frozen=True, eq=False)
class ThresholdTable:
    """The screens of a texture, in order of drawing.

    way: (64, lines) as `give_way` makes it.
    pen_pt: effective width of the strokes.
    magnification: of pen and tile, for those who want another pen than the texture's own.
    whole: strokes are drawn whole or not at all.
    fill: hatching of the tones that a tile which grows does not reach. least_pt: no side of that is smaller.
    """

    name: str
    screens: tuple[Screen, ...]
    way: Bytes
    pen_pt: float = PEN_PT
    magnification: float = 1.0
    whole: bool = False
    fill: tuple[HatchLayer, ...] = ()
    least_pt: float = 0.0


def reversed_bits(k: int, bits: int = 8) -> int:
    """The bits of k from right to left.

    >>> [reversed_bits(k, 2) for k in range(4)]
    [0, 2, 1, 3]
    """
    return int(f"{k:0{bits}b}"[::-1], 2)


def random_bytes(seed: int) -> Iterator[int]:
    """Numbers 0 … 255 from a congruence that 32-bit signed integers can hold, so that any device makes the same."""
    state = seed
    while True:
        state = (state * CHAIN_FACTOR + CHAIN_STEP) % 65536
        yield state >> 8


def lines(layer: HatchLayer, number: int) -> Screen:
    """The screen of one hatching layer, the `number`-th of its texture.

    Line k lies at v = 100/256 (k + ½) pt. It is cut into strokes 42 to 73 pt long, each of which starts and ends
    up to 0.1 pt off the line and bows by up to 0.1 pt.
    """
    byte = random_bytes(SEED + SEED_STEP * number)
    span = (layer.high - layer.low) / (1.0 - layer.low)  # coverage of this screen alone when it ends
    points, enters, line = [], [], []
    for k in range(LINES):
        v = (k + 0.5) * ACROSS / LINES
        cover = float(np.interp((reversed_bits(k) + 0.5) / LINES, PARTS, COVERS))
        u = next(byte) * ALONG / 256
        left = ALONG
        while left > 0:
            length = LONG + next(byte) / 8
            if left < length + LONG_REST:
                length = left
            rise, fall, bow = (next(byte) / 128 - 1 for _ in range(3))
            if cover < span:
                v0, v1, push = v + TILT * rise, v + TILT * fall, BOW * bow
                points.append(
                    [
                        (u, v0),
                        (u + length / 3, v0 + (v1 - v0) / 3 + push),
                        (u + length * 2 / 3, v0 + (v1 - v0) * 2 / 3 + push),
                        (u + length, v1),
                    ]
                )
                enters.append(layer.low + (1 - layer.low) * cover)
                line.append(k)
            u += length
            left -= length
    n = len(points)
    return Screen(
        layer.angle, ALONG, ACROSS, np.array(points).reshape(-1, 2), np.arange(n + 1) * 4, np.array(enters),
        np.array(COVERS[1:]), np.diff(COVERS) / np.diff(PARTS) * ACROSS / LINES,
        np.array(line, np.int32), levels(layer), widening(np.array([(0, 0), *[direction(layer.angle)] * 3])), layer,
    )  # fmt: skip


#: Rows of the table of how lines give way.
LEVELS = 64


def levels(layer: HatchLayer) -> Bytes:
    """(256,) for each tone in 255ths the row of `give_way`: in 64ths, what part of the screen's lines it lets in."""
    cover = np.clip((np.arange(256) / 255 - layer.low) / (1 - layer.low), 0, 1)
    return np.minimum(np.floor(np.interp(cover, COVERS, PARTS) * LEVELS), LEVELS - 1).astype(np.uint8)


def give_way() -> Bytes:
    """(64, lines) how far a line moves aside for those that have entered beside it, in 24ths of a point, 128 for not.

    In row r the first 4r + 2 lines are there. Three times each moves half way to the middle between its neighbours.
    """
    out = np.full((LEVELS, LINES), 128, np.uint8)
    rank = np.array([reversed_bits(k) for k in range(LINES)])
    for r in range(LEVELS):
        there = np.flatnonzero(rank < 4 * r + 2)
        home = (there + 0.5) * ACROSS / LINES
        at = home
        for _ in range(3):
            before, after = np.roll(at, 1), np.roll(at, -1)
            before[0] -= ACROSS
            after[-1] += ACROSS
            at = at / 2 + (before + after) / 4
        out[r, there] = np.clip(np.floor(128.5 + WAY_STEPS * (at - home)), 0, 255)
    return out


#: Steps in which the control points of strokes that are not lines are kept, points, and how far one may lead.
GRID_PT, FARTHEST = 0.25, 127
#: Strokes that enter later than this add more bytes than ink: the first ones come again, elsewhere, instead.
LATEST = 0.9


def strokes(texture: Texture) -> Screen:
    """The screen of any other texture: the segments of its tile's strokes, on a grid of 1/4 pt."""
    tile = texture.strokes
    enters = thresholds(texture, PIXEL)
    control, source, equal = _segments(texture, tile, np.flatnonzero(enters <= LATEST))
    at = np.floor(enters[source] * 255) / 255
    lengths = np.append(0, np.cumsum(equal)) / (tile.width * tile.height)
    reached = np.append(at, LATEST)
    knots = np.unique(np.searchsorted(reached, np.linspace(0, LATEST, 19)[1:]))
    knots = knots[knots > 0]
    covers = reached[knots] - 0.5 / 255  # between two levels, so that no rounding matters
    n = len(control)
    return Screen(
        0.0, tile.width, tile.height, control.reshape(-1, 2), np.arange(n + 1) * 4, at,
        covers, np.diff(np.append(0, covers)) / np.diff(np.append(0, lengths[knots])),
        np.full(n, -1, np.int32), np.zeros(256, np.uint8), widening(control),
    )  # fmt: skip


def _segments(texture: Texture, tile: Strokes, which: Ints) -> tuple[Floats, Ints, list[float]]:
    """Cubics (s, 4, 2) of some strokes of a tile, which stroke each is of, and its length as ink counts it."""
    pen = float(median(tile.widths)) + WIDENED
    points, source, equal = [], [], []
    for i in which.tolist():
        stroke = tile[i]
        segments = [np.repeat(stroke, 4, axis=0)] if len(stroke) == 1 else [
            half for k in range(0, len(stroke) - 1, 3) for half in _short(stroke[k : k + 4])
        ]  # fmt: skip
        for segment in segments:
            segment = segment - np.floor(segment[0] / (tile.width, tile.height)) * (tile.width, tile.height)
            first = np.floor(segment[0] / GRID_PT + 0.5)
            points.append((first + np.floor((segment - segment[0]) / GRID_PT + 0.5)) * GRID_PT)
            source.append(i)
            # whole strokes count with their round ends, runs without
            equal.append(float(exact.length(points[-1][3] - points[-1][0])) + (0.785 * pen if texture.whole else 0.0))
    return np.array(points).reshape(-1, 4, 2), np.array(source, np.int64), equal


#: Strokes that come in where a tile is larger than so many times its own size are left to the hatching.
LARGEST = 4
#: Spans are kept in so many parts, thresholds of tiles that grow in so many of a 255th; the last span has no end.
SPAN_PARTS, EVER = 16, 255


def growing(texture: Texture) -> Screen:
    """The strokes of a tile that grows, as they are where it has its own size.

    They hardly overlap where it is large, so what they cover there is told, and goes with the inverse of the size.
    """
    scales = texture.scales
    assert scales is not None
    there = np.flatnonzero(scales.spans[:, 0] <= LARGEST)
    tile = scales.strokes.taken(there)
    width, height = texture.strokes.width, texture.strokes.height
    large = replace(tile, points=tile.points * LARGEST, width=width * LARGEST, height=height * LARGEST)
    covers = thresholds(replace(texture, strokes=large, priorities=scales.priorities[there], scales=None), PIXEL)
    tile = replace(tile, width=width, height=height)
    control, source, equal = _segments(texture, tile, np.arange(len(tile)))
    spans = np.ceil(scales.spans[there][source] * SPAN_PARTS - 1e-6).clip(0, EVER).astype(np.int64)
    at = np.floor(np.minimum(covers[source] * LARGEST * 255 * SPAN_PARTS, 65535.0))
    # fresh ink of a point of length, where most have come
    drawn = float(np.cumsum(equal)[-1]) / (tile.width * tile.height) if equal else 1.0
    fresh = float(at[-1]) / 255 / SPAN_PARTS / drawn if equal else 0.0
    n = len(control)
    return Screen(
        0.0, tile.width, tile.height, control.reshape(-1, 2), np.arange(n + 1) * 4, at,
        np.array([1.0]), np.array([round(fresh, 4)]), np.full(n, -1, np.int32), np.zeros(256, np.uint8),
        round(widening(control), 4), spans=spans,
    )  # fmt: skip


def at_size(table: ThresholdTable, scale: float, unit: float) -> ThresholdTable:
    """The table for a picture so many times as large as it is by nature; unit: points, see `threshold`.

    Of a texture that does not grow it is the table as it is.
    """
    tile = table.screens[0]
    if tile.spans is None:
        return table
    scale = max(scale, table.least_pt / min(tile.width, tile.height))
    by = scale / unit
    parts = SPAN_PARTS * 1.001 * scale  # where the size is just that from which on a stroke is there, it is
    there = np.flatnonzero((tile.spans[:, 0] <= parts) & ((tile.spans[:, 1] > parts) | (tile.spans[:, 1] == EVER)))
    enters = (tile.enters[there] + 0.5) / (255 * SPAN_PARTS) / by
    reached = min(float(enters[-1]), 1.0) if len(there) else 0.0
    grown = replace(
        tile, width=tile.width * by, height=tile.height * by, points=(tile.control[there] * by).reshape(-1, 2),
        first=np.arange(len(there) + 1) * 4, enters=enters, line=tile.line[there], spans=None,
    )  # fmt: skip
    over = [
        replace(layer, low=reached + (1 - reached) * layer.low, high=reached + (1 - reached) * layer.high)
        for layer in table.fill
    ]
    return replace(table, screens=(grown, *(lines(layer, k) for k, layer in enumerate(over, 1))))


def once_more(screen: Screen, low: float) -> Screen:
    """The same strokes half a tile away: from tone `low` on they cover what the screen leaves bare."""
    half = (screen.width / 2, screen.height / 2)
    return replace(screen, points=screen.points + half, enters=low + (1 - low) * screen.enters, again=low)


def widening(cubics: Floats) -> float:
    """Mean of |cos| + |sin| over the directions of cubics (s, 4, 2), by length; of dots, that of all directions.

    >>> round(widening(np.array([[(0, 0), (1, 1), (2, 2), (3, 3)]], float)), 6)
    1.414214
    """
    steps = np.diff(cubics.reshape(-1, 4, 2), axis=1)
    length = np.sqrt((steps**2).sum(axis=2)).sum()
    return float(np.abs(steps).sum() / length) if length > 0 else WIDENED / PIXEL


def _short(segment: Floats) -> list[Floats]:
    """The cubic in halves, and theirs, until no control point lies too far from the first."""
    if np.abs(segment - segment[0]).max() < (FARTHEST - 1) * GRID_PT:
        return [segment]
    a, b, c, d = segment
    ab, bc, cd = (a + b) / 2, (b + c) / 2, (c + d) / 2
    abc, bcd = (ab + bc) / 2, (bc + cd) / 2
    middle = (abc + bcd) / 2
    return _short(np.array([a, ab, abc, middle])) + _short(np.array([middle, bcd, cd, d]))


def table(texture: Texture, pen_pt: float | None = None) -> ThresholdTable:
    """The threshold table of a texture; pen_pt: one pen for all its strokes.

    Raises ParameterError for a set of strokes.
    """
    if texture.oriented:
        raise ParameterError(f"the texture {texture.name} is a set of strokes, which only blast and render can lay")
    pen = pen_pt or (float(median(texture.strokes.widths)) if len(texture.strokes) else 0.4)
    if not texture.layers:
        own = float(median(texture.strokes.widths)) + WIDENED
        magnification = (pen + WIDENED) / own
        if texture.scales is not None and (texture.scales.spans[:, 0] <= LARGEST).any():
            return ThresholdTable(
                texture.name, (growing(texture),), give_way(), own, magnification, texture.whole,
                FILLS[texture.scales.fill], texture.scales.least_pt,
            )  # fmt: skip
        first = strokes(texture)
        return ThresholdTable(
            texture.name, (first, once_more(first, LATEST)), give_way(), own, magnification, texture.whole
        )
    screens, low = [], 0.0
    for number, layer in enumerate(texture.layers):
        screens.append(lines(replace(layer, low=low), number))
        low = layer.high
    return ThresholdTable(texture.name, tuple(screens), give_way(), PEN_PT, (pen + WIDENED) / PEN_PT)
