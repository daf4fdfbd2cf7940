"""The outputs: what `draw` writes, by the ending of -o, and the subcommands that write the same.

One line of `OUTPUTS` and one module, `outputs/NAME.py` for `to-NAME`, make an output. The module has

    GUIDE: what the help text says after its first line, with an example
    OPTIONS: options of its own (`Option`), a tuple that may be missing
    write(out, layers, page, colours, **options): writes the layers, the first at the bottom, on a `Page`

The subcommand, its man page and completion, `draw`'s endings, the README's table and the tests that run over all
subcommands follow from the line. An output that reads or writes in another way is a subcommand of its own instead,
`commands/to_name.py`, and its line is marked `own`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Medium:
    """What there is to know of an output before its module is loaded.

    endings: of the files that it writes, with spaces between them. summary: first line of the subcommand's help.
    reads: "strokes", each file a layer, or "illustration". own: the subcommand is a module of `penink_cli.commands`.
    binary: not to be written to a terminal. screen: mostly looked at on a screen, and not printed.
    """

    endings: str
    summary: str
    reads: str = "strokes"
    own: bool = False
    binary: bool = False
    screen: bool = False


@dataclass(frozen=True)
class Option:
    """An option of one output, which its `write` takes by the same name.

    default: False for a flag, a number, one of the choices, or an empty text for any text. least, most: of a number.
    length: the number is a length in points, which may be given in other units.
    """

    name: str
    help: str
    default: bool | float | str
    choices: tuple[str, ...] = ()
    least: float = -math.inf
    most: float = math.inf
    length: bool = False


OUTPUTS = {
    "pack": Medium(".penink", "Pack an illustration and its members in one small file.", "illustration", own=True),
    "to-html": Medium(".html", "Write an illustration as one web page that draws itself.", "illustration", own=True),
    "to-ps": Medium(".ps .eps", "Write strokes as PostScript.", own=True),
    "to-svg": Medium(".svg", "Write strokes as SVG, for drawing programs, the web, plotters.", own=True, screen=True),
    "to-pdf": Medium(".pdf", "Write strokes as a PDF page of vector paths.", binary=True),
    "to-png": Medium(".png", "Draw strokes into a PNG image, by the area that ink covers.", own=True, screen=True),
    "to-pgm": Medium(".pgm", "Draw strokes into a grey image, by the area that ink covers.", own=True, screen=True),
}

STROKES = ".jsonl"  # the strokes themselves, which no output writes
_BY_ENDING = {ending: name for name, output in OUTPUTS.items() for ending in output.endings.split()}


def endings() -> list[str]:
    """All endings that a drawing may have; those of illustrations come last."""
    return sorted([STROKES, *_BY_ENDING], key=of_illustrations)


def writer(ending: str) -> str | None:
    """The subcommand that writes files of that ending; None for strokes."""
    return _BY_ENDING.get(ending)


def of_illustrations(ending: str) -> bool:
    """Whether such a file is made of an illustration, and not of strokes."""
    return ending in _BY_ENDING and OUTPUTS[_BY_ENDING[ending]].reads == "illustration"


def on_screen(ending: str) -> bool:
    """Whether such a file is mostly looked at on a screen, where no printer widens the strokes."""
    return ending in _BY_ENDING and OUTPUTS[_BY_ENDING[ending]].screen
