"""Telling lines: every rule of the format, and the bytes written."""

from __future__ import annotations

import io
import json
import re
from importlib import resources

import jsonschema
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from penink_cli.formats import lines as lines_format
from penink_cli.ground.errors import FormatError, LimitError
from penink_cli.ground.model import Lines
from tests.formats.readers import written

FILES = resources.files("penink_cli.formats")
SCHEMA = json.loads(FILES.joinpath("schemas/lines.schema.json").read_text())
STROKE = {"points": [[0, 0], [10.5, 20.25], [40, 30]], "weight": [0, 0.5, 1], "rank": 7.5}
SPOT = {"points": [[12, 8.5]], "weight": [1], "rank": 2, "breadth": 5.5}
GOOD = {"format": "penink-lines", "version": 1, "width": 40, "height": 30, "lines": [STROKE, SPOT]}


def read(document: object) -> Lines:
    data = document if isinstance(document, bytes) else json.dumps(document).encode()
    return lines_format.read(io.BytesIO(data), "l.json")


def changed(**members: object) -> dict:
    return {**GOOD, **members}


def without(name: str, of: dict = GOOD) -> dict:
    return {key: value for key, value in of.items() if key != name}


def line(**members: object) -> dict:
    """The list whose second line is the example with these members."""
    return changed(lines=[STROKE, {**STROKE, **members}])


ACCEPTED = {
    "the example": GOOD,
    "no lines": changed(lines=[]),
    "a white line": line(white=True),
    "a line said not to be white": line(white=False),
    "a breadth of nothing": line(breadth=0),
    "a broad thing of several points": line(breadth=3),
    "rank 0": line(rank=0),
    "a closed line": line(points=[[1, 1], [2, 2], [1, 1]]),
    "members nobody named": line(note={"by": ["hand", None, True]}),
}

REFUSED = {
    "an array": ([], "an object is expected"),
    "edges": (changed(format="penink-edges"), "not telling lines but an edge list"),
    "another's": (changed(format="theirs"), 'format is "theirs"; "penink-lines" is expected'),
    "version 2": (changed(version=2), "version is 2"),
    "version true": (changed(version=True), "version is true"),
    "no width": (without("width"), '"width" is missing'),
    "no height": (without("height"), '"height" is missing'),
    "no lines at all": (without("lines"), '"lines" is missing'),
    "width 0": (changed(width=0), "width is 0"),
    "half a pixel": (changed(height=30.5), "height is 30.5"),
    "lines null": (changed(lines=None), "lines is null"),
    "a line null": (changed(lines=[STROKE, None]), "line 1 is null; an object is needed"),
    "a line of points": (changed(lines=[[[1, 1], [2, 2]]]), "line 0 is an array"),
    "no points": (changed(lines=[without("points", STROKE)]), 'line 0: member "points" is missing'),
    "no weight": (changed(lines=[without("weight", STROKE)]), 'line 0: member "weight" is missing'),
    "no rank": (changed(lines=[without("rank", STROKE)]), 'line 0: member "rank" is missing'),
    "points null": (line(points=None), "line 1: points is null"),
    "a point of three": (line(points=[[0, 0], [1, 1, 1], [2, 2]]), "line 1: point 1 is [1, 1, 1]"),
    "a point as text": (line(points=[[0, 0], [1, "1"], [2, 2]]), 'line 1: point 1 holds "1"'),
    "a coordinate true": (line(points=[[0, True], [1, 1], [2, 2]]), "line 1: point 0 holds true"),
    "points empty": (line(points=[], weight=[]), "line 1: 0 points; at least 2 are needed"),
    "one point": (line(points=[[1, 1]], weight=[1]), "line 1: 1 points; at least 2 are needed"),
    "one point of breadth 0": (line(points=[[1, 1]], weight=[1], breadth=0), "line 1: 1 points"),
    "a broad thing without points": (line(points=[], weight=[], breadth=1), "line 1: 0 points; at least 1 of a thing"),
    "right of the frame": (
        line(points=[[0, 0], [40.001, 2], [1, 1]]),
        "line 1: point 1: (40.001, 2) is outside the frame 40 x 30",
    ),
    "above the frame": (line(points=[[0, 0], [4, -2], [1, 1]]), "line 1: point 1: (4, -2) is outside"),
    "a point twice in a row": (line(points=[[0, 0], [1, 1], [1.0, 1]]), "line 1: points 1 and 2 are the same"),
    "too few weights": (line(weight=[0, 1]), "line 1: 2 weights for 3 points"),
    "a weight above 1": (line(weight=[0, 1.01, 1]), "line 1: weight 1: 1.01 is not in 0..1"),
    "a negative weight": (line(weight=[-0.5, 1, 1]), "line 1: weight 0: -0.5"),
    "a weight null": (line(weight=[0, None, 1]), "line 1: weight 1 holds null"),
    "weight a number": (line(weight=0.5), "line 1: weight is 0.5"),
    "a negative rank": (line(rank=-1), "line 1: rank is -1"),
    "rank true": (line(rank=True), "line 1: rank is true"),
    "a huge rank": (line(rank=1e7), "line 1: rank is 10000000.0"),
    "white 1": (line(white=1), "line 1: white is 1; true or false is needed"),
    "white null": (line(white=None), "line 1: white is null"),
    "a negative breadth": (line(breadth=-1), "line 1: breadth is -1"),
    "breadth null": (line(breadth=None), "line 1: breadth is null"),
    "infinity": (json.dumps(GOOD).replace("10.5", "1e999").encode(), "1e999 is out of range"),
    "NaN": (json.dumps(GOOD).replace("10.5", "NaN").encode(), "NaN is not JSON"),
    "a member twice": (json.dumps(GOOD).replace('"rank": 2', '"rank": 2, "rank": 3').encode(), '"rank" appears twice'),
    "cut short": (json.dumps(GOOD).encode()[:-3], "not JSON"),
    "nothing": (b"", "empty"),
}


@pytest.mark.parametrize("name", ACCEPTED)
def test_is_read(name):
    document = ACCEPTED[name]
    jsonschema.validate(document, SCHEMA)
    lines = read(document)
    assert (lines.width, lines.height, len(lines)) == (40, 30, len(document["lines"]))
    for i, item in enumerate(document["lines"]):
        assert lines[i].tolist() == item["points"] and lines.rank[i] == item["rank"]
        assert lines.weight[lines.first[i] : lines.first[i + 1]].tolist() == item["weight"]
        assert lines.white[i] == item.get("white", False) and lines.breadth[i] == item.get("breadth", 0)


@pytest.mark.parametrize("name", REFUSED)
def test_is_refused(name):
    document, complaint = REFUSED[name]
    with pytest.raises(FormatError) as caught:
        read(document)
    assert complaint in str(caught.value) and str(caught.value).startswith("l.json: ")
    assert str(caught.value).isprintable()


def test_the_schema_is_one_and_refuses_what_it_can():
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    beyond = ("frame", "twice in a row", "too few weights", "infinity")  # between values: not in a schema
    for name, (document, complaint) in REFUSED.items():
        if isinstance(document, bytes) or any(word in name + complaint for word in beyond):
            continue
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(document, SCHEMA)


def test_the_page_s_example_is_one():
    page = FILES.joinpath("README.md").read_text("utf-8")
    document = json.loads(re.search(r'^(\{"format": "penink-lines".*?\]\})\n```', page, re.M | re.S)[1])
    jsonschema.validate(document, SCHEMA)
    assert read(document).white.tolist() == [False, True, False]


def test_more_than_is_allowed_is_refused_before_it_is_parsed(monkeypatch):
    with pytest.raises(LimitError, match=f"more than {lines_format.MAX_BYTES} bytes"):
        read(b"[" * (lines_format.MAX_BYTES + 1))
    monkeypatch.setattr(lines_format, "MAX_LINES", 1)
    with pytest.raises(LimitError, match="2 lines; 1 are allowed"):
        read(GOOD)


coordinates = st.integers(0, 4000).map(lambda n: n / 10**lines_format.DECIMALS)


@st.composite
def lists(draw):
    out = Lines(draw(st.integers(40, 2**31 - 1)), 40)
    for _ in range(draw(st.integers(0, 4))):
        breadth = draw(st.sampled_from([0, 0.01, 7.25]))
        points = draw(st.lists(st.tuples(coordinates, coordinates), min_size=1 if breadth else 2, unique=True))
        weight = [n / 1000 for n in draw(st.lists(st.integers(0, 1000), min_size=len(points), max_size=len(points)))]
        out = Lines(
            out.width, 40, np.concatenate([out.points, np.array(points, float)]),
            np.append(out.first, out.first[-1] + len(points)), np.append(out.weight, weight),
            np.append(out.rank, draw(st.integers(0, 10**8)) / 100), np.append(out.white, draw(st.booleans())),
            np.append(out.breadth, breadth),
        )  # fmt: skip
    return out


def same(a: Lines, b: Lines) -> bool:
    parts = ("width", "height", "points", "first", "weight", "rank", "white", "breadth")
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in parts)


@given(lists())
def test_what_is_written_is_read_as_it_was(lines):
    data = written(lines_format.write, lines)
    jsonschema.validate(json.loads(data), SCHEMA)
    assert same(read(data), lines)
    assert same(lines.chosen(np.arange(len(lines))), lines)


@given(lists(), st.data())
def test_some_of_the_lines_are_themselves(lines, data):
    which = data.draw(st.lists(st.integers(0, len(lines) - 1), max_size=5)) if len(lines) else []
    some = lines.chosen(np.array(which, np.int64))
    assert len(some) == len(which)
    for k, i in enumerate(which):
        assert np.array_equal(some[k], lines[i]) and some.rank[k] == lines.rank[i]


def test_the_bytes_are_these():
    lines = Lines(
        40, 30, np.array([[0, -0.0], [1.004, 2.006], [4, 3]]), np.array([0, 2, 3]), np.array([0, 0.3333, 1]),
        np.array([2.5, 1]), np.array([True, False]), np.array([0, 3.25]),
    )  # fmt: skip
    assert written(lines_format.write, lines).decode() == (
        '{"format": "penink-lines", "version": 1, "width": 40, "height": 30, "lines": [\n'
        '  {"points": [[0.00, 0.00], [1.00, 2.01]], "weight": [0.000, 0.333], "rank": 2.50, "white": true},\n'
        '  {"points": [[4.00, 3.00]], "weight": [1.000], "rank": 1.00, "breadth": 3.25}]}\n'
    )
    assert written(lines_format.write, Lines(4, 3)).endswith(b'"lines": []}\n')


def test_points_that_round_to_one_are_one_and_what_would_not_be_read_is_not_written():
    near = Lines(
        40, 30, np.array([[1, 1], [1.001, 1], [2, 2]]), np.array([0, 3]), np.ones(3), np.ones(1), np.zeros(1, bool),
        np.zeros(1),
    )  # fmt: skip
    assert read(written(lines_format.write, near)).points.tolist() == [[1, 1], [2, 2]]
    with pytest.raises(FormatError, match="1 points"):
        written(lines_format.write, near.__class__(40, 30, near.points[:2], np.array([0, 2]), np.ones(2), np.ones(1),
                                                   np.zeros(1, bool), np.zeros(1)))  # fmt: skip
