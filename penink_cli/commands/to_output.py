"""Subcommands of the outputs that have no module here: each is made from its line in `outputs/registry.py`."""

from __future__ import annotations

import importlib
from typing import Any

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import TEXT, Finite, Length, output_options
from penink_cli.options.layers import (
    as_printed,
    colour_option,
    colours_of,
    files_argument,
    gain_option,
    page_options,
    read_layers,
)
from penink_cli.outputs.registry import OUTPUTS, Option


def subcommand(name: str) -> click.Command:
    """``penink NAME``: strokes files, each a layer, on a page."""
    kind = OUTPUTS[name]
    module = importlib.import_module(f"penink_cli.outputs.{name.removeprefix('to-').replace('-', '_')}")
    own: tuple[Option, ...] = getattr(module, "OPTIONS", ())

    def run(
        files: tuple[str, ...],
        paper: str | None,
        margin: float,
        landscape: bool,
        at: tuple[float, float] | None,
        colours: tuple[tuple[float, float, float], ...],
        device_dpi: float | None,
        output: str | None,
        **options: Any,
    ) -> None:
        from penink_cli.outputs.page import lay_out

        layers = as_printed(read_layers(files), device_dpi)
        page = lay_out(layers, paper, margin, landscape, at)
        with writing(output, binary=kind.binary) as out:
            told = {option.name: options[option.name] for option in own}
            module.write(out, layers, page, colours_of(layers, colours), **told)

    function: Any = run
    for decorate in (output_options, *map(_decorator, reversed(own)), gain_option, colour_option, page_options):
        function = decorate(function)
    return click.command(name=name, help=f"{kind.summary}\n{module.GUIDE}")(files_argument(function))


def _decorator(option: Option) -> Any:
    """The click option for an option of an output."""
    word = f"--{option.name.replace('_', '-')}"
    if option.default is False:
        return click.option(word, option.name, is_flag=True, help=option.help)
    kind: click.ParamType = Finite(option.least, option.most)
    if option.default == "":
        return click.option(word, option.name, type=TEXT, default="", metavar="TEXT", help=option.help)
    if option.choices:
        kind = click.Choice(option.choices)
    elif option.length:
        kind = Length(zero=option.least <= 0)
    return click.option(word, option.name, type=kind, default=option.default, show_default=True, help=option.help)
