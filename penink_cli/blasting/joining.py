"""Lines of an engraving that end where another begins, a little aside, are one line.

A field's topology asks for ends, but a phase has more of them than it needs: where one line too many begins and leaves
off again, two ends face each other, and the eye sees a fleck of white between them. Both belong to one line if the
line beside both is the same one, on the same side.
"""

from __future__ import annotations

import numpy as np

from penink_cli.blasting import curves
from penink_cli.blasting.level_lines import LevelLines
from penink_cli.blasting.taking_turns import beside
from penink_cli.ground.model import Floats, Ints

#: An end's direction is that over so many samples, and the lines beside it are those so far back.
BACK = 4
#: Ends are joined that are so far aside and apart at the most, or that overlap by so much, in parts of the lines'
#: distance; and whose lines lie so straight on (the cosine of the angle between them).
ASIDE, APART, OVERLAP, STRAIGHT = 0.9, 10.0, 5.0, 0.85
#: The way from one line to the other is so many times as long as it goes aside: lines give back as much as is lacking.
SLANT = 7.0
#: What an end that lies aside counts for, beside one that lies ahead.
WORSE = 5.0


def joined(lines: LevelLines, spacing: float) -> LevelLines:
    """The lines, in samples about a point apart, with those joined that face each other end to end."""
    points = np.asarray(lines.points, np.float64)
    sizes = np.diff(lines.first)
    open_ = np.flatnonzero(~lines.ring & (sizes > 2 * BACK))
    # tip k is the start of its line, or its end
    first, last = lines.first[:-1][open_], lines.first[1:][open_] - 1
    tip, inner, line = (
        np.column_stack(pair).ravel() for pair in ((first, last), (first + BACK, last - BACK), (open_, open_))
    )
    ahead = points[tip] - points[inner]
    ahead /= np.maximum(np.sqrt((ahead * ahead).sum(axis=1)), 1e-9)[:, None]
    one, other = _facing(points[tip], ahead, spacing)
    neighbours = _neighbours(points, lines.first, spacing, inner, ahead)
    # they look at each other: what is on the one's left is on the other's right
    same = (neighbours[one] == neighbours[other, ::-1]) & (neighbours[one] >= 0)
    one, other = one[same.any(axis=1)], other[same.any(axis=1)]
    partner = _paired(one, other, line, len(tip))
    return _chained(points, lines, open_, partner, ahead)


def _facing(at: Floats, ahead: Floats, spacing: float) -> tuple[Ints, Ints]:
    """Pairs of tips that face each other, the best ones first."""
    one, other = _near(at, APART * spacing)
    way = at[other] - at[one]
    mean = ahead[one] - ahead[other]
    long = np.sqrt((mean * mean).sum(axis=1))
    mean /= np.maximum(long, 1e-9)[:, None]
    along = (way * mean).sum(axis=1)
    aside = np.abs(way[:, 0] * mean[:, 1] - way[:, 1] * mean[:, 0])
    straight = -(ahead[one] * ahead[other]).sum(axis=1)
    good = (straight > STRAIGHT) & (aside < ASIDE * spacing)
    good &= (along < APART * spacing) & (along > -OVERLAP * spacing)
    cost = np.abs(along) + WORSE * aside
    order = np.lexsort((other[good], one[good], cost[good]))
    return one[good][order], other[good][order]


def _near(at: Floats, reach: float) -> tuple[Ints, Ints]:
    """Pairs (a < b) of points (n, 2) that are at most so far apart, by cells so wide."""
    cell = np.floor(at / reach).astype(np.int64)
    cell -= cell.min(axis=0, initial=0) - 1
    across = int(cell[:, 0].max(initial=0)) + 2
    key = cell[:, 1] * across + cell[:, 0]
    order = np.argsort(key, kind="stable")
    ranked = key[order]
    ones, others = [], []
    for step in (0, 1, across - 1, across, across + 1):
        low, high = np.searchsorted(ranked, key + step), np.searchsorted(ranked, key + step, side="right")
        count = high - low
        a = np.repeat(np.arange(len(at)), count)
        b = order[np.repeat(low, count) + curves.ramp(count)] if len(a) else a
        far = (at[a] - at[b]) ** 2
        keep = far[:, 0] + far[:, 1] <= reach * reach
        if step == 0:
            keep &= a < b
        ones.append(np.minimum(a, b)[keep])
        others.append(np.maximum(a, b)[keep])
    return np.concatenate(ones), np.concatenate(others)


def _neighbours(points: Floats, first: Ints, spacing: float, inner: Ints, ahead: Floats) -> Ints:
    """(n, 2) the line beside each of n samples, to its left and its right as it looks ahead, -1 for none."""
    normals = np.zeros_like(points)
    normals[inner] = np.column_stack([-ahead[:, 1], ahead[:, 0]])
    met = beside(points, first, normals, inner, spacing)
    return np.where(met >= 0, np.searchsorted(first, met, side="right") - 1, -1)


def _paired(one: Ints, other: Ints, line: Ints, count: int) -> Ints:
    """(count,) the tip that each is joined to, -1 for none, so that no lines make a ring."""
    partner = np.full(count, -1, np.int64)
    root: dict[int, int] = {}

    def top(k: int) -> int:
        while root.get(k, k) != k:
            k = root[k]
        return k

    for a, b in zip(one.tolist(), other.tolist()):
        if partner[a] < 0 and partner[b] < 0:
            p, q = top(int(line[a])), top(int(line[b]))
            if p != q:
                partner[a], partner[b] = b, a
                root[q] = p
    return partner


def _chained(
    points: Floats, lines: LevelLines, open_: Ints, partner: Ints, ahead: Floats
) -> LevelLines:
    """The lines with such tips joined; each stands where the first of its chain stood."""
    number = np.full(len(lines.ring), -1, np.int64)
    number[open_] = np.arange(len(open_))
    cut = np.zeros(len(partner), np.int64)  # samples that a tip gives back
    first, last = lines.first[:-1][open_], lines.first[1:][open_] - 1
    tip = np.column_stack([first, last]).ravel()
    size = np.repeat(last - first + 1, 2)
    a = np.flatnonzero(partner >= 0)
    b = partner[a]
    way = points[tip[b]] - points[tip[a]]
    along = (way * (ahead[a] - ahead[b])).sum(axis=1) / 2
    aside = np.abs(way[:, 0] * ahead[a, 1] - way[:, 1] * ahead[a, 0])
    cut[a] = np.clip(np.ceil((np.maximum(SLANT * aside, 2.0) - along) / 2), 0, np.minimum(size[a], size[b]) // 2 - 2)
    done = np.zeros(len(lines.ring), bool)
    out: list[Floats] = []
    ring = []
    for i in range(len(lines.ring)):
        if done[i]:
            continue
        done[i] = True
        k = int(number[i])
        if k < 0 or (partner[2 * k] < 0 and partner[2 * k + 1] < 0):
            out.append(points[lines.first[i] : lines.first[i + 1]])
            ring.append(bool(lines.ring[i]))
            continue
        entered = 2 * k  # back to where the chain begins
        while partner[entered] >= 0:
            entered = int(partner[entered]) ^ 1
        parts: list[Floats] = []
        while True:
            k = entered >> 1
            done[open_[k]] = True
            low, high = int(first[k] + cut[2 * k]), int(last[k] - cut[2 * k + 1]) + 1
            part = points[low:high] if entered & 1 == 0 else points[low:high][::-1]
            if parts:
                step = part[0] - parts[-1][-1]
                n = max(1, round(float(np.sqrt((step * step).sum()))))
                parts.append(parts[-1][-1] + step * (np.arange(1, n) / n)[:, None])
            parts.append(part)
            leaves = entered ^ 1
            if partner[leaves] < 0:
                break
            entered = int(partner[leaves])
        out.append(np.concatenate(parts))
        ring.append(False)
    if not out:
        return lines
    return LevelLines(np.concatenate(out), curves.starts(np.array([len(line) for line in out])), np.array(ring))
