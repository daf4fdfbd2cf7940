"""The README's commands are such as the program has, its manifest one that is read, and its blocks run as pasted."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys

import click
import jsonschema
import numpy as np
import pytest
from PIL import Image

from penink_cli.main import SUBCOMMANDS, command_of
from tests.conftest import ROOT, environment

README = (ROOT / "README.md").read_text("utf-8")
CODE = "\n".join(re.findall(r"^    .*|`[^`\n]+`", README, re.M))
# A command up to the pipe or redirection that ends it.
CALLS = sorted(set(re.findall(r"(?<![/\w-])penink ([a-z][a-z-]*)([^|`>;\n]*)", CODE)))


@pytest.mark.parametrize(("name", "words"), CALLS)
def test_every_command_and_option_exists(name, words):
    assert name in SUBCOMMANDS
    command = command_of(name)
    if isinstance(command, click.Group) and words.split():
        command = command.commands[words.split()[0]]
    known = {option for p in command.params if isinstance(p, click.Option) for option in (*p.opts, *p.secondary_opts)}
    assert set(re.findall(r"(?<=\s)--?[a-z][a-z-]*", words)) <= known | {"--help"}


def test_the_manifest_is_an_illustration_s():
    text = re.search(r'^    (\{"format": "penink-illustration".*?\})\n\n', README, re.M | re.S)[1]
    schema = json.loads((ROOT / "penink_cli/formats/schemas/illustration.schema.json").read_text("utf-8"))
    jsonschema.validate(json.loads(text), schema)
    for path in re.findall(r'"((?:light|dark)\.[a-z.]+)"', text):
        made = path.replace("light", "$layer").replace("dark", "$layer")
        assert f"-o {made}" in README


def test_the_makefile_lines_and_files_are_there():
    for path in re.findall(r"\((samples/[^)]*|penink_cli/[^)]*)\)", README):
        assert (ROOT / path).exists(), path
    assert "penink-photos =" in (ROOT / "samples/penink.mk").read_text()


def blocks() -> list[str]:
    """What is to be pasted, in order: indented blocks, and commands in a sentence that name a file."""
    found = []
    for match in re.finditer(r"((?:^    .*\n|^ *\n(?=    ))+)|`(penink [^`\n]+)`", README, re.M):
        if match[1]:
            found.append("\n".join(line[4:] for line in match[1].split("\n")).strip("\n"))
        elif re.search(r" [\w-]+\.[a-z]+( |$)", match[2]):
            found.append(match[2])
    return found


# Not run here: make and apt-get, which `make check-roots` runs, Snakemake, which `make cluster` runs, and what never
# ends, which test_drawing_again.py runs.
LEFT_OUT = re.compile(r"make |apt-get |snakemake |photo ──|.* --watch ")
PHOTO = os.environ.get("README_PHOTO", "600x400")  # 3000x2000: as large as a telephone's, some minutes


def test_every_block_runs_as_pasted_in_order(tmp_path):
    programs = tmp_path / "bin"
    programs.mkdir()
    for name, script in {"penink": f'exec "{sys.executable}" -m penink_cli "$@"', "vpype": "cat > photo.hpgl"}.items():
        (programs / name).write_text(f"#!/bin/sh\n{script}\n")
        (programs / name).chmod(0o755)
    folder = tmp_path / "place"
    (folder / "holiday").mkdir(parents=True)
    (folder / "penink").symlink_to(ROOT)
    width, height = map(int, PHOTO.split("x"))
    y, x = np.mgrid[:height, :width] / height
    disc = np.hypot(x - 0.6, y - 0.5) < 0.3
    grey = np.where(disc, 60 + 100 * y, 250 - 60 * x) + np.random.default_rng(0).normal(0, 2, x.shape)
    Image.fromarray(grey.clip(0, 255).astype(np.uint8)).save(folder / "photo.png")
    Image.open(folder / "photo.png").resize((96, 64)).save(folder / "holiday/portrait.png")
    Image.open(folder / "photo.png").resize((96, 64)).save(folder / "holiday/beach.jpg")
    lock = "".join(f'<path d="M2 {y}c8 -2 16 2 24 {y % 3}" stroke="#000" fill="none"/>' for y in range(4, 40, 4))
    svg = f'<svg xmlns="http://www.w3.org/2000/svg" width="30" height="44">{lock}</svg>'
    (folder / "hair.svg").write_text(svg)
    env = environment(PATH=f"{programs}:{os.environ['PATH']}", HOME=str(tmp_path), MAKEFLAGS="")
    ran = 0
    for block in blocks():
        if LEFT_OUT.match(block):
            continue
        if block.startswith("{"):
            (folder / "photo.illustration.json").write_text(block)
            continue
        if block.startswith("include "):
            (folder / "Makefile").write_text(block + "\n")
            block = "make -j4"
        done = subprocess.run(
            ["bash", "-e", "-o", "pipefail", "-c", block], cwd=folder, env=env, capture_output=True, check=False
        )
        assert done.returncode == 0 and b"warning" not in done.stderr, (block, done.stderr.decode())
        ran += 1
    assert ran > 10
    for name in ("photo.ps", "photo.svg", "photo.eps", "photo.html", "poster.ps", "plot.svg", "photo.hpgl"):
        assert (folder / name).stat().st_size > 1000, name
    assert {"beach.ps", "portrait.ps"} <= set(os.listdir(folder / "holiday"))
