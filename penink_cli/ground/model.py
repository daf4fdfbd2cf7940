"""The values that the rooms of the project hand to one another.

One coordinate decision holds everywhere: x right, y down, the origin at the top-left
*corner*. The pixel in row i, column j covers the unit square whose top-left corner is
(j, i), and its sample sits at (j + ½, i + ½). Only modules that speak to something
with another convention (scikit-image's integer centres, PostScript's y up) convert.

Nothing here knows of files, options or algorithms.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from penink_cli.ground.angles import direction

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class GreyImage:
    """Grey samples exactly as a PGM file stores them.

    values: (h, w), uint8 where maxval ≤ 255, else uint16; 0 is black, maxval is paper white.
    """

    values: npt.NDArray[np.uint8] | npt.NDArray[np.uint16]
    maxval: int = 255

    @property
    def tone(self) -> Floats:
        """Ink coverage (h, w), 0 paper … 1 solid ink."""
        return 1.0 - self.values / float(self.maxval)

    @property
    def grey(self) -> npt.NDArray[np.float32]:
        """Grey (h, w), 0 black … 1 paper white."""
        return np.divide(self.values, self.maxval, dtype=np.float32)

    @classmethod
    def from_grey(cls, grey: npt.NDArray[np.floating], maxval: int = 255) -> GreyImage:
        """The nearest grey levels, half up, to grey (h, w) 0 … 1."""
        levels = np.floor(np.clip(grey, 0, 1) * maxval + 0.5)
        return cls(levels.astype(np.uint8 if maxval < 256 else np.uint16), maxval)


@dataclass(frozen=True, eq=False)
class ColourImage:
    """A photograph in its colours, as stored.

    values: (h, w, 3) red, green, blue, uint8 where maxval ≤ 255, else uint16.
    """

    values: npt.NDArray[np.uint8] | npt.NDArray[np.uint16]
    maxval: int = 255


@dataclass(frozen=True, eq=False)
class EdgeList:
    """An arrangement of discontinuity edges, in pixels of the photo it was found in.

    width, height: the image frame [0, width] × [0, height], whole photo pixels.
    vertices: (n, 2) x, y.
    edges: (m, 2) indices into vertices. Edges meet only at shared vertices.
    strength: (m,) grey step across each edge, 0 … 1, or None where not known.

    One edge list serves every resolution of its image: see `scaled`.
    """

    width: int
    height: int
    vertices: Floats = field(default_factory=lambda: np.zeros((0, 2)))
    edges: Ints = field(default_factory=lambda: np.zeros((0, 2), np.int64))
    strength: Floats | None = None

    def scaled(self, width: float, height: float) -> Floats:
        """Vertices (n, 2) in an image of width × height that fills the same frame."""
        return self.vertices * (width / self.width, height / self.height)


@dataclass(frozen=True, eq=False)
class Lines:
    """Telling lines: what a pen would draw of a picture besides its tone, in pixels of the photo it was found in.

    width, height: the image frame [0, width] × [0, height], whole photo pixels.
    points: (p, 2) x, y of all lines, one line after the other.
    first: (n + 1,) line i owns points[first[i] : first[i + 1]].
    weight: (p,) how much the pen is pressed at each point, 0 the finest line it draws … 1 the broadest.
    rank: (n,) what each line is worth, from 0; a print has room for those of the highest rank.
    white: (n,) bool: a light line on dark ground, along which hatching is left away.
    breadth: (n,) how broad the thing itself is, pixels, where it is drawn as broad as it is (a pupil, a full stop);
        0 for a line, which is as broad as the pen draws it. A thing with breadth may have but one point: a spot.

    One list serves every size on paper: the rank says what to leave out.
    """

    width: int
    height: int
    points: Floats = field(default_factory=lambda: np.zeros((0, 2)))
    first: Ints = field(default_factory=lambda: np.zeros(1, np.int64))
    weight: Floats = field(default_factory=lambda: np.zeros(0))
    rank: Floats = field(default_factory=lambda: np.zeros(0))
    white: npt.NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, np.bool_))
    breadth: Floats = field(default_factory=lambda: np.zeros(0))

    def __len__(self) -> int:
        return len(self.rank)

    def __getitem__(self, i: int) -> Floats:
        """Points (k, 2) of line i."""
        return self.points[self.first[i] : self.first[i + 1]]

    def chosen(self, which: Ints) -> Lines:
        """These lines alone, in this order."""
        sizes = np.diff(self.first)[which]
        first = np.zeros(len(which) + 1, np.int64)
        np.cumsum(sizes, out=first[1:])
        at = np.repeat(self.first[:-1][which] - first[:-1], sizes) + np.arange(first[-1])
        return Lines(
            self.width, self.height, self.points[at], first, self.weight[at], self.rank[which], self.white[which],
            self.breadth[which],
        )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Directions:
    """A line field: at every place the angle θ, modulo 180°, that strokes are to run at, and how sure that is.

    θ is measured from x towards y (clockwise on paper). The samples fill the image frame, as those of a grey image do.

    cos2, sin2: (h, w) cos 2θ and sin 2θ, a unit vector in each place; both 0 where no direction is known.
    confidence: (h, w), 0 nothing is known … 1 the form says so.
    """

    cos2: npt.NDArray[np.floating]
    sin2: npt.NDArray[np.floating]
    confidence: npt.NDArray[np.floating]

    def turned(self, degrees: float) -> Directions:
        """The field with every direction turned clockwise."""
        if not degrees:
            return self
        c, s = direction(2.0 * degrees)
        return replace(self, cos2=self.cos2 * c - self.sin2 * s, sin2=self.cos2 * s + self.sin2 * c)


@dataclass(frozen=True, eq=False)
class Strokes:
    """Pen strokes on paper: chains of cubic Bézier segments, in points (1/72 inch).

    width, height: the sheet, points.
    points: (p, 2) control points of all strokes, one stroke after the other.
    first: (s + 1,) stroke i owns points[first[i] : first[i + 1]], 3k + 1 of them; one is a dot.
    widths: (s,) pen width of each stroke, points; of one that swells, the mean of its knots' widths.
    knot_widths: (n,) width at each knot, where a segment begins or ends, and linear along each segment's parameter
        between; stroke i owns knot_widths[knots[i] : knots[i + 1]], k + 1 of them. None where no stroke swells.
    color: ``#rrggbb``, None for what the output chooses.
    device_dpi: resolution of the printer whose gain the strokes allow for (see `gain`), None for no printer's.
    """

    width: float
    height: float
    points: Floats = field(default_factory=lambda: np.zeros((0, 2)))
    first: Ints = field(default_factory=lambda: np.zeros(1, np.int64))
    widths: Floats = field(default_factory=lambda: np.zeros(0))
    layer: str | None = None
    texture: str | None = None
    seed: int | None = None
    knot_widths: Floats | None = None
    color: str | None = None
    device_dpi: float | None = None

    def __len__(self) -> int:
        return len(self.widths)

    def __getitem__(self, i: int) -> Floats:
        """Control points (3k + 1, 2) of stroke i."""
        return self.points[self.first[i] : self.first[i + 1]]

    def picked(self, which: Ints) -> Strokes:
        """These strokes alone, in this order; of strokes that do not swell."""
        assert self.knot_widths is None
        sizes = np.diff(self.first)[which]
        first = np.zeros(len(which) + 1, np.int64)
        np.cumsum(sizes, out=first[1:])
        at = np.repeat(self.first[:-1][which] - first[:-1], sizes) + np.arange(first[-1])
        return replace(self, points=self.points[at], first=first, widths=self.widths[which])

    @classmethod
    def of(
        cls, width: float, height: float, chains: Sequence[npt.ArrayLike], widths: Sequence[npt.ArrayLike] | Floats
    ) -> Strokes:
        """Strokes from one array of control points (3k + 1, 2) each, and one width each, or k + 1 for one that swells.

        >>> Strokes.of(9, 9, [[[1, 2]], [[0, 0], [1, 0], [2, 0], [3, 0]]], [2.0, [0.5, 1.5]]).widths.tolist()
        [2.0, 1.0]
        """
        parts = [np.asarray(chain, np.float64).reshape(-1, 2) for chain in chains]
        points = np.concatenate(parts) if parts else np.zeros((0, 2))
        first = np.zeros(len(parts) + 1, np.int64)
        np.cumsum([len(part) for part in parts], out=first[1:])
        given = [np.asarray(w, np.float64) for w in widths]
        even = cls(width, height, points, first, np.array([float(w) if w.ndim == 0 else 0.0 for w in given]))
        if all(w.ndim == 0 for w in given):
            return even
        knots = [np.broadcast_to(w, (n + 2) // 3) for w, n in zip(given, np.diff(first).tolist())]
        return even.swelling(np.concatenate(knots))

    @staticmethod
    def joined(parts: Sequence[Strokes]) -> Strokes:
        """The strokes of all parts, in their order, on the first one's sheet; what the parts agree in is kept."""
        first = np.zeros(1 + sum(map(len, parts)), np.int64)
        np.cumsum(np.concatenate([np.diff(part.first) for part in parts]), out=first[1:])
        whole = Strokes(
            parts[0].width,
            parts[0].height,
            np.concatenate([part.points for part in parts]),
            first,
            np.concatenate([part.widths for part in parts]),
        )
        if any(part.knot_widths is not None for part in parts):
            whole = replace(whole, knot_widths=np.concatenate([part.at_knots for part in parts]))
        agreed = {name: {getattr(part, name) for part in parts} for name in HEADER}
        return replace(whole, **{name: values.pop() for name, values in agreed.items() if len(values) == 1})

    @property
    def knots(self) -> Ints:
        """(s + 1,) where each stroke's knots begin among those of all strokes."""
        return (self.first + 2 * np.arange(len(self.first))) // 3

    @property
    def at_knots(self) -> Floats:
        """(n,) width at each knot, whether its stroke swells or not."""
        return np.repeat(self.widths, np.diff(self.knots)) if self.knot_widths is None else self.knot_widths

    @property
    def swells(self) -> npt.NDArray[np.bool_]:
        """(s,) whether a stroke's width changes on its way."""
        if self.knot_widths is None or not len(self):
            return np.zeros(len(self), bool)
        starts = self.knots[:-1]
        thinnest = np.minimum.reduceat(self.knot_widths, starts)
        swells: npt.NDArray[np.bool_] = thinnest < np.maximum.reduceat(self.knot_widths, starts)
        return swells

    @property
    def widest(self) -> Floats:
        """(s,) the largest width of each stroke."""
        if self.knot_widths is None or not len(self):
            return self.widths
        return np.maximum.reduceat(self.knot_widths, self.knots[:-1])

    def swelling(self, knot_widths: Floats) -> Strokes:
        """The same strokes with these widths at their knots (n,), and their means."""
        knots = self.knots
        if not len(self):
            return self
        means = np.add.reduceat(knot_widths, knots[:-1]) / np.diff(knots)
        swelling = replace(self, widths=means, knot_widths=knot_widths)
        return replace(swelling, widths=np.where(swelling.swells, means, knot_widths[knots[:-1]]))

    def by_segments(self, step: float = 0.15) -> Strokes:
        """Strokes that cover the same, each of one width: those that swell in pieces, a step (points) apart."""
        if self.knot_widths is None:
            return self
        swells = self.swells
        even, some = self.taken(~swells), self.taken(swells)
        counts = np.diff(some.first) // 3
        within = np.arange(int(counts.sum())) - np.repeat(np.cumsum(counts) - counts, counts)
        control = some.points[(np.repeat(some.first[:-1], counts) + 3 * within)[:, None] + np.arange(4)]
        knot = np.repeat(some.knots[:-1], counts) + within
        begin, end = some.at_knots[knot], some.at_knots[knot + 1]
        n = np.maximum(np.ceil(np.abs(end - begin) / step), 1).astype(np.int64)
        which = np.repeat(np.arange(len(n)), n)
        k = np.arange(len(which)) - np.repeat(np.cumsum(n) - n, n)
        u, v = (k / n[which])[:, None], ((k + 1) / n[which])[:, None]

        def at(*places: Floats) -> Floats:  # the polar form
            p = control[which]
            for t in places:
                p = p[:, :-1] + (p[:, 1:] - p[:, :-1]) * t[:, :, None]
            return np.asarray(p[:, 0])

        points = np.stack([at(u, u, u), at(u, u, v), at(u, v, v), at(v, v, v)], axis=1).reshape(-1, 2)
        widths = begin[which] + (end - begin)[which] * (k + 0.5) / n[which]
        pieces = replace(some, points=points, first=4 * np.arange(len(which) + 1), widths=widths, knot_widths=None)
        return Strokes.joined([replace(even, knot_widths=None), pieces])

    def taken(self, which: npt.NDArray[Any], turned: npt.NDArray[np.bool_] | None = None) -> Strokes:
        """The strokes with these numbers, in that order, or those where a mask (s,) is true.

        turned: one for each stroke taken, whether it is to be drawn from its end.
        """
        if which.dtype == bool:
            which = np.flatnonzero(which)
        back = np.zeros(len(which), bool) if turned is None else turned
        index, first = _taken(self.first, which, back)
        widths = None if self.knot_widths is None else self.knot_widths[_taken(self.knots, which, back)[0]]
        return replace(
            self, points=self.points[index], first=first, widths=self.widths[which], knot_widths=widths
        )

    def rounded(self) -> Strokes:
        """The strokes as a strokes file holds them: thousandths of a point, widths in ten-thousandths, none 0."""
        widths = np.maximum(np.floor(self.widths * 10000 + 0.5), 1) / 10000
        knot_widths = self.knot_widths
        if knot_widths is not None:
            knot_widths = np.floor(knot_widths * 10000 + 0.5) / 10000
            swells = np.repeat(replace(self, knot_widths=knot_widths).swells, np.diff(self.knots))
            even = np.repeat(widths, np.diff(self.knots))
            knot_widths = np.where(swells, knot_widths, even) if swells.any() else None
        return replace(
            self,
            width=round(self.width, 3),
            height=round(self.height, 3),
            points=np.floor(self.points * 1000 + 0.5) / 1000,
            widths=widths,
            knot_widths=knot_widths,
        )


#: What the header of a strokes file may say besides the sheet.
HEADER = ("layer", "texture", "seed", "color", "device_dpi")


def _taken(first: Ints, which: Ints, turned: npt.NDArray[np.bool_]) -> tuple[Ints, Ints]:
    """Places of the members of the groups `which` of first (g + 1,), backwards where turned; and their new first."""
    counts = np.diff(first)[which]
    begins = np.zeros(len(which) + 1, np.int64)
    np.cumsum(counts, out=begins[1:])
    along = np.arange(begins[-1]) - np.repeat(begins[:-1], counts)
    step = np.where(turned, -1, 1)
    start = first[which] + np.where(turned, counts - 1, 0)
    return np.repeat(start, counts) + np.repeat(step, counts) * along, begins


@dataclass(frozen=True)
class HatchLayer:
    """One layer of hatching, for those who lay strokes as densely as the tone asks instead of from a tile.

    angle: direction of the strokes in degrees, from x towards y (clockwise on paper).
    low, high: the layer begins where the picture's tone exceeds `low`, and has brought it to `high` where it ends.
    pen_pt: width of the strokes, points.
    spacing_pt: the strokes' centre lines are nowhere closer than this, points; 0 for no limit.
    wave_pt, wave_length_pt: how far the strokes wander sideways, as the grain of wood does, and over what length.
    turn: where there is a field of directions, degrees of the strokes from it; None for what angle differs by from that
        of the first layer.
    """

    angle: float
    low: float
    high: float
    pen_pt: float = 0.4
    spacing_pt: float = 0.0
    wave_pt: float = 0.0
    wave_length_pt: float = 0.0
    turn: float | None = None


@dataclass(frozen=True)
class Engraving:
    """Lines that swell: evenly far apart, their width the tone.

    spacing_pt: distance of their middles, points. finest_pt: the least width of a line.
    angle: degrees, clockwise from the right, where lines are straight. along: they run along a field if there is one.
    centre: x and y in parts of the sheet's width and height of the point about which they are rings, None for none.
    waver: how much straight lines waver, 0 not at all, 1 as the grain of wood. blunt: ends do not taper.
    lines: keep so many lines across the sheet's width, whatever its size, instead of the spacing; None for no number.
    crosses: the tone from which on a second set of lines crosses the first, 1 for never.
    """

    spacing_pt: float = 1.46
    finest_pt: float = 0.16
    angle: float = -30.0
    along: bool = True
    centre: tuple[float, float] | None = None
    waver: float = 0.0
    blunt: bool = False
    lines: int | None = None
    crosses: float = 1.0


@dataclass(frozen=True, eq=False)
class Scales:
    """What a texture is on a sheet that is wider or narrower than it was made for: the same wall, seen larger.

    natural_pt: width of the picture in which the tile has its own size. least_pt: no side of the tile is smaller.
    fill: name of the hatching, of its own size always, that brings on the tone that these strokes do not reach.
    strokes, priorities: (s,) those that grow with the picture, their pens not. spans: (s, 2) each is there where the
        picture is from so many to less than so many times as wide as natural.
    fixed: (t,) bool, those of the texture's strokes that do not grow; the others are among these.
    """

    natural_pt: float
    least_pt: float
    fill: str
    strokes: Strokes
    priorities: Floats
    spans: Floats
    fixed: npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Texture:
    """A stroke texture: a tile of prioritized strokes that repeats in x and y.

    strokes: those of one tile in order of priority, lowest (drawn first) first; strokes.width and
        strokes.height are the tile's size in points. A stroke may reach over the tile's border.
    priorities: (s,) ascending.
    whole: strokes are drawn whole or not at all (stipple dots, mortar), never trimmed to a run.
    layers: what the tile is an instance of where that is plain hatching, in the order of drawing.
    engraving: the lines that swell for which the tile stands where only strokes of one width can be drawn.
    oriented: no tile but a set of examples, each with its first point on a line of the field and +x along that.
    scales: how it grows with the picture, None where it does not; strokes are those of the natural size.
    """

    name: str
    strokes: Strokes
    priorities: Floats
    whole: bool = False
    layers: tuple[HatchLayer, ...] = ()
    engraving: Engraving | None = None
    oriented: bool = False
    scales: Scales | None = None


def turned(texture: Texture, degrees: float) -> Texture:
    """The texture with its hatching turned clockwise; a tile without hatching layers is as it was."""
    if not degrees:
        return texture

    def around(angle: float) -> float:
        angle += degrees
        return angle - 360.0 if angle > 180.0 else angle + 360.0 if angle < -180.0 else angle

    layers = tuple(replace(layer, angle=around(layer.angle)) for layer in texture.layers)
    engraving = texture.engraving and replace(texture.engraving, angle=around(texture.engraving.angle))
    return replace(texture, layers=layers, engraving=engraving)


@dataclass(frozen=True)
class OutlineChoice:
    """Which edges of a layer become outline strokes, and how they are drawn.

    pen_pt: width of the strokes, points.
    even: one width from end to end, as a technical pen draws; otherwise a hand's slight swelling.
    min_strength: least mean strength (0 … 1) of a chain; edges without strengths are all taken.
    min_length: least length of a chain, in the edge list's pixels.
    regions: x, y in the edge list's pixels; where there are any, only edges around the regions that hold them.
    """

    pen_pt: float = 0.7
    even: bool = False
    min_strength: float = 0.0
    min_length: float = 0.0
    regions: tuple[tuple[float, float], ...] = ()


@dataclass(frozen=True)
class LineChoice:
    """Which telling lines of a layer are drawn, and how.

    pen_pt: width of the broadest strokes. even: one width from end to end, as a technical pen draws.
    density: points of line in a square point that there is room for. per_inch2: inches of line in a square inch
    that all lines may come to. min_rank: the least rank, None for one that suits the size.
    """

    pen_pt: float = 1.3
    even: bool = False
    density: float = 0.13
    per_inch2: float = 6.0
    min_rank: float | None = None


@dataclass(frozen=True, eq=False)
class Layer:
    """One overlay of an illustration: grey, edges, and the strokes it is to be drawn with.

    samples: fill the illustration's frame, as do those of every layer, whatever their numbers.
    levels: how many grey levels the samples are kept at.
    texture_name: the shipped texture's name, None for a texture of the illustration's own.
    pen_pt: one pen for all hatching, None for the texture's own widths.
    gamma, rule, seed, swell: as `blast` takes them.
    outline: None for no outline strokes.
    directions: what the hatching follows, None where it lies at the texture's angles.
    lines, line: its telling lines, None for none, and how they are drawn.
    color: of its ink, ``#rrggbb``, None for black. Inks of different colours are transparent and know nothing of each
        other: each is drawn as if it had the sheet to itself.
    turn: degrees that `texture` is turned already, and strokes are from the field: several inks' hatching is to cross.
    """

    samples: GreyImage
    edges: EdgeList | None
    texture: Texture
    texture_name: str | None = None
    name: str | None = None
    levels: int = 24
    pen_pt: float | None = None
    gamma: float = 1.0
    rule: str = "best"
    seed: int = 0
    outline: OutlineChoice | None = None
    directions: Directions | None = None
    lines: Lines | None = None
    line: LineChoice = LineChoice()
    swell: float = 0.0
    color: str | None = None
    turn: float = 0.0


@dataclass(frozen=True, eq=False)
class Illustration:
    """The representation itself (section 2): layers, bottom first, on a page of natural size width × height points."""

    width: float
    height: float
    layers: tuple[Layer, ...]
