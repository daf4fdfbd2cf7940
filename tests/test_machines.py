"""What the system must have: one list for `make`, tests and README; all that is missing named at once, first."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys

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


def test_a_program_that_is_missing_is_named_with_what_brings_it(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    for program, package in packages().items():
        if program not in ("headers", "venv"):
            with pytest.raises(AssertionError, match=f"{program} is missing: run 'apt-get install {package}' as root"):
                subprocess.run([program], check=False)
