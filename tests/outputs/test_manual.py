"""Help, man pages and completion: one source, and every example runs."""

import json
import os
import re
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import click
import numpy as np
import pytest
from PIL import Image

import penink_cli
from penink_cli import manual
from penink_cli.main import SUBCOMMANDS, penink

SHARE = Path(penink_cli.__file__).parent / "share"
CONTEXT = click.Context(penink, info_name="penink")


def command_of(name):
    return penink.get_command(CONTEXT, name) if name else penink


def examples(name):
    """The preformatted paragraphs of a help text, and of those of a subcommand's own subcommands."""
    command = command_of(name)
    texts = [command.help]
    if name and isinstance(command, click.Group):
        texts += [part.help for part in command.commands.values()]
    return [text for help in texts for kind, text in manual._paragraphs(help) if kind == "lines"]


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder with a small photograph and all that the examples' files stand for, and a PATH with penink in it."""
    folder = tmp_path_factory.mktemp("examples")
    programs = folder / "bin"
    programs.mkdir()
    for name, script in {"penink": f'exec "{sys.executable}" -m penink_cli "$@"', "lpr": "cat > /dev/null"}.items():
        (programs / name).write_text(f"#!/bin/sh\n{script}\n")
        (programs / name).chmod((programs / name).stat().st_mode | stat.S_IXUSR)
    root = str(Path(penink_cli.__file__).parent.parent)
    environment = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}", "PYTHONPATH": root, "HOME": str(folder)}
    y, x = np.mgrid[:48, :64]
    photo = np.where((x - 30) ** 2 + (y - 24) ** 2 < 200, 60, 200) + x // 2
    for kind in ("png", "jpg", "pgm"):
        Image.fromarray(photo.astype(np.uint8)).save(folder / f"photo.{kind}")
    Image.fromarray((255 * (photo < 100)).astype(np.uint8)).save(folder / "mask.png")
    layer = {"name": "keys", "samples": "photo.samples.pgm", "edges": "photo.edges.json", "texture": "crosshatch"}
    illustration = {"format": "penink-illustration", "version": 1, "width": 20, "height": 15, "layers": [layer]}
    (folder / "keys.illustration.json").write_text(json.dumps(illustration))
    run = """
    penink detect-edges photo.png -o photo.edges.json
    penink extract-samples -e photo.edges.json photo.png -o photo.samples.pgm
    penink blast --width 1in photo.pgm -o photo.strokes.jsonl
    mkdir -p .local/share/bash-completion/completions .zfunc .config/fish/completions
    cp photo.edges.json e.json; cp photo.samples.pgm photo.reduced.pgm; cp photo.strokes.jsonl hatching.strokes.jsonl
    cp photo.png keys.png; cp mask.png keys-mask.png
    penink detect-directions -e photo.edges.json photo.png -o photo.directions.pgm
    penink detect-lines photo.png -o photo.lines.json
    penink to-svg photo.strokes.jsonl -o hair.svg
    for ink in blue red; do cp photo.pgm $ink.pgm; cp photo.strokes.jsonl $ink.jsonl; done
    penink pack keys.illustration.json -o keys.penink"""
    subprocess.run(["bash", "-e", "-c", run], cwd=folder, env=environment, check=True)
    return folder, environment


def test_every_subcommand_says_what_it_does_with_an_example():
    for name, entry in SUBCOMMANDS.items():
        text = command_of(name).help
        assert len(entry.summary) < 80, name
        assert len(manual._paragraphs(text)) > 1, name
        assert any("penink" in example for example in examples(name)), f"{name} has no example"


@pytest.mark.parametrize("name", [None, *SUBCOMMANDS])
def test_examples_run(place, name, tmp_path):
    made, environment = place
    folder = tmp_path / "place"  # what one example writes is not what the next one finds
    shutil.copytree(made, folder, symlinks=True)
    for example in examples(name):
        if "penink" not in example:
            continue
        lines = re.sub(r"\\\n\s*", " ", example).split("\n")
        lines = [line for line in lines if "--watch" not in line]  # which never ends: test_drawing_again.py has it
        command = ["bash", "-e", "-o", "pipefail", "-c", "\n".join(lines)]
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, check=False, timeout=120)
        assert done.returncode == 0, (example, done.stderr.decode())


def test_the_files_that_are_installed_are_what_the_help_texts_say():
    for name, text in manual.files():
        assert (SHARE / name).read_text("ascii") == text, f"{name} is out of date: python -m penink_cli.manual"
    installed = {str(p.relative_to(SHARE)) for p in SHARE.rglob("*") if p.is_file()}
    assert installed == {name for name, _ in manual.files()}


def test_what_follows_from_the_registries_does():
    for path, text in manual.derived():
        assert path.read_text("utf-8") == text, f"{path.name} is out of date: python -m penink_cli.manual"


def test_a_man_page_holds_the_whole_help():
    page = manual.man_page("to-svg").replace(r"\-", "-")
    for option in command_of("to-svg").params:
        assert all(name in page for name in option.opts if isinstance(option, click.Option))
    for section in ("NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXAMPLES", "EXIT STATUS", "SEE ALSO"):
        assert f"\n.SH {section}\n" in page
    assert not re.search(r"\d{4}-\d\d-\d\d", page)
    assert all(ord(c) < 128 for c in page)


def test_a_man_page_names_every_variable_of_the_environment_that_the_program_obeys():
    sources = "\n".join(path.read_text("utf-8") for path in Path(penink_cli.__file__).parent.glob("**/*.py"))
    read = set(re.findall(r'environ\.get\("(\w+)"\)', sources)) | set(re.findall(r'^VARIABLE = "(\w+)"', sources, re.M))
    assert len(read) >= 4
    for name in read - {"TERM"}:  # which is the terminal's
        assert f"\n.B {name}\n" in manual.man_page(None), name


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["penink", "to-"], {"to-ps", "to-svg", "to-pdf", "to-pgm", "to-png"}),
        (["penink", "to-svg", "--or"], {"--order"}),
        (["penink", "completion", "b"], {"bash"}),
        (["penink", "blast", "--texture", "crossh"], {"crosshatch"}),
        (["penink", "texture", "show", "st"], {"stipple"}),
    ],
)
def test_completion(place, words, expected):
    _, environment = place
    environment = environment | {
        "_PENINK_COMPLETE": "bash_complete", "COMP_WORDS": " ".join(words), "COMP_CWORD": str(len(words) - 1)
    }  # fmt: skip
    done = subprocess.run(["penink"], env=environment, capture_output=True, text=True, check=False)
    assert {line.split(",")[1] for line in done.stdout.split()} >= expected
    assert not done.stderr


def test_no_subcommand_imports_what_a_help_text_does_not_need():
    """Numbers live in the benchmark; what costs them is here: numpy alone takes more than all the rest."""
    script = "import sys, click; from penink_cli.main import penink, SUBCOMMANDS\n" + (
        "for n in SUBCOMMANDS: penink.get_command(click.Context(penink), n)\n"
        "print(*sorted({'numpy', 'scipy', 'skimage', 'PIL', 'pydyf', 'triangle', 'asyncio'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""
