"""The same bytes wherever a filter runs: locale, time zone, hash seed, threads, processors, folder, names."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from penink_cli.main import _lacks_room
from tests.conftest import ROOT, environment
from tests.faults.calls import CALLS, arguments

PYTHON = (sys.executable, "-m", "penink_cli")


def run(
    words: list[str], env: dict[str, str] | None = None, command: tuple[str, ...] = PYTHON, **options: object
) -> bytes:
    env = environment() if env is None else env
    done = subprocess.run(
        [*command, *words], env=env, capture_output=True, stdin=subprocess.DEVNULL, check=False, **options
    )  # type: ignore[call-overload]
    assert (done.returncode, done.stderr) == (0, b""), done.stderr
    return done.stdout


@pytest.mark.parametrize("name", CALLS)
def test_one_strange_environment_for_every_subcommand(name, server, inputs):
    """All at once, since whatever differs would show: then the parts, below, for one subcommand."""
    strange = environment(
        LC_ALL="C", LANG="tr_TR.UTF-8", TZ="Asia/Kathmandu", PYTHONHASHSEED="77", PYTHONUTF8="0", COLUMNS="20",
        OMP_NUM_THREADS="3", OPENBLAS_NUM_THREADS="2", PYTHONINTMAXSTRDIGITS="640",
    )  # fmt: skip
    for gone in ("HOME", "TMPDIR", "USER", "LOGNAME", "TERM"):
        strange.pop(gone, None)
    done = run(arguments(name, inputs), strange, (sys.executable, "-OO", "-m", "penink_cli"), cwd="/")
    assert done == server.run(*arguments(name, inputs), cwd=ROOT).out


ENVIRONMENTS = {
    "locale C": {"LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"},
    "locale POSIX": {"LC_ALL": "POSIX"},
    "a locale there is none of": {"LC_ALL": "xx_XX.ISO-8859-7"},
    "time zone": {"TZ": "Pacific/Chatham"},
    "hash seed 0": {"PYTHONHASHSEED": "0"},
    "hash seed 1": {"PYTHONHASHSEED": "1"},
    "one thread of everything": {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"},
    "no temporary folder": {"TMPDIR": "/nowhere", "TEMP": "/nowhere", "TMP": "/nowhere"},
    "no home": {"HOME": "/nowhere", "XDG_CACHE_HOME": "/nowhere"},
    "text as ASCII": {"PYTHONIOENCODING": "ascii:strict"},
    "development mode": {"PYTHONDEVMODE": "1", "PYTHONWARNINGS": "default"},
}


@pytest.mark.parametrize("name", ENVIRONMENTS)
def test_each_part_of_the_environment(name, server, inputs):
    words = arguments("reduce", inputs)
    assert run(words, environment(**ENVIRONMENTS[name])) == server.run(*words).out


def test_an_empty_environment(server, inputs):
    words = arguments("detect-edges", inputs)
    assert run(words, {"PYTHONPATH": str(ROOT)}) == server.run(*words).out


@pytest.mark.parametrize("flags", [("-O",), ("-OO",), ("-B", "-s"), ("-X", "utf8=0"), ("-W", "error")])
def test_flags_of_the_interpreter(flags, server, inputs):
    words = arguments("reduce", inputs)
    assert run(words, command=(sys.executable, *flags, "-m", "penink_cli")) == server.run(*words).out


def test_one_processor(server, inputs):
    words = arguments("reduce", inputs)
    one = {min(os.sched_getaffinity(0))}
    assert run(words, preexec_fn=lambda: os.sched_setaffinity(0, one)) == server.run(*words).out


# All that is loaded at need is there after a first picture: what a loader says that finds no room is not ours.
LITTLE_MEMORY = """
import os, resource, sys
from penink_cli.main import main
try:
    main(["detect-edges", sys.argv[1], "-o", os.devnull])
except SystemExit as end:
    assert not end.code
used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + 4_000_000,) * 2)
main(["detect-edges", sys.argv[2]])
"""


def test_little_memory_is_one_line(inputs, tmp_path):
    (tmp_path / "large.pgm").write_bytes(b"P5 4000 3000 255\n" + bytes(12_000_000))
    command = [sys.executable, "-c", LITTLE_MEMORY, inputs / "photo.png", tmp_path / "large.pgm"]
    done = subprocess.run(command, env=environment(), capture_output=True, check=False, timeout=60)
    told = f"penink detect-edges: {tmp_path / 'large.pgm'}: 4000 x 3000 pixels do not fit into memory\n"
    assert (done.returncode, done.stderr.decode()) == (1, told)


def test_a_library_that_finds_no_room_is_a_want_of_memory():
    room = ImportError("libopenblas.so: failed to map segment from shared object")
    wrapped = ImportError("the install seems to be broken")
    wrapped.__cause__ = room
    assert _lacks_room(room) and _lacks_room(wrapped) and not _lacks_room(ImportError("no module named x"))


@pytest.mark.parametrize("name", [n for n in ("enlarge", "blast", "render") if n in CALLS])
def test_any_number_of_threads(name, server, inputs):
    found = {server.run(*arguments(name, inputs), "--threads", n).out for n in (1, 2, 3, 16)}
    assert len(found) == 1 and all(found)


def test_any_working_folder(server, inputs, tmp_path):
    expected = server.run(*arguments("reduce", inputs)).out
    relative = ["reduce", "samples.pgm", "-e", "./photo.edges.json", "--factor", "2"]
    assert server.run(*relative, cwd=inputs).out == expected
    gone = tmp_path / "gone"
    gone.mkdir()
    script = f'cd "{gone}" && rmdir "{gone}" && exec "$@"'
    command = ("sh", "-c", script, "-", *PYTHON)
    assert run(arguments("reduce", inputs), command=command) == expected


@pytest.mark.parametrize(
    "name", [b"caf\xe9", b"\xff\xfe", "日本".encode(), b"new\nline", b"-dash", b"\x1b[31mred", b" ", b"%s$HOME"]
)
def test_any_name_of_a_file(name, server, inputs, tmp_path):
    """Names are bytes: what is not UTF-8, or not printable, is read, written, and escaped in error lines."""
    words = arguments("reduce", inputs, by_name=False)
    expected = server.run(*words, inputs / "samples.pgm").out
    given, made = os.path.join(os.fsencode(tmp_path), name), os.path.join(os.fsencode(tmp_path), b"out" + name)
    Path(os.fsdecode(given)).write_bytes((inputs / "samples.pgm").read_bytes())
    for env in (environment(), environment(LC_ALL="C", PYTHONCOERCECLOCALE="0", PYTHONUTF8="0")):
        command = [*PYTHON, *words, "-o", made, given]
        assert subprocess.run(command, env=env, check=True, capture_output=True).stderr == b""
        assert Path(os.fsdecode(made)).read_bytes() == expected
        Path(os.fsdecode(given)).write_bytes(b"")
        done = subprocess.run(command, env=env, check=False, capture_output=True)
        assert done.returncode == 1 and done.stderr.startswith(b"penink reduce: ") and done.stderr.count(b"\n") == 1
        assert done.stderr.decode()[:-1].isprintable()
        Path(os.fsdecode(given)).write_bytes((inputs / "samples.pgm").read_bytes())


def test_a_relative_name_with_a_dash_and_a_file_called_dash(server, inputs, tmp_path):
    (tmp_path / "-").write_bytes((inputs / "samples.pgm").read_bytes())
    words = arguments("reduce", inputs, by_name=False)
    expected = server.run(*words, inputs / "samples.pgm").out
    assert server.run(*words, "./-", cwd=tmp_path).out == expected
    assert server.run(*words, "./-", "-o", "./-x", cwd=tmp_path).status == 0
    assert (tmp_path / "-x").read_bytes() == expected


def test_a_drawing_of_any_name_makes_a_texture_that_can_be_read(inputs, tmp_path):
    """The texture is called as its file; a byte that is not UTF-8 becomes a question mark."""
    drawing = os.path.join(os.fsencode(tmp_path), b"caf\xe9.svg")
    path = '<path d="M0 0h9" stroke="#000"/>'
    svg = f'<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9">{path}</svg>'
    Path(os.fsdecode(drawing)).write_text(svg)
    made = subprocess.run([*PYTHON, "texture", "import", drawing], check=True, capture_output=True).stdout
    shown = subprocess.run([*PYTHON, "texture", "show", "-"], input=made, check=True, capture_output=True).stdout
    assert b"name      caf?\n" in shown
