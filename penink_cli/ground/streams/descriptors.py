"""Descriptors that are open already: standard input and output, and the paths that name descriptors."""

from __future__ import annotations

import os
import re
import sys

STDIN, STDOUT = "<stdin>", "<stdout>"

_closed: set[int] = set()  # descriptors 0-2 that the caller had closed


def source_name(path: str | None) -> str:
    """What error lines call this input: its path, or ``<stdin>``."""
    return STDIN if path is None or path == "-" else path


def why(error: OSError) -> str:
    """What the system says of an error."""
    return os.strerror(error.errno) if error.errno else str(error)


def own_descriptor(path: str) -> int | None:
    """The descriptor N that ``/dev/stdout``, ``/dev/fd/N`` or the like names, None for any other path.

    Such a path is written through the descriptor itself: a rename would replace the file that the
    shell has opened, and opening the file again would lose its offset.
    """
    names = {"/dev/stdout": 1, "/dev/stderr": 2}
    if path in names:
        return names[path]
    match = re.fullmatch(r"(?:/dev/fd|/proc/self/fd)/([0-9]{1,9})", path, re.ASCII)
    return int(match[1]) if match else None


def hold_standard() -> None:
    """Fill the places of those of the descriptors 0 to 2 that the caller has closed.

    The next file opened would take such a place, and an edge list be read as standard input. The stand-in is
    ``/dev/null``, opened the other way round, so that reading or writing it fails as on a closed descriptor.
    """
    for descriptor in (0, 1, 2):
        try:
            os.fstat(descriptor)
        except OSError:
            _closed.add(descriptor)
            os.open(os.devnull, os.O_RDONLY if descriptor else os.O_WRONLY)
            if descriptor == 1:
                sys.stdout = open(1, "w", encoding="utf-8", closefd=False)  # noqa: SIM115


def is_closed(descriptor: int) -> bool:
    """Whether nothing is open there, or only the stand-in of `hold_standard`."""
    if descriptor in _closed:
        return True
    try:
        os.fstat(descriptor)
    except OSError:
        return True
    return False
