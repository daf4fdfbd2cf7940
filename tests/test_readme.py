"""The README's commands are such as the program has, its manifest one that is read."""

from __future__ import annotations

import importlib
import json
import re

import click
import jsonschema
import pytest

from penink_cli.main import SUBCOMMANDS
from tests.conftest import ROOT

README = (ROOT / "README.md").read_text("utf-8")
CODE = "\n".join(re.findall(r"^    .*|`[^`\n]+`", README, re.M))
# A command up to the pipe or redirection that ends it.
CALLS = sorted(set(re.findall(r"(?<![/\w-])penink ([a-z][a-z-]*)([^|`>;\n]*)", CODE)))


@pytest.mark.parametrize(("name", "words"), CALLS)
def test_every_command_and_option_exists(name, words):
    assert name in SUBCOMMANDS
    command = getattr(importlib.import_module(f"penink_cli.commands.{SUBCOMMANDS[name][0]}"), SUBCOMMANDS[name][0])
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
