"""What a call of `draw` asks for, whatever the photo: options, style, and what each filter is told of these."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import click

from penink_cli.chain.filters import found
from penink_cli.chain.words import check, worded
from penink_cli.ground import streams
from penink_cli.options.styles import find_style
from penink_cli.outputs.registry import writer

if TYPE_CHECKING:
    from penink_cli.formats.style import Style, Value

OUTLINE_STRENGTH = 0.2  # the least grey step that is outlined where the style does not say
# Options of `draw` that one stage is told: the stage, and the option's name there.
_TOLD = {
    "texture_name": ("blast", "texture"),
    "gamma": ("blast", "gamma"),
    "seed": ("blast", "seed"),
    "strength": ("compose", "strength"),
    "detail": ("compose", "detail"),
    "mix": ("compose", "mix"),
    "target": ("compose", "target"),
    "vignette": ("compose", "vignette"),
}


@dataclass(frozen=True)
class Request:
    """One call of `draw`.

    options: all of the call, by their parameters' names; given: those of them that the user has named.
    ending: of what is written, `.ps`. page: words for the filter that writes it.
    """

    options: dict[str, Any]
    given: dict[str, Any]
    ending: str
    page: list[str]
    style: Style

    def read_anew(self) -> Request:
        """The same request, with the style as its file says now."""
        return replace(self, style=checked_style(self.options["style_name"]))

    def stages(self) -> dict[str, dict[str, Value]]:
        """The options of each stage: those of the style, or in their place those of the call. It is a new table."""
        given = self.given
        stages = {stage: dict(options) for stage, options in self.style.stages.items()}
        for name in ("outline", "lines"):
            wanted = given.get({"outline": "outlines"}.get(name, name))
            if wanted is False:
                stages.pop(name, None)
            elif wanted:
                stages.setdefault(name, {"min-strength": OUTLINE_STRENGTH} if name == "outline" else {})
        stages.setdefault("compose", {"strength": 0.0})
        asked = {"detail", "mix", "target"} & set(given)
        if "strength" not in given and asked and stages["compose"].get("strength") == 0:
            del stages["compose"]["strength"]  # a call with a target asks for composing
        stages.setdefault("blast", {})
        for name, (stage, option) in _TOLD.items():
            if name in given:
                stages[stage][option] = worded(option, given[name])[1]
        if "pen" in given:
            for stage in ("blast", "outline", "lines"):
                if stage in stages:
                    stages[stage]["pen"] = given["pen"]
            stages["blast"].pop("swell", None)
            if "lines" in stages:
                stages["lines"]["even"] = True
        return stages

    def room(self, aspect: float) -> float:
        """The widest, in points, that a picture of that aspect (height over width) can be on the paper given."""
        if "paper" not in self.given:
            return math.inf
        from penink_cli.outputs.page import turned_paper

        across, down = turned_paper(self.given["paper"], self.given.get("landscape", False))
        margin = self.given.get("margin", 0.0)
        left, top = self.given.get("at", (margin, margin))
        width, height = across - left - margin, down - top - margin
        # A sheet is whole pixels of grey high, half a point each. Where nothing fits, the page says so.
        room = math.floor(min(width, (height - 0.5) / aspect) * 100) / 100
        return room if room > 0 else math.inf


def checked_style(name: str) -> Style:
    """The style of that name or file; FormatError where it has an option that no filter takes."""
    style = find_style(name)
    check(style, name)
    return style


def page_words(ending: str, given: dict[str, Any]) -> list[str]:
    """Words that tell the filter that writes the picture about the page. Raises UsageError for an option it has not."""
    by = writer(ending)
    known = {parameter.name for parameter in found(by).params} if by else set()
    words: list[str] = []
    for name in ("paper", "margin", "landscape", "at", "colours", "order", "pens_file"):
        if name not in given:
            continue
        option = {"colours": "color", "pens_file": "pens"}.get(name, name)
        if name not in known:
            raise click.UsageError(f"--{option} is of no use for {ending}")
        for value in given[name] if name == "colours" else (given[name],):
            words += worded(option, value)
    return words


def pen_of_all(path: str) -> float | None:
    """The width, points, that all pens of a pens file have, None where widths differ."""
    from penink_cli.formats import pens

    with streams.reading(path) as stream:
        widths = {pen.width for pen in pens.read(stream, streams.source_name(path))}
    return widths.pop() if len(widths) == 1 else None
