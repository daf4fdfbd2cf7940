"""Writing: an output with a name appears whole or not at all."""

from __future__ import annotations

import errno
import os
import select
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from penink_cli.ground.errors import StreamError
from penink_cli.ground.streams import bench, temporary
from penink_cli.ground.streams.descriptors import STDOUT, is_closed, own_descriptor, why
from penink_cli.ground.streams.inputs import BUFFER

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer


class Output:
    """Where a filter writes bytes: everything arrives or StreamError is raised, also on a non-blocking pipe."""

    def __init__(self, descriptor: int, source: str):
        self._descriptor, self._source = descriptor, source
        self._pending = bytearray()

    def write(self, data: ReadableBuffer) -> int:
        """Write all of a bytes-like object, which is C-contiguous where it is an array; returns its number of bytes."""
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
        return StreamError(f"cannot be written: {why(error)}", self._source)


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
    if path is not None and bench.on_bench(path):
        kept = _Kept(path)
        yield kept
        bench.put(path, kept.whole())
        return
    descriptor = 1 if path is None or path == "-" else own_descriptor(path)
    if descriptor is not None:
        yield from _straight(descriptor, STDOUT if descriptor == 1 else str(path), binary)
        return
    assert path is not None
    try:
        target, opened = _prepared(path)
    except (OSError, ValueError) as error:  # ValueError: a null character in the name
        if isinstance(error, StreamError):
            raise
        raise StreamError(why(error) if isinstance(error, OSError) else str(error), path) from error
    if opened is None:
        yield from _replacing(target, path)
        return
    try:
        yield from _straight(opened, path, binary)
    finally:
        os.close(opened)


def _prepared(path: str) -> tuple[str, int | None]:
    """A path, its links followed, and a descriptor of what is there if that is no regular file, else None.

    Raises StreamError, OSError or ValueError where nothing can be written there.
    """
    if not path or path.endswith("/"):
        raise StreamError(os.strerror(errno.EISDIR if path else errno.ENOENT), path or "''")
    target = os.path.realpath(path)
    try:
        status = os.stat(target)
    except FileNotFoundError:
        return target, None
    if stat.S_ISDIR(status.st_mode):
        raise StreamError(os.strerror(errno.EISDIR), path)
    if not stat.S_ISREG(status.st_mode):
        return target, os.open(target, os.O_WRONLY | os.O_CLOEXEC | os.O_NOCTTY)
    # A rename would replace a file that its owner has made read-only.
    if not os.access(target, os.W_OK, effective_ids=os.access in os.supports_effective_ids):
        raise StreamError(os.strerror(errno.EACCES), path)
    return target, None


def _straight(descriptor: int, source: str, binary: bool) -> Iterator[Output]:
    """Write to a descriptor that is open already."""
    if is_closed(descriptor):
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
    temporary.sweep(directory)
    try:
        name, descriptor = temporary.create(directory)
    except OSError as error:
        raise StreamError(f"cannot be written: {why(error)}", source) from error
    try:
        output = Output(descriptor, source)
        yield output
        output.flush()
        try:
            temporary.sync(descriptor)
            temporary.rename(name, target)
            closing, descriptor = descriptor, -1
            os.close(closing)
            temporary.sync_directory(directory)
        except OSError as error:
            raise output.failure(error) from error
    finally:
        temporary.remove(name)
        if descriptor >= 0:
            os.close(descriptor)


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
    # The interpreter would try again at its end, and complain in its own words: it gets /dev/null to write to.
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, 1)
    os.close(null)
    return StreamError(f"cannot be written: {why(error)}", STDOUT)
