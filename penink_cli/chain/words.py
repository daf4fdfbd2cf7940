"""Options as the words that one would type: those of a style, for the filters of its stages, and those of a call."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from penink_cli.chain.filters import found
from penink_cli.ground.errors import FormatError
from penink_cli.options.common import NameOrFile

if TYPE_CHECKING:
    from penink_cli.formats.style import Style, Value

#: The stages of a style, and the filters of each.
FILTERS = {
    "compose": ("compose",),
    "edges": ("detect-edges",),
    "lines": ("detect-lines", "lines"),
    "directions": ("detect-directions",),
    "outline": ("outline",),
    "blast": ("blast",),
}
# Parameters of filters that belong to a call and not to a style.
_NOT_A_STYLE_S = {"output", "max_pixels", "quiet", "help", "threads", "verbose", "width", "dpi", "device_dpi", "maxval"}


def options_of(stage: str) -> dict[str, tuple[str, click.Option]]:
    """The options that a style may give a stage: by their names, the filter that has each, and the option."""
    known = {}
    for filter_name in FILTERS[stage]:
        for parameter in found(filter_name).params:
            if not isinstance(parameter, click.Option) or parameter.name in _NOT_A_STYLE_S or parameter.multiple:
                continue
            if isinstance(parameter.type, click.Path) and not isinstance(parameter.type, NameOrFile):
                continue
            for name in parameter.opts:  # without the names that turn a flag off
                if name.startswith("--"):
                    known[name.removeprefix("--")] = filter_name, parameter
    return known


def words(stage: str, filter_name: str, options: dict[str, Value]) -> list[str]:
    """The command-line words of those of a stage's options that this filter has."""
    known = options_of(stage)
    result = []
    for name, value in options.items():
        if known[name][0] != filter_name or value is False:
            continue
        result += [f"--{name}"] if value is True else [f"--{name}", said(value)]
    return result


def worded(option: str, value: Any) -> list[str]:
    """The words of an option whose value has been parsed already."""
    if value is True:
        return [f"--{option}"]
    if option == "mix":
        value = "auto" if value is None else ",".join(map(repr, value))
    elif option == "target":
        value = ",".join(f"{share!r}:{grey!r}" for share, grey in value)
    elif option == "at":
        value = ",".join(map(repr, value))
    elif option == "color":
        value = "#" + "".join(f"{round(255 * part):02x}" for part in value)
    return [f"--{option}", said(value)]


def said(value: Value) -> str:
    """A value as one would type it."""
    return value if isinstance(value, str) else repr(value)


def check(style: Style, source: str) -> None:
    """Raise FormatError for an option that no filter of its stage has, or a value that it does not take."""
    for stage, options in style.stages.items():
        known = options_of(stage)
        for name, value in options.items():
            if name not in known:
                raise FormatError(f"{stage}: no option {_quoted(name)}; known are {', '.join(sorted(known))}", source)
            option = known[name][1]
            if isinstance(value, bool) != option.is_flag:
                needed = "true or false" if option.is_flag else "a value"
                raise FormatError(f"{stage}: {name} is {_quoted(value)}; {needed} is needed", source)
            if not option.is_flag:
                try:
                    option.type.convert(said(value), option, None)
                except click.UsageError as error:
                    raise FormatError(f"{stage}: {name}: {error.message}", source) from None


def _quoted(value: object) -> str:
    from penink_cli.formats.strict_json import quoted

    return quoted(value)
