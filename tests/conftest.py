"""What all tests share: running the command as a process, and photographs to run it on."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, settings

# No test is a stop-watch: a busy machine is no failure.
settings.register_profile("penink", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("quick", settings.get_profile("penink"), max_examples=20)
settings.load_profile("penink")

ROOT = Path(__file__).resolve().parent.parent

Run = Callable[..., "subprocess.CompletedProcess[bytes]"]


def environment(**changes: str) -> dict[str, str]:
    """The environment for a penink process that runs this checkout from any folder."""
    return {**os.environ, "PYTHONPATH": str(ROOT), **changes}


def packages() -> dict[str, str]:
    """Programs that tests may start, and the packages that bring them: .ci/packages."""
    lines = [line.split() for line in (ROOT / ".ci/packages").read_text().splitlines() if not line.startswith("#")]
    return {program: package for program, package, _ in lines}


PACKAGES = packages() | {"sh": "dash", "uname": "coreutils"}  # Python itself starts these two, which are everywhere
RENDERERS = ("gs", "chromium", "pdfimages", "rsvg-convert")


def _watch(event: str, arguments: tuple[object, ...]) -> None:
    """Fail a test that starts a program which is missing, or not in .ci/packages, or in the quick tier a renderer."""
    test = os.environ.get("PYTEST_CURRENT_TEST", "").rsplit(" (", 1)[0]
    if event != "subprocess.Popen" or not test:
        return
    program = os.fsdecode(arguments[0] or arguments[1][0])  # type: ignore[index, arg-type]
    name = os.path.basename(program)
    if "python" in name or name == "penink" or program.startswith((str(ROOT), tempfile.gettempdir())):
        return
    listed = next((known for known in PACKAGES if known.startswith(name)), None)  # chromium-headless-shell is chromium
    assert listed, f"{name} is not in .ci/packages: nobody installs it for the tests"
    assert shutil.which(program), f"{name} is missing: run 'apt-get install {PACKAGES[listed]}' as root"
    if name.startswith(RENDERERS) and test in _quick:
        _quick.discard(test)
        pytest.fail(f"{test} starts {name}: put it among RENDERED in tests/conftest.py")


# A make that a test starts is not to take itself for a part of the make that started the tests.
for _name in ("MAKEFLAGS", "MAKELEVEL", "MFLAGS", "MAKEOVERRIDES"):
    os.environ.pop(_name, None)

_quick: set[str] = set()  # tests of the quick tier that are not marked `rendered`
sys.addaudithook(_watch)


# Tests that `make quick` leaves out, by the beginnings of their names: those that start Ghostscript, Chromium or
# another program that draws, and those that take long. A test of the quick tier that starts one of these programs
# fails.
RENDERED = (
    "tests/selfdrawing/", "tests/blasting/test_blast.py", "tests/arrangement/test_detection.py", "tests/test_chain.py",
    "tests/illustration/test_drawing.py", "tests/outputs/test_postscript.py", "tests/outputs/test_vector.py",
    "tests/outputs/test_raster.py", "tests/outputs/test_swelling.py", "tests/outputs/test_device.py",
    "tests/test_make.py::test_nothing_in_a_name_is_run", "tests/outputs/test_inks.py",
    "tests/blasting/test_engraving.py", "tests/blasting/test_form.py", "tests/blasting/test_rules.py",
    "tests/blasting/test_stroke_set.py", "tests/blasting/test_pressure.py", "tests/blasting/test_restoring.py",
    "tests/blasting/test_reserved.py::test_the_tone_of_the_dark_",
    "tests/illustration/test_layering.py::test_what_is_left_over_",
)  # fmt: skip
SLOW = (
    "tests/faults/test_degenerate.py", "tests/faults/test_environment.py", "tests/faults/test_signals.py",
    "tests/faults/test_shortage.py", "tests/faults/test_outputs.py", "tests/formats/test_found.py",
    "tests/test_make.py", "tests/test_schedules.py", "tests/blasting/test_balancing.py::test_the_filter_writes_one_",
    "tests/test_readme.py::test_every_block", "tests/test_registries.py",
    "tests/outputs/test_manual.py::test_examples_run", "tests/textures/", "tests/directions/test_detection.py",
    "tests/composition/test_separation.py::test_draw_in_inks_",
    "tests/composition/test_separation.py::test_plates_by_name_",
    "tests/illustration/test_fitting.py", "tests/illustration/test_drawing_again.py", "tests/test_real.py",
    "tests/illustration/test_archive.py::test_archives_of_one_file_", "tests/outputs/test_travel.py::test_clusters_",
    "tests/illustration/test_archive.py::test_plates_share_", "tests/illustration/test_archive.py::test_pack_twice_",
    "tests/illustration/test_lines.py::test_loose_and_packed_", "tests/lines/test_detection.py::test_the_list_is_of_",
    "tests/outputs/test_plotter.py::test_a_drawing_for_a_paper_", "tests/measuring/test_measure.py",
    "tests/reconstruction/test_enlarge.py::test_random_", "tests/reconstruction/test_enlarge.py::test_a_strong_",
    "tests/reconstruction/test_enlarge.py::test_the_two_oracles_agree",
    "tests/composition/test_separation.py::test_plates_and_lines_whose_sheets_",
    "tests/reconstruction/test_thinning.py", "tests/arrangement/test_strengths.py::test_strengths_are_the_steps_",
)  # fmt: skip


def pytest_configure(config: pytest.Config) -> None:
    """Let the quick tier try fewer examples of each property."""
    if "not rendered" in config.option.markexpr:
        settings.load_profile("quick")


def pytest_itemcollected(item: pytest.Item) -> None:
    """Mark tests that the quick tier leaves out, and remember those that it runs."""
    if "ghostscript" in getattr(item, "fixturenames", ()) or item.nodeid.startswith(RENDERED):
        item.add_marker(pytest.mark.rendered)
    if item.nodeid.startswith(SLOW):
        item.add_marker(pytest.mark.slow)
    if "not rendered" in item.config.option.markexpr and not any(item.iter_markers("rendered")):
        _quick.add(item.nodeid)


@pytest.fixture(scope="session", autouse=True)
def _signals_as_from_a_terminal() -> None:
    """Let the processes that tests start obey the signals that nohup, or a script's background, has set to be ignored.

    A handler that does nothing keeps this process alive as before; a program that it executes has the default again.
    """
    for number in (signal.SIGINT, signal.SIGHUP, signal.SIGTERM, signal.SIGQUIT):
        if signal.getsignal(number) == signal.SIG_IGN:
            signal.signal(number, lambda *_: None)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--rewrite-golden", action="store_true", help="write tests/golden anew from what is found")


@pytest.fixture(scope="session")
def penink(request: pytest.FixtureRequest) -> Iterator[Run]:
    """Run ``penink ARGUMENTS`` as a process: penink("reduce", "--factor", "4", input=bytes).

    The quick tier forks these processes from one that has imported everything, which takes a tenth of the time.
    """

    def run(*arguments: object, **options: object) -> subprocess.CompletedProcess[bytes]:
        options.setdefault("env", environment())
        if "input" not in options:
            options.setdefault("stdin", subprocess.DEVNULL)
        command = [sys.executable, "-m", "penink_cli", *map(str, arguments)]
        return subprocess.run(command, capture_output=True, check=False, **options)  # type: ignore[call-overload]

    if "not rendered" not in request.config.option.markexpr:
        yield run
        return
    from tests.faults.forkserver import ForkServer

    server, began = ForkServer(), dict(os.environ)

    def forked(*arguments: object, **options: Any) -> subprocess.CompletedProcess[bytes]:
        now = {name: value for name, value in os.environ.items() if name != "PYTEST_CURRENT_TEST"}
        if not options.keys() <= {"input", "cwd"} or began.keys() - now.keys() - {"PYTEST_CURRENT_TEST"}:
            return run(*arguments, **options)
        changed = {name: value for name, value in now.items() if began.get(name) != value}
        given = options["input"] if "input" in options else os.open(os.devnull, os.O_RDONLY)
        try:
            done = server.run(*arguments, stdin=given, cwd=options.get("cwd", Path.cwd()), env=changed)
        finally:
            if isinstance(given, int):
                os.close(given)
        return subprocess.CompletedProcess(["penink", *map(str, arguments)], done.status, done.out, done.err)

    yield forked
    server.close()


@pytest.fixture(scope="session")
def photographs(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """The path of a bundled photograph as PNG: photographs("camera")."""
    folder = tmp_path_factory.mktemp("photographs")

    def path(name: str) -> Path:
        import skimage.data
        from PIL import Image

        file = folder / f"{name}.png"
        if not file.exists():
            Image.fromarray(np.asarray(getattr(skimage.data, name)())).save(file)
        return file

    return path


@pytest.fixture(scope="session")
def ghostscript() -> Callable[..., np.ndarray]:
    """Render PostScript bytes: ghostscript(ps, dpi=150, antialias=True) -> (h, w) grey 0 … 1, 1 is paper.

    Fails, and does not skip, where Ghostscript is missing or prints anything at all.
    """
    import io

    from PIL import Image

    def render(postscript: bytes, dpi: float = 150, antialias: bool = True) -> np.ndarray:
        command = ["gs", "-q", "-dSAFER", "-dBATCH", "-dNOPAUSE", "-dEPSCrop", f"-r{dpi:g}", "-sDEVICE=pgmraw"]
        command += ["-dGraphicsAlphaBits=4"] if antialias else []
        done = subprocess.run(
            [*command, "-sOutputFile=%stdout", "-"], input=postscript, capture_output=True, check=True
        )
        assert not done.stderr, done.stderr
        picture = Image.open(io.BytesIO(done.stdout))
        return np.asarray(picture, dtype=np.float64) / 255

    return render
