"""Files between filters of one process, which are on no disk."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from penink_cli.ground import changes

_bench: dict[str, bytes] | None = None


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
    """The state of an input now, by which a change is seen; None for standard input."""
    if path is None or path == "-":
        return None
    return _bench[path] if _bench is not None and path in _bench else changes.of_file(path)


def on_bench(path: str | None) -> bool:
    """Whether this is the name of no file but of an entry of the workbench."""
    return _bench is not None and path in _bench


def found(path: str | None) -> bytes | None:
    """The bytes of an entry of the workbench, None where it has none of that name."""
    return None if _bench is None or path is None else _bench.get(path)


def put(path: str, whole: bytes) -> None:
    """Let an entry of the workbench have these bytes."""
    assert _bench is not None
    _bench[path] = whole
