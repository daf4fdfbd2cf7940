"""Doing a thing again whenever one of the files that it has read changes."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import NoReturn

import click

from penink_cli.ground.changes import State, noting, of_file
from penink_cli.ground.errors import PeninkError, printable

LOOK = 0.03  # seconds between two looks at the files


def look() -> None:
    """Wait until it is time to look again."""
    time.sleep(LOOK)


def watch(do: Callable[[], object]) -> NoReturn:
    """Do it, and again after each change of the files that it reads, until a signal ends the process.

    A file that is being saved is left alone until two looks find it the same. An error of the first time is raised. A
    later one is a line, and the next change is waited for: the file may have been half written.
    """
    with noting() as read:
        do()
    files = _files(read)
    while True:
        _changed(files)
        with noting() as read:
            try:
                do()
            except PeninkError as error:
                context = click.get_current_context(silent=True)
                click.echo(f"{context.command_path if context else 'penink'}: {printable(str(error))}", err=True)
                files |= _files(read)  # the error may have come before all files were read
            else:
                files = _files(read)


def _files(read: dict[str, State]) -> dict[str, State]:
    """The files among what was read; the state of an entry of the workbench is its bytes."""
    return {path: state for path, state in read.items() if not isinstance(state, bytes)}


def _changed(files: dict[str, State]) -> None:
    """Wait until the files are not in these states, and are the same at two looks."""
    before = files
    while True:
        look()
        now = {path: of_file(path) for path in files}
        if now != files and now == before:
            return
        before = now
