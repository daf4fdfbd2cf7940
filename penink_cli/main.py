"""The ``penink`` command: finds the subcommand, and is the one place where errors become a line and an exit status.

Exit status 0: complete output delivered. 1: bad or unreadable input, a limit exceeded, a write
error. 2: usage. A reader that went away kills by SIGPIPE in silence; INT, TERM and HUP clean up and
then kill by that signal.
"""

from __future__ import annotations

import contextlib
import importlib
import os
import re
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import click

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

from penink_cli import __version__
from penink_cli.ground import streams
from penink_cli.ground.errors import PeninkError, printable
from penink_cli.outputs.registry import OUTPUTS


class Entry(NamedTuple):
    """What there is to know of a subcommand before its module is loaded.

    reads, writes: for the README's table. summary: first line of its help. parts: names of its own subcommands.
    """

    reads: str
    writes: str
    summary: str
    parts: tuple[str, ...] = ()


def _outputs(reads: str) -> dict[str, Entry]:
    """The subcommands of the outputs that read strokes, or illustrations."""
    found = {name: output for name, output in OUTPUTS.items() if output.reads == reads}
    return {name: Entry(reads, output.endings, output.summary) for name, output in found.items()}


# One line a subcommand, and its module in penink_cli.commands: `to-svg` is the function `to_svg` in to_svg.py. A table,
# so that neither `penink --help` nor one subcommand pays for the imports of all others.
SUBCOMMANDS = {
    "compose": Entry("photo", "PGM", "Make the grey that a drawing is to have, from a photo."),
    "detect-edges": Entry("photo", "edges", "Find the discontinuity edges of a photograph."),
    "thin-edges": Entry("edges, photo", "edges", "Leave out the edges that are not worth their bytes."),
    "detect-lines": Entry("photo", "lines", "Find the telling lines of a photograph."),
    "extract-samples": Entry("photo, edges", "PGM", "Take grey samples that no edge has contaminated."),
    "show-edges": Entry("photo, edges", "SVG", "Draw a photograph with its edges, to be looked at."),
    "detect-directions": Entry("photo, edges", "field", "Find the directions that strokes follow in a photograph."),
    "show-directions": Entry("photo, field", "SVG", "Draw a photograph with its directions, to be looked at."),
    "reduce": Entry("PGM, edges", "PGM", "Reduce samples to a coarser grid without mixing across edges."),
    "enlarge": Entry("PGM, edges", "PGM", "Reconstruct the image at any size, sharp at edges and smooth elsewhere."),
    "blast": Entry("PGM, edges, field, lines", "strokes", "Turn grey into pen strokes of the same tone."),
    "separate": Entry("photo", "PGM", "Make the overlay of one layer: grey where it is, white elsewhere."),
    "balance": Entry(
        "strokes, PGM", "strokes", "Press the strokes of plates so that together they print the right colours."
    ),
    "lines": Entry("lines", "strokes", "Turn telling lines into pen strokes for one size on paper."),
    "outline": Entry("edges", "strokes", "Turn discontinuity edges into smooth outline strokes."),
    "render": Entry("illustration", "strokes", "Draw an illustration anew for one size and one device."),
    "draw": Entry("photo", "any of these", "Turn a photo into a pen-and-ink drawing, the whole chain in one call."),
    "style": Entry("", "style", "List and show styles of drawing.", ("list", "show")),
    "texture": Entry("", "texture", "List, show, make and import stroke textures.", ("list", "show", "make", "import")),
    **_outputs("illustration"),
    **_outputs("strokes"),
    "measure": Entry("strokes", "table", "Measure a drawing: its tone against what it shows, how its strokes lie."),
    "compare": Entry("strokes, picture", "table", "Say whether two drawings or pictures are the same, to a tolerance."),
    "completion": Entry("", "script", "Print what makes a shell complete penink's words."),
}


def command_of(name: str) -> click.Command:
    """The subcommand of that name, its module loaded."""
    if name in OUTPUTS and not OUTPUTS[name].own:
        made: click.Command = importlib.import_module("penink_cli.commands.to_output").subcommand(name)
        return made
    module = name.replace("-", "_")
    command: click.Command = getattr(importlib.import_module(f"penink_cli.commands.{module}"), module)
    return command


class LazyGroup(click.Group):
    """A click group that imports a subcommand's module when it is asked for, and not before."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """All subcommands, in the order of the chain."""
        return list(SUBCOMMANDS)

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        """The subcommand of that name."""
        return command_of(name) if name in SUBCOMMANDS else None

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """As click's, with a guess at what a wrong name was meant to be."""
        if args and not args[0].startswith("-") and args[0] not in SUBCOMMANDS:
            import difflib  # for the rare mistake alone: it is slow to load

            near = difflib.get_close_matches(args[0], SUBCOMMANDS, n=1, cutoff=0.5)
            hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(SUBCOMMANDS)}"
            raise click.UsageError(f"no subcommand {printable(args[0], 60)}; {hint}", ctx)
        return super().resolve_command(ctx, args)

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """Subcommands from the table, importing none, and the group's own options."""
        from click.shell_completion import CompletionItem

        named = [CompletionItem(n, help=s.summary) for n, s in SUBCOMMANDS.items() if n.startswith(incomplete)]
        return named + click.Command.shell_complete(self, ctx, incomplete)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the subcommands from the table, importing none."""
        with formatter.section("Subcommands"):
            formatter.write_dl([(name, entry.summary) for name, entry in SUBCOMMANDS.items()])


@click.command(cls=LazyGroup, name="penink", no_args_is_help=False, subcommand_metavar="SUBCOMMAND [OPTIONS] [FILE]")
@click.version_option(__version__, prog_name="penink", message="%(prog)s %(version)s")
@click.help_option("-h", "--help")
def penink() -> None:
    """Photographs to pen-and-ink illustrations that keep their tone and their edges at any size.

    Every subcommand is a filter: it reads FILE or standard input and writes standard output, or
    the file of -o, which appears whole or not at all.

    \b
    penink detect-edges photo.png -o e.json
    penink extract-samples -e e.json photo.png \\
      | penink reduce -e e.json --factor 4 \\
      | penink enlarge -e e.json --scale 8 --soften \\
      | penink blast -e e.json --texture crosshatch --width 4in \\
      | penink to-ps > photo.ps
    """


def _complain(path: str, message: str) -> None:
    """One line on standard error, whatever the message holds; a closed standard error is no second error.

    On a terminal the name of the program is red, unless NO_COLOR (no-color.org) is set.
    """
    head = f"{path}:"
    if os.isatty(2) and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb":
        head = f"\x1b[1;31m{head}\x1b[0m"
    line = f"{head} {printable(message)}\n"
    with contextlib.suppress(OSError):
        os.write(2, line.encode("utf-8", "backslashreplace"))


def _run(arguments: Sequence[str]) -> int:
    """Run one subcommand; every error that is a user's to mend becomes one line."""
    path = "penink"
    if arguments and arguments[0] in SUBCOMMANDS:
        path = f"penink {arguments[0]}"
        if arguments[1:] and arguments[1] in SUBCOMMANDS[arguments[0]].parts:
            path += f" {arguments[1]}"
    try:
        result = penink.main(args=list(arguments), prog_name="penink", standalone_mode=False)
        streams.flush_text()
        return result if isinstance(result, int) else 0
    except click.UsageError as error:
        line = re.sub(r"\s*\n\s*", " ", error.format_message())  # click lists the choices on lines of their own
        _complain(path, f"{line} (see {path} --help)")
        return 2
    except click.exceptions.Exit as stop:
        return stop.exit_code
    except PeninkError as error:
        if os.environ.get("PENINK_DEBUG") == "1":
            raise
        _complain(path, str(error))
        return 1
    except OSError as error:  # click could not print to standard output; errors of files are StreamErrors
        if os.environ.get("PENINK_DEBUG") == "1":
            raise
        _complain(path, str(streams.text_failure(error)))
        return 1
    except MemoryError:
        if os.environ.get("PENINK_DEBUG") == "1":
            raise
        _complain(path, "not enough memory")
        return 1
    except (click.ClickException, click.Abort) as error:
        _complain(path, error.format_message() if isinstance(error, click.ClickException) else "aborted")
        return 1
    except Exception as error:
        if os.environ.get("PENINK_DEBUG") == "1":
            raise
        if _lacks_room(error):
            _complain(path, "not enough memory")
            return 1
        _complain(path, f"internal error: {type(error).__name__}: {error} (PENINK_DEBUG=1 shows where)")
        return 1


def _lacks_room(error: BaseException | None) -> bool:
    """Whether a library could not be loaded for want of memory; scipy, for one, says so only in the error's cause."""
    while error is not None and "failed to map segment" not in str(error):
        error = error.__cause__ or error.__context__
    return isinstance(error, ImportError)


def main(arguments: Sequence[str] | None = None) -> None:
    """Run one subcommand and exit with its status; the signals are prepared already, by __main__."""
    sys.exit(_run(sys.argv[1:] if arguments is None else arguments))
