"""What docstrings show by example is what happens; public functions have one, which says what they raise."""

from __future__ import annotations

import ast
import doctest
import importlib
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.conftest import ROOT

MODULES = sorted((ROOT / "penink_cli").rglob("*.py"))
SHOWING = [path for path in MODULES if ">>> " in path.read_text("utf-8")]
# A subcommand's docstring is its help text, and what it raises is an error line.
ROOMS = [path for path in MODULES if path.parent.name != "commands"]


@pytest.mark.parametrize("path", SHOWING, ids=lambda path: path.stem)
def test_examples_in_docstrings(path):
    module = importlib.import_module(".".join(path.relative_to(ROOT).with_suffix("").parts))
    failed, tried = doctest.testmod(module)
    assert tried and not failed


def public(tree: ast.Module | ast.ClassDef) -> Iterator[ast.FunctionDef]:
    """Functions and methods whose names, and whose classes' names, begin with no underscore."""
    for node in tree.body:
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            yield from public(node)
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            yield node


def raised(function: ast.FunctionDef) -> Iterator[str]:
    """The errors that a function raises itself, by their classes' names; what it calls may raise others."""
    waiting: list[ast.AST] = list(function.body)
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call) and isinstance(node.exc.func, ast.Name):
            yield from filter(re.compile("[A-Z].*Error").fullmatch, [node.exc.func.id])
        if not isinstance(node, ast.FunctionDef | ast.ClassDef | ast.Lambda):
            waiting += ast.iter_child_nodes(node)


def silent(text: str) -> list[str]:
    """Public functions without a docstring, or that raise errors of which their docstrings say nothing."""
    return [
        function.name
        for function in public(ast.parse(text))
        if not (told := ast.get_docstring(function) or "")
        or any(error not in told for error in raised(function) if error != "AssertionError")
    ]


@pytest.mark.parametrize("path", ROOMS, ids=lambda path: str(path.relative_to(ROOT / "penink_cli")))
def test_public_functions_say_what_they_raise(path: Path):
    assert not silent(path.read_text("utf-8"))


@pytest.mark.parametrize("text", [
    "def number(): return 1",
    "class Number:\n def whole(self):\n  'A number.'\n  raise FormatError('no')",
    "def number():\n 'A number. Raises LimitError.'\n if 1: raise FormatError('no')",
])  # fmt: skip
def test_one_that_does_not_is_found(text: str):
    assert silent(text)
    assert not silent(text.replace("A number.", "Raises FormatError.").replace("return 1", "'One.'"))
