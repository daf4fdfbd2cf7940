"""Temporary files, which lie beside their targets.

Each is locked while its writer lives. So the next run can tell the remains of a killed run, which it removes (nothing
cleans up after SIGKILL), from the work of a neighbour.
"""

from __future__ import annotations

import contextlib
import errno
import os
import re
import stat
import threading

# A short name of their own: a name made from the target's could be longer than the file system allows.
_NAME = re.compile(r"\.penink-[0-9a-f]{16}\.tmp", re.ASCII)

# Held while a temporary file comes into being or is renamed, and for ever once a signal has come: a thread that then
# waits for it dies of the signal, and does not complain of a file that is gone.
_guard = threading.Lock()
_temporaries: set[str] = set()


def create(directory: str) -> tuple[str, int]:
    """The path and descriptor of a new temporary file, locked, its mode by the umask as for any new file.

    Raises OSError.
    """
    import fcntl

    while True:
        path = os.path.join(directory, f".penink-{os.urandom(8).hex()}.tmp")
        with _guard:
            descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC | os.O_NOFOLLOW, 0o666)
            _temporaries.add(path)
        with contextlib.suppress(OSError):  # a file system without locks: then nothing is swept there either
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        # Between open and flock a neighbour's sweep may have taken the file for an orphan.
        if os.fstat(descriptor).st_nlink:
            return path, descriptor
        _temporaries.discard(path)
        os.close(descriptor)


def rename(path: str, target: str) -> None:
    """Let a temporary file take the place of its target."""
    with _guard:
        os.replace(path, target)
        _temporaries.discard(path)


def remove(path: str) -> None:
    """Remove a temporary file, unless it has been renamed."""
    if path in _temporaries:
        with contextlib.suppress(OSError):
            os.unlink(path)
        _temporaries.discard(path)


def remove_all() -> None:
    """Remove all temporary files of this process, which is about to die, and let none come into being any more."""
    _guard.acquire()  # and keep it
    for path in list(_temporaries):
        with contextlib.suppress(OSError):
            os.unlink(path)


def sweep(directory: str) -> None:
    """Remove the temporary files in ``directory`` that no living process holds."""
    import fcntl

    with contextlib.suppress(OSError), os.scandir(directory) as entries:
        orphans = [entry.path for entry in entries if _NAME.fullmatch(entry.name)]
        for path in orphans:
            with contextlib.suppress(OSError):
                descriptor = os.open(path, os.O_RDONLY | os.O_CLOEXEC | os.O_NOFOLLOW | os.O_NONBLOCK)
                try:
                    status = os.fstat(descriptor)
                    if stat.S_ISREG(status.st_mode) and status.st_uid == os.geteuid():
                        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
                        os.unlink(path)
                finally:
                    os.close(descriptor)


def sync(descriptor: int) -> None:
    """Have what was written stored, on file systems that know of storing. Raises OSError."""
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.ENOSYS, errno.ENOTSUP):  # nothing to sync there
            raise


def sync_directory(directory: str) -> None:
    """Make the rename itself durable, if the directory can be synced; the file is whole in any case."""
    with contextlib.suppress(OSError):
        descriptor = os.open(directory, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
