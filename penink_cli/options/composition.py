"""How a photo is composed: the options that `compose` and `draw` share, and what their values mean."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, TypeVar

import click

from penink_cli.ground.errors import ParameterError, in_quotes
from penink_cli.options.common import Finite, Length, plain_number

F = TypeVar("F", bound=Callable[..., Any])


class Mix(click.ParamType):
    """``R,G,B``, weights that sum to 1, or ``auto``."""

    name = "R,G,B"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[float, float, float] | None:
        """The weights, None for ``auto``."""
        if value == "auto" or isinstance(value, tuple):
            return None if value == "auto" else value
        weights = [plain_number(part) for part in value.split(",")]
        if len(weights) != 3 or not all(-2 <= w <= 2 for w in weights) or abs(math.fsum(weights) - 1) > 0.005:
            self.fail(f"{in_quotes(value)} is neither auto nor weights that sum to 1, such as 0.3,0.6,0.1", param, ctx)
        return weights[0], weights[1], weights[2]


class Target(click.ParamType):
    """The name of a tone distribution, or its quantiles ``SHARE:GREY,…``."""

    name = "target"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[tuple[float, float], ...]:
        """The quantiles."""
        from penink_cli.composition.exposure import TARGETS, check_quantiles

        if isinstance(value, tuple):
            return value
        if value in TARGETS:
            return TARGETS[value]
        pairs = [tuple(map(plain_number, part.split(":"))) for part in value.split(",")]
        if not all(len(pair) == 2 and all(0 <= v <= 1 for v in pair) for pair in pairs):
            known = ", ".join(TARGETS)
            self.fail(f"{in_quotes(value)} is none of {known}, nor SHARE:GREY,… from 0:0 to 1:1", param, ctx)
        found = tuple((pair[0], pair[1]) for pair in pairs)
        try:
            check_quantiles(found)
        except ParameterError as error:
            self.fail(error.message, param, ctx)
        return found


def composition_options(function: F) -> F:
    """--strength, --detail, --mix, --target, --mask and --vignette, of `compose` and `draw`."""
    for decorate in (
        click.option(
            "--vignette",
            type=Length(zero=True),
            metavar="LENGTH",
            help="Fade out over this length within the border of the mask, or of an oval where there is no mask.",
        ),
        click.option(
            "--mask",
            type=click.Path(allow_dash=True),
            metavar="FILE",
            help="A picture of the photo's size, white where the photo is drawn; elsewhere the paper stays white.",
        ),
        click.option(
            "--target",
            type=Target(),
            default="house",
            show_default=True,
            metavar="NAME|S:G,…",
            help="How light the drawing is to be: house, high-key or spot, or quantiles SHARE:GREY,… from 0:0 to 1:1.",
        ),
        click.option(
            "--mix",
            type=Mix(),
            default="auto",
            show_default=True,
            metavar="R,G,B",
            help="Weights of red, green and blue in the grey; auto keeps most contrast.",
        ),
        click.option(
            "--detail",
            type=Finite(0, 10),
            default=1.8,
            show_default=True,
            metavar="G",
            help="How many times detail is raised; 1 leaves it as it is.",
        ),
        click.option(
            "--strength",
            type=Finite(0, 1),
            default=0.6,
            show_default=True,
            metavar="0…1",
            help="How far tones are moved from the photo's; 0 is the photo's luma as stored.",
        ),
    ):
        function = decorate(function)
    return function
