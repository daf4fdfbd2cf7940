"""Corners and junctions put where the picture shows them: the edges are rendered and compared with the photo.

Blur rounds corners. Near junctions the gradient belongs to two edges at once, and chains end in bevels, stubs and
bends. Each such place is looked at through a window:

1. The edges part the window into regions. These are rendered, each in the grey that suits it best, through the photo's
   own blur (`_compiled/window`).
2. The vertices move to where the rendering is most like the photo.
3. Other arrangements are tried: a short edge shrinks to a point, an open end meets what is near, a vertex or an edge is
   left out or added (`_compiled/settling`).
4. The one that explains the photo with fewest vertices stays (`_compiled/view`). In texture, where regions are not
   flat, the number of vertices counts less.

Places that share an edge are settled one after the other in a fixed order, others by several threads.
"""

from __future__ import annotations

import math
from collections import defaultdict
from functools import partial
from itertools import chain

import numpy as np
import numpy.typing as npt

from penink_cli.arrangement._compiled import exchange as _exchange
from penink_cli.arrangement._compiled.exchange import Exchange
from penink_cli.arrangement._compiled.place import Place
from penink_cli.arrangement._compiled.planar import Planar
from penink_cli.arrangement._compiled.regions import FINENESS
from penink_cli.arrangement._compiled.settling import Settler
from penink_cli.arrangement.planar import UNIT
from penink_cli.geometry.trails import hanging_together
from penink_cli.ground import exact
from penink_cli.ground import threads as threading
from penink_cli.ground.model import Floats

Ints32 = npt.NDArray[np.int32]
# Vertices; the same and those at the other ends of short edges; how many pixels around those are looked at.
Site = tuple[Ints32, Ints32, int]

_TURN = 0.6  # radians: at a vertex, or at two that are close, which makes them a corner
_GENTLE = 1.0  # radians at one vertex of a curve
_PASSES = 2
_LEAST_NOISE = 1 / 255  # a model of flat regions is never better than this
_FEW, _PIXELS_A_SITE = 400, 6000  # places looked at, the strongest first: a photo's are fewer, a mosaic's all its cells
_BESIDE = 1.5  # times how far blur reaches: what is beside a place is looked at with it
_AROUND = 3  # pixels around a place that are looked at; around an open end as many as it may be joined across
_TOGETHER = 8  # places that a thread takes at once
# What a drawing shows of edges: strokes end at them, or follow them, where the grey steps by SHOWN on and they hang
# together for SHOWN_PT on paper.
_SHOWN, _SHOWN_PT = 0.2, 30.0


def settle_junctions(
    planar: Planar, grey: npt.NDArray[np.floating], step: Floats, lens: float, noise: float, blur: float,
    seen_at: float | None = None,
) -> None:  # fmt: skip
    """Improve the corners and junctions of an arrangement, which stays one.

    Args:
        planar: the arrangement, few long segments.
        grey: (h, w) the photo, 0 … 1.
        step: (n,) grey step at each vertex of the arrangement, 0 where unknown.
        lens: standard deviation (pixels) of the photo's blur beyond its pixels' area.
        noise: standard deviation of the photo's noise, 0 … 1.
        blur: that (pixels) of the whole blur that the edges were found through.
        seen_at: the width on paper, points, of the drawing that is to show it: of places that it does not show none is
            improved. None for all.

    """
    height, width = grey.shape
    vertices, ends = np.asarray(planar.vertices), np.asarray(planar.ends)
    live = np.asarray(planar.live)[: len(ends)].astype(bool)
    unused = np.bincount(ends[live].ravel(), minlength=len(vertices)) == 0
    right, bottom = round(width / UNIT) - 1, round(height / UNIT) - 1
    spare, spare_vertices = (np.flatnonzero(which).astype(np.int32) for which in (~live, unused))
    exchange = Exchange(planar, spare, spare_vertices, UNIT, right, bottom)
    spread = math.sqrt(lens * lens + 1 / 12)
    near = 3.0 * blur + 1.0  # how far blur may have moved things apart
    halo = min(5, math.ceil(2.5 * spread))
    photo, taps = np.ascontiguousarray(grey, np.float32), _taps(lens)
    workers = threading.count(None)
    idle = [Settler(photo, taps, spread, near, halo, max(noise, _LEAST_NOISE) ** 2, UNIT) for _ in range(workers)]

    def improve(sites: list[Site]) -> list[tuple[Place, Place] | None]:
        settler = idle.pop()
        found = [settler.improve(planar, step, *site) for site in sites]
        idle.append(settler)
        return found

    again: set[int] = set()  # vertices moved by a site that is not theirs
    for turn in range(_PASSES):
        wanted = None
        if turn:
            wanted = np.zeros(len(np.asarray(planar.vertices)), np.bool_)
            wanted[list(again)] = True
        elif seen_at is not None:
            wanted = _shown_vertices(planar, grey, 2.0 * blur, _SHOWN_PT * width / seen_at)
        sites = _sites(planar, step, near, width, height, wanted)
        again = set()
        for wave in _waves(_in_view(planar, sites, idle[0])):
            tasks = (partial(improve, wave[k : k + _TOGETHER]) for k in range(0, len(wave), _TOGETHER))
            # All of a wave is found before any of it is exchanged: a change may reach into another site's view.
            found = list(chain.from_iterable(threading.in_order(tasks, min(workers, len(wave) // _TOGETHER))))
            for site, better in zip(wave, found, strict=True):
                if better is not None:
                    again.update(set(exchange.exchange(*better)).difference(site[0].tolist()))


def _in_view(planar: Planar, sites: list[Site], settler: Settler) -> list[tuple[Site, list[int]]]:
    """The sites with the segments that they are told by; the vertices of one too wide for a window, one by one."""
    found = []
    for site in sites:
        segments, crowded = settler.segments_in_view(planar, *site)
        if segments or crowded or len(site[0]) == 1:
            found.append((site, segments))
        else:
            alone = [(site[0][k : k + 1], site[0][k : k + 1], _AROUND) for k in range(len(site[0]))]
            found.extend((one, settler.segments_in_view(planar, *one)[0]) for one in alone)
    return found


def _waves(sites: list[tuple[Site, list[int]]]) -> list[list[Site]]:
    """The sites in groups, one group after the other: each site comes after those before it with a common segment."""
    waves: dict[int, list[Site]] = defaultdict(list)
    last: dict[int, int] = defaultdict(int)
    for site, segments in sites:
        if segments:
            wave = 1 + max(last[s] for s in segments)
            last.update(dict.fromkeys(segments, wave))
            waves[wave].append(site)
    return [waves[k] for k in sorted(waves)]


def _sites(
    planar: Planar, step: Floats, near: float, width: int, height: int, wanted: npt.NDArray[np.bool_] | None
) -> list[Site]:
    """Corners, junctions and open ends beside something, those together that are near to one another.

    wanted: (n,) vertices of which a site has at least one; None for all. The strongest are chosen of all sites.
    """
    at, ends = np.asarray(planar.vertices) * UNIT, _ends(planar)
    inside = np.asarray(((at > 0) & (at < (width, height))).all(axis=1))
    special = _special(planar, at, ends, near)
    special = special[inside[special]]
    if not len(special):
        return []
    group = np.zeros(len(special), np.int32)
    _exchange.cluster(np.ascontiguousarray(at[special]), near, group)
    order = np.argsort(group, kind="stable")
    special, group = special[order], group[order]
    firsts = np.flatnonzero(np.diff(group, prepend=-1))
    most = max(_FEW, width * height // _PIXELS_A_SITE)
    strength = np.maximum.reduceat(step[special], firsts)
    chosen = np.sort(np.argsort(-strength, kind="stable")[:most])
    if wanted is not None:
        chosen = chosen[np.logical_or.reduceat(wanted[special], firsts)[chosen]]
    if not len(chosen):
        return []

    owner = np.full(len(at), -1, np.int32)
    of_chosen = np.zeros(len(firsts), np.bool_)
    of_chosen[chosen] = True
    owner[special] = np.where(np.repeat(of_chosen, np.diff(firsts, append=len(special))), group, -1)
    a, b = np.concatenate([ends, ends[:, ::-1]]).T
    short = exact.length(at[a] - at[b]) < _BESIDE * near
    next_to = np.flatnonzero(short & (owner[a] >= 0) & (owner[a] != owner[b]) & inside[b])
    beside: dict[int, set[int]] = defaultdict(set)
    for k, v in zip(owner[a[next_to]].tolist(), b[next_to].tolist()):
        beside[k].add(v)
    degree = np.bincount(ends.ravel(), minlength=len(at))
    opens = np.logical_or.reduceat(degree[special] == 1, firsts)
    sites = []
    for k, first, last in zip(chosen.tolist(), firsts[chosen].tolist(), np.append(firsts, len(special))[chosen + 1]):
        core = special[first:last]
        wider = np.concatenate([core, np.array(sorted(beside[group[first]]), np.int32)])
        sites.append((core, wider, int(near) if opens[k] else _AROUND))
    return sites


def _shown_vertices(
    planar: Planar, grey: npt.NDArray[np.floating], beside: float, least: float
) -> npt.NDArray[np.bool_]:
    """Which of the vertices (n,) are on edges of a strong step that hang together for so many pixels.

    beside: how far from an edge the grey of its sides is looked up, pixels. At vertices themselves slopes tell little.
    """
    at, ends = np.asarray(planar.vertices) * UNIT, _ends(planar)
    a, b = at[ends[:, 0]], at[ends[:, 1]]
    along = b - a
    length = exact.length(along)
    off = np.column_stack([-along[:, 1], along[:, 0]]) * (beside / np.maximum(length, 1e-9))[:, None]
    last = np.array(grey.shape[::-1]) - 1
    step = np.zeros(len(ends))
    for part in (0.25, 0.5, 0.75):
        middle = a + part * along
        right, left = (np.clip((middle + side * off).astype(np.int64), 0, last) for side in (1, -1))
        step += np.abs(grey[right[:, 1], right[:, 0]] - grey[left[:, 1], left[:, 0]]) / 3
    strong = step >= _SHOWN
    group = hanging_together(ends[strong], len(at))
    whole = np.bincount(group, length[strong], len(at))
    result = np.zeros(len(at), np.bool_)
    result[ends[strong][whole[group] >= least]] = True
    return result


def _ends(planar: Planar) -> Ints32:
    """The ends (m, 2) of the edges that there are."""
    ends = np.asarray(planar.ends)
    return ends[np.asarray(planar.live)[: len(ends)].astype(bool)]


def _special(planar: Planar, at: Floats, ends: Ints32, near: float) -> Ints32:
    """Corners, junctions, and open ends that another edge comes close to."""
    count = len(at)
    degree = np.bincount(ends.ravel(), minlength=count)
    open_ends = np.flatnonzero(degree == 1).astype(np.int32)
    beside = np.zeros(len(open_ends), np.uint8)
    _exchange.beside(planar, open_ends, near / UNIT, beside)

    tail = np.concatenate([ends[:, 0], ends[:, 1]])
    order = np.argsort(tail, kind="stable")
    head = np.concatenate([ends[:, 1], ends[:, 0]])[order]
    middle = degree == 2
    first = (np.cumsum(degree) - degree)[middle]
    before, after = np.zeros(count, np.int32), np.zeros(count, np.int32)
    before[middle], after[middle] = head[first], head[first + 1]
    turn = np.zeros(count)  # on the way from `before` to `after`
    turn[middle] = _angle(at[before[middle]], at[middle], at[after[middle]])
    most = np.abs(turn)
    a, b = ends[middle[ends].all(axis=1)].T
    short = exact.length(at[a] - at[b]) < near
    a, b = a[short], b[short]
    both = np.abs(np.where(after[a] == b, turn[a], -turn[a]) + np.where(before[b] == a, turn[b], -turn[b]))
    np.maximum.at(most, a, both)
    np.maximum.at(most, b, both)
    most[_on_curve(turn, before, after, middle)] = 0
    found = np.concatenate([np.flatnonzero((degree > 2) | (middle & (most > _TURN))), open_ends[beside == 1]])
    return np.sort(found).astype(np.int32)


def _on_curve(turn: Floats, before: Ints32, after: Ints32, middle: npt.NDArray[np.bool_]) -> npt.NDArray[np.intp]:
    """Vertices of two edges where the way turns gently, and so it does before and after: nothing to be sharpened."""
    v = np.flatnonzero(middle & (np.abs(turn) < _GENTLE))
    u, w = before[v], after[v]
    steady = middle[u] & middle[w]
    for other, follows in ((u, after[u] == v), (w, before[w] == v)):
        steady &= np.where(follows, turn[other], -turn[other]) * np.sign(turn[v]) > 0.5 * np.abs(turn[v])
    return np.asarray(v[steady])


def _angle(p: Floats, q: Floats, r: Floats) -> Floats:
    """How far the ways p, q, r (n, 2) turn at q, radians, positive to the right on the screen."""
    (ux, uy), (vx, vy) = (q - p).T, (r - q).T
    return np.asarray(exact.atan2(ux * vy - uy * vx, ux * vx + uy * vy))


def _taps(lens: float) -> Floats:
    """What each of `FINENESS` points a pixel gives to a pixel along one axis: the lens's Gaussian over its width."""
    fine = int(FINENESS)
    reach = min(fine * 5, math.ceil(fine * 2.5 * lens) + fine // 2)
    gauss = [float(exact.exp(-0.5 * (d / (fine * lens)) ** 2)) for d in range(-reach - 1, reach + 2)]
    taps = [math.fsum(gauss[k : k + fine]) for k in range(2 * reach + 1)]
    return np.array(taps) / math.fsum(taps)
