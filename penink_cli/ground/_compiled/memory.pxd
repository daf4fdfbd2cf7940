"""Room on the heap for kernels. Want of memory is a MemoryError, so that no result of malloc goes unchecked."""

from libc.stdlib cimport realloc


cdef extern from *:
    size_t SIZE_MAX


cdef inline void* room(size_t count, size_t each) except NULL nogil:
    """Room for `count` things of `each` bytes, or for one if there are none; `free` gives it back."""
    cdef void* place = NULL
    grow(&place, count, each)
    return place


cdef inline int grow(void** place, size_t count, size_t each) except -1 nogil:
    """Make room for `count` things at a place, and keep those that are there. After a MemoryError all is as before."""
    cdef void* larger = NULL
    if count == 0:
        count = 1
    if count <= SIZE_MAX // each:
        larger = realloc(place[0], count * each)
    if larger is NULL:
        with gil:
            raise MemoryError
    place[0] = larger
    return 0
