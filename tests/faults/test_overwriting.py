"""An output that is one of the inputs, by whatever name: refused before anything is read, and nothing is changed."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import click
import pytest

from penink_cli.main import SUBCOMMANDS, penink
from penink_cli.options import common as options
from tests.faults.calls import CALLS, arguments
from tests.faults.test_outputs import one_line

readers = pytest.mark.parametrize("name", [name for name, call in CALLS.items() if call.reads])

# Names of one file: FILE is its path in FOLDER, from where the command is run.
WAYS = {
    "the same word": "{file}",
    "a dot": "./{file}",
    "a roundabout way": "sub/../{file}",
    "two slashes": ".//{file}",
    "the whole path": "{folder}/{file}",
    "the folder by another name": "other/{file}",
    "a symbolic link": "link",
    "a link to a link": "linked-link",
    "a link from another folder": "sub/link",
    "a hard link": "hard",
    "a hard link in another folder": "sub/hard",
}


@pytest.fixture
def place(inputs: Path, tmp_path: Path) -> Path:
    folder = tmp_path / "place"
    shutil.copytree(inputs, folder)
    (folder / "sub").mkdir()
    (folder / "other").symlink_to(folder)
    return folder


def link(folder: Path, file: str) -> None:
    """All that WAYS names."""
    (folder / "link").symlink_to(file)
    (folder / "linked-link").symlink_to("link")
    (folder / "sub/link").symlink_to(f"../{file}")
    os.link(folder / file, folder / "hard")
    os.link(folder / file, folder / "sub/hard")


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def refused(done, name: str) -> None:
    assert done.status == 1 and done.out == b"", done
    assert "is the same file as the input" in one_line(done.err, name)


@readers
def test_every_name_of_the_input_is_refused(name, server, place):
    file = CALLS[name].reads
    link(place, file)
    before = contents(place)
    for way, path in WAYS.items():
        path = path.format(file=file, folder=place)
        words = arguments(name, Path(), by_name=False, inputs=place)
        refused(server.run(*words, file, "-o", path, cwd=place), name)
        refused(server.run(*words, path, "-o", file, cwd=place), name)
        assert contents(place) == before, way


@readers
def test_standard_input_and_output_are_files_too(name, server, place):
    file = place / CALLS[name].reads
    before = contents(place)
    words = arguments(name, place, by_name=False)
    given = os.open(file, os.O_RDONLY)
    taken = os.open(file, os.O_WRONLY | os.O_APPEND)
    try:
        for source in ([], ["-"], ["/dev/stdin"], ["/dev/fd/0"]):
            refused(server.run(*words, *source, "-o", file, stdin=given), name)
            refused(server.run(*words, *source, stdin=given, stdout=taken), name)
        for output in ([], ["-o", "-"], ["-o", "/dev/stdout"], ["-o", "/proc/self/fd/1"]):
            refused(server.run(*words, file, *output, stdout=taken), name)
    finally:
        os.close(given)
        os.close(taken)
    assert contents(place) == before


def commands():
    """(words, command) of every subcommand, and of every part of one."""
    for name in SUBCOMMANDS:
        command = penink.get_command(click.Context(penink), name)
        if isinstance(command, click.Group):
            yield from (([name, part], inner) for part, inner in command.commands.items())
        else:
            yield [name], command


def path_parameters(command, output: bool):
    paths = [p for p in command.params if isinstance(p.type, click.Path) and p.type.file_okay]
    return [p for p in paths if isinstance(p.type, options.OutputFile) == output]


INPUTS = [(words, p) for words, command in commands() for p in path_parameters(command, output=False)]


def test_every_subcommand_writes_by_an_option_that_is_watched():
    for words, command in commands():
        written = [p.opts for p in path_parameters(command, output=True) if p.opts != ["--plates"]]  # a name for each
        assert written == [["-o", "--output"]], words
    named = {option for _, p in INPUTS if isinstance(p, click.Option) for option in p.opts}
    assert {"--edges", "--photo", "--mask", "--ink", "--texture"} <= named
    # A parameter that says it takes a file is one of those that are compared.
    for words, command in commands():
        for parameter in command.params:
            if isinstance(parameter, click.Option) and "FILE" in (parameter.metavar or ""):
                assert isinstance(parameter.type, click.Path), (words, parameter.opts)


@pytest.mark.parametrize(("words", "parameter"), INPUTS, ids=lambda v: "-".join(v) if isinstance(v, list) else v.name)
def test_every_file_that_is_read_is_compared(words, parameter, server, place):
    """Before it is read: what the file holds is not what the parameter takes."""
    (place / "some.file").write_bytes(b"anything")
    os.link(place / "some.file", place / "out.ps")
    given = ["some.file"] if isinstance(parameter, click.Argument) else [parameter.opts[-1], "some.file"]
    call = arguments(words[0], Path(), inputs=place) if words[0] in CALLS and len(words) == 1 else words
    if isinstance(parameter, click.Argument) and len(words) == 1:
        call = arguments(words[0], Path(), by_name=False, inputs=place)
    done = server.run(*call, *given, "-o", "out.ps", cwd=place)
    assert done.status == 1 and b"out.ps: is the same file as the input some.file" in done.err, done
    assert (place / "some.file").read_bytes() == b"anything"


@pytest.mark.parametrize("name", ["render", "pack", "to-html", "to-ps"])
@pytest.mark.parametrize("member", ["samples.pgm", "photo.edges.json", "own.texture.json"])
def test_a_manifest_s_members_are_inputs(name, member, server, place):
    server.run("texture", "show", "brick", "--json", "-o", place / "own.texture.json")
    manifest = place / "photo.illustration.json"
    manifest.write_text(manifest.read_text().replace('"crosshatch"', '"own.texture.json"'))
    link(place, member)
    before = contents(place)
    words = ["to-ps", "--self", manifest.name] if name == "to-ps" else arguments(name, Path(), inputs=place)
    for output in ("hard", "sub/link", member):
        refused(server.run(*words, "-o", output, cwd=place), name)
    assert contents(place) == before
    manifest.write_text(manifest.read_text().replace("{", "{ ", 1))
    done = server.run(*words, "-o", manifest.name, cwd=place)
    refused(done, name)


def test_a_shipped_thing_of_the_output_s_name_is_no_file(server, place):
    """``-o crosshatch`` with the texture of that name: it is not read from here."""
    (place / "crosshatch").write_bytes(b"old")
    words = arguments("blast", Path(), inputs=place)
    assert server.run(*words, "-o", "crosshatch", cwd=place).status == 0
    assert (place / "crosshatch").read_bytes().startswith(b'{"format": "penink-strokes"')


def test_devices_may_be_both(server):
    assert b"same file" not in server.run("to-ps", "/dev/null", "-o", "/dev/null").err
