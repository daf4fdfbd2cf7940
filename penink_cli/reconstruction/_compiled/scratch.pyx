# cython: boundscheck=False, wraparound=False, cdivision=True
"""What one thread keeps at hand while it reconstructs one tile after the other."""

from libc.stdlib cimport free
from libc.string cimport memcpy, memset
from penink_cli.ground._compiled.memory cimport grow, room
from penink_cli.reconstruction._compiled.lanes cimport vector_bytes_here

cdef Py_ssize_t NUMBER = sizeof(double)  # room for one, in floats too
cdef Py_ssize_t LINE = 64  # bytes of a cache line: no row of numbers lies across two
cdef Py_ssize_t PARTS = 256 * 8 + 2 * 8 + 2 * 32 + 2 * 32 + 32 * 64 + 16 + 2 * 16 * 64  # numbers


cdef class Scratch:
    """Scratch of one thread, numbers in single or in double, aligned for any lanes they are computed in.

    single: in floats rather than doubles. stored: the bytes of a number of output, eight where it is kept as it is.
    measure, cover, fade, paint: the arithmetic, see `fades` and `sums`, which bind a scratch with it.
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

    def __init__(self, bint single, int stored=8, double radius=1.0, bint only_b=False, double maxval=1.0):
        cdef int k, i
        self.single = single
        self.stored = stored
        # As the numbers that are compared with it have been: see `enlarge`.
        self.radius = <float>radius if single else radius
        self.only_b = only_b
        self.maxval = maxval
        self.room = room(PARTS * NUMBER + 16 * LINE, 1)
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
        self.nodes_room = room(self.size * 64 * NUMBER + LINE, 1)
        self.nodes = aligned(self.nodes_room)
        self.node_mask = <unsigned long long*>room(self.size, sizeof(unsigned long long))
        self.bend = <int*>room(self.size, sizeof(int))
        self.bend_length = <double*>room(self.size, sizeof(double))
        for k in range(256):
            for i in range(8):
                if single:
                    (<float*>self.bits)[8 * k + i] = (k >> i) & 1
                else:
                    (<double*>self.bits)[8 * k + i] = (k >> i) & 1

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

    cdef void* part(self, Py_ssize_t numbers) noexcept nogil:
        """The next part of the room, for that many numbers."""
        cdef char* at = self.free_place
        self.free_place = <char*>aligned(at + numbers * NUMBER)
        return at

    cdef int another_node(self, unsigned long long seen) except -1 nogil:
        """Room for the distances to one more node, seen from some pixels; its place."""
        cdef void* larger
        cdef int slot = self.used
        if slot == self.size:
            grow(<void**>&self.node_mask, 2 * self.size, sizeof(unsigned long long))
            grow(<void**>&self.bend, 2 * self.size, sizeof(int))
            grow(<void**>&self.bend_length, 2 * self.size, sizeof(double))
            larger = room(2 * self.size * 64 * NUMBER + LINE, 1)
            memcpy(aligned(larger), self.nodes, self.size * 64 * NUMBER)
            free(self.nodes_room)
            self.nodes_room = larger
            self.nodes = aligned(larger)
            self.size *= 2
        self.node_mask[slot] = seen
        self.used = slot + 1
        return slot


cdef char* aligned(void* place) noexcept nogil:
    """The first line of the cache at or after a place."""
    cdef size_t at = <size_t>place
    return <char*>((at + LINE - 1) // LINE * LINE)


cdef void measure_nothing(Scratch scratch, int slot, int ny, double x, double y) noexcept nogil:
    """For benchmarks, which tell how long everything else takes."""


cdef void cover_nothing(Scratch scratch, int s, unsigned long long hidden, int nx, int ny) noexcept nogil:
    """For benchmarks, which tell how long everything else takes."""


cdef void fade_nothing(
    Scratch scratch, int s, unsigned long long hidden, int bends, int ny, int down, int across
) noexcept nogil:
    """For benchmarks, which tell how long everything else takes."""


cdef void paint_nothing(Scratch scratch, int samples, int nx, int ny, void* out, Py_ssize_t stride) noexcept nogil:
    """For benchmarks, which tell how long everything else takes."""


def lanes() -> int:
    """How many bytes of numbers side by side the processor this runs on is good at: 16, 32 or 64."""
    return vector_bytes_here()
