"""One photo drawn: its size on paper, then the filters in their order."""

from __future__ import annotations

import shlex
from collections.abc import Iterable
from functools import partial
from importlib import import_module

import click

from penink_cli.chain import finer_pens, found
from penink_cli.chain.filters import Chain
from penink_cli.chain.hatched import hatch, lines_drawn
from penink_cli.chain.job import Job
from penink_cli.chain.kept import Kept
from penink_cli.chain.plates import Plate, plates
from penink_cli.chain.request import Request
from penink_cli.ground import threads as threading
from penink_cli.ground.turns import together
from penink_cli.options.common import reporter
from penink_cli.options.photographs import photo_words, read_colours
from penink_cli.options.progress import progress
from penink_cli.options.sheet import check_sheet
from penink_cli.outputs.registry import of_illustrations, on_screen

USUAL_WIDTH = 432.0  # points
PRINTER_DPI = 600.0
#: What the filters of each stage load, and does not depend on the photo: a tenth of a second of the processor.
MODULES = {
    "compose": ("composition.compose", "arrangement.detection"),
    "lines": ("lines.detection",),
    "directions": ("directions.detection",),
    "blast": ("blasting.blast",),
}


def draw_one(
    request: Request, file: str | None, output: str | None, bench: dict[str, bytes], kept: Kept | None = None,
    quiet: bool = False,
) -> None:  # fmt: skip
    """Draw a photo (None: standard input) into a file (None: standard output).

    bench: the workbench. kept: what filters have made before, where `draw --watch` draws again. quiet: no progress bar.
    """
    options, given = request.options, request.given
    width, max_pixels = options["width"], options["max_pixels"]
    stages = request.stages()
    inks = options["inks"]
    steps = 9 if inks is None else 9 + 4 * len(inks.names)
    with progress(steps, "draw", quiet or options["quiet"]) as advance:
        shape = _shape(file, max_pixels, stages, threading.count(options["threads"]))
        rows, columns = shape[:2]
        if options["height"] is not None:
            width = options["height"] * columns / rows
        if width is None:
            width = min(USUAL_WIDTH, request.room(rows / columns))
        check_sheet(width, width * rows / columns, max_pixels)
        taken = (file, output, given.get("mask"), given.get("directions_file"), given.get("texture_name"))
        limit = max_pixels if "max_pixels" in given else None
        say = reporter(options["verbose"])
        chain = Chain(bench, taken, options["threads"], limit, say, lambda: advance(1), kept)
        if file is None:
            chain.from_standard_input("photo")
        device_dpi = given.get("device_dpi", None if on_screen(request.ending) else PRINTER_DPI)
        job = Job(chain, stages, given, width, rows / columns, request.ending, device_dpi, inks)
        _draw(job, file, shape, output, request.page)
    if kept is not None:
        kept.forget_others()


def _shape(file: str | None, max_pixels: int, stages: Iterable[str], threads: int) -> tuple[int, ...]:
    """Rows and columns of the photo, which is remembered; while it is decoded the filters are loaded."""
    context = click.get_current_context()

    def read() -> tuple[int, ...]:
        with context.scope(cleanup=False):  # it says how to read the photo, and is one thread's own
            return read_colours(file, max_pixels).values.shape

    def load() -> None:
        for stage in stages:
            for name in MODULES.get(stage, ()):
                import_module(f"penink_cli.{name}")

    return together(read, load, threads)[0]


def _draw(job: Job, file: str | None, shape: tuple[int, ...], output: str | None, page: list[str]) -> None:
    """The filters in their order. shape: rows and columns of the photo.

    Lines are found in the photo while edges are found in the grey: either takes a third of the time before hatching.
    """
    finer_pens.refine(job)
    photo = [*shlex.split(photo_words()), "-" if file is None else file]
    illustrated = of_illustrations(job.ending)
    composed, size = found.composed(job, photo, shape)
    edges, (lines, drawn) = job.chain.together(
        partial(found.edges, job, composed, size), partial(_lines, job, photo, found_alone=illustrated)
    )
    directions = found.directions(job, photo, edges, lines)
    if job.inks is None:
        of_each = [Plate(composed, size)]
    elif job.composes:
        of_each = plates(job, [composed], size)
    else:
        of_each = plates(job, photo, (shape[1], shape[0]))
    if illustrated:
        from penink_cli.chain.manifest import illustrate

        illustrate(job, of_each, size, edges, lines, directions, output, page)
        return
    hatch(job, of_each, size, edges, lines, drawn, directions, output, page)


def _lines(job: Job, photo: list[str], *, found_alone: bool) -> tuple[str | None, list[str]]:
    """The telling lines, if there are to be any, and their strokes."""
    lines = found.lines(job, photo)
    return lines, [] if found_alone or lines is None else [lines_drawn(job, lines)]
