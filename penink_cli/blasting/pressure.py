"""The hand's pressure along each stroke: hatching swells where the picture is darker than its surroundings.

Lines of a hatching lie further apart than the finest things in a picture; their places follow the tone of a wider
surrounding. Their widths tell the finer things, as with a pen whose nib gives way: at each knot the width is the
stroke's own, times the tone there, over the mean tone around. Where this makes the sheet too dark or too light as the
eye sees it, the widths are corrected.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import curves
from penink_cli.blasting.sheet import SIGMA_PT, Cells, Sheet, look_up
from penink_cli.composition.filters import Picture, blurred, by_rows
from penink_cli.ground.device import MEAN
from penink_cli.ground.model import Floats, Ints, Strokes

#: σ of the Gaussian for the tone at a knot and for the tone around it, points; a tone added to both.
FINE_PT, AROUND_PT, FLOOR = 0.5, SIGMA_PT, 0.02
#: The least and the greatest width, in parts of the stroke's own.
LEAST, MOST = 0.2, 2.6
#: The least distance of knots, points, and the numbers of parts that a segment may be split into.
KNOT_PT, KNOTS = 2.0, (1, 2, 3, 4, 6, 8, 12, 16, 24, 32)
#: By how much widths may be off, points, so that fewer knots do.
TOLERANCE_PT = 0.08
#: A stroke whose widths differ by no more than this is drawn with one. Each side of it is then off by half a
#: dot of 600 to the inch.
EVEN_PT = 0.1
#: Rounds in which the widths are corrected, and the most of a width that a round changes. The last is for the mean.
ROUNDS, CORRECTION = 4, 0.3
#: Errors are taken so many times: what a printer adds to a stroke does not swell with it, and strokes overlap.
AGAINST = np.float32(1.5)
#: What is left on the mean of the sheet all strokes make good alike in the last round: each is so much of its width
#: wider, at the most, for ink that grows by one part of it in OVERLAP, since strokes overlap.
EVENLY, OVERLAP = 0.04, 1.2
#: Errors are held against the tone, or against this where the tone is less.
SINGLE = 0.1


def swollen(sheet: Sheet, strokes: Strokes, tone: Floats, swell: float) -> Strokes:
    """The strokes, which are on the sheet, with widths along their way that follow the tone (h, w).

    swell: 0 … 2, how much: 1 makes a stroke as much wider as the tone is darker.
    """
    if not len(strokes):
        return strokes
    px, single = tone.shape[1] / sheet.width, tone.astype(np.float32)
    fine, around = (blurred(single, sigma * px, sheet.threads) for sigma in (FINE_PT, AROUND_PT))

    def darker(fine: Picture, around: Picture) -> Picture:
        ratio = (fine + np.float32(FLOOR)) / (around + np.float32(FLOOR))
        return np.clip(1 + np.float32(swell) * (ratio - 1), np.float32(LEAST), np.float32(MOST))

    factor = by_rows(darker, fine, around, threads=sheet.threads)
    del single, fine, around
    split, owner = _split(strokes, factor, sheet)
    knots = split.points[np.repeat(split.first[:-1], np.diff(split.knots)) + 3 * curves.ramp(np.diff(split.knots))]
    own = strokes.widths[owner] * look_up(factor, knots, sheet.width, sheet.height)
    sheet.clear()
    there = _mean(sheet.ink)
    correction: Cells = np.ones((sheet.rows, sheet.columns), np.float32)
    against = sheet.spread(np.maximum(sheet.seen(sheet.tone), np.float32(SINGLE)))
    for turn in range(ROUNDS + 1):
        widths = own * look_up(correction, knots, sheet.width, sheet.height)
        drawn = split.swelling(np.maximum(np.round(widths, 2), 0.05))
        if turn == ROUNDS:
            break
        sheet.clear()
        _ink(sheet, drawn)
        if turn == ROUNDS - 1:
            correction *= np.float32(1 + _evenly(sheet, there, _mean(widths)))
            continue
        seen = sheet.spread(sheet.error()) / against
        correction = correction * (1 + np.clip(AGAINST * seen, np.float32(-CORRECTION), np.float32(CORRECTION)))
    drawn = _simpler(strokes, drawn)
    sheet.clear()
    _ink(sheet, drawn)
    return drawn


def _evenly(sheet: Sheet, there: float, width: float) -> float:
    """The part of their width by which strokes are to be wider so that the sheet, on the mean, has its tone.

    there: the mean ink that is none of theirs. width: of theirs, on the mean, to which a device adds its gain.

    Lines and blacks on light ground have nothing beside them to pay with.
    """
    drawn = _mean(sheet.ink)
    grows = OVERLAP * (1 + MEAN * sheet.gain_pt / width)
    part = grows * (_mean(sheet.tone) - drawn) / max(drawn - there, SINGLE * SINGLE)
    return min(max(part, -EVENLY), EVENLY)


def _mean(values: npt.NDArray[np.floating]) -> float:
    """The mean by way of whole numbers, whose sum is the same in any order."""
    return int(np.rint(values * (1 << 20)).astype(np.int64).sum()) / (values.size << 20)


def _simpler(strokes: Strokes, swelling: Strokes) -> Strokes:
    """Those that swell, and before them as they were those that hardly do, each of its mean width."""
    if swelling.knot_widths is None:
        return replace(strokes, widths=swelling.widths)
    low, high = (part.reduceat(swelling.knot_widths, swelling.knots[:-1]) for part in (np.minimum, np.maximum))
    even = high - low <= EVEN_PT + 1e-9
    plain = replace(strokes, widths=np.maximum(np.round(swelling.widths, 2), 0.01)).taken(even)
    return Strokes.joined([plain, swelling.taken(~even)])


def _split(strokes: Strokes, factor: Cells, sheet: Sheet) -> tuple[Strokes, Ints]:
    """The strokes with as many knots as their widths need, and (n,) the stroke of each knot."""
    count = curves.segments_of(strokes.first)
    which = np.repeat(np.arange(len(strokes)), count)
    control = strokes.points[curves.begins_of(strokes.first)[:, None] + np.arange(4)]
    parts = _parts(control, strokes.widths[which], factor, sheet)
    inner, k = np.repeat(np.arange(len(parts)), parts), curves.ramp(parts)
    pieces = curves.blossom(control[inner], k / parts[inner], (k + 1) / parts[inner])
    total = np.zeros(len(strokes), np.int64)
    np.add.at(total, which, parts)
    first = curves.starts(3 * total + 1)
    points = np.empty((int(first[-1]), 2))
    points[first[:-1]] = strokes.points[strokes.first[:-1]]
    at = np.repeat(first[:-1], total) + 3 * curves.ramp(total)
    for j in range(1, 4):
        points[at + j] = pieces[:, j]
    return replace(strokes, points=points, first=first), np.repeat(np.arange(len(strokes)), total + 1)


def _parts(control: Floats, widths: Floats, factor: Cells, sheet: Sheet) -> Ints:
    """(n,) into how many parts each cubic (n, 4, 2) is split, for a width that is linear along each of them."""
    legs = np.diff(control, axis=1)
    length = np.sqrt((legs * legs).sum(axis=2)).sum(axis=1)
    most = np.array(KNOTS)[np.minimum(np.searchsorted(KNOTS, length / KNOT_PT), len(KNOTS) - 1)]
    finest = KNOTS[-1]
    wanted = np.empty((finest + 1, len(most)))
    for k in range(finest + 1):
        t = k / finest
        s = 1 - t
        place = s * s * s * control[:, 0] + 3 * s * s * t * control[:, 1]
        place = place + 3 * s * t * t * control[:, 2] + t * t * t * control[:, 3]
        wanted[k] = look_up(factor, place, sheet.width, sheet.height) * widths
    parts = most.copy()
    left = np.arange(len(most))
    for n in KNOTS[:-1]:
        at = np.arange(finest + 1) * n / finest
        low = np.minimum(at.astype(np.int64), n - 1)
        share = (at - low)[:, None]
        ends = np.rint(np.arange(n + 1) * finest / n).astype(np.int64)
        mine = wanted[:, left]
        off = np.abs(mine[ends[low]] * (1 - share) + mine[ends[low + 1]] * share - mine).max(axis=0)
        good = (off <= TOLERANCE_PT) | (most[left] <= n)
        parts[left[good]] = n
        left = left[~good]
    return parts


def _ink(sheet: Sheet, strokes: Strokes) -> None:
    """Ink the strokes on the sheet, in pieces of one width."""
    pieces = strokes.by_segments()
    steps = curves.pieces_of(pieces.points, pieces.first, sheet.width / sheet.columns)
    sheet.paint(curves.sample(pieces.points, pieces.first, steps), pieces.widths)
