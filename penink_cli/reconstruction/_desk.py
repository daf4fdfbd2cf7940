# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""What one thread keeps at hand while it reconstructs one tile after the other."""

import cython
from cython.cimports.libc.stdlib import free, malloc, realloc

COMPILED = cython.compiled


@cython.final
@cython.cclass
class Desk:
    """Scratch of one thread. Arrays of 64 hold one number a pixel of the tile, row by row."""

    def __init__(self):
        k: cython.int
        i: cython.int
        self.size = 32
        self.bits = cython.cast(cython.p_double, malloc(256 * 8 * cython.sizeof(cython.double)))
        self.bits_single = cython.cast(cython.p_float, malloc(256 * 8 * cython.sizeof(cython.float)))
        self.alpha = cython.cast(cython.p_double, malloc(16 * 64 * cython.sizeof(cython.double)))
        self.alpha_single = cython.cast(cython.p_float, self.alpha)
        self.nodes = cython.cast(cython.p_double, malloc(self.size * 64 * cython.sizeof(cython.double)))
        self.nodes_single = cython.cast(cython.p_float, self.nodes)
        self.node_mask = cython.cast(cython.p_ulonglong, malloc(self.size * cython.sizeof(cython.ulonglong)))
        for k in range(256):
            for i in range(8):
                self.bits[8 * k + i] = self.bits_single[8 * k + i] = (k >> i) & 1

    def __dealloc__(self):
        free(self.bits)
        free(self.bits_single)
        free(self.alpha)
        free(self.nodes)
        free(self.node_mask)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def another_node(self, seen: cython.ulonglong) -> cython.int:
        """Room for the distances to one more node, seen from some pixels; its place."""
        slot: cython.int = self.used
        if slot == self.size:
            self.size *= 2
            self.nodes = cython.cast(
                cython.p_double, realloc(self.nodes, self.size * 64 * cython.sizeof(cython.double))
            )
            self.nodes_single = cython.cast(cython.p_float, self.nodes)
            self.node_mask = cython.cast(
                cython.p_ulonglong, realloc(self.node_mask, self.size * cython.sizeof(cython.ulonglong))
            )
        self.node_mask[slot] = seen
        self.used = slot + 1
        return slot
