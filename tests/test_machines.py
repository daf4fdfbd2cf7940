"""What the system must have: one list for `make`, tests and README; all that is missing named at once, first."""

from __future__ import annotations

import ast
import os
import re
import shutil
import subprocess
import sys
import tomllib

import pytest

from tests.conftest import ROOT, packages


def needed(*who: str) -> set[str]:
    lines = [line.split() for line in (ROOT / ".ci/packages").read_text().splitlines() if not line.startswith("#")]
    return {package for _, package, needer in lines if needer in who}


def test_the_readme_repeats_the_list():
    text = (ROOT / "README.md").read_text("utf-8")
    drawing, testing = re.findall(r"^    apt-get install ([a-z0-9 .+-]+)", text, re.M)
    assert set(drawing.split()) == needed("install", "make") and set(testing.split()) == needed("test")


@pytest.fixture
def bare(tmp_path):
    """A PATH with Python, the shell and what every system has: nothing of the list, and no apt-get."""
    for name in ("sh", "grep", "sort", "tr", "sed", "id", "dirname"):
        (tmp_path / name).symlink_to(shutil.which(name))
    (tmp_path / "python3").write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')
    (tmp_path / "python3").chmod(0o755)
    return tmp_path


@pytest.mark.parametrize("who", ["install", "make", "test"])
def test_all_that_is_missing_is_named_at_once(bare, who):
    command = ["sh", str(ROOT / ".ci/need"), who]
    done = subprocess.run(command, env={"PATH": str(bare)}, capture_output=True, text=True, check=False)
    assert done.returncode == 1 and done.stdout == "" and done.stderr.count("\n") == 1
    named = set(re.search(r"apt-get install ([^']*)'", done.stderr)[1].split())
    tiers = {"install": ("install",), "make": ("install", "make"), "test": ("install", "make", "test")}[who]
    assert named == needed(*tiers) - {"python3-dev", "python3-venv"}  # which this interpreter has


def test_an_interpreter_that_is_too_old_is_named(bare):
    (bare / "python3").write_text("#!/bin/sh\nexit 1\n")
    command = ["sh", str(ROOT / ".ci/need"), "install"]
    done = subprocess.run(command, env={"PATH": str(bare)}, capture_output=True, text=True, check=False)
    told = "python3 is not CPython 3.11 or later: make PYTHON=/path/to/another\n"
    assert (done.returncode, done.stderr) == (1, told)


def test_it_comes_before_anything_else_is_done(tmp_path):
    told = subprocess.run(
        ["make", "-n", "test", f"VENV={tmp_path}/venv"], cwd=ROOT, env={**os.environ, "MAKEFLAGS": ""},
        capture_output=True, text=True, check=True,
    ).stdout.split("\n")  # fmt: skip
    assert told[0].endswith(".ci/need test")
    plain = subprocess.run(
        ["make", "-n", f"VENV={tmp_path}/venv"], cwd=ROOT, env={**os.environ, "MAKEFLAGS": ""},
        capture_output=True, text=True, check=True,
    ).stdout  # fmt: skip
    assert plain.split("\n")[0].endswith(".ci/need make")


def test_no_test_starts_a_program_that_nobody_installs():
    with pytest.raises(AssertionError, match=r"xmllint is not in \.ci/packages"):
        subprocess.run(["xmllint", "--version"], check=False)


READERS = "readers.py"  # a benchmark whose scripts run in the interpreters of the programs that it compares


def imported() -> set[str]:
    """Modules that tests import, in scripts that they run as well, which are not Python's own."""
    found = set()
    for path in (ROOT / "tests").rglob("*.py"):
        tree = ast.parse(path.read_text("utf-8"))
        for node in ast.walk(tree):
            if isinstance(node, ast.Import):
                found |= {name.name for name in node.names}
            elif isinstance(node, ast.ImportFrom):
                found.add(node.module)
            elif isinstance(node, ast.Constant) and isinstance(node.value, str) and path.name != READERS:
                found |= set(re.findall(r"^\s*(?:import|from) ([A-Za-z]\w*)(?=\s*$| import |\.|,)", node.value, re.M))
    own = {"tests", "penink_cli", "samples"}
    return {name.split(".")[0] for name in found} - set(sys.stdlib_module_names) - own


def test_tests_import_what_the_project_asks_for():
    """And nothing that happens to lie beside it, as setuptools does in the environments of some Pythons."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    extras = project["optional-dependencies"]
    asked = [*project["dependencies"], *(line for name, lines in extras.items() if name != "lint" for line in lines)]
    names = {re.match(r"[\w-]+", line)[0].lower().replace("-", "_") for line in asked}
    called = {"PIL": "pillow", "skimage": "scikit_image"}
    modules = imported()
    assert {"numpy", "hypothesis"} <= modules
    assert {called.get(name, name).lower() for name in modules} <= names


def test_a_program_that_is_missing_is_named_with_what_brings_it(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    for program, package in packages().items():
        if program not in ("headers", "venv"):
            with pytest.raises(AssertionError, match=f"{program} is missing: run 'apt-get install {package}' as root"):
                subprocess.run([program], check=False)
