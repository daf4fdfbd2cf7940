"""A phase over the sheet whose level lines are pen lines: along a field of directions, as dense as is asked.

Where lines are to run along a field, their phase grows by their density (lines a point) along the field's normal. For
most fields no phase does so everywhere. Nor has a line a front: the normal may point either way from place to place. So
each node of a grid keeps its phase modulo a turn, and but for its sign, as a unit complex number. Each is made to agree
with its neighbours as well as all can, by nested iteration (after Knöppel, Crane, Pinkall and Schröder, Stripe
patterns on surfaces, 2015, who solve an eigenproblem instead). Where lines must begin or end to keep their density,
singularities are left, few and far apart.

Every level is settled in bands of rows, each with as many rows more on both sides as any node can be felt through
in its sweeps: the result depends on neither bands nor threads, and memory grows little with the sheet.

This module alone imports the compiled kernel `phase`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from penink_cli.blasting._compiled import phase as _phase
from penink_cli.ground.model import Floats

Plane: TypeAlias = npt.NDArray[np.float32]
#: Runs a function over each of some items, on threads or not.
Each: TypeAlias = Callable[[Callable[[int], None], Iterable[int]], None]

#: Sweeps over each of the coarser grids, and over the finest.
COARSE_SWEEPS, SWEEPS = 14, 12
#: Rows to a band, and how many nodes a grid may have to keep its finest links: they are most of the memory.
BAND, KEPT = 256, 1 << 20
#: What a link weighs that an edge crosses; one between normals at right angles; how much more one along the lines.
LEAK, LEAST, ALONG = 0.05, 0.15, 2.0


@dataclass(frozen=True)
class Nodes:
    """A grid over the sheet: the node in row j, column i is at (left + i dx, top + j dy), points."""

    left: float
    top: float
    dx: float
    dy: float
    rows: int
    columns: int


@dataclass(frozen=True, eq=False)
class Field:
    """Lines asked for at every node.

    nx, ny: (rows, columns) unit normal of the lines, either way. density: lines a point, above nought everywhere.
    """

    nodes: Nodes
    nx: Plane
    ny: Plane
    density: Plane


def one_by_one(work: Callable[[int], None], items: Iterable[int]) -> None:
    """Run work over items on this thread."""
    for item in items:
        work(item)


def solve(field: Field, walls: Floats | None, seed: int, each: Each = one_by_one) -> Plane:
    """The phase (rows, columns), in turns from -1/2 to 1/2, whose level lines lie as the field asks.

    walls: segments (m, 4), points, over which lines need not go on: there the phase may break.
    """
    nodes = field.nodes
    weak = np.zeros((nodes.rows, nodes.columns), np.uint8)
    if walls is not None and len(walls):
        at = (walls - np.array([nodes.left, nodes.top] * 2)) / np.array([nodes.dx, nodes.dy] * 2)
        _phase.weaken(np.ascontiguousarray(at), weak)

    rows, columns, wide = nodes.rows, nodes.columns, _phase.wide(nodes.columns)

    def made(low: int, out: Plane) -> Plane:
        row = np.empty((3, columns), np.float32)
        _phase.links(field.nx, field.ny, field.density, weak, nodes.dx, nodes.dy, LEAK, LEAST, ALONG, low, row, out)
        return out

    kept = np.empty((rows if rows * columns <= KEPT else 0, 12, wide), np.float32)

    def keep(low: int) -> None:
        made(low, kept[low : low + BAND])

    each(keep, range(0, len(kept), BAND))

    def links(low: int, high: int) -> Plane:
        return kept[low:high] if len(kept) else made(low, np.empty((high - low, 12, wide), np.float32))

    # coarser and coarser links; the finest are made anew for each band when it is their turn
    levels: list[tuple[int, Plane]] = []
    if min(rows, columns) > 4:
        levels.append(_halved(links, rows, columns, each))
        while min(levels[-1][0], len(levels[-1][1])) > 4:
            rows_there = len(levels[-1][1])
            levels.append(_halved(lambda low, high: levels[-1][1][low:high], rows_there, levels[-1][0], each))
    psi = np.zeros((0, 4, 0), np.float32)
    for k, (across, level) in reversed(list(enumerate(levels))):
        finer = np.empty((len(level), 4, level.shape[2]), np.float32)

        def band(
            low: int, level: Plane = level, finer: Plane = finer, psi: Plane = psi, k: int = k, across: int = across
        ) -> None:
            high, begin, end = _reach(low, len(level), COARSE_SWEEPS)
            room = np.zeros((end - begin + 2, 4, level.shape[2]), np.float32)
            out = finer[low:high]
            _phase.relax(level[begin:end], psi, begin, across, seed + k, COARSE_SWEEPS, room, low - begin, out)

        each(band, range(0, len(level), _even(len(level))))
        psi = finer
        levels.pop()
    phase = np.empty((rows, columns), np.float32)

    def finest(low: int) -> None:
        high, begin, end = _reach(low, rows, SWEEPS)
        out, room = np.empty((high - low, 4, wide), np.float32), np.zeros((end - begin + 2, 4, wide), np.float32)
        _phase.relax(links(begin, end), psi, begin, columns, seed, SWEEPS, room, low - begin, out)
        _phase.turns(out, np.empty((1, wide), np.float32), phase[low:high])

    each(finest, range(0, rows, _even(rows)))
    return phase


def _even(rows: int) -> int:
    """Rows to a band, an even number: as few bands as may be, each as long as the others, as threads like them."""
    bands = -(-rows // BAND)
    return 2 * -(-rows // (2 * bands))


def _reach(low: int, rows: int, sweeps: int) -> tuple[int, int, int]:
    """Where the band from row low ends, and the first and the end of the rows that are felt in it."""
    high = min(low + _even(rows), rows)
    margin = 2 * sweeps + 2
    return high, max(low - margin, 0), min(high + margin, rows)


def _halved(links: Callable[[int, int], Plane], rows: int, columns: int, each: Each) -> tuple[int, Plane]:
    """How many columns every second node of a grid makes, and links between these, made band by band.

    links: those of rows low … high of the grid itself.
    """
    across = (columns + 1) // 2
    out = np.empty(((rows + 1) // 2, 12, _phase.wide(across)), np.float32)

    def band(low: int) -> None:
        _phase.coarsen(links(low, min(low + BAND, rows)), low, across, out)

    each(band, range(0, rows, BAND))
    return across, out
