"""One file and one line add a subcommand, an output, a texture or a rule: to a copy of the program, which then has it
everywhere and passes the tests that run over all of them.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.conftest import ROOT, environment


@dataclass(frozen=True)
class Addition:
    """A new thing: its file and what that holds; the table, the line it goes before, and the line; its tests."""

    file: str
    text: str
    table: str
    before: str
    line: str
    tests: str


SUBCOMMAND = Addition(
    "penink_cli/commands/darken.py",
    '''"""``penink darken``."""

from typing import Any

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import filter_options
from penink_cli.options.inputs import read_grey


@click.command()
@filter_options
def darken(file: str | None, output: str | None, max_pixels: int, **_: Any) -> None:
    """Halve all grey.

    \\b
    penink darken photo.pgm -o dark.pgm
    """
    image = read_grey(file, max_pixels)
    rows, columns = image.values.shape
    with writing(output) as out:
        out.write(b"P5\\n%d %d\\n%d\\n" % (columns, rows, image.maxval) + (image.values // 2).tobytes())
''',
    "penink_cli/main.py",
    '    "completion": ',
    '    "darken": Entry("PGM", "PGM", "Halve all grey."),\n',
    "test_main.py test_rooms.py outputs/test_manual.py faults/test_outputs.py faults/test_overwriting.py",
)
OUTPUT = Addition(
    "penink_cli/outputs/ends.py",
    '''"""Where strokes begin and end, as text."""

from typing import Any

from penink_cli.outputs.registry import Option

GUIDE = """
One stroke a line.

\\b
penink to-ends photo.strokes.jsonl -o photo.ends
"""
OPTIONS = (Option("decimals", "So many decimals.", 2.0, least=0, most=9), Option("numbered", "Number them.", False))


def write(out: Any, layers: Any, page: Any, colours: Any, decimals: float, numbered: bool) -> None:
    """A line of four numbers a stroke."""
    for layer in layers:
        for i in range(len(layer)):
            numbers = [f"{v:.{int(decimals)}f}" for v in (*layer[i][0], *layer[i][-1])]
            out.write(" ".join([str(i)] * numbered + numbers).encode() + b"\\n")
''',
    "penink_cli/outputs/registry.py",
    '    "to-pdf": ',
    '    "to-ends": Medium(".ends", "Write where strokes begin and end."),\n',
    "test_main.py test_rooms.py outputs/test_manual.py faults/test_outputs.py faults/test_overwriting.py",
)
OWN = Addition(
    "penink_cli/commands/to_tally.py",
    '''"""``penink to-tally``."""

from typing import Any

import click

from penink_cli.ground.streams import writing
from penink_cli.options.common import output_options
from penink_cli.options.layers import files_argument, read_layers


@click.command(name="to-tally")
@files_argument
@output_options
@click.option("--points", is_flag=True, help="Count the points too.")
def to_tally(files: tuple[str, ...], output: str | None, points: bool, **_: Any) -> None:
    """Count strokes.

    One line of text for each layer, whatever page it would lie on.

    \\b
    penink to-tally photo.strokes.jsonl -o photo.tally
    """
    layers = read_layers(files)
    with writing(output, binary=False) as out:
        for layer in layers:
            out.write(f"{len(layer)}{f' {len(layer.points)}' * points}\\n".encode())
''',
    "penink_cli/outputs/registry.py",
    '    "to-pdf": ',
    '    "to-tally": Medium(".tally", "Count strokes.", own=True),\n',
    "test_main.py test_rooms.py outputs/test_manual.py faults/test_outputs.py faults/test_overwriting.py",
)
TEXTURE = Addition(
    "penink_cli/textures/kinds/ticks.py",
    '''"""Short upright lines."""

from penink_cli.ground.model import Texture
from penink_cli.textures.sets import oriented


def make(*, pen: float = 0.4, seed: int = 0) -> Texture:
    """Three of them."""
    return oriented("ticks", [(0, 0, 2, 0, 4, 0, 6, 0), (0, 0, 2, 1, 4, 1, 6, 0), (0, 0, 2, -1, 4, -1, 6, 0)], pen)
''',
    "penink_cli/textures/registry.py",
    '    "wood": ',
    '    "ticks": "short upright lines",\n',
    "test_rooms.py textures/test_textures.py",
)
RULE = Addition(
    "penink_cli/blasting/rules/frugal.py",
    '''"""The paper's rule for a drawing half as dark."""

from dataclasses import replace

from penink_cli.blasting.rules import strict
from penink_cli.blasting.task import Task
from penink_cli.ground.model import Strokes

SETS, follows = False, strict.follows


def draw(task: Task) -> Strokes:
    """Strokes for half the tone."""
    return strict.draw(replace(task, tone=task.tone / 2))
''',
    "penink_cli/ground/rules.py",
    '    "strict": ',
    '    "frugal": "half as dark",\n',
    "test_rooms.py outputs/test_manual.py blasting/test_rules.py",
)


class Copy:
    """A copy of the program and its tests, with an addition."""

    def __init__(self, folder: Path, added: Addition):
        self.folder = folder
        for place, _, names in os.walk(ROOT):
            inside = Path(place).relative_to(ROOT)
            if inside.parts and inside.parts[0] not in ("penink_cli", "tests", ".build", ".ci", "samples"):
                continue
            (folder / inside).mkdir(exist_ok=True)
            for name in names:  # tests ask where their own file really is
                put = shutil.copy if name.endswith(".py") else os.symlink
                put(ROOT / inside / name, folder / inside / name)
        before = {path.relative_to(folder) for path in folder.rglob("*")}
        self.write(added.file, added.text)
        table = (folder / added.table).read_text("utf-8")
        assert table.count(added.before) == 1
        self.write(added.table, table.replace(added.before, added.line + added.before))
        assert {path.relative_to(folder) for path in folder.rglob("*")} - before == {Path(added.file)}
        for path in [*(folder / "penink_cli/share").rglob("*"), folder / "README.md", *folder.rglob("*.schema.json")]:
            if path.is_file():  # what `make manual` writes
                self.write(str(path.relative_to(folder)), path.read_text("utf-8"))
        self.python("-m", "penink_cli.manual")

    def write(self, name: str, text: str) -> None:
        """A file of the copy's own."""
        (self.folder / name).unlink(missing_ok=True)
        (self.folder / name).write_text(text, "utf-8")

    def python(self, *words: str) -> bytes:
        """What Python prints, which runs the copy."""
        run = {**environment(), "PYTHONPATH": str(self.folder), "PYTHONDONTWRITEBYTECODE": "1"}
        done = subprocess.run([sys.executable, *words], cwd=self.folder, env=run, capture_output=True, check=False)
        assert done.returncode == 0, (done.stdout + done.stderr).decode()
        return done.stdout

    def penink(self, *words: str) -> bytes:
        """What a subcommand writes."""
        return self.python("-m", "penink_cli", *words)

    def pass_tests(self, names: str, only: str) -> None:
        """Run the tests that run over all such things, for the new one."""
        files = [f"tests/{name}" for name in names.split()]
        self.python("-m", "pytest", "-q", "-p", "no:cacheprovider", *files, "-k", f"{only} or first_page")


def test_a_subcommand(tmp_path):
    copy = Copy(tmp_path, SUBCOMMAND)
    assert b"Halve all grey." in copy.penink("--help")
    assert "| `darken` | PGM | PGM | Halve all grey. |" in (tmp_path / "README.md").read_text("utf-8")
    assert "penink darken photo.pgm" in (tmp_path / "penink_cli/share/man/man1/penink-darken.1").read_text("utf-8")
    assert "darken" in (tmp_path / "penink_cli/share/man/man1/penink.1").read_text("utf-8")
    copy.pass_tests(SUBCOMMAND.tests, "darken or follows or installed")


def test_an_output(tmp_path, photographs):
    copy = Copy(tmp_path, OUTPUT)
    assert b"--decimals" in copy.penink("to-ends", "--help") and b".ends" in copy.penink("draw", "--help")
    assert "| `to-ends` | strokes | .ends |" in (tmp_path / "README.md").read_text("utf-8")
    assert "decimals" in (tmp_path / "penink_cli/share/man/man1/penink-to-ends.1").read_text("utf-8")
    drawn = tmp_path / "coins.ends"
    copy.penink("draw", str(photographs("coins")), "--width", "0.5in", "-o", str(drawn))
    assert re.fullmatch(r"(-?\d+\.\d\d( -?\d+\.\d\d){3}\n)+", drawn.read_text())
    copy.pass_tests(OUTPUT.tests, "ends or follows or installed")


def test_an_output_with_a_subcommand_of_its_own(tmp_path, photographs):
    copy = Copy(tmp_path, OWN)
    assert b"--points" in copy.penink("to-tally", "--help") and b".tally" in copy.penink("draw", "--help")
    assert "| `to-tally` | strokes | .tally |" in (tmp_path / "README.md").read_text("utf-8")
    drawn = tmp_path / "coins.tally"
    copy.penink("draw", str(photographs("coins")), "--width", "0.5in", "-o", str(drawn))
    assert re.fullmatch(r"(\d+\n)+", drawn.read_text())
    copy.pass_tests(OWN.tests, "tally or follows or installed")


def test_a_texture(tmp_path):
    copy = Copy(tmp_path, TEXTURE)
    assert b"ticks        short upright lines\n" in copy.penink("texture", "list")
    assert b"ticks" in copy.penink("texture", "make", "--help")
    made = copy.penink("texture", "make", "ticks", "--seed", "3")
    assert json.loads(made)["oriented"] and made == copy.penink("texture", "show", "--json", "ticks")
    copy.pass_tests(TEXTURE.tests, "ticks or kind")


def test_a_rule(tmp_path):
    copy = Copy(tmp_path, RULE)
    assert b"frugal: half as dark." in copy.penink("blast", "--help").replace(b"\n" + b" " * 29, b" ")
    assert b"frugal" in b"".join(path.read_bytes() for path in (tmp_path / "penink_cli/share").rglob("penink-blast.1"))
    schema = json.loads((tmp_path / "penink_cli/formats/schemas/illustration.schema.json").read_text("utf-8"))
    assert "frugal" in schema["$defs"]["layer"]["properties"]["rule"]["enum"]
    copy.pass_tests(RULE.tests, "frugal or follows or installed or rule")


@pytest.mark.parametrize("added", [SUBCOMMAND, OUTPUT, OWN, TEXTURE, RULE], ids=lambda added: Path(added.file).stem)
def test_an_addition_is_one_file_and_one_line(added):
    assert added.line.count("\n") == 1 and len(added.line) <= 121
    assert not (ROOT / added.file).exists()
