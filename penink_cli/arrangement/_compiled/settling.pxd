cimport cython

from penink_cli.arrangement._compiled.place cimport Place
from penink_cli.arrangement._compiled.view cimport View


@cython.final
cdef class Settler(View):
    cdef double score, wanted, left_over
    cdef Place best, chosen, other
    cdef bint search(self) noexcept nogil
    cdef void consider(self, int rounds, int centre) noexcept nogil
    cdef void merge(self) noexcept nogil
    cdef void join(self) noexcept nogil
    cdef void bend(self) noexcept nogil
    cdef bint within(self, int e) noexcept nogil
    cdef void shrink(self, int a, int b) noexcept nogil
    cdef void meet(self, int v, int e) noexcept nogil
    cdef void bow(self, int e, double part) noexcept nogil
    cdef void drop(self) noexcept nogil
    cdef void link(self) noexcept nogil
    cdef double contrast(self, int u, int v) noexcept nogil
