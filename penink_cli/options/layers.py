"""What the to-* subcommands share: strokes files as layers, the page, colours, the order for a pen."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

import click

from penink_cli.ground.errors import ParameterError
from penink_cli.ground.papers import paper_size
from penink_cli.ground.streams import reading, source_name
from penink_cli.ground.units import POINT_MM
from penink_cli.options.colours import COLOUR
from penink_cli.options.common import LENGTH, DeviceDpi, Finite, Length, Pair

if TYPE_CHECKING:  # numpy and what needs it are imported when there is work, not for a help text
    from penink_cli.ground.model import Strokes
    from penink_cli.travel.clock import Plotter

F = TypeVar("F", bound=Callable[..., Any])

class PaperName(click.ParamType):
    """The name of a paper, or its size."""

    name = "paper"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """The name as given, known to be one."""
        try:
            paper_size(value)
        except ParameterError as error:
            self.fail(error.message, param, ctx)
        return str(value)


#: A place on the paper, points.
PLACE = Pair(Length(zero=True), "a place such as 20mm,35mm")
files_argument = click.argument("files", nargs=-1, metavar="[FILE]...", type=click.Path(allow_dash=True))


def page_options(function: F) -> F:
    """--paper, --margin, --landscape and --at."""
    for decorate in (
        click.option(
            "--at",
            type=PLACE,
            metavar="X,Y",
            help="Put the picture's top-left corner there on the page: 20mm,35mm.  [default: in the middle]",
        ),
        click.option("--landscape", is_flag=True, help="Turn the paper's longer side across."),
        click.option(
            "--margin",
            type=Length(zero=True),
            default="0",
            metavar="LENGTH",
            help="Leave at least so much free around the picture: 10mm, 0.5in.  [default: 0]",
        ),
        click.option(
            "--paper",
            type=PaperName(),
            metavar="NAME|WxH",
            help="Put the picture in the middle of a4, letter … or 300x210mm.  [default: the picture's size]",
        ),
    ):
        function = decorate(function)
    return function


colour_option = click.option(
    "--color",
    "--colour",
    "colours",
    type=COLOUR,
    multiple=True,
    metavar="COLOUR",
    help="Colour of the ink, #rrggbb or a name; given again, of the next layer.  [default: as the file says, or black]",
)


class Gain(DeviceDpi):
    """Dots per inch of the printer as whose the strokes are drawn, 0 for ``none``."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """The resolution, 0 for ``none``."""
        return super().convert(value, param, ctx) or 0.0


def gain_option(function: F) -> F:
    """--device-dpi of outputs that do not widen strokes by themselves, as a printer does."""
    return click.option(
        "--device-dpi",
        type=Gain(),
        metavar="N|none",
        help="Draw the strokes as wide as a printer of N dots an inch paints them.  [default: the printer that the "
        "strokes are made for, as their file says; of to-pgm none]",
    )(function)


def travel_options(function: F) -> F:
    """--order, --join, --pen, and --speed, --travel-speed, --accel, --lift: the plotter whose time is estimated."""
    for decorate in (
        click.option(
            "--lift",
            type=Finite(0, 60),
            metavar="SECONDS",
            help="Time that the pen takes to be raised, and to be lowered: changes the time only.  [default: 0.12]",
        ),
        click.option(
            "--accel",
            type=LENGTH,
            metavar="LENGTH",
            help="Acceleration with the pen down, LENGTH a second each second; twice that with the pen up. Changes the "
            "time only.  [default: 200mm]",
        ),
        click.option(
            "--travel-speed",
            type=LENGTH,
            metavar="LENGTH",
            help="Length a second with the pen up: changes the time only.  [default: 200mm]",
        ),
        click.option(
            "--speed",
            type=LENGTH,
            metavar="LENGTH",
            help="Length a second with the pen down: changes the time only, which is told.  [default: 50mm]",
        ),
        click.option(
            "--pen",
            type=LENGTH,
            metavar="LENGTH",
            help="One pen of this width draws all: strokes become as wide, so that --join joins any that meet.",
        ),
        click.option(
            "--join",
            type=Length(zero=True),
            default="0.05",
            metavar="LENGTH",
            help="With --order: draw strokes of one width in one go if their ends are so near. Fewer lifts.  "
            "[default: 0.05pt]",
        ),
        click.option(
            "--order", is_flag=True, help="Order and turn the strokes so that a pen travels little: the order changes."
        ),
    ):
        function = decorate(function)
    return function


def plotter_of(
    speed: float | None, travel_speed: float | None, accel: float | None, lift: float | None
) -> Plotter:
    """The plotter whose time is estimated: an AxiDraw, with the values that are given.

    speed, travel_speed: points a second with the pen down and up. accel: points a second, each second. lift: seconds.
    """
    from penink_cli.travel.clock import Motion, Plotter

    usual = Plotter()
    down = Motion(
        speed * POINT_MM if speed else usual.down.speed,
        accel * POINT_MM if accel else usual.down.acceleration,
    )
    up = Motion(travel_speed * POINT_MM if travel_speed else usual.up.speed, 2 * down.acceleration, usual.up.corner)
    return Plotter(down, up, usual.lift if lift is None else lift)


def read_layers(files: Sequence[str]) -> list[Strokes]:
    """Strokes files as layers, the first at the bottom; no files mean standard input.

    Raises UsageError for standard input twice, FormatError and LimitError.
    """
    from penink_cli.formats import strokes

    paths = list(files) or ["-"]
    if paths.count("-") > 1:
        raise click.UsageError("standard input can be one layer only")
    layers = []
    for path in paths:
        with reading(path) as stream:
            layers.append(strokes.read(stream, source_name(path)))
    return layers


def as_printed(layers: Sequence[Strokes], device_dpi: float | None) -> list[Strokes]:
    """The layers with their strokes as wide as a printer paints them.

    device_dpi: of that printer, 0 for no printer; None for the one that each layer's file names.
    """
    from penink_cli.ground.device import widened

    printers = [layer.device_dpi if device_dpi is None else device_dpi for layer in layers]
    return [widened(layer, dpi) if dpi else layer for layer, dpi in zip(layers, printers)]


def colours_of(
    layers: Sequence[Strokes], chosen: Sequence[tuple[float, float, float]]
) -> list[tuple[float, float, float]]:
    """Red, green and blue of each layer's ink: as chosen, else as its file says, else black."""
    from penink_cli.ground.codes import of_code

    return [*chosen, *(of_code(layer.color or "#000000") for layer in layers[len(chosen) :])]


def for_a_pen(layers: Sequence[Strokes], join: float, quiet: bool, by_width: bool = False) -> list[Strokes]:
    """Each layer with its strokes in an order of little travel, those whose ends meet joined.

    join: ends so near, points, meet. by_width: order the strokes of each width by themselves, one width after another.
    """
    from penink_cli.ground.model import Strokes
    from penink_cli.options.progress import progress
    from penink_cli.travel.order import joined, ordered

    result = []
    with progress(2 * sum(map(len, layers)), "order", quiet) as advance:
        for layer in layers:
            widths = sorted(set(layer.widths.tolist())) if by_width else []
            parts = [layer.taken(layer.widths == width) for width in widths] or [layer]
            found = [joined(ordered(part, advance=advance), join) for part in parts]
            result.append(Strokes.joined(found) if len(found) > 1 else found[0])
    return [replace(one, layer=layer.layer, color=layer.color) for one, layer in zip(result, layers, strict=True)]


def travel_report(before: Sequence[Strokes], after: Sequence[Strokes], seconds: float) -> str:
    """A line for the user: drawn and travelled length, and the time.

    before: the layers as they were before they were ordered, or ``after`` where they were not. seconds: the time.
    """
    from penink_cli.travel.order import drawn_length, travel_length

    drawn = math.fsum(map(drawn_length, after)) * POINT_MM
    was, travelled = (math.fsum(map(travel_length, layers)) * POINT_MM for layers in (before, after))
    count = sum(map(len, after))
    line = f"{count} strokes: {drawn / 1000:.2f} m drawn, {travelled / 1000:.2f} m travelled with the pen up"
    if before is not after:
        line += f" ({was / 1000:.2f} m before)"
    whole = round(seconds)
    return f"{line}, {whole // 3600}:{whole // 60 % 60:02d}:{whole % 60:02d} on the plotter"
