"""The command itself: the table of subcommands, errors, exit statuses."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
import threading

import click
import numpy as np
import pytest

from penink_cli import main
from penink_cli.ground import errors, units
from penink_cli.main import SUBCOMMANDS, command_of
from penink_cli.options import common as options
from penink_cli.reconstruction import lanes
from tests.conftest import ROOT, environment

KERNELS = sorted((ROOT / "penink_cli").glob("**/_compiled/*.pyx"))


@pytest.mark.parametrize("kernel", KERNELS, ids=lambda kernel: f"{kernel.parts[-3]}.{kernel.stem}")
def test_each_kernel_was_found_by_the_build(kernel):
    if kernel.stem.endswith("_avx2") and lanes.VECTOR_BYTES < 32:
        pytest.skip("this processor cannot run it")
    module = importlib.import_module(".".join(kernel.relative_to(ROOT).with_suffix("").parts))
    assert not module.__file__.endswith((".py", ".pyx"))


@pytest.mark.parametrize("name", SUBCOMMANDS)
def test_every_subcommand_is_described_in_the_table_as_in_its_docstring(name):
    command = command_of(name)
    assert isinstance(command, click.Command)
    assert command.name == name
    assert command.help.splitlines()[0] == SUBCOMMANDS[name].summary
    for parameter in command.params:
        if isinstance(parameter, click.Option):
            assert parameter.help, f"{name} {parameter.opts} has no help"


@pytest.mark.parametrize("name", SUBCOMMANDS)
def test_every_subcommand_has_the_options_of_a_filter(name, penink):
    done = penink(name, *{"texture": ("make",), "style": ("show",)}.get(name, ()), "--help")
    assert done.returncode == 0 and not done.stderr
    for option in (b"--output", b"--quiet", b"--max-pixels"):
        assert option in done.stdout


def test_version(penink):
    from penink_cli import __version__

    done = penink("--version")
    assert done.stdout.decode() == f"penink {__version__}\n" and done.returncode == 0


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["enlrage"], "did you mean enlarge?"),
        (["reduce", "--fctor", "4"], "--factor"),
        (["reduce", "--factor", "4", "--relative"], "--relative goes with --auto"),
        (["reduce", "--auto", "--relative"], "--relative goes with --seen-at"),
        (["enlarge", "--scale", "nan"], "not a number above 0"),
        (["enlarge", "--scale", "1_0"], "'1_0' is not a number above 0"),
        (["enlarge", "--size", "4x0"], "not a size"),
        (["blast", "--width", "4parsec"], "not a length"),
        (["blast", "--width", "4\nin"], "'4\\nin' is not a length"),
        (["separate", "--grey", "0.2"], "'0.2' is not a range of grey such as 0,0.5"),
        (["separate", "--grey", "0_1,1"], "is not a range of grey"),
        (["separate", "--point", "7"], "'7' is not a point such as"),
        (["completion"], "Choose from: bash, zsh, fish (see"),
        (["blast", "--width", "1in", "--layer", "a\udcff"], "'--layer': 'a\\udcff' is not UTF-8"),
        (["outline", "--width", "1in", "--pen", "1pt", "--weight", "2pt"], "give one of --pen and --weight"),
        (["thin-edges", "--keep-length", "4"], "--keep-length goes with --keep-strength"),
        (["detect-lines", "--density", "1"], "--density goes with --seen-at"),
        (["detect-lines", "--per-inch2", "1"], "--per-inch2 goes with --seen-at"),
        (["to-svg", "--join", "1mm"], "--join goes with --order"),
        (["texture", "import", "--whole", "--oriented"], "--whole is of a tile, and does not go with --oriented"),
        (["texture", "make", "fur", "--name", "\udcff"], "'--name': '\\udcff' is not UTF-8"),
        (["texture", "import", "--name", "\udcff"], "'--name': '\\udcff' is not UTF-8"),
        (["to-html", "--title", "\udcff"], "'--title': '\\udcff' is not UTF-8"),
        (["to-pdf", "--author", "\udcff"], "'--author': '\\udcff' is not UTF-8"),
    ],
)
def test_wrong_usage_is_one_line_and_status_2(arguments, complaint, penink):
    done = penink(*arguments)
    assert done.returncode == 2
    assert complaint in done.stderr.decode()
    assert done.stderr.count(b"\n") == 1 and not done.stdout


def test_a_missing_file_is_one_line_and_status_1(penink):
    done = penink("detect-edges", "no\nsuch\x1b.png")
    assert done.returncode == 1
    assert done.stderr == b"penink detect-edges: no\\nsuch\\x1b.png: No such file or directory\n"
    assert not done.stdout


@pytest.mark.parametrize(("environ", "red"), [({}, True), ({"NO_COLOR": "1"}, False), ({"TERM": "dumb"}, False)])
def test_the_program_s_name_is_red_on_a_terminal_only(environ, red):
    ours, theirs = os.openpty()
    before = {"TERM": "xterm", "NO_COLOR": ""}
    command = [sys.executable, "-m", "penink_cli", "reduce", "--factor", "2", "no-such.pgm"]
    subprocess.run(command, env=environment(**(before | environ)), stderr=theirs, check=False)
    os.close(theirs)
    line = os.read(ours, 1000).decode()
    os.close(ours)
    name = "\x1b[1;31mpenink reduce:\x1b[0m" if red else "penink reduce:"
    assert line == f"{name} no-such.pgm: No such file or directory\r\n"


def test_an_error_line_names_the_subcommand_of_a_subcommand(penink):
    done = penink("texture", "import", input=b"hello\n")
    assert done.returncode == 1 and done.stderr.startswith(b"penink texture import: <stdin>: not SVG")
    done = penink("texture", "show", "--nme")
    assert done.returncode == 2 and done.stderr.startswith(b"penink texture show: ")
    assert b"(see penink texture show --help)" in done.stderr


def test_the_table_of_subcommands_of_subcommands_is_whole():
    for name, entry in SUBCOMMANDS.items():
        command = command_of(name)
        parts = tuple(command.commands) if isinstance(command, click.Group) else ()
        assert entry.parts == parts


def test_a_backslash_is_shown_once(penink):
    done = penink("reduce", "--factor", "2", input=b"\n\n")
    assert done.stderr == b"penink reduce: <stdin>: not a PGM image: begins with '\\n\\n', not P2 or P5\n"


EDGES = b'{"format": "penink-edges", "version": 1, "width": 451, "height": 300, "vertices": [[9, 9], [99, 99]]'
EDGES += b', "edges": [[0, 1]]}'


@pytest.mark.parametrize(
    ("width", "height", "warned"),
    [(451, 300, 0), (100, 67, 0), (100, 66, 0), (902, 600, 0), (3, 2, 0), (384, 303, 1), (300, 451, 1), (902, 610, 1)],
)
def test_edges_of_a_picture_of_another_shape_are_warned_of(width, height, warned, penink, tmp_path):
    (tmp_path / "e.json").write_bytes(EDGES)
    photo = b"P5 %d %d 255\n" % (width, height) + bytes([200]) * (width * height)
    done = penink("extract-samples", "-e", tmp_path / "e.json", input=photo)
    assert done.returncode == 0 and done.stdout.startswith(b"P5\n%d" % width)
    assert done.stderr.count(b"\n") == warned
    told = f"451 x 300 pixels, and this of {width} x {height} has another shape"
    assert (told in done.stderr.decode()) == bool(warned)


def test_a_photo_of_another_shape_than_the_samples_is_warned_of(penink, tmp_path):
    (tmp_path / "photo.pgm").write_bytes(b"P5 9 9 255\n" + bytes(81))
    done = penink("reduce", "--factor", "2", "--photo", tmp_path / "photo.pgm", input=b"P5 9 6 255\n" + bytes(54))
    told = b"the edges are of a picture of 9 x 6 pixels, and the photo of 9 x 9 has another shape\n"
    assert done.stderr == b"penink reduce: warning: " + told and done.returncode == 0 and done.stdout


def test_a_drawing_of_a_few_points_is_warned_of(penink):
    done = penink("outline", "--width", "4", input=EDGES)
    assert done.returncode == 0 and done.stdout
    told = "penink outline: warning: the drawing is 4 × 2.66 pt (1.4 × 0.94 mm) on paper"
    assert done.stderr.decode().startswith(told) and done.stderr.count(b"\n") == 1
    assert not penink("outline", "--width", "4in", input=EDGES).stderr


def test_lengths_are_points_and_know_their_units():
    assert units.parse_length("1in") == 72
    assert units.parse_length("25.4 mm".replace(" ", "")) == 72
    assert units.parse_length("2.54cm") == pytest.approx(72)
    assert units.parse_length(".5") == 0.5
    assert units.parse_length("600px", dpi=600) == 72
    for wrong in ("", "in", "-1in", "1e3", "nan", "1 in", "600px", "1inch", "٣in"):
        with pytest.raises(errors.ParameterError):
            units.parse_length(wrong)


@pytest.mark.parametrize("text", ["640x480", "1X1"])
def test_sizes(text):
    width, height = options.SIZE.convert(text, None, None)
    assert f"{width}x{height}" == text.lower()


@pytest.mark.parametrize("text", ["", "x", "0x4", "4x", "4x4x4", "-1x4", "1.5x2", "٤x٤"])
def test_sizes_that_are_none(text):
    with pytest.raises(click.BadParameter):
        options.SIZE.convert(text, None, None)


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["--self", "--paper", "a4"], "--paper is of strokes, and does not go with --self"),
        (["--self", "--margin", "9"], "--margin is of strokes, and does not go with --self"),
        (["--self", "--landscape"], "--landscape is of strokes, and does not go with --self"),
        (["--self", "--colour", "red"], "--color is of strokes, and does not go with --self"),
        (["--self", "--device-dpi", "300"], "--device-dpi is of strokes, and does not go with --self"),
        (["--self", "--compress"], "--compress is of strokes, and does not go with --self"),
        (["--level", "2"], "--level goes with --self"),
        (["--readable"], "--readable goes with --self"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)  # fmt: skip
def test_to_ps_takes_no_option_that_it_would_ignore(penink, arguments, line):
    done = penink("to-ps", *arguments, input=b"")
    assert done.returncode == 2 and line in done.stderr.decode()


def test_a_sheet_is_limited_by_its_area_and_the_refusal_is_quick(penink, tmp_path):
    tall = tmp_path / "tall.pgm"
    tall.write_bytes(b"P5 1 300 255\n" + bytes(300))
    done = penink("draw", "--width", "3in", tall)
    assert done.returncode == 1 and b"3 \xc3\x97 900 in on paper needs 55987200 pixels; at most 50000000" in done.stderr
    done = penink("blast", "--width", "1in", "--max-pixels", "1000", tall)
    assert done.returncode == 1 and b"at most 1000 are allowed (--max-pixels)" in done.stderr


def test_what_is_written_is_limited_as_what_is_read(penink, tmp_path):
    small = tmp_path / "small.pgm"
    small.write_bytes(b"P5 10 10 255\n" + bytes(100))
    done = penink("enlarge", "--scale", "4", "--max-pixels", "1599", small)
    told = b"penink enlarge: 40 x 40 pixels are asked for; at most 1599 are allowed (--max-pixels)\n"
    assert (done.returncode, done.stdout, done.stderr) == (1, b"", told)
    assert penink("enlarge", "--scale", "4", "--max-pixels", "1600", "-q", small).returncode == 0
    assert penink("enlarge", "--scale", "4", "--window", "0,0,40,2", "--max-pixels", "100", "-q", small).returncode == 0
    done = penink("enlarge", "--scale", "4000", small)
    assert done.returncode == 1 and b"40000 x 40000 pixels are asked for; at most 1000000000" in done.stderr
    # a picture of strokes too: 144 dots an inch of the sheet pass, 150 of the picture do not
    done = penink("draw", "--width", "2in", "--max-pixels", "85000", small, "-o", tmp_path / "drawn.png")
    assert done.returncode == 1 and b"300 x 300 pixels; at most 85000 are allowed" in done.stderr
    assert not (tmp_path / "drawn.png").exists()


def test_threads_are_as_many_as_asked_for_everywhere(tmp_path, monkeypatch):
    """Also in stages that take no number: one thread starts no other."""
    photo = tmp_path / "photo.pgm"
    y, x = np.mgrid[:200, :200]
    photo.write_bytes(b"P5 200 200 255\n" + ((np.hypot(x - 99, y - 99) % 40 < 20) * 255).astype(np.uint8).tobytes())
    started = []
    start = threading.Thread.start
    monkeypatch.setattr(threading.Thread, "start", lambda self: (started.append(self), start(self)))
    for ending in ("png", "ps"):
        output = str(tmp_path / f"o.{ending}")
        main._run(["draw", "--quiet", "--threads", "1", "--width", "1in", str(photo), "-o", output])
    assert (tmp_path / "o.png").exists() and not started
    from penink_cli.ground import threads

    assert threads.limit(None) is None


def test_a_drawing_too_thin_for_strokes_is_told(penink, tmp_path):
    wide = tmp_path / "wide.pgm"
    wide.write_bytes(b"P5 300 1 255\n" + bytes(300))
    done = penink("draw", "--width", "3in", wide)
    assert done.returncode == 0 and done.stderr.decode().count("\n") == 1
    assert "the drawing is 216 × 0.72 pt" in done.stderr.decode()
