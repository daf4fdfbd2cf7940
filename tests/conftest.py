"""What all tests share: running the command as a process, and photographs to run it on."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, settings

# No test is a stop-watch: a busy machine is no failure.
settings.register_profile("penink", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("penink")

ROOT = Path(__file__).resolve().parent.parent

Run = Callable[..., "subprocess.CompletedProcess[bytes]"]


def environment(**changes: str) -> dict[str, str]:
    """The environment for a penink process that runs this checkout from any folder."""
    return {**os.environ, "PYTHONPATH": str(ROOT), **changes}


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--rewrite-golden", action="store_true", help="write tests/golden anew from what is found")


@pytest.fixture(scope="session")
def penink() -> Run:
    """Run ``penink ARGUMENTS`` as a process: penink("reduce", "--factor", "4", input=bytes)."""

    def run(*arguments: object, **options: object) -> subprocess.CompletedProcess[bytes]:
        options.setdefault("env", environment())
        if "input" not in options:
            options.setdefault("stdin", subprocess.DEVNULL)
        command = [sys.executable, "-m", "penink_cli", *map(str, arguments)]
        return subprocess.run(command, capture_output=True, check=False, **options)  # type: ignore[call-overload]

    return run


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
