cimport cython

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
    cdef bint sees(self, double px, double py, double qx, double qy) noexcept nogil
    cdef bint sees_vertex(self, double qx, double qy, int v) noexcept nogil
    cdef bint joined(self, int u, int v) noexcept nogil
    cdef bint obstructed(self, double px, double py, double qx, double qy, int u, int v) noexcept nogil
    cdef bint meets(self, int e, double px, double py, double qx, double qy, int u, int v) noexcept nogil
    cdef bint bends_for(self, int node, double qx, double qy) noexcept nogil
    cdef bint clear(self, double x0, double y0, double x1, double y1) noexcept nogil

@cython.final
cdef class Finder:
    cdef readonly Scene scene
    cdef int row0, row1
    cdef bint closed
    cdef double reach, radius, from_x, from_y
    cdef int* start
    cdef int* count
    cdef int* pool_node
    cdef double* pool_length
    cdef Py_ssize_t pool_used, pool_size
    cdef double* distance
    cdef int* stamp
    cdef int now
    cdef int* heap_node
    cdef double* heap_key
    cdef int heap_used, heap_size
    cdef int* done
    cdef int n_done
    cdef double* alpha
    cdef int alpha_size
    cdef void push(self, int node, double key) noexcept nogil
    cdef bint worth(self, double x, double y, double length) noexcept nogil
    cdef void first_bends(self, double qx, double qy, double reach) noexcept nogil
    cdef void spread(self, double reach) noexcept nogil
    cdef int bends_of(self, int i, int j) noexcept nogil
    cdef bint attenuate(self, double px, double py, int i0, int i1, int j0, int j1, double r) noexcept nogil
    cdef double last_leg(self, double qx, double qy, double limit) noexcept nogil
    cdef double length(self, double px, double py, double qx, double qy, double limit) noexcept nogil
