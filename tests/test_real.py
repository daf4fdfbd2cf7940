"""Our own sine, exponential, logarithm and angle over long ranges; `test_same_bytes.py` has their bits and edges."""

import re

import numpy as np
import pytest

from penink_cli.ground import exact
from tests.conftest import ROOT

RANGES = [("sin", -1e5, 1e5), ("cos", -1e5, 1e5), ("sin", -4, 4), ("cos", -4, 4), ("exp", -690, 690), ("exp", -1, 1)]
FUNCTIONS = {"sin": lambda x: exact.cos_sin(x)[1], "cos": lambda x: exact.cos_sin(x)[0], "exp": exact.exp}


@pytest.mark.parametrize(("name", "low", "high"), RANGES)
def test_within_two_units_in_the_last_place(name, low, high):
    values = np.random.default_rng(1).uniform(low, high, 4000)
    true = getattr(np, name)(values)
    # near its zeros the sine of a long way is only as exact as the way
    bound = 2 * np.spacing(true) if name == "exp" else 4e-16
    assert (np.abs(FUNCTIONS[name](values) - true) <= bound).all()


def test_logarithm():
    values = 10.0 ** np.random.default_rng(2).uniform(-300, 300, 4000)
    true = np.log(values)
    assert (np.abs(exact.log(values) - true) <= 3 * np.spacing(np.abs(true))).all()


def test_angle():
    x, y = np.random.default_rng(3).normal(size=(2, 4000)) * 10.0 ** np.random.default_rng(4).uniform(-3, 3, (2, 4000))
    assert np.abs(exact.atan2(y, x) - np.arctan2(y, x)).max() < 2e-15


def test_shapes_are_kept_and_brought_together():
    x = np.arange(1.0, 7.0).reshape(2, 3)
    assert np.array_equal(exact.exp(x.T), exact.exp(x).T) and exact.log(x[:, ::2]).shape == (2, 2)
    assert np.array_equal(exact.power(x, 2.0), exact.exp(2.0 * exact.log(x)))
    assert np.array_equal(exact.atan2(x, x[0]), exact.atan2(x, np.broadcast_to(x[0], (2, 3))))
    assert exact.exp(np.zeros((0, 2))).shape == (0, 2) and exact.exp(0.5).shape == ()


def test_kernels_use_no_other():
    """libm's transcendental functions differ between C libraries in the last bit."""
    forbidden = re.compile(r"from libc\.math cimport [^\n]*\b(sin|cos|tan|exp|log|pow|atan2?|hypot|cbrt|sincos)\b")
    found = [str(p) for p in (ROOT / "penink_cli").rglob("*.p[yx][xd]") if forbidden.search(p.read_text())]
    assert not found
