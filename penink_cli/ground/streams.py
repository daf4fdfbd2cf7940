"""Inputs, outputs and signals: the one place where penink meets the operating system.

Inputs are named or standard input. An output with a name appears whole or not at all: it is
written to a temporary file beside its target, synced, and renamed. The temporary file is
locked while its writer lives, so that the next run can tell the remains of a killed one
(nothing can be cleaned up after SIGKILL) from the work of a neighbour, and remove them.

INT, TERM and HUP are waited for by a thread of its own (`install_signals`), which removes the
temporary files and lets the process die of the signal, at once, even while a compiled loop
runs in the main thread.
"""

from __future__ import annotations

import contextlib
import errno
import io
import os
import re
import select
import signal
import stat
import sys
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, BinaryIO, NoReturn, cast

from penink_cli.ground import changes
from penink_cli.ground.errors import StreamError, printable

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer, WriteableBuffer

STDIN, STDOUT = "<stdin>", "<stdout>"
BUFFER = 1 << 18

# Temporary files lie beside their target under a short name of their own: a name made from the
# target's could be longer than the file system allows.
_TEMPORARY = re.compile(r"\.penink-[0-9a-f]{16}\.tmp", re.ASCII)

_guard = threading.Lock()  # held while a temporary file comes into being, and for ever once a signal has come
_temporaries: set[str] = set()
_closed: set[int] = set()  # descriptors 0-2 that the caller had closed
_targets: dict[tuple[int, int], str] = {}  # device and inode of each file that this call replaces: its name


_bench: dict[str, bytes] | None = None  # files that are not on any disk, by their names: see `workbench`


def _why(error: OSError) -> str:
    return os.strerror(error.errno) if error.errno else str(error)


def source_name(path: str | None) -> str:
    """What error lines call this input: its path, or ``<stdin>``."""
    return STDIN if path is None or path == "-" else path


# ---------------------------------------------------------------------------- files between filters of one process


@contextmanager
def workbench(files: dict[str, bytes]) -> Iterator[dict[str, bytes]]:
    """While the block runs `reading` and `writing` take the names in this table for its entries, not for files.

    So filters can be run one after another in one process as in a pipe: nothing is left behind when it is killed, and
    no disk is too full. A name that is to be written is entered first, with anything.
    """
    global _bench  # noqa: PLW0603
    before, _bench = _bench, files
    try:
        yield files
    finally:
        _bench = before


def state(path: str | None) -> changes.State:
    """What tells whether an input has changed since."""
    if path is None or path == "-":
        return None
    return _bench[path] if _bench is not None and path in _bench else changes.of_file(path)


def on_bench(path: str | None) -> bool:
    """Whether this is the name of no file but of an entry of the workbench."""
    return _bench is not None and path in _bench


# ---------------------------------------------------------------------------- no output over an input


def keep_inputs(outputs: Iterable[str | None], inputs: Iterable[str | None]) -> None:
    """Refuse a call whose output is one of its inputs, under whatever name, link or redirection.

    Nothing has been opened yet. ``None`` and ``-`` are standard output and standard input. What else the call
    comes to read, such as the members that a manifest names, is refused by `reading`. Regular files alone can be
    overwritten: a terminal or ``/dev/null`` may be both.

    Raises StreamError, which names both.
    """
    _targets.clear()
    for path in outputs:
        status = _status(path, 1)
        if status is not None and stat.S_ISREG(status.st_mode):
            _targets[status.st_dev, status.st_ino] = STDOUT if path in (None, "-") else str(path)
    for path in inputs if _targets else ():
        status = _status(path, 0)
        if status is not None:
            _keep(status, source_name(path))


def _keep(status: os.stat_result, source: str) -> None:
    """Refuse an input that the call is to overwrite."""
    name = _targets.get((status.st_dev, status.st_ino))
    if name is not None:
        raise StreamError(f"is the same file as the input {printable(source)}, which it would overwrite", name)


def _status(path: str | None, standard: int) -> os.stat_result | None:
    """What a path, or a standard descriptor, leads to; None where that is nothing yet."""
    if on_bench(path):
        return None
    if path is None or path == "-":
        descriptor: int | None = standard
    else:
        descriptor = _own_descriptor(path)
    try:
        return os.stat(str(path)) if descriptor is None else os.fstat(descriptor)
    except (OSError, ValueError):
        return None


# ---------------------------------------------------------------------------- reading


class _Source(io.RawIOBase):
    """A descriptor whose read errors name the file, and which waits where O_NONBLOCK would give up."""

    def __init__(self, descriptor: int, source: str, owned: bool):
        self._descriptor, self._source, self._owned = descriptor, source, owned

    def readable(self) -> bool:
        return True

    def fileno(self) -> int:
        return self._descriptor

    def readinto(self, buffer: WriteableBuffer) -> int:
        while True:
            try:
                return os.readv(self._descriptor, [buffer])
            except BlockingIOError:
                select.select([self._descriptor], [], [])
            except OSError as error:
                raise StreamError(f"cannot be read: {_why(error)}", self._source) from error

    def close(self) -> None:
        if not self.closed and self._owned:
            os.close(self._descriptor)
        super().close()


@contextmanager
def reading(path: str | None) -> Iterator[BinaryIO]:
    """Open ``path`` (None or ``-``: standard input) for buffered binary reading.

    Raises StreamError, which names the file, when it cannot be opened or, later, read. The
    stream cannot seek, whatever it is: a filter reads its input once.
    """
    source = source_name(path)
    if path is not None and _bench is not None and path in _bench:
        changes.note(path, _bench[path])
        yield cast(BinaryIO, io.BytesIO(_bench[path]))
        return
    if path is None or path == "-":
        if _is_closed(0):
            raise StreamError("standard input is closed", source)
        raw = _Source(0, source, owned=False)
    else:
        try:
            raw = _Source(os.open(path, os.O_RDONLY | os.O_CLOEXEC | os.O_NOCTTY), source, owned=True)
        except (OSError, ValueError) as error:  # ValueError: a null character in the name
            why = _why(error) if isinstance(error, OSError) else str(error)
            changes.note(path, None)
            raise StreamError(why, source) from error
    with raw, io.BufferedReader(raw, BUFFER) as stream:
        status = os.fstat(raw.fileno())
        _keep(status, source)
        if source != STDIN:
            changes.note(source, changes.of_status(status))
        yield stream


# ---------------------------------------------------------------------------- writing


class Output:
    """Where a filter writes bytes: everything arrives or StreamError is raised, also on a non-blocking pipe."""

    def __init__(self, descriptor: int, source: str):
        self._descriptor, self._source = descriptor, source
        self._pending = bytearray()

    def write(self, data: ReadableBuffer) -> int:
        """Write all of a bytes-like object, C-contiguous where it is an array; its number of bytes."""
        view = memoryview(data)
        if not view.nbytes:
            return 0
        view = view.cast("B")
        if view.nbytes < BUFFER:
            self._pending += view
            if len(self._pending) >= BUFFER:
                self.flush()
        else:
            self.flush()
            self._deliver(view)
        return view.nbytes

    def flush(self) -> None:
        """Hand over what is buffered."""
        if self._pending:
            self._deliver(memoryview(self._pending))
            self._pending = bytearray()

    def _deliver(self, view: memoryview) -> None:
        while view.nbytes:
            try:
                view = view[os.write(self._descriptor, view) :]
            except BlockingIOError:
                select.select([], [self._descriptor], [])
            except OSError as error:
                raise self.failure(error) from error

    def failure(self, error: OSError) -> StreamError:
        """The error line for what went wrong with this output."""
        return StreamError(f"cannot be written: {_why(error)}", self._source)


class _Kept(Output):
    """An output that becomes an entry of the workbench."""

    def __init__(self, source: str):
        super().__init__(-1, source)
        self._parts: list[bytes] = []

    def _deliver(self, view: memoryview) -> None:
        self._parts.append(bytes(view))

    def whole(self) -> bytes:
        """All that was written."""
        self.flush()
        return b"".join(self._parts)


@contextmanager
def writing(path: str | None, binary: bool = True) -> Iterator[Output]:
    """An output for ``path`` (None or ``-``: standard output) that is complete once the block has ended.

    A regular file is replaced in one step at the end of the block, and stays as it was if the block
    raises, if the process is killed, or if any byte could not be stored. FIFOs and devices are written
    straight. Links are followed. A terminal is refused where ``binary``.

    Raises StreamError when the output cannot be opened, written, flushed or closed.
    """
    if path is not None and _bench is not None and path in _bench:
        kept = _Kept(path)
        yield kept
        _bench[path] = kept.whole()
        return
    descriptor = 1 if path is None or path == "-" else _own_descriptor(path)
    if descriptor is not None:
        yield from _straight(descriptor, STDOUT if descriptor == 1 else str(path), binary)
        return
    assert path is not None
    try:
        if not path or path.endswith("/"):
            raise StreamError(os.strerror(errno.EISDIR if path else errno.ENOENT), path or "''")
        target = os.path.realpath(path)
        try:
            status = os.stat(target)
        except FileNotFoundError:
            status = None
        if status is not None and stat.S_ISDIR(status.st_mode):
            raise StreamError(os.strerror(errno.EISDIR), path)
        if status is not None and not stat.S_ISREG(status.st_mode):
            opened = os.open(target, os.O_WRONLY | os.O_CLOEXEC | os.O_NOCTTY)
            try:
                yield from _straight(opened, path, binary)
            finally:
                os.close(opened)
            return
        # A rename would replace a file that its owner has made read-only.
        if status is not None and not os.access(target, os.W_OK, effective_ids=os.access in os.supports_effective_ids):
            raise StreamError(os.strerror(errno.EACCES), path)
    except StreamError:
        raise
    except (OSError, ValueError) as error:
        raise StreamError(_why(error) if isinstance(error, OSError) else str(error), path) from error
    yield from _replacing(target, path)


def _straight(descriptor: int, source: str, binary: bool) -> Iterator[Output]:
    """Write to a descriptor that is open already."""
    if _is_closed(descriptor):
        raise StreamError("standard output is closed" if descriptor == 1 else os.strerror(errno.EBADF), source)
    if binary and os.isatty(descriptor):
        raise StreamError("binary output is not written to a terminal: use -o FILE or redirect it", source)
    output = Output(descriptor, source)
    yield output
    output.flush()
    try:
        os.close(os.dup(descriptor))  # some file systems report only here that they had no room
    except OSError as error:
        raise output.failure(error) from error


def _replacing(target: str, source: str) -> Iterator[Output]:
    """Write a temporary file and let it take the place of the regular file ``target``."""
    directory = os.path.dirname(target)
    _sweep(directory)
    try:
        temporary, descriptor = _create(directory)
    except OSError as error:
        raise StreamError(f"cannot be written: {_why(error)}", source) from error
    try:
        output = Output(descriptor, source)
        yield output
        output.flush()
        try:
            _sync(descriptor)
            os.replace(temporary, target)
            _temporaries.discard(temporary)
            closing, descriptor = descriptor, -1
            os.close(closing)
            _sync_directory(directory)
        except OSError as error:
            raise output.failure(error) from error
    finally:
        if temporary in _temporaries:
            with contextlib.suppress(OSError):
                os.unlink(temporary)
            _temporaries.discard(temporary)
        if descriptor >= 0:
            os.close(descriptor)


def _create(directory: str) -> tuple[str, int]:
    """A new temporary file, locked, its mode by the umask as for any new file."""
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


def _sweep(directory: str) -> None:
    """Remove the temporary files in ``directory`` that no living process holds."""
    import fcntl

    with contextlib.suppress(OSError), os.scandir(directory) as entries:
        orphans = [entry.path for entry in entries if _TEMPORARY.fullmatch(entry.name)]
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


def _sync(descriptor: int) -> None:
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.ENOSYS, errno.ENOTSUP):  # nothing to sync there
            raise


def _sync_directory(directory: str) -> None:
    """Make the rename itself durable; the file is whole whether or not the directory can be synced."""
    with contextlib.suppress(OSError):
        descriptor = os.open(directory, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def _own_descriptor(path: str) -> int | None:
    """N for ``/dev/stdout``, ``/dev/fd/N`` and the like.

    They are written through the descriptor itself: a rename would replace the file that the shell
    has opened, and opening it again would lose its offset.
    """
    names = {"/dev/stdout": 1, "/dev/stderr": 2}
    if path in names:
        return names[path]
    match = re.fullmatch(r"(?:/dev/fd|/proc/self/fd)/([0-9]{1,9})", path, re.ASCII)
    return int(match[1]) if match else None


# ---------------------------------------------------------------------------- descriptors and signals


def _is_closed(descriptor: int) -> bool:
    if descriptor in _closed:
        return True
    try:
        os.fstat(descriptor)
    except OSError:
        return True
    return False


def install_signals() -> None:
    """Prepare the process: standard descriptors, SIGPIPE, and the thread that waits for INT, TERM and HUP.

    Called once, first thing, by the entry point. A signal that the caller has set to be ignored
    (``nohup``, a background job) stays ignored, except for SIGPIPE: a filter whose reader has gone
    has nothing left to do.
    """
    for descriptor in (0, 1, 2):
        # A closed one is taken by the next file opened: the edge list would be read as standard input.
        # Its place is held by one that fails just so.
        try:
            os.fstat(descriptor)
        except OSError:
            _closed.add(descriptor)
            os.open(os.devnull, os.O_RDONLY if descriptor else os.O_WRONLY)
            if descriptor == 1:
                sys.stdout = open(1, "w", encoding="utf-8", closefd=False)  # noqa: SIM115
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGPIPE})
    deadly = {s for s in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP) if signal.getsignal(s) != signal.SIG_IGN}
    if not deadly:
        return
    for number in deadly:
        signal.signal(number, signal.SIG_DFL)
    # Blocked in every thread to come, so that the waiting thread alone receives them.
    signal.pthread_sigmask(signal.SIG_BLOCK, deadly)
    try:
        threading.Thread(target=_await, args=(deadly,), daemon=True, name="signals").start()
    except RuntimeError:  # no thread to be had: they kill at once, and the next run removes what is left
        signal.pthread_sigmask(signal.SIG_UNBLOCK, deadly)


def _await(deadly: set[signal.Signals]) -> None:
    """Wait for a deadly signal, remove the temporary files, die of it."""
    number = signal.sigwait(deadly)
    _guard.acquire()  # and keep it: no temporary file comes into being any more
    for path in list(_temporaries):
        with contextlib.suppress(OSError):
            os.unlink(path)
    die_of(number)


def die_of(number: int) -> NoReturn:
    """End the process by a signal, as its parent expects of one that was told to stop."""
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {number})
    os.kill(os.getpid(), number)
    os._exit(128 + number)  # not reached: the disposition is the default one


def flush_text() -> None:
    """Deliver what help and listings have printed to standard output, and report what could not be."""
    if sys.stdout is None:
        return
    try:
        sys.stdout.flush()
    except OSError as error:
        raise text_failure(error) from error


def text_failure(error: OSError) -> StreamError:
    """The error line for text that standard output did not take."""
    # The interpreter would try again at its end, and complain in its own words.
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, 1)
    os.close(null)
    return StreamError(f"cannot be written: {_why(error)}", STDOUT)
