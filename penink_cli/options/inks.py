"""The options of `separate` and `draw` that say which inks a picture is printed in, and each ink's plate."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

import click

from penink_cli.ground.codes import Colour, code_of
from penink_cli.ground.errors import in_quotes
from penink_cli.options.colours import COLOUR
from penink_cli.options.common import Finite, is_given

if TYPE_CHECKING:
    from penink_cli.ground.model import GreyImage

F = TypeVar("F", bound=Callable[..., Any])

LEAST_INKS, MOST_INKS = 2, 6
BLACK_SHARE = 0.8  # of the grey in a colour, that black ink prints


@dataclass(frozen=True)
class Inks:
    """The colours of inks on white paper, and their names."""

    colours: tuple[Colour, ...]
    names: tuple[str, ...]

    def number(self, plate: str) -> int:
        """The place, from 0, of an ink given by its name, its place from 1, or its colour. Raises UsageError."""
        if plate.lower() in self.names:
            return self.names.index(plate.lower())
        if plate.isascii() and plate.isdigit() and 1 <= int(plate[:3]) <= len(self.names):
            return int(plate) - 1
        known = ", ".join(self.names)
        try:
            return self.colours.index(COLOUR.convert(plate, None, None))
        except (click.UsageError, ValueError):
            wanted = f"the inks are {known}, or 1 to {len(self.names)}"
            raise click.UsageError(f"--plate {in_quotes(plate)}: {wanted}") from None


#: What inks of four-colour printing look like on white paper (coated, SWOP).
CMYK = Inks(
    (
        (0.0, 174 / 255, 239 / 255),
        (236 / 255, 0.0, 140 / 255),
        (1.0, 242 / 255, 0.0),
        (35 / 255, 31 / 255, 32 / 255),
    ),
    ("cyan", "magenta", "yellow", "black"),
)


class InkList(click.ParamType):
    """``cmyk``, or two to six colours."""

    name = "inks"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Inks:
        """The inks."""
        if isinstance(value, Inks):
            return value
        if value.lower() == "cmyk":
            return CMYK
        colours: tuple[Colour, ...] = tuple(COLOUR.convert(part.strip(), param, ctx) for part in value.split(","))
        if not LEAST_INKS <= len(colours) <= MOST_INKS or len(set(colours)) < len(colours):
            wanted = f"cmyk or {LEAST_INKS} to {MOST_INKS} colours, no two alike"
            self.fail(f"{in_quotes(value)} is not {wanted}", param, ctx)
        return Inks(colours, tuple(map(code_of, colours)))


inks_option = click.option(
    "--inks",
    type=InkList(),
    metavar="cmyk|COLOUR,…",
    help="Two to six transparent inks, by their colours on white paper: '#1b4f9c,#d2232a,#f2c300'.",
)


def inks_options(function: F) -> F:
    """--inks, --paper-color and --black."""
    for decorate in (
        click.option(
            "--black",
            type=Finite(0, 1),
            default=BLACK_SHARE,
            show_default=True,
            metavar="SHARE",
            help="Where one ink is black: the share of the grey in a colour that it prints.",
        ),
        click.option(
            "--paper-color",
            "--paper-colour",
            "paper_colour",
            type=COLOUR,
            default="white",
            show_default=True,
            metavar="COLOUR",
            help="Colour of the paper.",
        ),
        inks_option,
    ):
        function = decorate(function)
    return function


def refuse_without_plate() -> None:
    """Raise UsageError where an option is given that concerns plates only."""
    for name, word in (("inks", "inks"), ("paper_colour", "paper-color"), ("black", "black")):
        if is_given(name):
            raise click.UsageError(f"--{word} goes with --plate and --plates")


def separated(file: str | None, max_pixels: int, inks: Inks, paper: Colour, black: float) -> list[GreyImage]:
    """The plate of each ink: grey, white where there is no ink, black where it is solid."""
    from penink_cli.composition import separation
    from penink_cli.ground.model import GreyImage as Grey
    from penink_cli.options.photographs import read_colours

    photo = read_colours(file, max_pixels)
    return [
        Grey.from_grey(1.0 - amount)
        for amount in separation.amounts(photo.values, photo.maxval, inks.colours, paper, black)
    ]


def inverted(plate: GreyImage) -> GreyImage:
    """The plate that makes up this one to solid ink."""
    from penink_cli.ground.model import GreyImage as Grey

    return Grey(plate.maxval - plate.values, plate.maxval)
