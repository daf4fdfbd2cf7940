cimport cython

cdef enum:
    CROWD = 48  # edges in one cell from which on it gets a grid of its own
    FINE = 32  # cells of that grid along a side
    BLOCK = 2  # nodes are sorted into blocks of 2² × 2² cells: fewer to pass over than cells

cdef double PAD  # cells are closed, and this much wider than that: rounding is far below it

cdef double* doubles(double[::1] array)
cdef int* ints(int[::1] array)
cdef void span(double ax, double ay, double bx, double by, int row, double* left, double* right) noexcept nogil
cdef int within(double x, int n) noexcept nogil
cdef int side_of_query(double ax, double ay, double bx, double by, double qx, double qy) noexcept nogil
cdef int side_of_vertex(double px, double py, double qx, double qy, double ax, double ay) noexcept nogil


@cython.final
cdef class Scene:
    cdef list arrays
    cdef readonly int width, height
    cdef readonly int n_edges, n_nodes, n_vertices
    cdef readonly double reach
    cdef double* vx
    cdef double* vy
    cdef int* ea
    cdef int* eb
    cdef int gw, gh
    cdef int* cell_start
    cdef int* cell_edge
    cdef int n_crowded, most
    cdef int* crowded
    cdef int* fine_start
    cdef int* fine_edge
    cdef int* star_start
    cdef int* star
    cdef int* node_vertex
    cdef int* node_low
    cdef int* node_high
    cdef int node_across
    cdef int* node_start
    cdef int* node_sorted
    cdef double* node_x
    cdef double* node_y
    cdef int* arc_start
    cdef int* arc_to
    cdef double* arc_length
    cdef int row_of(self, double y) noexcept nogil
    cdef int column_of(self, double x) noexcept nogil
    cdef bint empty_around(self, int column, int row) noexcept nogil
    cdef bint sees(self, double px, double py, double qx, double qy) noexcept nogil
    cdef bint sees_vertex(self, double qx, double qy, int v) noexcept nogil
    cdef bint joined(self, int u, int v) noexcept nogil
    cdef bint obstructed(self, double px, double py, double qx, double qy, int u, int v) noexcept nogil
    cdef bint obstructed_in_crowd(
        self, double px, double py, double qx, double qy, int u, int v, int row, int c0, int c1
    ) noexcept nogil
    cdef bint meets(self, int e, double px, double py, double qx, double qy, int u, int v) noexcept nogil
    cdef bint bends_for(self, int node, double qx, double qy) noexcept nogil
    cdef bint clear(self, double x0, double y0, double x1, double y1) noexcept nogil
