# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The edges of a scene sorted into the unit cells that they touch, and those of crowded cells into finer ones."""

import cython
from cython.cimports.penink_cli.reconstruction._scene import CROWD, FINE, PAD, Scene, ints, span, within

COMPILED = cython.compiled


def sort_edges(scene: Scene) -> None:
    """Fill in the cells of a scene that has edges."""
    import numpy as np

    start = np.zeros(scene.gw * scene.gh + 1, np.intc)
    scene.cell_start = ints(start)
    entries = np.empty(max(1, bucket(scene)), np.intc)
    scene.cell_edge = ints(entries)
    fill_buckets(scene)
    scene.arrays += [start, entries]
    if scene.most >= CROWD:  # rare
        crowded = np.full(scene.gw * scene.gh, -1, np.intc)
        scene.crowded = ints(crowded)
        count_crowds(scene)
        fine_start = np.zeros(scene.n_crowded * FINE * FINE + 1, np.intc)
        scene.fine_start = ints(fine_start)
        fine_entries = np.empty(max(1, refine(scene, False)), np.intc)
        scene.fine_edge = ints(fine_entries)
        refine(scene, True)
        scene.arrays += [crowded, fine_start, fine_entries]


@cython.cfunc
def bucket(scene: Scene) -> cython.int:
    """Count the edges of each cell into cell_start, as running sums up to its end; how many entries there are."""
    e: cython.int
    k: cython.int
    total: cython.int = 0
    for e in range(scene.n_edges):
        enter(scene, e, False)
    for k in range(scene.gw * scene.gh + 1):
        total += scene.cell_start[k]
        scene.cell_start[k] = total
    return total


@cython.cfunc
def fill_buckets(scene: Scene) -> cython.void:
    """Enter each edge into its cells."""
    e: cython.int
    for e in range(scene.n_edges):
        enter(scene, e, True)


@cython.cfunc
@cython.exceptval(check=False)
def enter(scene: Scene, e: cython.int, fill: cython.bint) -> cython.void:
    """Count or enter one edge in the cells that it touches."""
    ax: cython.double = scene.vx[scene.ea[e]]
    ay: cython.double = scene.vy[scene.ea[e]]
    bx: cython.double = scene.vx[scene.eb[e]]
    by: cython.double = scene.vy[scene.eb[e]]
    y0: cython.double = (ay if ay < by else by) - PAD
    y1: cython.double = (by if ay < by else ay) + PAD
    left: cython.double = 0.0
    right: cython.double = 0.0
    row: cython.int
    k: cython.int
    if y1 < -1.0 or y0 > scene.height:
        return
    for row in range(scene.row_of(y0), scene.row_of(y1) + 1):
        span(ax, ay, bx, by, row - 1, cython.address(left), cython.address(right))
        if right < -1.0 or left > scene.width:
            continue
        for k in range(
            row * scene.gw + scene.column_of(left),
            row * scene.gw + scene.column_of(right) + 1,
        ):
            if fill:  # from the end of the cell down, so that its start is what is left
                scene.cell_start[k] -= 1
                scene.cell_edge[scene.cell_start[k]] = e
            else:
                scene.cell_start[k] += 1
                if scene.cell_start[k] > scene.most:
                    scene.most = scene.cell_start[k]


@cython.cfunc
def count_crowds(scene: Scene) -> cython.void:
    """Find the crowded cells, and say where the fine grid of each begins."""
    k: cython.int
    for k in range(scene.gw * scene.gh):
        if scene.cell_start[k + 1] - scene.cell_start[k] >= CROWD:
            scene.crowded[k] = scene.n_crowded * FINE * FINE
            scene.n_crowded += 1


@cython.cfunc
def refine(scene: Scene, fill: cython.bint) -> cython.int:
    """Count the edges of each fine cell as running sums, or enter them; how many entries there are."""
    cell: cython.int
    k: cython.int
    e: cython.int
    row: cython.int
    c: cython.int
    n: cython.int
    total: cython.int = 0
    left: cython.double = 0.0
    right: cython.double = 0.0
    ax: cython.double
    ay: cython.double
    bx: cython.double
    by: cython.double
    for cell in range(scene.gw * scene.gh):
        if scene.crowded[cell] < 0:
            continue
        for k in range(scene.cell_start[cell], scene.cell_start[cell + 1]):
            e = scene.cell_edge[k]
            ax = (scene.vx[scene.ea[e]] - (cell % scene.gw - 1)) * FINE
            ay = (scene.vy[scene.ea[e]] - (cell // scene.gw - 1)) * FINE
            bx = (scene.vx[scene.eb[e]] - (cell % scene.gw - 1)) * FINE
            by = (scene.vy[scene.eb[e]] - (cell // scene.gw - 1)) * FINE
            for row in range(
                within((ay if ay < by else by) - PAD, FINE), within((by if ay < by else ay) + PAD, FINE) + 1
            ):
                span(ax, ay, bx, by, row, cython.address(left), cython.address(right))
                if right < 0.0 or left > FINE:
                    continue
                for c in range(within(left, FINE), within(right, FINE) + 1):
                    n = scene.crowded[cell] + row * FINE + c
                    if fill:
                        scene.fine_edge[scene.fine_start[n]] = e
                    scene.fine_start[n] += 1
    n = scene.n_crowded * FINE * FINE
    if fill:
        for k in range(n, 0, -1):
            scene.fine_start[k] = scene.fine_start[k - 1]
        scene.fine_start[0] = 0
        return 0
    for k in range(n + 1):
        c = scene.fine_start[k]
        scene.fine_start[k] = total
        total += c
    return total
