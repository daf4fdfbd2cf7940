"""How memory that is let go of is kept for what needs it next, where the C library is one that can be told (glibc).

A drawing makes hundreds of planes of some megabytes, one after the other. Left to itself the library hands each back to
the system, which clears every page of the next one: a quarter of the processor's time before hatching was that. And it
keeps what a thread has let go of for that thread alone: a tenth more memory. Only `__main__` imports this module.
"""

cdef extern from *:
    """
    #include <stdlib.h>
    #ifdef __GLIBC__
    #include <malloc.h>
    #define PLANE (1 << 25) /* bytes: what is larger is handed back, and so is more than two that are in no use */
    static void share_heap(void) {
        mallopt(M_ARENA_MAX, 1);
        mallopt(M_MMAP_THRESHOLD, PLANE);
        mallopt(M_TRIM_THRESHOLD, 2 * PLANE);
    }
    #else
    static void share_heap(void) {}
    #endif
    """
    void share_heap()


def share() -> None:
    """Let all threads allocate from one heap, which keeps planes that are let go of. Before any thread begins."""
    share_heap()
