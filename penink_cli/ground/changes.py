"""States of inputs, by which a change is seen, and a note of every input that a part of the program has read."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

#: Device, inode, mode, size and time of a file, the bytes of a file on the workbench, or None where there is no file.
State = tuple[int, ...] | bytes | None

_noted: ContextVar[tuple[dict[str, State], ...]] = ContextVar("noted", default=())


@contextmanager
def noting() -> Iterator[dict[str, State]]:
    """The inputs that the block opens: their states at that moment, by their names; not those that others open."""
    read: dict[str, State] = {}
    before = _noted.set((*_noted.get(), read))
    try:
        yield read
    finally:
        _noted.reset(before)


def note(path: str, state: State) -> None:
    """Tell every block of `noting` that an input is opened, or could not be. The first state of a name is kept."""
    for read in _noted.get():
        read.setdefault(path, state)


def of_status(status: os.stat_result) -> State:
    """The state of a file by its status."""
    return status.st_dev, status.st_ino, status.st_mode, status.st_size, status.st_mtime_ns


def of_file(path: str) -> State:
    """The state of the file of that name, None where there is none."""
    try:
        return of_status(os.stat(path))
    except (OSError, ValueError):
        return None
