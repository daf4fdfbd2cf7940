"""Engraving: one layer of lines as far apart everywhere, whose width is the tone.

`tracks` says where lines run. The width of a line is its distance from the next times the tone, less what the device
adds. Where that would be less than the finest line, the line is broken into dashes. Where hardly any white would be
left between two, they close. So tone goes on evenly from paper to black. The lines of one round are inked on the sheet.
What is wrong there, as the eye sees it, is added to the tone that the next round's widths are made for.

Lines end at strong edges, and free ends taper to a point.

What a plate cut by hand has and this has not: a burin's line swells within a stroke's length for the form's sake, not
for the tone alone; flesh, cloth and metal have their own spacing, and a second set crosses where the cutter wants a
texture, with dots or flicks in its lozenges; lines of a dark are cut in two, a broad one and a hair line between; and
where two fields of lines meet the cutter leaves no wedge, for he sets the new line at the last one's shoulder.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import curves, polylines, tracks, walls
from penink_cli.blasting.low_pass import LowPass
from penink_cli.blasting.sheet import CELL_PT, EYE_PT, Cells, Sheet, halve, look_up
from penink_cli.blasting.taking_turns import LEVELS
from penink_cli.blasting.tracks import CLOSED, FRAME_PEN_PT, Tracks
from penink_cli.ground.angles import direction
from penink_cli.ground.model import EdgeList, Engraving, Floats, Ints, Strokes

#: Rounds of inking and correcting, and how much of the error a round corrects.
ROUNDS, CORRECTION = 6, 0.7
#: As far as the tone that is drawn may be from any that there is.
REACH = (-0.3, 1.3)
#: Tone from which on lines close up.
MOST = 0.97
#: The length of a dash and of a gap; the shortest and the longest stretch of line that holds one of each, which have
#: precedence; the least gap; the tone below which there are no dashes.
DASH_PT, GAP_PT, PERIOD_PT, LONGEST_PERIOD_PT, LEAST_GAP_PT, LEAST_TONE = 3.0, 5.0, 12.0, 40.0, 0.7, 0.004
#: Whether a line breaks up is decided by the mean over so many samples each way; not where it is so many times as dark.
CALM, SURELY = 5, 1.6
#: Samples whose widths are made at once.
CHUNK = 1 << 16
#: Knots are about so far apart, points; lines are sampled this many times as finely.
KNOT_PT = 2.0
#: Free ends taper to this width over so many points, or over a share of a short stroke. From the last of these on, in
#: parts of the lines' distance, wider strokes taper less: among dark lines a point leaves a speck of white.
TIP_PT, TAPER_PT, TAPER_SHARE, BLUNT = 0.05, 6.0, 0.4, 0.25
#: Where a line goes on after a gap, points are no longer than so many times the gap.
TAPER_GAP = 1.2
#: A second set of lines is turned so far from the first.
CROSS_ANGLE = 55.0


def engrave(
    sheet: Sheet,
    engraving: Engraving,
    edges: EdgeList | None,
    seed: int,
    field: tuple[Cells, Cells] | None,
    tick: Callable[[], None] = lambda: None,
    drawn: npt.NDArray[np.bool_] | None = None,
) -> Strokes:
    """Strokes that swell and give the sheet its tone, together with the ink that is there already.

    field: cosine and sine of twice the angle of the lines in each cell of the sheet; without, and where the engraving
    does not follow it, lines are straight, wavering or rings. drawn: (rows, columns) where small dark things are that
    are drawn already: a line that swelled for one would taper off beside it.
    """
    spacing = engraving.spacing_pt
    if engraving.lines:
        spacing = sheet.width / engraving.lines
    borders = walls.build(edges, sheet, FRAME_PEN_PT)
    sets = [tracks.laid(sheet, engraving, spacing, borders, seed, field)]
    if engraving.crosses < 1:
        c, s = (np.float32(part) for part in direction(2 * CROSS_ANGLE))
        across = None if field is None else (field[0] * c - field[1] * s, field[1] * c + field[0] * s)
        second = replace(engraving, angle=engraving.angle + CROSS_ANGLE, centre=None)
        sets.append(tracks.laid(sheet, second, spacing, borders, seed + 1, across, rim=False))
    wanted = sheet.tone.astype(np.float64)
    if drawn is not None:
        wanted[drawn] = 0.0
    # an engraver's lines go on across steps of tone, and so does what the eye sees of them
    eye = LowPass(EYE_PT / CELL_PT / 2, halve(sheet.tone), 2.0, sheet.threads)
    seen = eye(np.ones_like(halve(sheet.tone)))
    rng = np.random.default_rng([seed, 21])
    begin = [rng.random(len(some.step)) for some in sets]
    best: tuple[float, Strokes] | None = None
    for turn in range(ROUNDS):
        tick()
        strokes = Strokes.joined(
            [
                strokes
                for some, part, at in zip(sets, _parts(wanted, engraving.crosses), begin)
                for strokes in _drawn(sheet, engraving, spacing, some, part, at)
            ]
        )
        sheet.clear()
        sheet.swell(strokes)
        missing = sheet.tone - sheet.ink
        error = eye(halve(missing)) / seen
        size = float(np.mean(np.square(error, dtype=np.float64)))
        if best is None or size < best[0]:
            best = size, strokes
        if turn < ROUNDS - 1:
            wanted = wanted + CORRECTION * sheet.spread(error).astype(np.float64)
            wanted = np.clip(wanted, *REACH)
    assert best is not None
    return best[1]


def _parts(tone: Floats, crosses: float) -> list[Floats]:
    """What each set of lines covers (rows, columns): above the tone from which on they cross, both grow."""
    first = np.where(tone > crosses, crosses + (tone - crosses) / 2, tone)
    return [first, np.where(tone > crosses, 1 - (1 - tone) / np.maximum(1 - first, 1e-3), 0.0)]


def _drawn(
    sheet: Sheet, engraving: Engraving, spacing: float, lines: Tracks, wanted: Floats, begin: Floats
) -> list[Strokes]:
    """`_strokes` of so many tracks at once as keeps the memory small, on threads."""
    cuts = np.searchsorted(lines.first, np.arange(CHUNK, int(lines.first[-1]), CHUNK)).tolist()
    cuts = sorted({0, *cuts, len(lines.step)})
    out = [Strokes(sheet.width, sheet.height)] * (len(cuts) - 1)

    def draw(i: int) -> None:
        low, high = cuts[i : i + 2]
        out[i] = _strokes(sheet, engraving, spacing, lines.some(low, high), wanted, begin[low:high])

    sheet.each(draw, range(len(out)))
    return out


def _strokes(
    sheet: Sheet, engraving: Engraving, spacing: float, lines: Tracks, wanted: Floats, begin: Floats
) -> Strokes:
    """The strokes that the tone wanted (rows, columns) asks for along the lines, whose dashes begin at begin (n,)."""
    which = np.repeat(np.arange(len(lines.step)), np.diff(lines.first))
    tone = look_up(wanted, lines.asked, sheet.width, sheet.height)
    tone = polylines.smoothed(tone, lines.first)
    finest = (engraving.finest_pt + lines.across) / lines.apart
    width = np.clip(tone, finest, MOST) * lines.apart - lines.across
    # and on, from where white hardly shows, until none is left
    width = width + np.clip((tone - MOST) / (1 - MOST), 0.0, 1.0) * (CLOSED * lines.apart - width)
    width = polylines.smoothed(width, lines.first)
    duty, saw = _dashes(engraving, lines, which, tone, finest, begin)
    full, low, high = lines.rim[which].T
    rim = full > 0
    dark = np.clip((tone - low) / np.where(rim, high - low, 1.0), 0.0, 1.0)
    room = np.minimum(lines.points, (sheet.width, sheet.height) - lines.points).min(axis=1)
    duty = np.where(rim, np.where(dark > 0.05, 1.0, 0.0), duty)
    width = np.where(rim, full * dark, width)
    width = np.minimum(width, np.maximum(np.minimum(2 * room - 0.1, lines.room), TIP_PT))
    return _runs(sheet, engraving, spacing, lines, which, duty, saw, width)


def _dashes(
    engraving: Engraving, lines: Tracks, which: Ints, tone: Floats, finest: Floats, begin: Floats
) -> tuple[Floats, Floats]:
    """What part (p,) of the line is drawn, where the finest line would be darker than the tone (p,); and the saw.

    Of two neighbours one goes on while the other breaks up and leaves off, of those that are left one, and so on. A
    line is drawn where its saw is below its part; that allows for what dashes lose by their pointed ends.
    """
    share = polylines.mean_along(tone / finest, lines.first, CALM)
    # of the first that leave off each makes half of the tone, of the next a quarter …
    halved = np.array([1 << LEVELS, *(1 << k for k in range(1, LEVELS + 1))], np.float64)[lines.level]
    share = np.clip(share * halved - (lines.level > 0), 0.0, 1.0)
    period = np.maximum(DASH_PT / np.maximum(share, 1e-3), GAP_PT / np.maximum(1 - share, 1e-3))
    period = np.clip(period, PERIOD_PT, LONGEST_PERIOD_PT)
    duty = share
    if not engraving.blunt:
        lost = (engraving.finest_pt - min(TIP_PT, engraving.finest_pt)) / (engraving.finest_pt + lines.across)
        gap = period * (1 - share) / (1 + TAPER_GAP * lost)
        taper = np.minimum(np.minimum(TAPER_PT, TAPER_GAP * gap), TAPER_SHARE * period * share)
        duty = share + lost * taper / period
    duty = np.where((1 - duty) * period < LEAST_GAP_PT, 1.0, duty)
    duty = np.where(tone >= SURELY * finest, 1.0, np.where(tone > LEAST_TONE, duty, 0.0))
    return duty, _saw(lines, which, period, begin)


def _saw(lines: Tracks, which: Ints, period: Floats, begin: Floats) -> Floats:
    """(p,) 0 … 1 along the lines, over and over, once in each period (p,), points."""
    turns = np.cumsum(lines.step[which] / period)
    turns = turns - turns[lines.first[:-1]][which] + begin[which]
    return turns - np.floor(turns)


def _between(saw: Floats, duty: Floats, at: Ints) -> Floats:
    """How far from samples `at` to the next a line begins or leaves off, 0 … 1."""
    before, after = saw[at], saw[at + 1]
    less, more = np.abs(before - duty[at]), np.abs(after - duty[at + 1])
    wrapped = after < before
    less, more = np.where(wrapped, 1 - before, less), np.where(wrapped, after, more)
    return np.asarray(less / np.maximum(less + more, 1e-9), np.float64)


def _runs(
    sheet: Sheet, engraving: Engraving, spacing: float, lines: Tracks, which: Ints, duty: Floats, saw: Floats,
    width: Floats,
) -> Strokes:  # fmt: skip
    """Strokes of the runs of samples that are drawn, a knot every `KNOT_PT` or so, their free ends tapered."""
    drawn = (saw < duty) & (duty > 0)
    key = np.concatenate([[-1], np.where(drawn, which, -1), [-1]])
    change = np.flatnonzero(key[1:] != key[:-1])
    low = change[key[change + 1] >= 0]
    if not len(low):
        return Strokes(sheet.width, sheet.height)
    high = change[np.searchsorted(change, low) + 1] - 1
    track = which[low]
    begin, end = lines.first[track], lines.first[track + 1] - 1
    # on to where the saw is as high as the part to be drawn, within the track
    a = low - np.where(low > begin, 1 - _between(saw, duty, np.maximum(low - 1, begin)), 0.0) - begin
    b = high + np.where(high < end, _between(saw, duty, np.minimum(high, end - 1)), 0.0) - begin
    gap = np.full(len(low) + 1, np.inf)  # before each run
    gap[1:-1] = np.where(track[1:] == track[:-1], (a[1:] - b[:-1]) * lines.step[track[1:]], np.inf)
    length = (b - a) * lines.step[track]
    segments = np.maximum(np.where(length > 1.5, 2, 1), np.rint(length / KNOT_PT)).astype(np.int64)
    first = curves.starts(segments + 1)
    run = np.repeat(np.arange(len(low)), segments + 1)
    part = curves.ramp(segments + 1) / segments[run]
    at = a[run] + (b - a)[run] * part
    origin, last = begin[run], end[run]
    knots = polylines.between(lines.points, origin, at, last)
    widths = polylines.between(width[:, None], origin, at, last)[:, 0]
    if not engraving.blunt:
        free = np.column_stack([(low > begin) | ~lines.bounded[track, 0], (high < end) | ~lines.bounded[track, 1]])
        for side, way in ((0, part), (1, 1 - part)):
            taper = np.minimum(np.minimum(TAPER_PT, TAPER_SHARE * length), TAPER_GAP * gap[side : len(low) + side])[run]
            inward = np.clip(way * length[run] / np.maximum(taper, 1e-6), 0.0, 1.0)
            inward = np.maximum(inward, np.clip((widths / spacing - BLUNT) / (1 - BLUNT), 0.0, 1.0))
            thin = np.minimum(TIP_PT, widths) * (1 - inward) + widths * inward
            widths = np.where(free[run, side], thin, widths)
    lean = polylines.between(lines.ahead, origin, at, last)
    third = np.repeat((length / segments)[run] / 3, 1)[:, None]
    points = np.empty((len(knots), 3, 2))
    points[:, 0], points[:, 1], points[:, 2] = knots - lean * third, knots, knots + lean * third
    inner = np.ones((len(knots), 3), bool)
    inner[first[:-1], 0] = inner[first[1:] - 1, 2] = False
    strokes = Strokes(
        sheet.width, sheet.height, points[inner], curves.starts(3 * segments + 1), np.ones(len(low))
    ).swelling(np.maximum(widths, 0.01))
    return strokes.rounded()
