"""Files made of registries and help texts: man pages, completion, the README's table, names in schemas, textures.

``python -m penink_cli.manual`` writes them. Man pages and completion go to penink_cli/share, from where they are
installed.
"""

from __future__ import annotations

import gzip
import inspect
import json
import os
import re
import sys
import textwrap
from collections.abc import Iterator
from pathlib import Path

import click
from click.shell_completion import BashComplete, FishComplete, ShellComplete, ZshComplete

from penink_cli.ground.rules import RULES
from penink_cli.main import SUBCOMMANDS, penink

_COMMON = r"""
.SH EXIT STATUS
.TP
.B 0
The whole output has been delivered.
.TP
.B 1
Input that is wrong or cannot be read, a limit that is exceeded, an output that cannot be written: one line on
standard error says which. A file named by \fB\-o\fR is then as it was before.
.TP
.B 2
The command line is wrong.
.SH ENVIRONMENT
.TP
.B NO_COLOR
Set to anything, the name of the program in an error line has no colour on a terminal either.
.TP
.B PENINK_DEBUG
Set to 1, an error shows its traceback.
.TP
.B PENINK_MESHER
The library that parts a frame into regions, \fBtriangle\fR or \fBpythoncdt\fR; otherwise the first of these that is
installed. Both give the same output.
"""


def man_page(name: str | None) -> str:
    """The page of one subcommand, or of penink itself, in man's macros."""
    command: click.Command = penink
    context = click.Context(penink, info_name="penink")
    if name is not None:
        found = penink.get_command(context, name)
        assert found is not None
        command = found
        context = click.Context(command, info_name=name, parent=context)
    title = "penink" if name is None else f"penink-{name}"
    paragraphs = _paragraphs(command.help or "")
    lines = [f'.TH "{title.upper()}" 1 "" "penink" "User Commands"', ".SH NAME"]
    lines.append(_escaped(title) + r" \- " + _escaped(paragraphs[0][1].rstrip(".")))
    pieces = " ".join(command.collect_usage_pieces(context))
    lines += [".SH SYNOPSIS", rf".B {_escaped(context.command_path)}", _escaped(pieces), ".SH DESCRIPTION"]
    lines += _running([(kind, text) for kind, text in paragraphs if kind == "text"])
    lines += [".SH OPTIONS"]
    for left, text in _options(command, context):
        lines += [".TP", rf"\fB{_escaped(left)}\fR", _escaped(text) or r"\&"]
    if name is not None and isinstance(command, click.Group):
        lines += _parts(command, context)
    if name is None:
        lines += [".SH SUBCOMMANDS"]
        for other, entry in SUBCOMMANDS.items():
            lines += [".TP", rf".BR penink\-{_escaped(other)} (1)", _escaped(entry.summary)]
    examples = _examples(paragraphs)
    lines += [".SH EXAMPLES", *examples] if examples else []
    lines += _COMMON.strip().split("\n")
    others = [r".BR penink (1)"] if name is not None else [r".BR gs (1)", r".BR make (1)"]
    lines += [".SH SEE ALSO", *others]
    return "\n".join(lines) + "\n"


def _parts(group: click.Group, context: click.Context) -> list[str]:
    """The section on the subcommands of a subcommand, each with its options."""
    lines = [".SH SUBCOMMANDS"]
    for part in group.list_commands(context):
        command = group.get_command(context, part)
        assert command is not None
        inner = click.Context(command, info_name=part, parent=context)
        paragraphs = _paragraphs(command.help or "")
        lines += [".SS " + _escaped(f"{inner.command_path} {' '.join(command.collect_usage_pieces(inner))}")]
        lines += _running([(kind, text) for kind, text in paragraphs if kind == "text"])
        for left, text in _options(command, inner):
            lines += [".TP", rf"\fB{_escaped(left)}\fR", _escaped(text) or r"\&"]
        lines += _examples(paragraphs)
    return lines


def _examples(paragraphs: list[tuple[str, str]]) -> list[str]:
    lines = []
    for kind, text in paragraphs:
        if kind == "lines":
            lines += [".PP", ".nf", ".RS", *(_escaped(line) for line in text.split("\n")), ".RE", ".fi"]
    return lines


def _paragraphs(text: str) -> list[tuple[str, str]]:
    r"""Paragraphs of a help text: ("text", as one line), or after a \b ("lines", as they stand)."""
    result = []
    # CPython 3.13 takes the indentation off docstrings, earlier ones leave it.
    for paragraph in re.split(r"\n\s*\n", re.sub(r"(?m)^ +$", "", inspect.cleandoc(text))):
        if paragraph.lstrip().startswith("\b"):
            result.append(("lines", textwrap.dedent(paragraph.lstrip()[1:].strip("\n"))))
        else:
            result.append(("text", " ".join(paragraph.split())))
    return result


def _running(paragraphs: list[tuple[str, str]]) -> list[str]:
    return [line for _, text in paragraphs for line in (".PP", _escaped(text))][1:]


def _options(command: click.Command, context: click.Context) -> Iterator[tuple[str, str]]:
    for parameter in command.get_params(context):
        record = parameter.get_help_record(context) if isinstance(parameter, click.Option) else None
        if record:
            yield record[0], " ".join(record[1].split())


def _escaped(text: str) -> str:
    """Text that troff takes as it stands."""
    coded = text.replace("\\", r"\e").replace("-", r"\-").replace("'", r"\(aq").replace("`", r"\(ga")
    coded = coded.replace("^", r"\(ha").replace("~", r"\(ti")
    coded = "".join(c if ord(c) < 128 else rf"\[u{ord(c):04X}]" for c in coded)
    return r"\&" + coded if coded.startswith(".") else coded


def completion_script(shell: str) -> str:
    """The script by which bash, zsh or fish complete penink's words."""
    kinds: dict[str, type[ShellComplete]] = {"bash": BashComplete, "zsh": ZshComplete, "fish": FishComplete}
    complete = kinds[shell](penink, {}, "penink", "_PENINK_COMPLETE")
    text = complete.source_template % complete.source_vars()
    return text.strip() + "\n"


def files() -> Iterator[tuple[str, str]]:
    """The man pages and completion scripts: path below share, and content."""
    for name in (None, *SUBCOMMANDS):
        yield f"man/man1/penink{'-' + name if name else ''}.1", man_page(name)
    yield "bash-completion/completions/penink", completion_script("bash")
    yield "zsh/site-functions/_penink", completion_script("zsh")
    yield "fish/vendor_completions.d/penink.fish", completion_script("fish")


def filter_table() -> str:
    """The README's table of the filters."""
    rows = [f"| `{name}` | {entry.reads} | {entry.writes} | {entry.summary} |" for name, entry in SUBCOMMANDS.items()]
    return "\n".join(["| filter | reads | writes | |", "| --- | --- | --- | --- |", *rows])


def derived() -> Iterator[tuple[Path, str]]:
    """Files of the project of which a part is made of the registries, and their whole text as it is to be."""
    schema = Path(__file__).parent / "formats" / "schemas" / "illustration.schema.json"
    yield schema, _enumerated(schema.read_text("utf-8"))
    readme = Path(__file__).parent.parent / "README.md"
    if readme.exists():  # not where the package is installed
        text = readme.read_text("utf-8")
        head, rest = text.split("<!-- the filters, by `make manual` -->\n\n", 1)
        _, tail = rest.split("\n\n", 1)
        yield readme, f"{head}<!-- the filters, by `make manual` -->\n\n{filter_table()}\n\n{tail}"


def _enumerated(schema: str) -> str:
    """The text of the schema of illustrations with the names of all rules in it."""
    return re.sub(r'(?<="rule": \{ "enum": )\[[^]]*\]', json.dumps(list(RULES)), schema)


def main() -> None:
    """Write man pages and completion below the folder given; without one those of the project, and all other files."""
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent / "share"
    for name, text in files():
        target = root / name
        os.makedirs(target.parent, exist_ok=True)
        target.write_text(text, encoding="ascii")
    if len(sys.argv) == 1:
        for target, text in derived():
            target.write_text(text, encoding="utf-8")
        pack_tiles()


def pack_tiles() -> None:
    """Make and pack the shipped textures that have no file yet. To make one again, remove its file first."""
    from penink_cli.options import textures

    for name in textures.shipped():
        tile = Path(__file__).parent / "textures" / "tiles" / (name + textures.ENDING)
        if not tile.exists():
            tile.write_bytes(gzip.compress(textures.made(name), mtime=0))


if __name__ == "__main__":
    main()
