"""Our own sine, exponential, logarithm and angle. They live in a .pxd: the test compiles a face for them."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.conftest import ROOT

FACE = """# cython: language_level=3
from penink_cli.ground._compiled.real cimport angle_of, sine_of, exponential, logarithm
def sin(double x): return sine_of(x)
def exp(double x): return exponential(x)
def log(double x): return logarithm(x)
def angle(double x, double y): return angle_of(x, y)
"""
BUILD = """
import sys
from setuptools import Extension, setup
from Cython.Build import cythonize
sys.argv = ["setup.py", "-q", "build_ext", "--inplace"]
setup(ext_modules=cythonize(
    [Extension("face", ["face.pyx"], extra_compile_args=["-O2", "-ffp-contract=off"])], include_path=[sys.path[0]]))
"""


@pytest.fixture(scope="module")
def face(tmp_path_factory):
    folder = tmp_path_factory.mktemp("face")
    (folder / "face.pyx").write_text(FACE)
    script = f"import sys; sys.path.insert(0, {str(ROOT)!r})\n{BUILD}"
    subprocess.run([sys.executable, "-c", script], cwd=folder, check=True, capture_output=True)
    sys.path.insert(0, str(folder))
    import face

    return face


def _ulps(found, exact):
    return abs(found - exact) / np.spacing(max(abs(exact), 1e-300))


RANGES = [("sin", -1e5, 1e5), ("sin", -4, 4), ("exp", -690, 690), ("exp", -1, 1)]


@pytest.mark.parametrize(("name", "low", "high"), RANGES)
def test_within_two_units_in_the_last_place(face, name, low, high):
    values = np.random.default_rng(1).uniform(low, high, 4000)
    found = np.array([getattr(face, name)(x) for x in values.tolist()])
    # near its zeros the sine of a long way is only as exact as the way
    bound = 2 * np.spacing(np.abs(getattr(np, name)(values))) if name == "exp" else 4e-16
    assert (np.abs(found - getattr(np, name)(values)) <= bound).all()


def test_logarithm(face):
    values = 10.0 ** np.random.default_rng(2).uniform(-300, 300, 4000)
    assert max(_ulps(face.log(x), np.log(x)) for x in values.tolist()) <= 3
    assert face.log(1.0) == 0.0


def test_angle(face):
    x, y = np.random.default_rng(3).normal(size=(2, 4000)) * 10.0 ** np.random.default_rng(4).uniform(-3, 3, (2, 4000))
    found = [face.angle(a, b) for a, b in zip(x.tolist(), y.tolist())]
    assert np.abs(found - np.arctan2(y, x)).max() < 2e-15
    assert (face.angle(-1.0, 0.0), face.angle(0.0, 0.0)) == (np.pi, 0.0)


def test_where_they_are_exact(face):
    assert (face.sin(0.0), face.exp(0.0), face.exp(-1e4)) == (0.0, 1.0, 0.0)


def test_kernels_use_no_other():
    """libm's transcendental functions differ between C libraries in the last bit."""
    forbidden = re.compile(r"from libc\.math cimport [^\n]*\b(sin|cos|tan|exp|log|pow|atan2?|hypot|cbrt|sincos)\b")
    found = [str(p) for p in (ROOT / "penink_cli").rglob("*.p[yx][xd]") if forbidden.search(p.read_text())]
    assert not found


def test_the_face_is_ours(face):
    assert Path(face.__file__).name.startswith("face.")
