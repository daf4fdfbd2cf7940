"""Options that subcommands share, and the types of their values."""

from __future__ import annotations

import contextlib
import functools
import math
import re
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, Any, TypeVar, cast

import click
from click.core import ParameterSource

from penink_cli.ground import streams
from penink_cli.ground.errors import ParameterError, in_quotes, printable
from penink_cli.ground.turns import in_turn
from penink_cli.ground.units import parse_length

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

F = TypeVar("F", bound=Callable[..., Any])

MAX_PIXELS = 100_000_000


class Length(click.ParamType):
    """A length on paper, in points once parsed: ``4in``, ``100mm``, ``288`` (points)."""

    name = "length"

    def __init__(self, zero: bool = False):
        self.zero = zero

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Points."""
        if isinstance(value, float):
            return value
        try:
            points = parse_length(value)
        except ParameterError as error:
            self.fail(error.message, param, ctx)
        if points == 0 and not self.zero:
            self.fail("a length of nothing", param, ctx)
        return points


class Size(click.ParamType):
    """``WxH`` in pixels, a pair of whole numbers from 1."""

    name = "WxH"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[int, int]:
        """(width, height)."""
        if isinstance(value, tuple):
            return value
        parts = value.lower().split("x")
        if len(parts) != 2 or not all(p.isascii() and p.isdigit() and len(p) < 10 and int(p) > 0 for p in parts):
            self.fail(f"{in_quotes(value)} is not a size such as 640x480", param, ctx)
        return int(parts[0]), int(parts[1])


class PixelWindow(click.ParamType):
    """``X,Y,W,H`` in pixels, whole numbers."""

    name = "X,Y,W,H"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[int, int, int, int]:
        """(x, y, width, height)."""
        if isinstance(value, tuple):
            return value
        parts = value.split(",")
        if len(parts) != 4 or not all(p.isascii() and p.isdigit() and len(p) < 10 for p in parts):
            self.fail(f"{in_quotes(value)} is not a window such as 0,0,640,480", param, ctx)
        x, y, width, height = (int(p) for p in parts)
        if not width or not height:
            self.fail("the window is empty", param, ctx)
        return x, y, width, height


def plain_number(value: Any) -> float:
    """A number in ASCII, NaN for anything else; ``1_0`` and ``١``, which Python takes, are typing errors."""
    try:
        return float(value) if re.fullmatch(r"[-+.0-9a-zA-Z]*", str(value)) else math.nan
    except ValueError:
        return math.nan


class Finite(click.ParamType):
    """A finite number within bounds; ``above`` is exclusive, the others inclusive."""

    name = "number"

    def __init__(self, least: float = -math.inf, most: float = math.inf, above: float = -math.inf):
        self.least, self.most, self.above = least, most, above

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """The number."""
        number = plain_number(value)
        if not (math.isfinite(number) and self.least <= number <= self.most and number > self.above):
            low = f"above {self.above:g}" if self.above > -math.inf else f"from {self.least:g}"
            high = f" to {self.most:g}" if self.most < math.inf else ""
            bounded = self.above > -math.inf or self.least > -math.inf
            self.fail(f"{in_quotes(str(value))} is not a number{f' {low}{high}' if bounded else high}", param, ctx)
        return number


class Pair(click.ParamType):
    """``X,Y``, each of a type of its own; such_as: what it is, with an example, for the error."""

    name = "X,Y"

    def __init__(self, each: click.ParamType, such_as: str):
        self.each, self.such_as = each, such_as

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, float]:
        """(x, y)."""
        if isinstance(value, tuple):
            return value
        parts = value.split(",")
        if len(parts) != 2:
            self.fail(f"{in_quotes(value)} is not {self.such_as}", param, ctx)
        x, y = (self.each.convert(part, param, ctx) for part in parts)
        return x, y


#: A place in the photo, pixels.
POINT = Pair(Finite(), "a point such as 120,85.5")


class DeviceDpi(click.ParamType):
    """Dots per inch of the printer, or ``none``."""

    name = "dpi"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float | None:
        """The resolution, None for ``none``."""
        if value == "none":
            return None
        return Finite(10, 100_000).convert(value, param, ctx)


LENGTH = Length()
SIZE = Size()
WINDOW = PixelWindow()
POSITIVE = Finite(above=0)


class Text(click.ParamType):
    """A text that goes into a file: it must be UTF-8, as files are."""

    name = "text"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """The text as given."""
        text = str(value)
        try:
            text.encode("utf-8")
        except UnicodeEncodeError:  # Python's stand-in for a byte that is not UTF-8
            self.fail(f"{in_quotes(text)} is not UTF-8", param, ctx)
        return text


TEXT = Text()


class OutputFile(click.Path):
    """A file to be written; every other path that a subcommand takes is read."""

    def __init__(self) -> None:
        super().__init__(allow_dash=True)


def is_given(name: str) -> bool:
    """Whether the running command was given this parameter; outside of a command each counts as given."""
    context = click.get_current_context(silent=True)
    return context is None or context.get_parameter_source(name) is not ParameterSource.DEFAULT


def is_file(name: str) -> bool:
    """Whether a name is a file's and not a shipped texture's or style's: it has a dot or a slash, or is ``-``."""
    return name == "-" or "/" in name or "." in name


class NameOrFile(click.Path):
    """A texture or style that comes with the program, by its name, or a file; shells complete both."""

    def __init__(self, names: Callable[[], Iterable[str]]):
        super().__init__(allow_dash=True)
        self.names = names

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        """The names that begin as the word does, and files, which bash offers only where no name fits."""
        from click.shell_completion import CompletionItem

        found = [CompletionItem(name) for name in self.names() if name.startswith(incomplete)]
        return [CompletionItem(incomplete, type="file"), *found]


def _keeping_inputs(function: F) -> F:
    """The subcommand, made to refuse an output that is one of its inputs before anything is read."""

    @functools.wraps(function)
    def checked(*arguments: Any, **values: Any) -> Any:
        context = click.get_current_context()
        outputs, inputs = [], []
        for parameter in context.command.params:
            if not isinstance(parameter.type, click.Path):
                continue
            value = context.params.get(parameter.name or "")
            paths = list(value) if isinstance(value, tuple) else [value]
            if isinstance(parameter.type, NameOrFile):
                inputs += [path for path in paths if path is not None and is_file(path)]
            elif isinstance(parameter.type, OutputFile):
                outputs += paths
            elif isinstance(parameter, click.Argument):
                inputs += paths or [None]  # no FILE is standard input
            else:
                inputs += [path for path in paths if path is not None]
        streams.keep_inputs(outputs, inputs)
        return function(*arguments, **values)

    return cast(F, checked)


def filter_options(function: F) -> F:
    """What every filter has: FILE, -o, --max-pixels, --quiet, -h.

    The function receives ``file`` (a path, or None for standard input), ``output`` (a path, or
    None for standard output), ``max_pixels`` and ``quiet``.
    """
    for decorate in (
        click.argument("file", required=False, metavar="[FILE]", type=click.Path(allow_dash=True)),
        output_options,
    ):
        function = decorate(function)
    return function


def output_options(function: F) -> F:
    """-o, --max-pixels, --quiet, -h: what every subcommand has, whatever it reads.

    A parameter that is a file to be read must be of click's type Path, one to be written of `OutputFile`: by these
    types an output that is an input is refused.
    """
    function = _keeping_inputs(function)
    for decorate in (
        click.help_option("-h", "--help"),
        click.option("-q", "--quiet", is_flag=True, help="No progress bar."),
        click.option(
            "--max-pixels",
            type=click.IntRange(1),
            default=MAX_PIXELS,
            metavar="N",
            help="Refuse images that declare more pixels.  [default: 100000000, of photographs 250000000]",
        ),
        click.option(
            "-o",
            "--output",
            type=OutputFile(),
            metavar="FILE",
            help="Write there, whole or not at all, instead of to standard output.",
        ),
    ):
        function = decorate(function)
    return function


def printer_option(
    says: str = "Resolution of the printer, which paints every dot that a stroke touches; "
    "none for plotters and screens.",
) -> Callable[[F], F]:
    """--device-dpi of subcommands that lay strokes for a printer; says: the help text."""
    return click.option("--device-dpi", type=DeviceDpi(), default="600", show_default=True, metavar="N|none", help=says)


def edges_option(required: bool, says: str = "Without it nothing is kept sharp.") -> Callable[[F], F]:
    """-e/--edges FILE: the discontinuity edges of the image; says: what they do, where they are not required."""
    return click.option(
        "-e",
        "--edges",
        "edges_file",
        required=required,
        type=click.Path(allow_dash=True),
        metavar="FILE",
        help="The edge list of the image." + ("" if required else f" {says}"),
    )


def _limit_threads(ctx: click.Context, _: click.Parameter, threads: int | None) -> int | None:
    """Limit the threads of all that runs within this command, also of what takes no number of threads."""
    if threads is not None:
        from penink_cli.ground import threads as threading

        before = threading.limit(threads)
        ctx.call_on_close(lambda: threading.limit(before) and None)
    return threads


threads_option = click.option(
    "--threads",
    callback=_limit_threads,
    type=click.IntRange(1, 256),
    metavar="N",
    help="Threads to use; the bytes are the same for any number.  [default: one a processor]",
)

verbose_option = click.option(
    "-v", "--verbose", is_flag=True, help="Say on standard error what was chosen automatically."
)


def reporter(verbose: bool) -> Callable[[str], None]:
    """A function that takes lines for --verbose: to standard error, or nowhere."""
    return _said if verbose else (lambda line: None)


def _said(line: str) -> None:
    in_turn(functools.partial(click.echo, line, err=True))


_warned: set[str] | None = None  # what has been warned of, within `warning_once`


@contextlib.contextmanager
def warning_once() -> Iterator[None]:
    """While the block runs, a warning that several filters of one process would give is given by the first alone."""
    global _warned  # noqa: PLW0603
    before, _warned = _warned, set()
    try:
        yield
    finally:
        _warned = before


def warn(line: str, about: str | None = None) -> None:
    """A line on standard error, with the command's name: the result is as asked for, but perhaps not as meant.

    about: names the subject for `warning_once`, where filters word the same warning in different ways.
    """
    context = click.get_current_context(silent=True)
    program = context.command_path if context else "penink"

    def say() -> None:
        if _warned is not None:
            if (about or line) in _warned:
                return
            _warned.add(about or line)
        click.echo(f"{program}: warning: {printable(line)}", err=True)

    in_turn(say)


def processors() -> int:
    """How many processors this process may run on: the default of --threads."""
    from penink_cli.ground import threads

    return threads.count(None)
