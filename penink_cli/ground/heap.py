"""How memory that is let go of is kept for what needs it next, where the C library is one that can be told (glibc).

A drawing makes hundreds of planes of some megabytes, one after the other. Left to itself the library hands each back
to the system, which clears every page of the next one: a quarter of the processor's time before hatching was that. And
it keeps what a thread has let go of for that thread alone: a tenth more memory.
"""

from __future__ import annotations

from contextlib import suppress

_TRIM_THRESHOLD, _MMAP_THRESHOLD, _ARENA_MAX = -1, -3, -8  # of malloc.h
_PLANE, _SPARE = 1 << 25, 1 << 26  # bytes: what is larger is handed back; so much at the most is kept and in no use


def share() -> None:
    """Let all threads allocate from one heap, which keeps planes that are let go of."""
    import ctypes  # numpy loads it too

    with suppress(AttributeError, OSError, TypeError):
        tell = ctypes.CDLL(None).mallopt
        tell(_ARENA_MAX, 1)
        tell(_MMAP_THRESHOLD, _PLANE)
        tell(_TRIM_THRESHOLD, _SPARE)
