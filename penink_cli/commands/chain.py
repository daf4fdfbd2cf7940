"""Filters run one after another in one process, as in a pipe, and the command lines that do the same by hand.

`draw` is such a chain, and what --verbose prints of it is what has been run: the bytes are the same because nothing
else made them. What one filter hands to the next lies on a workbench, in no file.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import click

from penink_cli.ground import streams
from penink_cli.ground.changes import State, note, noting
from penink_cli.ground.errors import FormatError, PeninkError
from penink_cli.main import penink
from penink_cli.options.common import NameOrFile, warning_once

if TYPE_CHECKING:
    from penink_cli.formats.style import Style, Value

#: The filters of each stage that a style may tell something.
FILTERS = {
    "compose": ("compose",),
    "edges": ("detect-edges",),
    "lines": ("detect-lines", "lines"),
    "directions": ("detect-directions",),
    "outline": ("outline",),
    "blast": ("blast",),
}
# What belongs to one call and not to a style.
_NOT_A_STYLE_S = {"output", "max_pixels", "quiet", "help", "threads", "verbose", "width", "dpi", "device_dpi", "maxval"}


class Kept:
    """What filters have made of what: while that is the same, they need not run again."""

    def __init__(self) -> None:
        self._made: dict[tuple[str, ...], tuple[dict[str, State], bytes]] = {}
        self._used: set[tuple[str, ...]] = set()

    def made(self, call: tuple[str, ...]) -> bytes | None:
        """What a call made, if nothing that it read has changed."""
        read, result = self._made.get(call, ({}, None))
        if result is None or any(streams.state(path) != state for path, state in read.items()):
            return None
        for path, state in read.items():
            note(path, state)
        self._used.add(call)
        return result

    def keep(self, call: tuple[str, ...], read: dict[str, State], result: bytes) -> None:
        """Remember what a call has read and made."""
        self._made[call] = read, result
        self._used.add(call)

    def forget_others(self) -> None:
        """Forget what nobody has asked for since the last time."""
        self._made = {call: made for call, made in self._made.items() if call in self._used}
        self._used = set()


class Chain:
    """say: receives each command line, once it has run. step: is told after each filter. kept: from chains before."""

    def __init__(
        self, bench: dict[str, bytes], taken: Iterable[str | None], threads: int | None, max_pixels: int | None,
        say: Callable[[str], None], step: Callable[[], None], kept: Kept | None = None,
    ):  # fmt: skip
        self._bench, self._say, self._step, self._kept = bench, say, step, kept
        self._taken = {path for path in taken if path is not None}
        self._common = {"quiet": "--quiet"}
        if max_pixels is not None:
            self._common["max_pixels"] = f"--max-pixels={max_pixels}"
        if threads is not None:
            self._common["threads"] = f"--threads={threads}"

    def name(self, wanted: str) -> str:
        """A name on the bench that is none of the user's own files."""
        while wanted in self._taken:
            wanted = f"drawing-{wanted}"
        self._bench.setdefault(wanted, b"")
        return wanted

    def put(self, name: str, text: str) -> None:
        """A file that no filter has written."""
        self._bench[name] = text.encode()
        self._say(f"cat > {shlex.quote(name)} <<'END'\n{text}END")

    def run(self, filter_name: str, words: list[str], output: str | None, may_fail: bool = False) -> bool:
        """Run a filter; output: a name on the bench, or the user's, None for standard output. Whether all was well."""
        command = found(filter_name)
        known = {parameter.name for parameter in command.params}
        common = [word for parameter, word in self._common.items() if parameter in known]
        target = [] if output is None else ["-o", output]
        call = (filter_name, *words)
        made = self._kept.made(call) if self._kept and output in self._bench else None
        if made is not None:
            self._bench[str(output)] = made
        else:
            with noting() as read:
                try:
                    command.main([*common, *words, *target], prog_name=_program(), standalone_mode=False)
                except PeninkError:
                    if may_fail:
                        return False
                    raise
            if self._kept and output in self._bench:
                self._kept.keep(call, read, self._bench[str(output)])
        self._say(shlex.join(["penink", *call, *target]))
        self._step()
        return True

    def lines(self, name: str) -> int:
        """How many lines of text a file on the bench has: of strokes, one more than there are strokes."""
        return self._bench[name].count(b"\n")

    def joined(self, names: list[str], output: str | None) -> None:
        """The strokes of several files as one list; `draw` alone writes that."""
        from penink_cli.formats import strokes
        from penink_cli.ground.model import Strokes
        from penink_cli.options.layers import read_layers

        whole = Strokes.joined(read_layers(names))
        with streams.writing(output, binary=False) as out:
            strokes.write(out, whole)
        self._say(f"# the strokes of {' '.join(map(shlex.quote, names))} on one sheet")


def _program() -> str:
    """The command that warnings name."""
    context = click.get_current_context(silent=True)
    return context.command_path if context else "penink"


def found(filter_name: str) -> click.Command:
    """The subcommand of that name."""
    assert isinstance(penink, click.Group)
    command = penink.get_command(click.Context(penink), filter_name)
    assert command is not None, filter_name
    return command


@contextmanager
def bench() -> Iterator[dict[str, bytes]]:
    """A workbench, on which photographs are remembered too, and nothing is warned of twice."""
    from penink_cli.options.inputs import remembering_photos

    with streams.workbench({}) as files, remembering_photos(), warning_once():
        yield files


def options_of(stage: str) -> dict[str, tuple[str, click.Option]]:
    """The options that a style may give a stage: by their names, the filter that has each, and the option."""
    known = {}
    for filter_name in FILTERS[stage]:
        for parameter in found(filter_name).params:
            if not isinstance(parameter, click.Option) or parameter.name in _NOT_A_STYLE_S or parameter.multiple:
                continue
            if isinstance(parameter.type, click.Path) and not isinstance(parameter.type, NameOrFile):
                continue
            for name in parameter.opts:  # and not what turns it off
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
