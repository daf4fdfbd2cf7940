"""Corners and junctions put where the picture shows them: what the edges would look like against the photo.

Blur rounds corners, and near junctions the gradient belongs to two edges at once, so that chains end
there in bevels, stubs and bends. Each such place is looked at through a window: the edges part it into
regions, which are rendered with the greys that suit best, through the photo's own blur (`_window`). The
vertices settle where this is most like the photo; a short edge may shrink to a point, an open end may
meet what is near; and of all these the arrangement stays that explains the photo with fewest vertices.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from penink_cli.arrangement._planar import Planar
from penink_cli.arrangement._window import FINE, MOST_MOVED, MOST_SIDE, Window
from penink_cli.arrangement.places import Place, Point, angle, distance
from penink_cli.arrangement.planar import UNIT
from penink_cli.model import Floats

Lines = dict[int, tuple[float, ...]]

_TURN = 0.6  # radians: at a vertex, or at two that are close, which makes them a corner
_AROUND = 3  # pixels around the vertices of a place that are compared with the photo
_CELL = 16  # pixels
_BEND = 8.0  # what a radian of turning costs: a bevel turns as far as its corner, a thorn much farther
_SHARP, _ARM = 1.65, 0.75  # radians that the way turns at a thorn; of how far blur reaches, its shorter edge
_ROUNDS, _GLANCE = 5, 2  # of Gauss and Newton: to settle, and to tell whether a change is worth it
_LOOSE = 0.5  # by which a vertex stays where it is, in noise² a pixel²
_LINE = 0.015  # of step² a pixel, over the blur: what the rest of an edge tells of its end's place (1 / 6 √π)
_TOLD = 40.0  # pixels: longer edges may be curved
_PASSES = 2
_STEPS = 4  # changes one after the other at one place
_VERTEX = 3.0  # what a vertex costs: the logarithm of the pixels that its two coordinates are told by
_LEAST_NOISE = 1 / 255  # a model of flat regions is never better than this
_FEW, _PIXELS_A_SITE = 400, 6000  # places looked at, the strongest first: a photo's are fewer, a mosaic's all its cells
_CROWDED = 14  # edges in a window: no junction, but texture


def settle_junctions(
    planar: Planar, grey: npt.NDArray[np.floating], step: Floats, lens: float, noise: float, blur: float
) -> None:
    """Improve the corners and junctions of an arrangement, which stays one.

    Args:
        planar: the arrangement, few long segments.
        grey: (h, w) the photo, 0 … 1.
        step: (n,) grey step at each vertex of the arrangement, 0 where unknown.
        lens: standard deviation (pixels) of the photo's blur beyond its pixels' area.
        noise: standard deviation of the photo's noise, 0 … 1.
        blur: that (pixels) of the whole blur that the edges were found through.

    """
    work = _Work(planar, grey, step, lens, noise, blur)
    again: set[int] = set()
    for k in range(_PASSES):
        changed: set[int] = set()
        for site in work.sites():
            if k == 0 or again.intersection(site):
                changed.update(work.improve(site))
        again = changed


class _Work:
    def __init__(
        self, planar: Planar, grey: npt.NDArray[np.floating], step: Floats, lens: float, noise: float, blur: float
    ) -> None:
        self.planar, self.step = planar, step
        self.vertices, self.ends = np.asarray(planar.vertices), np.asarray(planar.ends)
        self.height, self.width = grey.shape
        self.near = 3.0 * blur + 1.0  # how far blur may have moved things apart
        self.spread = math.hypot(lens, math.sqrt(1 / 12))
        self.halo = min(5, math.ceil(2.5 * self.spread))
        self.window = Window(np.ascontiguousarray(grey, np.float32), _taps(lens), self.spread)
        self.top = self.left = 0
        self.floor = max(noise, _LEAST_NOISE) ** 2
        live = np.flatnonzero(np.asarray(planar.live)[: len(self.ends)])
        self.spare = iter(np.flatnonzero(np.asarray(planar.live)[: len(self.ends)] == 0).tolist())
        used = np.zeros(len(self.vertices), bool)
        used[self.ends[live]] = True
        self.spare_vertices = iter(np.flatnonzero(~used).tolist())
        self.around: dict[int, list[int]] = defaultdict(list)
        self.cells: dict[tuple[int, int], list[int]] = defaultdict(list)
        for s in live.tolist():
            self.enter(s)

    def at(self, v: int) -> Point:
        x, y = self.vertices[v].tolist()
        return x * UNIT, y * UNIT

    def enter(self, s: int) -> None:
        a, b = self.ends[s].tolist()
        self.around[a].append(s)
        self.around[b].append(s)
        for cell in _cells(self.at(a), self.at(b)):
            self.cells[cell].append(s)

    def leave(self, s: int) -> None:
        a, b = self.ends[s].tolist()
        self.around[a].remove(s)
        self.around[b].remove(s)
        for cell in _cells(self.at(a), self.at(b)):
            self.cells[cell].remove(s)

    def sites(self) -> list[list[int]]:
        """Vertices (of corners, junctions and open ends beside something) that belong together."""
        special = {v for v in sorted(self.around) if self._special(v)}
        group = {v: v for v in special}

        def root(v: int) -> int:
            while group[v] != v:
                v = group[v]
            return v

        buckets: dict[tuple[int, int], list[int]] = defaultdict(list)
        for v in sorted(special):
            x, y = self.at(v)
            i, j = int(y // self.near), int(x // self.near)
            for other in (u for p in (i - 1, i, i + 1) for q in (j - 1, j, j + 1) for u in buckets[p, q]):
                if math.dist(self.at(other), (x, y)) < self.near:
                    group[root(v)] = root(other)
            buckets[i, j].append(v)
        found: dict[int, list[int]] = defaultdict(list)
        for v in sorted(special):
            found[root(v)].append(v)
        most = max(_FEW, self.width * self.height // _PIXELS_A_SITE)
        strength = [-max(float(self.step[v]) for v in site) for site in found.values()]
        chosen = sorted(np.argsort(strength, kind="stable")[:most].tolist())
        sites = list(found.values())
        return [sites[k] for k in chosen]

    def _special(self, v: int) -> bool:
        around = self.around[v]
        x, y = self.at(v)
        if not (0 < x < self.width and 0 < y < self.height):
            return False
        if len(around) > 2:
            return True
        if len(around) == 1:
            return self._beside(v)
        if len(around) == 2:
            turn = self._turn(v)
            for s in around:
                other = int(self.ends[s].sum()) - v
                if len(self.around[other]) == 2 and math.dist(self.at(other), (x, y)) < self.near:
                    turn = max(turn, abs(self._signed(v, other, s)))
            return turn > _TURN
        return False

    def _turn(self, v: int) -> float:
        one, two = (int(self.ends[s].sum()) - v for s in self.around[v])
        return abs(angle(self.at(one), self.at(v), self.at(two)))

    def _signed(self, v: int, other: int, s: int) -> float:
        """How far the way turns along the edge s between two vertices of degree 2, at both its ends together."""
        before = next(int(self.ends[t].sum()) - v for t in self.around[v] if t != s)
        after = next(int(self.ends[t].sum()) - other for t in self.around[other] if t != s)
        p, q = self.at(v), self.at(other)
        return angle(self.at(before), p, q) + angle(p, q, self.at(after))

    def _beside(self, v: int) -> bool:
        """Whether an edge that is not its own comes close to an open end."""
        p = self.at(v)
        for s in self.within(p[0] - self.near, p[1] - self.near, p[0] + self.near, p[1] + self.near):
            a, b = self.ends[s].tolist()
            if v not in (a, b) and distance(p, self.at(a), self.at(b))[0] < self.near:
                return True
        return False

    def within(self, left: float, top: float, right: float, bottom: float) -> list[int]:
        """Segments in the cells of a rectangle, in order."""
        rows = range(int(top // _CELL), int(bottom // _CELL) + 1)
        columns = range(int(left // _CELL), int(right // _CELL) + 1)
        return sorted({s for i in rows for j in columns for s in self.cells.get((i, j), ())})

    def improve(self, site: list[int]) -> Iterable[int]:
        """Look at one place and change it for the better: the vertices moved."""
        site = [v for v in site if self.around[v]]
        if not site:
            return ()
        places = [self.at(v) for v in site]
        xs, ys = [x for x, _ in places], [y for _, y in places]
        left, right = math.floor(min(xs)) - _AROUND, math.ceil(max(xs)) + _AROUND
        top, bottom = math.floor(min(ys)) - _AROUND, math.ceil(max(ys)) + _AROUND
        if max(right - left, bottom - top) + 2 * self.halo > MOST_SIDE:
            return ()
        window = left - self.halo, top - self.halo, right + self.halo, bottom + self.halo
        segments = [s for s in self.within(*window) if self._through(s, *window)]
        if len(segments) > _CROWDED:
            return ()
        edges = [(*self.ends[s].tolist(), s) for s in segments]
        at = {v: self.at(v) for a, b, _ in edges for v in (a, b)}
        free = frozenset(
            v for v, (x, y) in at.items()
            if left <= x <= right and top <= y <= bottom and 0 < x < self.width and 0 < y < self.height
            and all(s in segments for s in self.around[v])
        )  # fmt: skip
        if len(free) > MOST_MOVED:
            free = frozenset(v for v in free if v in site)
            if len(free) > MOST_MOVED:
                return ()
        given = Place(at, edges, free)
        if given.closed():
            return ()
        pixels = self.window.place(top - self.halo, left - self.halo, bottom + self.halo, right + self.halo, self.halo)
        self.top, self.left = max(0, top - self.halo), max(0, left - self.halo)
        lines = self.known(segments, free)
        seen = self.settled(given, pixels, lines, 0)
        if seen is None:
            return ()
        best, best_score = seen
        for turn in range(_STEPS):
            tries = [self.settled(best, pixels, lines)] if turn == 0 else []
            tries += [self.settled(other, pixels, lines, _GLANCE) for other in best.changes(self.near)]
            good = [found for found in tries if found is not None]
            if not good or min(found[1] for found in good) >= best_score - 1:
                more = [self.settled(other, pixels, lines, _GLANCE) for other in best.bends()]
                good += [found for found in more if found is not None]
            if not good:
                break
            chosen = min(good, key=lambda found: found[1])
            if turn or chosen is not tries[0]:
                chosen = self.settled(chosen[0], pixels, lines) or chosen
            if chosen[1] >= best_score - 1:
                break
            best, best_score = chosen
        return self.apply(given, best) if best is not seen[0] else ()

    def _through(self, s: int, left: float, top: float, right: float, bottom: float) -> bool:
        (ax, ay), (bx, by) = (self.at(v) for v in self.ends[s].tolist())
        if max(ax, bx) < left or min(ax, bx) > right or max(ay, by) < top or min(ay, by) > bottom:
            return False
        sides = [(bx - ax) * (y - ay) - (by - ay) * (x - ax) for x in (left, right) for y in (top, bottom)]
        return min(sides) <= 0 <= max(sides)

    def _arrays(self, place: Place) -> tuple[Floats, npt.NDArray[np.int32], list[int]]:
        names = sorted(place.at)
        number = {v: k for k, v in enumerate(names)}
        ends = np.array([(number[a], number[b]) for a, b, _ in place.edges], np.int32).reshape(-1, 2)
        return np.array([place.at[v] for v in names]), ends, names

    def known(self, segments: list[int], free: frozenset[int]) -> Lines:
        """Of each segment that leaves the window: its line's normal and offset, and the weight of what lies outside."""
        lines: Lines = {}
        for s in segments:
            a, b = self.ends[s].tolist()
            if (a in free) == (b in free):
                continue
            v, other = (a, b) if a in free else (b, a)
            (x, y), (u, w) = self.at(v), self.at(other)
            length = math.hypot(x - u, y - w)
            outside = min(length, _TOLD) - _AROUND - 1
            if outside > 0:
                nx, ny = (y - w) / length, (u - x) / length
                step = max(self.step[v], self.step[other])
                lines[s] = nx, ny, nx * x + ny * y, _LINE * step * step * outside / self.spread
        return lines

    def settled(self, place: Place, pixels: int, lines: Lines, rounds: int = _ROUNDS) -> tuple[Place, float] | None:
        """The place with its vertices where the photo wants them, and its description length up to a constant.

        None where that has too many regions, or thorns: sharp points of short edges, which blur cannot show.
        """
        vertices, ends, names = self._arrays(place)
        number = np.full(len(names), -1, np.int32)
        moved = [k for k, v in enumerate(names) if v in place.free]
        number[moved] = np.arange(len(moved))
        lines_of: dict[int, list[tuple[float, ...]]] = {names[k]: [] for k in moved}
        for a, b, s in place.edges:
            if s in lines:
                for v in (a, b):
                    if v in place.free:
                        lines_of[v].append(lines[s])
        held = np.array([self.held(*place.at[v], told) for v, told in lines_of.items()]).reshape(-1, 6)
        left_over = self.window.settle(ends, vertices, number, len(moved), held, rounds)
        if left_over < 0:
            return None
        score = pixels * math.log(left_over / pixels + self.floor) + _VERTEX * len(place.at)
        at = {v: (float(x), float(y)) for v, (x, y) in zip(names, vertices)}
        found = Place({**place.at, **{v: at[v] for v in place.free}}, place.edges, place.free)
        turns = list(found.turns())
        if rounds and any(turn > _SHARP and arm < _ARM * self.near for turn, arm in turns):
            return None
        return found, score + _BEND * sum(turn for turn, _ in turns)

    def held(self, x: float, y: float, lines: list[tuple[float, ...]]) -> tuple[float, ...]:
        """What is known of a vertex, as `Window.settle` takes it: that it is at x, y, and lies on lines."""
        x, y = x - self.left, y - self.top
        xx = yy = w = _LOOSE * self.floor
        xy, bx, by, c = 0.0, w * x, w * y, w * (x * x + y * y)
        for nx, ny, offset, weight in lines:
            offset -= nx * self.left + ny * self.top
            xx, xy, yy = xx + weight * nx * nx, xy + weight * nx * ny, yy + weight * ny * ny
            bx, by, c = bx + weight * nx * offset, by + weight * ny * offset, c + weight * offset * offset
        return xx, xy, yy, bx, by, c

    def apply(self, old: Place, new: Place) -> Iterable[int]:
        """Put the new place into the arrangement, if it fits there: the vertices moved."""
        names = {v: next(self.spare_vertices, -1) for v in new.at if v < 0}
        if -1 in names.values():
            return ()
        if names:
            new = Place(
                {names.get(v, v): xy for v, xy in new.at.items()},
                [(names.get(a, a), names.get(b, b), s) for a, b, s in new.edges],
                new.free,
            )
        before = {s: (a, b) for a, b, s in old.edges}
        moved = {v for v in new.at if new.at[v] != old.at.get(v)}
        gone = [s for s in before if s not in {t for _, _, t in new.edges}]
        touched = [(a, b, s) for a, b, s in new.edges if s < 0 or before[s] != (a, b) or a in moved or b in moved]
        if not touched and not gone:
            return ()
        touched = [(a, b, s if s >= 0 else next(self.spare, -1)) for a, b, s in touched]
        if any(s < 0 for _, _, s in touched):
            return ()
        removed = [s for s in before if s in gone or s in {t for _, _, t in touched}]
        spots = {v: self.vertices[v].copy() for v in moved}
        for s in removed:
            self.planar.remove(s)
            self.leave(s)
        for v in moved:
            self.vertices[v] = np.clip(
                np.rint(np.array(new.at[v]) / UNIT), 1, (round(self.width / UNIT) - 1, round(self.height / UNIT) - 1)
            )
        self.planar.ignore_none()
        added = []
        for a, b, s in touched:
            if not self.planar.fits(a, b):
                break
            self.ends[s] = a, b
            self.planar.add(s)
            added.append(s)
        else:
            for s in added:
                self.enter(s)
            return moved
        for s in added:
            self.planar.remove(s)
        for v in moved:
            self.vertices[v] = spots[v]
        for s in removed:
            self.ends[s] = before[s]
            self.planar.add(s)
            self.enter(s)
        return ()


def _taps(lens: float) -> Floats:
    """What each of `FINE` points a pixel gives to a pixel along one axis: the lens's Gaussian over its width."""
    reach = min(FINE * 5, math.ceil(FINE * 2.5 * lens) + FINE // 2)
    gauss = [math.exp(-0.5 * (d / (FINE * lens)) ** 2) for d in range(-reach - 1, reach + 2)]
    taps = [sum(gauss[k : k + FINE]) for k in range(2 * reach + 1)]
    return np.array(taps) / sum(taps)


def _cells(p: Point, q: Point) -> Iterable[tuple[int, int]]:
    """The cells that a segment's way goes through, and some beside it."""
    steps = int(max(abs(q[0] - p[0]), abs(q[1] - p[1])) // _CELL) + 1
    found = set()
    for k in range(steps):
        x0, y0 = p[0] + (q[0] - p[0]) * k / steps, p[1] + (q[1] - p[1]) * k / steps
        x1, y1 = p[0] + (q[0] - p[0]) * (k + 1) / steps, p[1] + (q[1] - p[1]) * (k + 1) / steps
        for i in range(int(min(y0, y1) // _CELL), int(max(y0, y1) // _CELL) + 1):
            for j in range(int(min(x0, x1) // _CELL), int(max(x0, x1) // _CELL) + 1):
                found.add((i, j))
    return found
