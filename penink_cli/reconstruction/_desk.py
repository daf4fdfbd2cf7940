# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""What one thread keeps at hand while it reconstructs one tile after the other."""

import cython
from cython.cimports.libc.stdlib import free, malloc, realloc
from cython.cimports.libc.string import memcpy, memset
from cython.cimports.penink_cli.reconstruction._lanes import lanes_here

COMPILED = cython.compiled

NUMBER = cython.declare(cython.Py_ssize_t, cython.sizeof(cython.double))  # room for one, in floats too
LINE = cython.declare(cython.Py_ssize_t, 64)  # bytes of a cache line: no row of numbers lies across two
PARTS = cython.declare(cython.Py_ssize_t, 256 * 8 + 2 * 8 + 2 * 32 + 2 * 32 + 32 * 64 + 16 + 2 * 16 * 64)  # numbers


@cython.final
@cython.cclass
class Desk:
    """Scratch of one thread, numbers in single or in double, aligned for any lanes they are computed in.

    single: in floats rather than doubles. stored: the bytes of a number of output, eight where it is kept as it is.
    measure, cover, fade, paint: the arithmetic, see `_fades` and `_sums`, which furnish a desk with it.
    bits: (256, 8) a byte as eight numbers, 0 or 1 for each bit.
    ux, uy: (8,) the columns and rows of pixels, relative to the cell and in units of the radius.
    kx: (2, 4, 8) weights of each column of samples at the columns of pixels, cubic and B-spline.
    ky: (2, 8, 4) those of each row of samples at the rows of pixels.
    weights: (2, 16, 8, 8) the products of those, for each sample at each pixel; known_weights: the sets of samples for
    which they are filled in. They stay while the pixels stand alike in their cells.
    values: (16,) the samples.
    distance: (16, 8, 8) of each pixel from the samples −1 … 2 down and across the cell, in units of the radius.
    known: the set of those that are filled in; they stay likewise.
    alpha: (16, 8, 8) attenuation of a sample at each pixel.
    nodes: (size, 8, 8) distance of each pixel from a node, vast where it is hidden; node_mask: where it is seen.
    bend, bend_length: (size,) the nodes next to one sample, and how far it is to them, in units of the radius.
    shaded_rows: for each sample the set of rows in which some pixels do not see it, filled in by `cover` and `fade`.
    faded_rows: those of them in which its attenuation is not zero throughout.
    """

    def __init__(
        self,
        single: cython.bint,
        stored: cython.int = 8,
        radius: cython.double = 1.0,
        only_b: cython.bint = False,
        maxval: cython.double = 1.0,
    ):
        k: cython.int
        i: cython.int
        self.single = single
        self.stored = stored
        # As the numbers that are compared with it have been: see `enlarge`.
        self.radius = cython.cast(cython.float, radius) if single else radius
        self.only_b = only_b
        self.maxval = maxval
        self.room = malloc(PARTS * NUMBER + 16 * LINE)
        memset(self.room, 0, PARTS * NUMBER + 16 * LINE)
        self.free_place = aligned(self.room)
        self.bits = self.part(256 * 8)
        self.ux = self.part(8)
        self.uy = self.part(8)
        self.kx = self.part(2 * 4 * 8)
        self.ky = self.part(2 * 8 * 4)
        self.weights = self.part(2 * 16 * 64)
        self.values = self.part(16)
        self.distance = self.part(16 * 64)
        self.alpha = self.part(16 * 64)
        self.size = 32
        self.nodes_room = malloc(self.size * 64 * NUMBER + LINE)
        self.nodes = aligned(self.nodes_room)
        self.node_mask = cython.cast(cython.p_ulonglong, malloc(self.size * cython.sizeof(cython.ulonglong)))
        self.bend = cython.cast(cython.p_int, malloc(self.size * cython.sizeof(cython.int)))
        self.bend_length = cython.cast(cython.p_double, malloc(self.size * cython.sizeof(cython.double)))
        for k in range(256):
            for i in range(8):
                if single:
                    cython.cast(cython.p_float, self.bits)[8 * k + i] = (k >> i) & 1
                else:
                    cython.cast(cython.p_double, self.bits)[8 * k + i] = (k >> i) & 1

    def __dealloc__(self):
        free(self.room)
        free(self.nodes_room)
        free(self.node_mask)
        free(self.bend)
        free(self.bend_length)

    def rest(self):
        """Do no arithmetic from now on; so the benchmarks tell how long everything else takes."""
        self.measure = measure_nothing
        self.cover = cover_nothing
        self.fade = fade_nothing
        self.paint = paint_nothing

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def part(self, numbers: cython.Py_ssize_t) -> cython.p_void:
        """The next part of the room, for that many numbers."""
        at: cython.p_char = self.free_place
        self.free_place = cython.cast(cython.p_char, aligned(at + numbers * NUMBER))
        return at

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def another_node(self, seen: cython.ulonglong) -> cython.int:
        """Room for the distances to one more node, seen from some pixels; its place."""
        slot: cython.int = self.used
        larger: cython.p_void
        if slot == self.size:
            larger = malloc(2 * self.size * 64 * NUMBER + LINE)
            memcpy(aligned(larger), self.nodes, self.size * 64 * NUMBER)
            free(self.nodes_room)
            self.nodes_room = larger
            self.nodes = aligned(larger)
            self.size *= 2
            self.node_mask = cython.cast(
                cython.p_ulonglong, realloc(self.node_mask, self.size * cython.sizeof(cython.ulonglong))
            )
            self.bend = cython.cast(cython.p_int, realloc(self.bend, self.size * cython.sizeof(cython.int)))
            self.bend_length = cython.cast(
                cython.p_double, realloc(self.bend_length, self.size * cython.sizeof(cython.double))
            )
        self.node_mask[slot] = seen
        self.used = slot + 1
        return slot


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def aligned(place: cython.p_void) -> cython.p_char:
    """The first line of the cache at or after a place."""
    at: cython.size_t = cython.cast(cython.size_t, place)
    return cython.cast(cython.p_char, (at + LINE - 1) // LINE * LINE)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def measure_nothing(desk: Desk, slot: cython.int, ny: cython.int, x: cython.double, y: cython.double) -> cython.void:
    """For a desk at rest."""


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def cover_nothing(desk: Desk, s: cython.int, hidden: cython.ulonglong, nx: cython.int, ny: cython.int) -> cython.void:
    """For a desk at rest."""


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def fade_nothing(
    desk: Desk,
    s: cython.int,
    hidden: cython.ulonglong,
    bends: cython.int,
    ny: cython.int,
    down: cython.int,
    across: cython.int,
) -> cython.void:
    """For a desk at rest."""


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def paint_nothing(
    desk: Desk, samples: cython.int, nx: cython.int, ny: cython.int, out: cython.p_void, stride: cython.Py_ssize_t
) -> cython.void:
    """For a desk at rest."""


def lanes() -> int:
    """How many bytes of numbers side by side the processor this runs on is good at: 16, 32 or 64."""
    return lanes_here()
