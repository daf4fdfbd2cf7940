"""Reading: a name, or standard input."""

from __future__ import annotations

import io
import os
import select
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, BinaryIO, cast

from penink_cli.ground import changes
from penink_cli.ground.errors import StreamError
from penink_cli.ground.streams import bench
from penink_cli.ground.streams.descriptors import STDIN, is_closed, source_name, why
from penink_cli.ground.streams.overwriting import keep

if TYPE_CHECKING:
    from _typeshed import WriteableBuffer


BUFFER = 1 << 18


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
                raise StreamError(f"cannot be read: {why(error)}", self._source) from error

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
    if path is not None and (whole := bench.found(path)) is not None:
        changes.note(path, whole)
        yield cast(BinaryIO, io.BytesIO(whole))
        return
    if path is None or path == "-":
        if is_closed(0):
            raise StreamError("standard input is closed", source)
        raw = _Source(0, source, owned=False)
    else:
        try:
            raw = _Source(os.open(path, os.O_RDONLY | os.O_CLOEXEC | os.O_NOCTTY), source, owned=True)
        except (OSError, ValueError) as error:  # ValueError: a null character in the name
            reason = why(error) if isinstance(error, OSError) else str(error)
            changes.note(path, changes.of_file(path))  # it may be there, and only not be read
            raise StreamError(reason, source) from error
    with raw, io.BufferedReader(raw, BUFFER) as stream:
        status = os.fstat(raw.fileno())
        keep(status, source)
        if source != STDIN:
            changes.note(source, changes.of_status(status))
        yield stream
