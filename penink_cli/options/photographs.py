"""Photographs: the options that say how one is read, how many pixels it may have, and reading it."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import click

from penink_cli.ground import streams
from penink_cli.ground.errors import in_quotes
from penink_cli.options import remembered
from penink_cli.options.common import is_given, warn

if TYPE_CHECKING:
    from penink_cli.formats.photo.choices import Choices
    from penink_cli.ground.model import ColourImage, GreyImage, Strokes

F = TypeVar("F", bound=Callable[..., Any])

PHOTO_PIXELS = 250_000_000  # of a photograph and of samples as large: telephones take more than 100 megapixels
ALPHA = "alpha"
NAMED = {"white": (255, 255, 255), "black": (0, 0, 0), "grey": (128, 128, 128)}
_META = "penink.photo"  # where the context keeps the values of `photo_options`


class Background(click.ParamType):
    """``white``, ``#rrggbb`` or ``alpha``."""

    name = "COLOR|alpha"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[int, int, int] | str:
        """(red, green, blue), 0 … 255, or ALPHA."""
        if isinstance(value, tuple) or value == ALPHA:
            return value
        if value in NAMED:
            return NAMED[value]
        if re.fullmatch(r"#[0-9a-fA-F]{3}", value):
            value = "#" + "".join(2 * digit for digit in value[1:])
        if not re.fullmatch(r"#[0-9a-fA-F]{6}", value):
            self.fail(f"{in_quotes(value)} is no color such as white, black or #f0e0d0, nor alpha", param, ctx)
        return int(value[1:3], 16), int(value[3:5], 16), int(value[5:7], 16)


def _keep(ctx: click.Context, param: click.Parameter, value: Any) -> Any:
    """Keep an option's value in the context, for `photo_choices`."""
    ctx.meta.setdefault(_META, {})[param.name] = value
    return value


def photo_options(function: F) -> F:
    """--background, --profile, --strict, --lenient. The function receives none of them: `read_photo` looks them up."""
    for decorate in (
        click.option(
            "--lenient",
            is_flag=True,
            expose_value=False,
            callback=_keep,
            help="Read what is left of a damaged photograph.",
        ),
        click.option(
            "--strict",
            is_flag=True,
            expose_value=False,
            callback=_keep,
            help="Refuse a photograph whose file is not whole, even if all its pixels are.",
        ),
        click.option(
            "--profile",
            type=click.Choice(["apply", "ignore"]),
            default="apply",
            show_default=True,
            expose_value=False,
            callback=_keep,
            help="The photograph's color profile or gamma: follow it, or take its values for sRGB's.",
        ),
        click.option(
            "--background",
            type=Background(),
            default="white",
            show_default=True,
            expose_value=False,
            callback=_keep,
            help="What a transparent photograph lies on: white, black, #rrggbb; alpha draws its opacity instead.",
        ),
    ):
        function = decorate(function)
    return function


def photo_choices() -> Choices:
    """What the running command's `photo_options` say. Raises UsageError for --strict with --lenient."""
    from penink_cli.formats.photo.choices import Choices

    context = click.get_current_context(silent=True)
    given = context.meta.get(_META, {}) if context else {}
    if given.get("strict") and given.get("lenient"):
        raise click.UsageError("--strict and --lenient exclude each other")
    damage = "strict" if given.get("strict") else "lenient" if given.get("lenient") else ""
    return Choices(given.get("background", NAMED["white"]), given.get("profile") != "ignore", damage)


def photo_words() -> str:
    """The `photo_options` that are not at their defaults, as words for another filter; a blank before each."""
    choices = photo_choices()
    words = ""
    if choices.background == ALPHA:
        words += f" --background {ALPHA}"
    elif choices.background != NAMED["white"]:
        words += " --background " + shlex.quote("#" + "".join(f"{level:02x}" for level in choices.background))
    if not choices.profile:
        words += " --profile ignore"
    return words + (f" --{choices.damage}" if choices.damage else "")


def photo_limit(max_pixels: int) -> int:
    """The pixels that a photograph, or samples of its size, may have: --max-pixels if given, else PHOTO_PIXELS."""
    return max_pixels if is_given("max_pixels") else PHOTO_PIXELS


def read_photo(path: str | None, max_pixels: int) -> GreyImage:
    """The grey of a photograph, read as `photo_options` say. Raises FormatError and LimitError."""
    from penink_cli.formats import photo
    from penink_cli.ground.model import ColourImage

    known = remembered.known_photo(path)
    if known is not None:
        return photo.grey_of(known) if isinstance(known, ColourImage) else known
    with streams.reading(path) as stream:
        return photo.read_grey(stream, streams.source_name(path), photo_limit(max_pixels), photo_choices(), warn)


def read_colours(path: str | None, max_pixels: int) -> GreyImage | ColourImage:
    """A photograph in its colours, grey where it has none, read as `photo_options` say.

    Raises FormatError and LimitError.
    """
    from penink_cli.formats import photo

    def read() -> ColourImage | GreyImage:
        with streams.reading(path) as stream:
            return photo.read_colours(stream, streams.source_name(path), photo_limit(max_pixels), photo_choices(), warn)

    return read() if streams.on_bench(path) else remembered.photo(path, read)


def read_image_or_strokes(path: str | None, max_pixels: int) -> GreyImage | Strokes:
    """What a drawing is compared with: strokes, or the grey of a PGM image or a photograph.

    Raises FormatError and LimitError.
    """
    from penink_cli.formats import photo, strokes

    source = streams.source_name(path)
    with streams.reading(path) as stream:
        if stream.peek(1)[:1] == b"{":  # type: ignore[attr-defined]
            return strokes.read(stream, source)
        return photo.read_grey(stream, source, photo_limit(max_pixels), photo_choices(), warn)
