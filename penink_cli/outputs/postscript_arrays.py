"""Strokes as arrays of whole numbers, and the PostScript procedures that draw them.

Compact, as a drawing is a hundred thousand strokes: coordinates are whole numbers, of 1/20 pt
unless the pen is very fine, and each is relative to the one before. Strokes of one pen and one
kind stand together in arrays of numbers, and a short procedure per kind draws an array:

    {dx dy …}           d    dots
    {dx dy u v …}     k l    straight segments, k a stroke, each u v long
    {dx dy u v p q …} k b    segments that bend: control points at a third and two thirds of
                             the way, p and p + q to the left of it
    {dx dy x1 y1 x2 y2 x3 y3 …} k c   any Bézier segments
    {dx dy w k u v p q dw …} t   strokes that swell: each of k segments that bend, w the width at
                             the beginning and dw what a segment adds, in eighths of a unit

dx dy leads from the last stroke's end to the beginning. The position is kept in whole numbers,
so nothing drifts. The ink of a layer has one colour, so its strokes may be drawn in any order: one
with short ways between them makes short numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from penink_cli.ground.decimals import plain
from penink_cli.ground.exact import length as length_of
from penink_cli.ground.model import Floats, Ints, Strokes
from penink_cli.outputs import swelling, words

#: Brings each run first[g] … first[g + 1] - 1 of strokes into an order with short ways between them.
Order = Callable[[Strokes, Ints], Strokes]

UNITS = 20  # a point: an eighth of a 0.4 pt pen
#: Where a whole number lies in its unit. At 0 both edges of most pens would lie right on those of pixels where the unit
#: is in a simple proportion to them, as it is at 150 to 1200 dpi, and a pixel that is merely met there is not painted:
#: stipple came out .3 % too light. So far inside, such edges gain as much on the average as any others.
MIDDLE = 0.5
CHAIN = 200  # segments; Level 1 interpreters hold 1500 elements in a path
NUMBERS = 400  # in an array
SEGMENT = {"d": 0, "l": 2, "b": 4, "c": 6}  # numbers a segment, by the kind of stroke

# Names of one letter keep the file small. They are in a dictionary of the file's own.
# dx dy e: a new position. dx dy m: the same, and a path begins there. {…} k n a: does `p`, which has been set, with the
# n numbers of each segment of each stroke of k segments.
PROLOG = b"""\
/penink 80 dict def
penink begin
/x 0 def /y 0 def
/w {setlinewidth} bind def
/e {y add /y exch def x add /x exch def} bind def
/m {e x y moveto} bind def
/d {cvlit /A exch def currentflat .2 setflat
 0 2 A length 1 sub {A exch 2 getinterval aload pop m x y lineto stroke} for setflat} bind def
/a {/n exch def n mul 2 add /N exch def cvlit /A exch def
 0 N A length 1 sub {
  A exch N getinterval dup 0 2 getinterval aload pop m
  /S exch def
  2 n N 1 sub {S exch n getinterval aload pop p} for
  stroke
 } for} bind def
/l {/p {2 copy rlineto e} def 2 a} bind def
/c {/p {2 copy 8 2 roll rcurveto e} def 6 a} bind def
/b {/p {
  1 index add /r exch def /s exch def /v exch def /u exch def
  u u mul v v mul add sqrt /L exch def /s s L div def /r r L div def
  u 3 div v s mul sub v 3 div u s mul add
  u 1.5 div v r mul sub v 1.5 div u r mul add
  u v rcurveto u v e} def 4 a} bind def
"""
# Strokes that swell are filled: in one path a shape a segment, between its two sides, and a disc at both ends. Where
# shapes meet they have an edge in common. The sides are those of `swelling`, but at right angles to the curve: from
# x + X, y + Y to x + u + U, y + v + V on the left, and on the right from x + u − U … back. h and Z are the radius at
# both ends, i j and f g a third of the directions there, H and J what the bend takes from the control points' lean.
# x y O: a disc. a b P: a - b, or 0 where that is below 0.
SWELLING = b"""\
/O {h 0 gt {2 copy exch h add exch moveto h 360 0 arcn closepath} {pop pop} ifelse} bind def
/P {sub dup 0 lt {pop 0} if} bind def
/t {cvlit /A exch def /I 0 def {
  I A length ge {exit} if
  A I 4 getinterval aload pop /K exch def 16 div /h exch def e /I I 4 add def
  x y O /X null def
  K {A I 5 getinterval aload pop 16 div /D exch def /q exch def /p exch def /v exch def /u exch def /I I 5 add def
   u u mul v v mul add sqrt /L exch def /s p L div def /r p q add L div def
   /i u 3 div v s mul sub def /j v 3 div u s mul add def
   /f u 3 div v r mul add def /g v 3 div u r mul sub def
   /M u i sub f sub def /N v j sub g sub def
   /S i i mul j j mul add sqrt def /T f f mul g g mul add sqrt def
   X null eq {/X j S div h mul neg def /Y i S div h mul def} if
   /Z h D add def /D D 3 div def
   /U g T div Z mul neg def /V f T div Z mul def
   /H i N mul j M mul sub S div S div S div h mul 1.5 div def
   /J M g mul N f mul sub T div T div T div Z mul 1.5 div def
   /B D j mul S div def /C D i mul S div def /E D g mul T div def /G D f mul T div def
   x X add y Y add moveto
   1 H P dup i mul x add X add B sub exch j mul y add Y add C add
   1 J P dup f mul u U add x add exch sub E add exch g mul v V add y add exch sub G sub
   u U add x add v V add y add curveto
   u U sub x add v V sub y add lineto
   1 J neg P dup f mul u U sub x add exch sub E sub exch g mul v V sub y add exch sub G add
   1 H neg P dup i mul x add X sub B add exch j mul y add Y sub C sub
   x X sub y Y sub curveto closepath
   u v e /X U def /Y V def /h Z def} repeat
  x y O fill} loop} bind def
"""


def units_of(layers: Sequence[Strokes]) -> int:
    """How many units of the arrays go to a point: more than UNITS only for pens so fine that a unit is half of one."""
    finest = min((float(s.widths.min()) for s in layers if len(s)), default=1.0)
    return min(max(UNITS, math.ceil(2 / finest)), 2000)


def written(
    strokes: Strokes, units: int, at: tuple[int, int], order: Order
) -> tuple[list[bytes], tuple[int, int]]:
    """The arrays of one layer, beginning with the pen at ``at``, and where the pen is left, in units."""
    parts: list[bytes] = []
    swells = strokes.swells
    if swells.any():
        numbers, first, at = _swelling(strokes.taken(swells), units, at, order)
        parts += [b"{", bytes(_ragged(numbers, first))]
        strokes = strokes.taken(~swells)
    if len(strokes):
        groups = _groups(_split(replace(strokes, knot_widths=None)), units)
        text, at = _even(replace(groups, strokes=order(groups.strokes, groups.first)), units, at)
        parts += text
    return parts, at


def number(value: float, decimals: int = 3) -> bytes:
    """A number as PostScript has it."""
    return plain(value, decimals).encode("ascii")


def _even(groups: Groups, units: int, at: tuple[int, int]) -> tuple[list[bytes], tuple[int, int]]:
    """The arrays of groups of strokes, the pen set where it changes, and where the last stroke ends, in units.

    There may be a thousand groups of a single stroke, so the numbers of all groups become text in one go.
    """
    strokes, begins, sizes = groups.strokes, groups.first[:-1], np.diff(groups.first)
    same = list(zip(groups.kinds, groups.segments))
    alike: dict[tuple[str, int], list[int]] = {}
    for g, key in enumerate(same):
        alike.setdefault(key, []).append(g)
    place = np.cumsum([0, *np.repeat([2 + k * SEGMENT[kind] for kind, k in same], sizes)])
    numbers, after = np.empty(place[-1], np.int64), np.empty(place[-1], np.int32)
    ends = np.empty((len(place) - 1, 4), np.int64)
    calls: list[bytes] = []
    grid = _Grid(strokes, units, "b" in groups.kinds)
    for (kind, k), which in alike.items():
        count = sizes[which]
        rank = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
        own = np.repeat(begins[which], count) + rank
        rows, ends[own] = grid.rows(kind, k, own)
        at_rows = place[own][:, None] + np.arange(rows.shape[1])
        numbers[at_rows] = rows
        after[at_rows] = _breaks(rank, rows.shape[1], SEGMENT[kind], 2 + len(calls))
        calls.append(b"}d\n{" if kind == "d" else b"}%d %s\n{" % (k, kind.encode()))
    ways = ends[:, :2] - np.vstack([at, ends[:-1, 2:]])
    numbers[place[:-1]], numbers[place[:-1] + 1] = ways[:, 0], ways[:, 1]
    widths = strokes.widths[begins].tolist()
    pens = [b"%s w\n{" % number(width * units) for width in widths]
    names = {key: call.removesuffix(b"{") for key, call in zip(alike, calls)}
    closing = [names[key] for key in same]
    for g in range(len(same) - 1):
        closing[g] += b"{" if widths[g + 1] == widths[g] else pens[g + 1]
    after[place[groups.first[1:]] - 1] = 2 + len(calls) + np.arange(len(same))
    text = words.text(numbers, after, [b" ", b"\n", *calls, *closing])
    return [pens[0], bytes(text)], (int(ends[-1, 2]), int(ends[-1, 3]))


def _breaks(rank: Ints, length: int, step: int, full: int) -> npt.NDArray[np.int32]:
    """The word (s, length) that follows each number of strokes of `length` numbers.

    A line ends after each stroke, or each segment of a long stroke. rank: (s,) the number of each stroke in its group.
    step: numbers a segment. full: the word that follows an array of some 400 numbers.
    """
    after = np.zeros((len(rank), length), np.int32)
    if length > 24:
        after[:, 1::step] = 1
    after[:, -1] = 1 if step else rank % 8 == 7  # eight dots a line
    every = max(1, NUMBERS // length)
    after[rank % every == every - 1, -1] = full
    return after


def _swelling(
    strokes: Strokes, units: int, at: tuple[int, int], order: Order
) -> tuple[Ints, Ints, tuple[int, int]]:
    """The numbers of strokes that swell, where each stroke's numbers begin, and where the last one ends, in units."""

    def writable(points: Floats) -> npt.NDArray[np.bool_]:
        """Whether segments (m, 4, 2) bend so that two numbers tell it, or are too short for it to matter."""
        return (_bends(points * units)[1] < 3) | (length_of(points[:, 3] - points[:, 0]) * units < 8)

    strokes = swelling.pieces(strokes, writable, CHAIN)
    strokes = order(strokes, np.array([0, len(strokes)]))
    segments = np.diff(strokes.first) // 3
    knots = words.whole(strokes.points[_knot_places(strokes)] * (units, -units) - MIDDLE)
    widths = words.whole(strokes.at_knots * (8 * units))
    starts = strokes.knots[:-1]
    ways = np.diff(knots, axis=0, prepend=0)
    kept = (ways != 0).any(axis=1)  # a segment that goes nowhere is left out
    kept[starts] = True
    used_knots = np.flatnonzero(kept)
    owner = np.repeat(np.arange(len(strokes)), segments + 1)[used_knots]
    begins = np.concatenate([[True], owner[1:] != owner[:-1]])
    rows = np.zeros((len(used_knots), 5), np.int64)
    rows[:, :2] = np.diff(knots[used_knots], axis=0, prepend=[at])
    rows[:, 4] = np.diff(widths[used_knots], prepend=0)
    after = used_knots[~begins]
    into = _knot_places(strokes)[after]
    exact = strokes.points[into[:, None] + np.arange(-3, 1)] * (units, -units)
    rows[~begins, 2:4], _ = _bends(exact)
    rows[begins, 2] = widths[used_knots[begins]]
    rows[begins, 3] = np.bincount(owner, minlength=len(strokes)) - 1
    used = np.ones(rows.shape, bool)
    used[begins, 4] = False
    first = np.append(np.cumsum(used.sum(axis=1))[begins] - 4, used.sum())
    x, y = knots[-1].tolist()
    return rows[used], first, (x, y)


def _knot_places(strokes: Strokes) -> Ints:
    """The place of each knot among the points, (n,)."""
    segments = np.diff(strokes.first) // 3
    return np.repeat(strokes.first[:-1] - 3 * strokes.knots[:-1], segments + 1) + 3 * np.arange(strokes.knots[-1])


def _ragged(numbers: Ints, first: Ints) -> memoryview:
    """Numbers of strokes as arrays of some 400, a line ending after every stroke or 50 numbers."""
    after = np.zeros(len(numbers), np.int32)
    after[np.arange(49, len(numbers), 50)] = 1
    after[first[1:] - 1] = 1
    full = np.diff(first[1:] // NUMBERS, append=-1) != 0
    after[(first[1:] - 1)[full]] = 2
    after[-1] = 3
    return words.text(numbers, after, [b" ", b"\n", b"}t\n{", b"}t\n"])


@dataclass(frozen=True, eq=False)
class Groups:
    """Strokes in groups of one pen, one kind and one number of segments.

    first: (g + 1,) where each group begins among the strokes. kinds, segments: of each group; see `SEGMENT`.
    """

    strokes: Strokes
    first: Ints
    kinds: list[str]
    segments: list[int]


def _groups(strokes: Strokes, units: int) -> Groups:
    """The strokes, at least one, sorted into groups."""
    counts = np.diff(strokes.first)
    segments = (counts - 1) // 3
    owner = np.repeat(np.arange(len(strokes)), segments)
    _, kinds = _bends(strokes.points[_segments(strokes)[:, None] + np.arange(4)] * units)
    kind = np.zeros(len(strokes), np.int64)
    np.maximum.at(kind, owner, kinds)
    _, pen = np.unique(strokes.widths, return_inverse=True)
    key = (pen * len(SEGMENT) + kind) * (int(segments.max(initial=0)) + 1) + segments
    by_key = np.argsort(key, kind="stable")
    begin = np.flatnonzero(np.diff(key[by_key], prepend=-1))
    names = [list(SEGMENT)[i] for i in kind[by_key[begin]].tolist()]
    return Groups(strokes.taken(by_key), np.append(begin, len(strokes)), names, segments[by_key[begin]].tolist())


class _Grid:
    """Strokes in units, y up. exact: their points (p, 2); grid: these in whole numbers; bends: p and q of segments."""

    def __init__(self, strokes: Strokes, units: int, bent: bool):
        self.first = strokes.first
        self.exact = strokes.points * (units, -units)
        self.grid = words.whole(self.exact - MIDDLE)
        self.bends = np.zeros((0, 2), np.int64)
        if bent:
            self.bends, _ = _bends(self.exact[_segments(strokes)[:, None] + np.arange(4)])

    def rows(self, kind: str, k: int, own: Ints) -> tuple[Ints, Ints]:
        """The numbers of strokes `own` (s,) of k segments, a row each, and x, y of both ends of each (s, 4).

        The first two columns, the way to the stroke, are left empty.
        """
        first = self.first[own]
        knots = self.grid[first[:, None] + 3 * np.arange(k + 1)]
        rows = np.zeros((len(own), 2 + k * SEGMENT[kind]), np.int64)
        numbers = rows[:, 2:].reshape(len(own), k, SEGMENT[kind])  # a copy, as the two columns lie between
        if kind == "c":
            inner = first[:, None, None] + (3 * np.arange(k)[:, None] + np.arange(1, 4))
            numbers = (self.grid[inner] - knots[:, :-1, None]).reshape(len(own), k, 6)
        elif k:
            numbers[:, :, :2] = np.diff(knots, axis=1)
        if kind == "b":
            numbers[:, :, 2:] = self.bends[((first - own) // 3)[:, None] + np.arange(k)]
        rows[:, 2:] = numbers.reshape(len(own), -1)
        return rows, np.hstack([knots[:, 0], knots[:, -1]])


def _segments(strokes: Strokes) -> Ints:
    """The place among the points at which each segment of all strokes begins."""
    counts = np.diff(strokes.first) // 3
    first = np.repeat(strokes.first[:-1] - 3 * (np.cumsum(counts) - counts), counts)
    return np.asarray(first + 3 * np.arange(len(first)))


def _bends(segments: Floats) -> tuple[Ints, Ints]:
    """Of segments (s, 4, 2) in units: how far the inner control points lie to the left of the chord, as p and q (s, 2),
    and the kind (s,).

    Kind 1 is straight, kind 2 bends. Kind 3 is any other: sliding the control points along the chord to a third and two
    thirds would move the ink by more than a unit.
    """
    chord = segments[:, 3] - segments[:, 0]
    length = length_of(chord)
    safe = np.where(length > 0, length, 1.0)
    along, left = np.empty((2, len(segments))), np.empty((2, len(segments)))
    for i, third in enumerate((1 / 3, 2 / 3)):
        control = segments[:, 1 + i] - segments[:, 0]
        along[i] = np.abs((control * chord).sum(axis=1) / safe - third * length)
        left[i] = (chord[:, 0] * control[:, 1] - chord[:, 1] * control[:, 0]) / safe
    slide = along.max(axis=0)
    slope = 3 * np.maximum(np.abs(left).max(axis=0), np.abs(left[1] - left[0])) / safe
    whole = words.whole(left)
    usual = (slide <= length / 4) & (slide * slope <= 1.0) & (length >= 2)
    kinds: npt.NDArray[np.int64] = np.where(usual, np.where((whole == 0).all(axis=0), 1, 2), 3)
    return np.stack([whole[0], whole[1] - whole[0]], axis=1), kinds


def _split(strokes: Strokes) -> Strokes:
    """The strokes with those of more than CHAIN segments in pieces, which round caps join invisibly."""
    counts = np.diff(strokes.first)
    if counts.max(initial=0) <= 3 * CHAIN + 1:
        return strokes
    pieces = np.maximum(1, -(-(counts - 1) // (3 * CHAIN)))
    which = np.repeat(np.arange(len(counts)), pieces)
    begin = strokes.first[which] + 3 * CHAIN * (np.arange(len(which)) - np.repeat(np.cumsum(pieces) - pieces, pieces))
    size = np.minimum(strokes.first[which + 1] - begin, 3 * CHAIN + 1)
    first = np.concatenate([[0], np.cumsum(size)])
    at = np.repeat(begin - first[:-1], size) + np.arange(first[-1])
    return replace(strokes, points=strokes.points[at], first=first, widths=strokes.widths[which])
