"""--plates: all plates of several inks written in one call, each into a file of its own."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, TypeVar

import click

from penink_cli.ground import streams
from penink_cli.ground.errors import in_quotes
from penink_cli.options.common import OutputFile

F = TypeVar("F", bound=Callable[..., Any])

PLACE = "{}"


class PlateFiles(OutputFile):
    """A file name with ``{}`` where the number of a plate stands."""

    name = "pattern"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """The name as given."""
        if str(value).count(PLACE) != 1:
            self.fail(f"{in_quotes(str(value))} has no {PLACE} for the number, or several", param, ctx)
        return str(super().convert(value, param, ctx))


def plates_option(function: F) -> F:
    """--plates."""
    return click.option(
        "--plates",
        "pattern",
        type=PlateFiles(),
        metavar="NAME",
        help="Write all in one go, into files of that name with the plate's number, from 1, for {}.",
    )(function)


def names_of(pattern: str, count: int, output: str | None, inputs: Iterable[str | None]) -> list[str]:
    """The file of each of ``count`` plates.

    Raises UsageError where -o is given too, StreamError where one of the files is an input.
    """
    if output is not None:
        raise click.UsageError("--plates names the files, and -o has no use")
    names = [pattern.replace(PLACE, str(number)) for number in range(1, count + 1)]
    streams.keep_inputs(names, inputs)
    return names
