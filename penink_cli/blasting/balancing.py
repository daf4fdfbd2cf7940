"""Plates of several inks, drawn so that together they print the right colours.

Every plate is hatched for itself, and what each is wrong by adds up in the print, together with what their strokes do
to one another: where those of two inks happen to lie beside each other more light goes than where they cross. So the
print is looked at as a whole, as the eye sees it, and held against what it would be if each plate had just its tone.
By what it is off the tones are corrected, and the plates drawn anew; then each stroke is pressed a little more or less.
To first order a colour there, in CIE Lab, is the sum of what each stroke near it does. The changes of width that come
nearest to what is wanted, by least squares, are found by conjugate gradients; the print is looked at anew, and all is
done again. There are some twenty strokes to each place that the eye can tell from its neighbours, so small changes do.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from penink_cli.blasting import curves
from penink_cli.blasting.frame_ends import drawn_on
from penink_cli.blasting.sheet import EYE_PT, Cells, coverage, resample
from penink_cli.composition import separation
from penink_cli.composition.filters import Picture, blurred, enlarged, shrunk
from penink_cli.ground import device, threads
from penink_cli.ground.codes import Colour
from penink_cli.ground.colour import lab_of_light, linear
from penink_cli.ground.model import Floats, Ints, Strokes

#: Sides of the cells that the print is made of, and of those that are held against what is wanted.
PRINT_PT, PLACE_PT = 0.24, 1.5
#: How far strokes are widened or narrowed in all, in parts of their width; few are by so much.
PRESSURE = 0.4
#: How often the print is looked at, and the steps of the conjugate gradients each time.
ROUNDS, STEPS = 12, 20
#: How far strokes go to where they would be right if the print were linear: a part of the way, in each place more after
#: a round that left the colour off to the same side, and less after one that went too far.
PACE, FASTER, SLOWER = 0.6, 1.2, 0.6
#: The price of changing a stroke's width by all of it, as differences of colour summed over places.
PRICE = 2.0
#: What is off by more counts by its size, and by less by its square: of a place that no pressing mends, such as a dark
#: thing's border where no stroke lies, not much is to be made.
FLOOR = 0.25
#: Widening by so much tells what the strokes do, which lie over one another in the dark; more than MOST is noise.
PROBE, MOST = 0.1, 1.5
#: How hard it is to change a plate's tone: what is off by less than the root of it, in Lab, is mended in part.
CAUTION = 30.0
#: And no tone is changed by more than this: what is left white on purpose, as light lines are, darkens its surroundings
#: no further.
MOST_CHANGED = 0.1
SAMPLE_PT = 2.0
LEAST_PT = 0.01


@dataclass(frozen=True, eq=False)
class Plate:
    """What one ink draws.

    strokes: which are pressed. ink: its colour on white. tone: (h, w) how much of the paper it is to cover, of
    all plates one shape, what lies there included. there: other strokes of this ink, which stay as they
    are, such as outlines. left: (rows, columns) the tone less what it leaves white on purpose, as light lines, for
    which nothing is to make up; None where that is nothing.
    """

    strokes: Strokes
    ink: Colour
    tone: Floats
    there: Strokes | None = None
    left: Floats | None = None

    @property
    def wanted(self) -> Floats:
        """What the print is to have of it."""
        return self.tone if self.left is None else self.left


def balanced(
    plates: Sequence[Plate], device_dpi: float | None = None, workers: int = 1,
    tick: Callable[[], None] = lambda: None,
) -> list[Strokes]:  # fmt: skip
    """The strokes of each plate, of one sheet all, pressed so that the print has the colours of the plates' tones.

    device_dpi: of the printer that paints every dot that a stroke touches. workers: threads; the result is the same
    for any number. tick: called in each of `ROUNDS` rounds.
    """
    press = _Press(plates, device_dpi, workers)
    factors = [np.zeros(handles.count) for handles in press.handles]
    drawn = [plate.strokes for plate in plates]
    covers = press.covers(drawn)
    best: tuple[int, list[Strokes]] | None = None
    pace = np.full(press.rows * press.columns, PACE)
    before: Floats | None = None
    for turn in range(ROUNDS + 1):
        off, slopes = press.seen(covers)
        wrong = int(np.rint(np.sqrt(_squares(off)) * 1024.0).astype(np.int64).sum())
        if best is None or wrong < best[0]:
            best = wrong, drawn
        if turn == ROUNDS:
            break
        if before is not None:
            same = before[:, 0] * off[:, 0] + before[:, 1] * off[:, 1] + before[:, 2] * off[:, 2] >= 0
            pace = np.where(same, np.minimum(pace * FASTER, 1.0), pace * SLOWER)
        before = off
        wanted = press.solved(off, slopes, press.gains(covers, factors), factors)
        factors = [
            np.clip(factor + handles.mean(pace) * (aim - factor), -PRESSURE, PRESSURE)
            for factor, aim, handles in zip(factors, wanted, press.handles, strict=True)
        ]
        drawn = [
            pressed(plate.strokes, handles, factor)
            for plate, handles, factor in zip(plates, press.handles, factors, strict=True)
        ]
        covers = press.covers(drawn)
        tick()
    assert best is not None
    return best[1]


def corrected(plates: Sequence[Plate], device_dpi: float | None = None, workers: int = 1) -> list[Floats]:
    """The tones (h, w) that plates are to be drawn anew with: what the print is off by is made up for by all of them.

    Of all changes that do so the smallest, in the plates together; in few places a plate is so solid, or so bare, that
    the others must do more.
    """
    press = _Press(plates, device_dpi, workers)
    off, slopes = press.seen(press.covers([plate.strokes for plate in plates]))
    shares = _least_change(off, slopes)
    result = []
    for plate, share in zip(plates, shares, strict=True):
        change = resample(share.reshape(press.rows, press.columns), *plate.tone.shape)
        tone = plate.tone + np.clip(change, -MOST_CHANGED, MOST_CHANGED)
        result.append(np.asarray(np.clip(tone, 0.0, 1.0)))
    return result


def _least_change(off: Floats, slopes: list[Floats]) -> list[Floats]:
    """The smallest change of each amount (m,) that takes away what Lab (m, 3) is off, or most of it.

    That is -Sᵀ (S Sᵀ + c I)⁻¹ off, S the slopes; the matrix of three by three is turned by Cramer's rule.
    """
    rows = [[np.full(len(off), CAUTION if i == j else 0.0) for j in range(3)] for i in range(3)]
    for slope in slopes:
        for i in range(3):
            for j in range(3):
                rows[i][j] = rows[i][j] + slope[:, i] * slope[:, j]
    (a, b, c), (_, d, e), (_, _, f) = rows
    inverse = [[d * f - e * e, c * e - b * f, b * e - c * d], [None, a * f - c * c, b * c - a * e],
               [None, None, a * d - b * b]]  # fmt: skip
    whole = a * inverse[0][0] + b * inverse[0][1] + c * inverse[0][2]
    turned = []
    for i in range(3):
        parts = [inverse[min(i, j)][max(i, j)] * off[:, j] for j in range(3)]
        turned.append((parts[0] + parts[1] + parts[2]) / whole)
    return [-(s[:, 0] * turned[0] + s[:, 1] * turned[1] + s[:, 2] * turned[2]) for s in slopes]


@dataclass(frozen=True, eq=False)
class Handles:
    """Where the widths of strokes can be changed: at each knot of those that swell, once for each of the others.

    count: how many there are. of_knot: (n,) the handle of each knot of all strokes. cell, handle: (p,) in which place a
    piece of a stroke lies and which handle widens it; ink: (p,) how much of the place it covers, if nothing else did.
    """

    count: int
    of_knot: Ints
    cell: Ints
    handle: Ints
    ink: Floats

    def mean(self, places: Floats) -> Floats:
        """Of a value of places (m,) the mean over what each handle (count,) widens."""
        whole = np.bincount(self.handle, self.ink, self.count)
        return np.asarray(np.bincount(self.handle, self.ink * places[self.cell], self.count) / np.maximum(whole, 1e-12))


def pressed(strokes: Strokes, handles: Handles, factor: Floats) -> Strokes:
    """The strokes, wider by that part (count,) of their width, drawn on to the frame."""
    knots = np.maximum(np.round(strokes.at_knots * (1.0 + factor[handles.of_knot]), 2), LEAST_PT)
    if strokes.knot_widths is not None:
        return drawn_on(strokes.swelling(knots))
    return drawn_on(replace(strokes, widths=knots[strokes.knots[:-1]]))


def _handles(strokes: Strokes, rows: int, columns: int) -> Handles:
    """The handles of strokes on a sheet of that many places."""
    knots, swells = strokes.knots, strokes.swells
    per_knot = np.repeat(swells, np.diff(knots))
    first = np.zeros(len(per_knot), bool)
    first[knots[:-1]] = True
    of_knot = np.cumsum(per_knot | first) - 1
    pieces = curves.pieces_of(strokes.points, strokes.first, SAMPLE_PT)
    lines = curves.sample(strokes.points, strokes.first, pieces)
    # the knot before each sample, and how far it is from there to the next
    counts = np.diff(lines.first)
    segment = np.repeat(np.arange(len(pieces)), pieces)
    inner = np.ones(len(lines.points), bool)
    inner[lines.first[1:] - 1] = False  # the last of each stroke: that of a dot too
    before = np.repeat(knots[1:] - 1, counts)
    share = np.zeros(len(before))
    before[inner] = segment + np.repeat(np.arange(len(strokes)), curves.segments_of(strokes.first))[segment]
    share[inner] = curves.ramp(pieces) / pieces[segment]
    after = np.minimum(before + 1, max(len(per_knot) - 1, 0))
    width = strokes.at_knots[before] * (1.0 - share) + strokes.at_knots[after] * share
    legs = np.diff(lines.points, axis=0)
    legs = np.sqrt(legs[:, 0] * legs[:, 0] + legs[:, 1] * legs[:, 1]) * inner[:-1] / 2
    length = np.where(np.repeat(counts == 1, counts), width, 0.0)  # a dot, more or less
    length[:-1] += legs
    length[1:] += legs
    scale = columns / strokes.width, rows / strokes.height
    x = np.clip((lines.points[:, 0] * scale[0]).astype(np.int64), 0, columns - 1)
    y = np.clip((lines.points[:, 1] * scale[1]).astype(np.int64), 0, rows - 1)
    ink = length * width * (scale[0] * scale[1])
    return Handles(
        int(of_knot[-1]) + 1 if len(of_knot) else 0, of_knot, np.tile(y * columns + x, 2),
        np.concatenate([of_knot[before], of_knot[after]]), np.concatenate([ink * (1.0 - share), ink * share]),
    )  # fmt: skip


class _Press:
    """The plates on one sheet: what they print, and what pressing their strokes does to that.

    Places are (rows, columns) of the sheet, flat; the eye sees each together with those around it.
    """

    def __init__(self, plates: Sequence[Plate], device_dpi: float | None, workers: int):
        self.plates, self.device_dpi, self.workers = plates, device_dpi, workers
        sheet = plates[0].strokes
        self.rows, self.columns = (max(1, round(side / PLACE_PT)) for side in (sheet.height, sheet.width))
        self.fine = tuple(max(1, round(side / PRINT_PT)) for side in (sheet.height, sheet.width))
        self.passed = np.maximum(linear(np.array([plate.ink for plate in plates])), separation.LEAST)
        self.handles = [_handles(plate.strokes, self.rows, self.columns) for plate in plates]
        # at their own size: what is finer than strokes still tells how far dark of one lies on dark of another
        self.wanted = lab_of_light(self._light([plate.wanted.astype(np.float32) for plate in plates]))
        self.scale = _discernible(self.wanted)

    def covers(self, drawn: Sequence[Strokes]) -> list[Cells]:
        """How much of each fine cell the plates cover."""
        tasks = (
            lambda strokes=strokes, plate=plate: self._cover(strokes, plate)
            for strokes, plate in zip(drawn, self.plates, strict=True)
        )
        return list(threads.in_order(tasks, self.workers))

    def _cover(self, strokes: Strokes, plate: Plate) -> Cells:
        whole = Strokes.joined([plate.there, strokes]) if plate.there is not None else strokes
        return coverage(device.widened(whole, self.device_dpi) if self.device_dpi else whole, *self.fine)

    def seen(self, covers: Sequence[Cells]) -> tuple[Floats, list[Floats]]:
        """By how much Lab (m, 3) is off, and what it changes by with the tone of each plate."""
        light = self._light(covers)
        amounts = np.stack([self._low(cover).ravel() for cover in covers]).astype(np.float64)
        slopes = separation.slopes(np.clip(amounts, 0.0, 1.0), self.passed)
        off = (lab_of_light(light) - self.wanted) * self.scale
        return off, [slope * self.scale for slope in slopes]

    def gains(self, covers: Sequence[Cells], factors: Sequence[Floats]) -> list[Floats]:
        """How much of what strokes that are pressed so are widened by (m,) is ink where there was none."""
        wider = [
            pressed(plate.strokes, handles, factor + PROBE)
            for plate, handles, factor in zip(self.plates, self.handles, factors, strict=True)
        ]
        result = []
        for cover, more, handles in zip(covers, self.covers(wider), self.handles, strict=True):
            gained = self._low(more - cover) * np.float32(1 / PROBE)
            could = self._eye(self._laid(handles, handles.ink))
            result.append(np.clip((gained.ravel() + 1e-4) / (could + 1e-4), 0.0, MOST))
        return result

    def solved(
        self, off: Floats, slopes: list[Floats], gains: list[Floats], factors: list[Floats]
    ) -> list[Floats]:
        """By which part each handle of each plate is to be widened so that what is off is least; factors: as it is."""
        weight = (1.0 / np.sqrt(FLOOR * FLOOR + _squares(off)))[:, None]
        ink = [handles.ink * gain[handles.cell] for handles, gain in zip(self.handles, gains, strict=True)]
        ends = np.cumsum([handles.count for handles in self.handles])

        def done(change: Floats) -> Floats:
            """What Lab (m, 3) changes by."""
            total = np.zeros_like(off)
            parts = np.split(change, ends[:-1])
            for handles, part, own, slope in zip(self.handles, parts, ink, slopes, strict=True):
                laid = self._laid(handles, own * part[handles.handle])
                total += self._eye(laid)[:, None] * slope
            return total

        def back(colours: Floats) -> Floats:
            """The same the other way round: how much each handle has to do with colours (m, 3)."""
            found = []
            for handles, own, slope in zip(self.handles, ink, slopes, strict=True):
                both = slope * colours * weight
                near = self._eye(both[:, 0] + both[:, 1] + both[:, 2])
                found.append(np.bincount(handles.handle, own * near[handles.cell], handles.count))
            return np.concatenate(found)

        before = np.concatenate(factors)
        found = least_squares(done, back, done(before) - off, PRICE, STEPS, before)
        return np.split(found, ends[:-1])

    def _laid(self, handles: Handles, ink: Floats) -> Floats:
        """The ink (p,) of pieces of strokes by places (m,)."""
        return np.asarray(np.bincount(handles.cell, ink, self.rows * self.columns), np.float64)

    def _light(self, covers: Sequence[Cells]) -> Floats:
        """The light (m, 3) of what the plates cover, as the eye sees it."""
        light: list[Picture] = [np.ones(covers[0].shape, np.float32) for _ in range(3)]
        for cover, passed in zip(covers, self.passed.astype(np.float32), strict=True):
            for channel in range(3):
                light[channel] *= 1 - cover * (1 - passed[channel])
        return np.stack([self._low(one).ravel() for one in light], axis=-1).astype(np.float64)

    def _low(self, fine: Picture) -> Picture:
        """Fine cells as the eye sees them, by places."""
        if self.rows <= fine.shape[0] and self.columns <= fine.shape[1]:
            places = shrunk(fine, self.columns, self.rows, threads=self.workers)
        else:
            places = enlarged(fine, self.columns, self.rows, self.workers)
        return blurred(places, EYE_PT / PLACE_PT, self.workers)

    def _eye(self, places: Floats) -> Floats:
        """Places (m,), each together with those around it."""
        picture = places.reshape(self.rows, self.columns).astype(np.float32)
        return blurred(picture, EYE_PT / PLACE_PT, self.workers).ravel().astype(np.float64)


def _discernible(lab: Floats) -> Floats:
    """What differences of L, a and b (m, 3) count near colours: less in what is light, dark or gaudy (CIEDE2000, 2001,
    its hue and chroma taken together).
    """
    middle = (lab[:, 0] - 50.0) * (lab[:, 0] - 50.0)
    lightness = 1.0 + 0.015 * middle / np.sqrt(20.0 + middle)
    chroma = 1.0 + 0.03 * np.sqrt(lab[:, 1] * lab[:, 1] + lab[:, 2] * lab[:, 2])
    return 1.0 / np.stack([lightness, chroma, chroma], axis=-1)


def _squares(colours: Floats) -> Floats:
    """Squared lengths (m,) of (m, 3)."""
    return np.asarray(colours[:, 0] * colours[:, 0] + colours[:, 1] * colours[:, 1] + colours[:, 2] * colours[:, 2])


def least_squares(
    done: Callable[[Floats], Floats], back: Callable[[Floats], Floats], wanted: Floats, price: float, steps: int,
    begin: Floats,
) -> Floats:  # fmt: skip
    """The x (n,) for which |done(x) - wanted|² + price |x|² is least, or near it after so many steps.

    done: linear; back: its transpose. begin: where it is looked for. By conjugate gradients (Hestenes and Stiefel,
    1952).
    """
    x = begin
    rest = back(wanted - done(x)) - price * x
    along = rest
    size = dot(rest, rest)
    for _ in range(steps):
        if size <= 0.0:
            break
        changed = back(done(along)) + price * along
        length = size / dot(along, changed)
        x = x + length * along
        rest = rest - length * changed
        before, size = size, dot(rest, rest)
        along = rest + (size / before) * along
    return x


def dot(a: Floats, b: Floats) -> float:
    """The inner product of a and b (n,), by whole numbers: the order of the sum is not the same on every machine."""
    products = a * b
    largest = float(np.abs(products).max(initial=0.0))
    if largest == 0.0:
        return 0.0
    bits = 40 - math.frexp(largest)[1]
    return math.ldexp(int(np.rint(np.ldexp(products, bits)).astype(np.int64).sum()), -bits)
