"""Filters run one after another in one process, as in a pipe, and the command lines that do the same by hand.

`draw` is such a chain. What --verbose prints is what has been run, so the same commands by hand make the same bytes.
A workbench holds what one filter hands to the next; there are no files between them.
"""

from __future__ import annotations

import io
import shlex
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager

import click

from penink_cli.chain.kept import Kept
from penink_cli.ground import streams
from penink_cli.ground import threads as threading
from penink_cli.ground.changes import noting
from penink_cli.ground.errors import PeninkError
from penink_cli.ground.turns import First, Second, in_turn, together
from penink_cli.main import penink
from penink_cli.options.common import warning_once
from penink_cli.options.plates import PLACE


class Chain:
    """One chain.

    bench: the workbench. taken: names of the user's own files, which the chain gives to nothing. threads, max_pixels:
    for every filter that has such an option, None for its default. say: receives each command line, once it has run.
    step: is told after each filter. kept: what filters of former chains have made, None for nothing.
    """

    def __init__(
        self, bench: dict[str, bytes], taken: Iterable[str | None], threads: int | None, max_pixels: int | None,
        say: Callable[[str], None], step: Callable[[], None], kept: Kept | None = None,
    ):  # fmt: skip
        self._bench, self._say, self._step, self._kept = bench, say, step, kept
        self._threads = threading.count(threads)
        self._program = _program()  # a thread that runs filters has no context to ask
        self._taken = {path for path in taken if path is not None}
        self._standard_input = "-"
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

    def from_standard_input(self, wanted: str) -> None:
        """Let `-` in printed command lines be a file: several filters read it, but standard input can be read once."""
        self._standard_input = self.name(wanted)
        self._say(f"cat > {shlex.quote(self._standard_input)}")

    def put(self, name: str, text: str) -> None:
        """Put a file on the bench that no filter has written."""
        self._bench[name] = text.encode()
        self._say(f"cat > {shlex.quote(name)} <<'END'\n{text}END")

    def run(self, filter_name: str, words: list[str], output: str | None, may_fail: bool = False) -> bool:
        """Run a filter; whether it succeeded.

        output: a name on the bench or of the user's, None for standard output. may_fail: a PeninkError is no error.
        """
        target = [] if output is None else ["-o", output]
        return self._ran(filter_name, words, target, [output], may_fail)

    def run_plates(self, filter_name: str, words: list[str], pattern: str, count: int) -> list[str]:
        """Run a filter that writes so many plates; the names of these: the pattern with 1 and so on in place of {}."""
        while any(pattern.replace(PLACE, str(i + 1)) in self._taken for i in range(count)):
            pattern = f"drawing-{pattern}"
        outputs = [self.name(pattern.replace(PLACE, str(i + 1))) for i in range(count)]
        self._ran(filter_name, words, ["--plates", pattern], outputs, may_fail=False)
        return outputs

    def _ran(
        self, filter_name: str, words: list[str], target: list[str], outputs: Sequence[str | None], may_fail: bool
    ) -> bool:
        command = found(filter_name)
        known = {parameter.name for parameter in command.params}
        common = [word for parameter, word in self._common.items() if parameter in known]
        call = (filter_name, *words)
        names = [output for output in outputs if output is not None and output in self._bench]
        kept = self._kept if len(names) == len(outputs) else None
        made = [one for name in names if kept and (one := kept.made((*call, name))) is not None]
        if kept and len(made) == len(names):
            self._bench.update(zip(names, made, strict=True))
        else:
            with noting() as read:
                try:
                    command.main([*common, *words, *target], prog_name=self._program, standalone_mode=False)
                except PeninkError:
                    if may_fail:
                        return False
                    raise
            if kept:
                for name in names:
                    kept.keep((*call, name), read, self._bench[name])
        by_hand = (self._standard_input if word == "-" else word for word in call)
        self._say(shlex.join(["penink", *by_hand, *target]))
        in_turn(self._step)
        return True

    def together(self, first: Callable[[], First], second: Callable[[], Second]) -> tuple[First, Second]:
        """Run filters that need nothing of each other at the same time; all looks as if it were one after the other."""
        return together(first, second, self._threads)

    def lines(self, name: str) -> int:
        """How many lines of text a file on the bench has: a file of strokes has one more than it has strokes."""
        return self._bench[name].count(b"\n")

    def joined(self, names: list[str], output: str | None) -> None:
        """Write the strokes of several files as one list, which no filter does."""
        import numpy as np

        from penink_cli.formats import strokes
        from penink_cli.ground.model import Strokes
        from penink_cli.options.layers import read_layers

        whole = Strokes.joined(read_layers(names))
        with streams.writing(output, binary=False) as out:
            strokes.write(out, whole)
        head = io.BytesIO()
        strokes.write(head, whole.taken(np.zeros(0, np.int64)))
        files = " ".join(map(shlex.quote, names))
        target = "" if output is None else f" > {shlex.quote(output)}"
        self._say(f"{{ echo {shlex.quote(head.getvalue().decode().rstrip())}; tail -q -n +2 {files}; }}{target}")


def _program() -> str:
    """The command that warnings name: the one that the user has called."""
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
    """A workbench. While it is there, inputs that were read are remembered, and no warning is given twice."""
    from penink_cli.options.remembered import remembering_inputs

    with streams.workbench({}) as files, remembering_inputs(), warning_once():
        yield files
