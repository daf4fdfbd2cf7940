"""What docstrings show by example is what happens."""

from __future__ import annotations

import doctest
import importlib

import pytest

from tests.conftest import ROOT

SHOWING = sorted(path for path in (ROOT / "penink_cli").rglob("*.py") if ">>> " in path.read_text("utf-8"))


@pytest.mark.parametrize("path", SHOWING, ids=lambda path: path.stem)
def test_examples_in_docstrings(path):
    module = importlib.import_module(".".join(path.relative_to(ROOT).with_suffix("").parts))
    failed, tried = doctest.testmod(module)
    assert tried and not failed
