"""Many photographs in one call, each into a file of its own name in one folder."""

from __future__ import annotations

import os
from collections.abc import Sequence

import click

from penink_cli.chain.drawing import draw_one
from penink_cli.chain.filters import bench
from penink_cli.chain.request import Request
from penink_cli.ground.errors import PeninkError, StreamError, in_quotes
from penink_cli.options.progress import progress


def output_names(files: Sequence[str], folder: str, ending: str) -> list[str]:
    """The file into which each photo is drawn. The folder is made, if need be.

    Raises UsageError where two photos would become one file, StreamError where the folder cannot be made.
    """
    outputs: dict[str, str] = {}
    for file in files:
        output = os.path.join(folder, os.path.splitext(os.path.basename(file))[0] + ending)
        if output in outputs:
            raise click.UsageError(f"{in_quotes(outputs[output])} and {in_quotes(file)} would both become {output}")
        outputs[output] = file
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise StreamError(os.strerror(error.errno or 0), folder) from error
    return list(outputs)


def draw_all(request: Request, files: Sequence[str], outputs: Sequence[str]) -> None:
    """Draw each photo into its file. Raises PeninkError, after the last, which names those that could not be drawn."""
    failed = []
    with progress(len(files), "draw", request.options["quiet"]) as advance:
        for file, output in zip(files, outputs):
            try:
                with bench() as files_between:
                    draw_one(request, file, output, files_between, quiet=True)
            except (PeninkError, MemoryError) as error:
                why = str(error) if isinstance(error, PeninkError) else "not enough memory"
                failed.append(why if why.startswith(file) else f"{file}: {why}")
            advance(1)
    if failed:
        raise PeninkError(f"{len(failed)} of {len(files)} photos could not be drawn: {'; '.join(failed)}")
