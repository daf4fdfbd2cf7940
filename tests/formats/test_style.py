"""Styles: what their files may say, and that the shipped ones are right and drawn as they say."""

from __future__ import annotations

import io
import json

import jsonschema
import pytest

from penink_cli.chain.words import FILTERS, check, options_of
from penink_cli.formats import style as style_format
from penink_cli.ground.errors import FormatError
from penink_cli.options.styles import find_style, shipped, style_text
from tests.conftest import ROOT

SCHEMA = json.loads((ROOT / "penink_cli/formats/schemas/style.schema.json").read_text())


def read(document: object) -> style_format.Style:
    text = document if isinstance(document, bytes) else json.dumps(document).encode()
    found = style_format.read(io.BytesIO(text), "s.style.json")
    check(found, "s.style.json")
    return found


HEAD = {"format": "penink-style", "version": 1}
REJECTED = [
    (b"", "not JSON: empty"),
    (b"[1]", "an object is expected, found [1]"),
    ({"format": "penink-texture", "version": 1}, "texture"),
    ({"format": "penink-style", "version": 2}, "version is 2; 1 is the only one known"),
    ({**HEAD, "description": 3}, "description is 3; text is needed"),
    ({**HEAD, "compose": []}, "compose is []; an object is needed"),
    ({**HEAD, "compose": {"strength": None}}, 'compose: "strength" is null; a number, text or true is needed'),
    ({**HEAD, "compose": {"strength": [1]}}, 'compose: "strength" is [1]; a number, text or true is needed'),
    ({**HEAD, "compose": {"stregth": 1}}, 'compose: no option "stregth"; known are '),
    ({**HEAD, "compose": {"strength": 2}}, "compose: strength: '2' is not a number from 0 to 1"),
    ({**HEAD, "compose": {"strength": True}}, "compose: strength is true; a value is needed"),
    ({**HEAD, "compose": {"mask": "m.png"}}, 'no option "mask"'),
    ({**HEAD, "compose": {"output": "x"}}, 'no option "output"'),
    ({**HEAD, "compose": {"width": "4in"}}, 'no option "width"'),
    ({**HEAD, "blast": {"rule": "worst"}}, "blast: rule: "),
    ({**HEAD, "blast": {"pen": "4parsec"}}, "blast: pen: '4parsec' is not a length"),
    ({**HEAD, "outline": {"min-length": "long"}}, "outline: min-length: "),
]


@pytest.mark.parametrize(("document", "reason"), REJECTED)
def test_bad_styles_are_refused(document, reason):
    with pytest.raises(FormatError) as raised:
        read(document)
    assert reason in str(raised.value) and str(raised.value).startswith("s.style.json: ")


def test_a_style_says_what_it_says_and_no_more():
    stages = {"compose": {"strength": 0.9, "target": "spot"}, "blast": {"pen": "0.5pt", "gamma": 1}}
    document = {**HEAD, "note": 7, **stages}
    found = read(document)
    assert found.stages == stages
    assert read(style_format.text(found)) == found
    jsonschema.validate(document, SCHEMA)


@pytest.mark.parametrize("name", shipped())
def test_shipped_styles_are_right(name):
    document = json.loads(style_text(name))
    jsonschema.validate(document, SCHEMA)
    assert read(document) == find_style(name) and find_style(name).description
    assert set(document) <= {"format", "version", "description", *style_format.STAGES}


def test_every_stage_has_its_filters():
    assert set(FILTERS) == set(style_format.STAGES)
    assert {"strength", "detail", "mix", "target"} <= set(options_of("compose"))
    assert not {"output", "mask", "threads", "edges", "width"} & set(options_of("blast"))


def test_styles_are_listed_and_shown(penink, tmp_path):
    listed = penink("style", "list")
    assert listed.returncode == 0 and [line.split()[0] for line in listed.stdout.decode().splitlines()] == shipped()
    done = penink("style", "show", "true", "-o", tmp_path / "mine.style.json")
    assert done.returncode == 0 and (tmp_path / "mine.style.json").read_bytes() == style_text("true")
    (tmp_path / "bad.style.json").write_text(json.dumps({**HEAD, "blast": {"texture": "crosshatch", "sheed": 1}}))
    done = penink("style", "show", tmp_path / "bad.style.json")
    assert done.returncode == 1 and b'blast: no option "sheed"' in done.stderr and done.stderr.count(b"\n") == 1
    assert b"no style velvet; known are " in penink("style", "show", "velvet").stderr
