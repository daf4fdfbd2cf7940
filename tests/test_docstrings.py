"""What docstrings show by example is what happens."""

from __future__ import annotations

import doctest
import importlib
import re

import pytest

import tests
from tests.conftest import ROOT

SHOWING = sorted(path for path in (ROOT / "penink_cli").rglob("*.py") if ">>> " in path.read_text("utf-8"))


@pytest.mark.parametrize("path", SHOWING, ids=lambda path: path.stem)
def test_examples_in_docstrings(path):
    module = importlib.import_module(".".join(path.relative_to(ROOT).with_suffix("").parts))
    failed, tried = doctest.testmod(module)
    assert tried and not failed


def test_what_was_wrong_once_has_the_tests_that_are_named():
    named = re.findall(r"^    (\S+\.py)::(\w+)$", tests.__doc__, re.MULTILINE)
    assert len(named) > 10
    for path, name in named:
        assert f"\ndef {name}(" in (ROOT / "tests" / path).read_text("utf-8"), f"{path}::{name}"
