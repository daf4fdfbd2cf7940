"""Level lines of a phase: polylines, found band by band and joined.

Memory is that of a band's crossings and of the lines themselves.

This module alone imports the compiled kernel `levels`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import curves
from penink_cli.blasting._compiled import levels as _levels
from penink_cli.blasting.phase import Each, Field, Plane, one_by_one
from penink_cli.ground.model import Ints

#: Nodes to a band, and rows at the least.
BAND_NODES, BAND_ROWS = 1 << 19, 32
#: Crossings of one link that are told from each other in two bands that share it.
PER_LINK = 16


@dataclass(frozen=True, eq=False)
class LevelLines:
    """Polylines, as in `curves.Polylines`; those that end where they began are rings (n,).

    points: (p, 2), in single precision as they are found.
    """

    points: npt.NDArray[np.floating]
    first: Ints
    ring: npt.NDArray[np.bool_]


def level_lines(
    field: Field,
    phase: Plane,
    level: float = 0.0,
    each: Each = one_by_one,
    wanted: npt.NDArray[np.bool_] | None = None,
) -> LevelLines:
    """Where the phase (rows, columns; see `phase.solve`) is `level` but for whole turns: 0, or 1/2 for lines between.

    Lines end at singularities, at the border of the grid, and beyond nodes where they are wanted (rows, columns).
    """
    rows = field.nodes.rows
    band_rows = max(BAND_ROWS, BAND_NODES // field.nodes.columns)
    cuts = list(range(0, rows - 1, band_rows))
    there = np.ones((rows, field.nodes.columns), np.uint8) if wanted is None else wanted.astype(np.uint8)
    found: dict[int, tuple[Plane, Ints, Ints]] = {}

    def band(low: int) -> None:
        found[low] = _band_lines(field, phase, level, there, low, min(low + band_rows, rows - 1))

    each(band, cuts)
    parts = [found.pop(low) for low in cuts]
    return _joined(parts, field.nodes.columns)


def _band_lines(
    field: Field, phase: Plane, level: float, wanted: npt.NDArray[np.uint8], low: int, high: int
) -> tuple[Plane, Ints, Ints]:
    """Points, first and ends (see the kernel) of the lines between two rows of nodes."""
    links = _levels.Band(field, phase, level, low, high)
    links.cross(wanted)
    (place, border), beside = links.places(), links.pairs()
    del links
    total = len(place)
    points = np.empty((total + total // 4 + 1, 2), np.float32)
    first, ends = np.empty(total // 2 + 2, np.int32), np.empty((total // 2 + 1, 2), np.int32)
    n = _levels.follow(beside, place, border, points, first, ends)
    return points[: first[n]].copy(), first[: n + 1].astype(np.int64), ends[:n].astype(np.int64)


def _joined(parts: list[tuple[Plane, Ints, Ints]], columns: int) -> LevelLines:
    """The lines of all bands, those that end on the row between two bands made one."""
    counts = np.array([len(first) - 1 for _, first, _ in parts])
    size = np.concatenate([np.diff(first) for _, first, _ in parts])
    points = np.concatenate([points for points, _, _ in parts])
    first = curves.starts(size)
    ends = np.concatenate([ends for _, _, ends in parts])
    parts.clear()
    ring = ends[:, 0] == -2
    # the last row of a band is the first one of the next: number rows through
    band = np.repeat(np.arange(len(counts)), counts)
    key = np.where(ends >= 0, ends + band[:, None] * (PER_LINK * columns), -1).ravel()
    order = np.argsort(key, kind="stable")
    order = order[key[order] >= 0]
    same = np.flatnonzero(key[order][1:] == key[order][:-1])
    if not len(same):
        return LevelLines(points, first, ring)
    partner = np.full(len(key), -1)
    partner[order[same]], partner[order[same + 1]] = order[same + 1], order[same]
    chains = _chains(partner.tolist())
    # lines that are joined come after all others; a point on the row between two bands is in both, and taken once
    whole = np.flatnonzero((partner.reshape(-1, 2) < 0).all(axis=1))
    links = np.array([end for chain, _ in chains for end in chain], np.int64)
    later = np.array([k > 0 for chain, _ in chains for k in range(len(chain))], np.int64)
    line, back = links >> 1, links & 1
    begin = np.where(back, first[line + 1] - 1 - later, first[line] + later)
    count = np.concatenate([size[whole], size[line] - later])
    out = np.empty((int(count.sum()), 2), np.float32)
    step = np.concatenate([np.ones(len(whole), np.int64), 1 - 2 * back])
    _levels.gather(points, np.concatenate([first[whole], begin]), count, step, out)
    chain_first = curves.starts(np.array([len(chain) for chain, _ in chains]))[:-1]
    sizes = np.concatenate([size[whole], np.add.reduceat(size[line] - later, chain_first)])
    closed = np.array([is_ring for _, is_ring in chains], bool)
    return LevelLines(out, curves.starts(sizes), np.concatenate([ring[whole], closed]))


def _chains(partner: list[int]) -> list[tuple[list[int], bool]]:
    """Runs of lines that are joined: of each line the end at which it is entered, and whether the run is a ring.

    partner: for each end (2 i, 2 i + 1 of line i) the end that it is joined to, or -1.
    """
    done = [False] * (len(partner) // 2)
    out = []
    for ring in (False, True):
        for start, other in enumerate(partner):
            if done[start >> 1] or partner[start ^ 1] < 0 or (other >= 0 and not ring):
                continue
            chain, end = [], start
            while end >= 0 and not done[end >> 1]:
                done[end >> 1] = True
                chain.append(end)
                end = partner[end ^ 1]
            out.append((chain, ring))
    return out
