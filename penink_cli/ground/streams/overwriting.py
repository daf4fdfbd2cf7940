"""No output over an input of the same call."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable

from penink_cli.ground.errors import StreamError, printable
from penink_cli.ground.streams.bench import on_bench
from penink_cli.ground.streams.descriptors import STDOUT, own_descriptor, source_name

_targets: dict[tuple[int, int], str] = {}  # device and inode of each file that this call replaces: its name


def keep_inputs(outputs: Iterable[str | None], inputs: Iterable[str | None]) -> None:
    """Refuse a call whose output is one of its inputs, under whatever name, link or redirection.

    Nothing has been opened yet. ``None`` and ``-`` are standard output and standard input. Inputs that show up later,
    such as the members that a manifest names, are refused by `reading`. Regular files alone can be
    overwritten: a terminal or ``/dev/null`` may be both input and output.

    Raises StreamError, which names the output and the input.
    """
    _targets.clear()
    for path in outputs:
        status = _status(path, 1)
        if status is not None and stat.S_ISREG(status.st_mode):
            _targets[status.st_dev, status.st_ino] = STDOUT if path in (None, "-") else str(path)
    for path in inputs if _targets else ():
        status = _status(path, 0)
        if status is not None:
            keep(status, source_name(path))


def keep(status: os.stat_result, source: str) -> None:
    """Raise StreamError if an input, of that status and name, is a file that the call is to overwrite."""
    name = _targets.get((status.st_dev, status.st_ino))
    if name is not None:
        raise StreamError(f"is the same file as the input {printable(source)}, which it would overwrite", name)


def _status(path: str | None, standard: int) -> os.stat_result | None:
    """The status of what a path leads to, None for nothing. standard: the descriptor meant by None and ``-``."""
    if on_bench(path):
        return None
    if path is None or path == "-":
        descriptor: int | None = standard
    else:
        descriptor = own_descriptor(path)
    try:
        return os.stat(str(path)) if descriptor is None else os.fstat(descriptor)
    except (OSError, ValueError):
        return None
