# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""What one thread keeps at hand while it reconstructs one tile after the other."""

import cython
from cython.cimports.libc.stdlib import free, malloc, realloc
from cython.cimports.libc.string import memset

COMPILED = cython.compiled

NUMBER = cython.declare(cython.size_t, cython.sizeof(cython.double))  # room for one, in floats too
SPREAD = cython.declare(cython.size_t, 4 * cython.sizeof(cython.float))  # room for one that is in all lanes


@cython.final
@cython.cclass
class Desk:
    """Scratch of one thread, numbers in single or in double, aligned for the lanes they are computed in.

    bits: (256, 8) a byte as eight numbers, 0 or 1 for each bit.
    ux: (8,) the columns of pixels, relative to the cell and in units of the radius. uy: (8,) the rows, spread.
    kx: (2, 4, 8) weights of each column of samples at the columns of pixels, cubic and B-spline.
    ky: (2, 8, 4) those of each row of samples at the rows of pixels, spread.
    weights: (2, 16, 8, 8) the products of those, for each sample at each pixel; known_weights: the sets of samples for
    which they are filled in. They stay while the pixels stand alike in their cells.
    values: (16,) the samples. spread: (16,) those of them that are not seen by all, spread.
    distance: (16, 8, 8) of each pixel from the samples −1 … 2 down and across the cell, in units of the radius.
    known: the set of those that are filled in; they stay likewise.
    alpha: (16, 8, 8) attenuation of a sample at each pixel.
    nodes: (size, 8, 8) distance of each pixel from a node, FAR where it is hidden; node_mask: where it is seen.
    bend, bend_length: (size,) the nodes next to one sample, and how far it is to them, spread.
    shaded: for each row of pixels the set of samples that some of them do not see.
    faded: those of them whose attenuation is not zero throughout the row. A number that is *spread* is in all lanes.
    """

    def __init__(self, single: cython.bint):
        k: cython.int
        i: cython.int
        self.size = 32
        self.bits = malloc(256 * 8 * NUMBER)
        self.ux = malloc(8 * NUMBER)
        self.uy = malloc(8 * SPREAD)
        memset(self.ux, 0, 8 * NUMBER)
        memset(self.uy, 0, 8 * SPREAD)
        self.kx = malloc(2 * 4 * 8 * NUMBER)
        self.ky = malloc(2 * 8 * 4 * SPREAD)
        self.weights = malloc(2 * 16 * 64 * NUMBER)
        self.values = malloc(16 * NUMBER)
        memset(self.kx, 0, 2 * 4 * 8 * NUMBER)
        memset(self.ky, 0, 2 * 8 * 4 * SPREAD)
        self.spread = malloc(16 * SPREAD)
        self.distance = malloc(16 * 64 * NUMBER)
        self.alpha = malloc(16 * 64 * NUMBER)
        self.nodes = malloc(self.size * 64 * NUMBER)
        self.node_mask = cython.cast(cython.p_ulonglong, malloc(self.size * cython.sizeof(cython.ulonglong)))
        self.bend = cython.cast(cython.p_int, malloc(self.size * cython.sizeof(cython.int)))
        self.bend_length = malloc(self.size * SPREAD)
        for k in range(256):
            for i in range(8):
                if single:
                    cython.cast(cython.p_float, self.bits)[8 * k + i] = (k >> i) & 1
                else:
                    cython.cast(cython.p_double, self.bits)[8 * k + i] = (k >> i) & 1

    def __dealloc__(self):
        free(self.bits)
        free(self.ux)
        free(self.uy)
        free(self.kx)
        free(self.ky)
        free(self.weights)
        free(self.values)
        free(self.spread)
        free(self.distance)
        free(self.alpha)
        free(self.nodes)
        free(self.node_mask)
        free(self.bend)
        free(self.bend_length)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def another_node(self, seen: cython.ulonglong) -> cython.int:
        """Room for the distances to one more node, seen from some pixels; its place."""
        slot: cython.int = self.used
        if slot == self.size:
            self.size *= 2
            self.nodes = realloc(self.nodes, self.size * 64 * NUMBER)
            self.node_mask = cython.cast(
                cython.p_ulonglong, realloc(self.node_mask, self.size * cython.sizeof(cython.ulonglong))
            )
            self.bend = cython.cast(cython.p_int, realloc(self.bend, self.size * cython.sizeof(cython.int)))
            self.bend_length = realloc(self.bend_length, self.size * SPREAD)
        self.node_mask[slot] = seen
        self.used = slot + 1
        return slot
