"""Edge lists: every rule that concerns a vertex, an edge or a strength by itself, and the bytes written."""

from __future__ import annotations

import io
import json
from importlib import resources

import jsonschema
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from penink_cli.formats import edge_list, strict_json
from penink_cli.ground.errors import FormatError, LimitError
from penink_cli.ground.model import EdgeList
from tests.formats.readers import written

GOOD = {
    "format": "penink-edges",
    "version": 1,
    "width": 40,
    "height": 30,
    "vertices": [[0, 0], [40, 30], [10.5, 20.25], [39.9999, 0]],
    "edges": [[0, 1], [2, 3]],
}
SCHEMA = json.loads(resources.files("penink_cli.formats").joinpath("schemas/edges.schema.json").read_text())


def read(document: object) -> EdgeList:
    data = document if isinstance(document, bytes) else json.dumps(document).encode()
    return edge_list.read(io.BytesIO(data), "e.json")


def changed(**members: object) -> dict:
    return {**GOOD, **members}


def without(name: str) -> dict:
    return {key: value for key, value in GOOD.items() if key != name}


ACCEPTED = {
    "the example": GOOD,
    "no edges": changed(edges=[]),
    "no vertices": changed(vertices=[], edges=[]),
    "a vertex of no edge": changed(edges=[[0, 1]]),
    "strengths": changed(strength=[0, 1]),
    "strengths of no edges": changed(edges=[], strength=[]),
    "members nobody named": changed(note={"by": ["hand", None, True]}, Width=-1),
    "a frame of one pixel": changed(width=1, height=1, vertices=[[0, 1], [1, 0]], edges=[[1, 0]]),
    "the corners of the frame": changed(vertices=[[0, 0], [40, 0], [0, 30], [40, 30]]),
    "an edge backwards": changed(edges=[[1, 0]]),
    "whole numbers with a fraction of zero as coordinates": changed(vertices=[[0.0, 1.0], [2e0, 30], [3, 4], [5, 6]]),
    "tiny distances": changed(vertices=[[1, 1], [1, 1.0000001], [2, 2], [3, 3]]),
}

REFUSED = {
    "an array": ([], "an object is expected"),
    "null": (None, "an object is expected"),
    "strokes": (changed(format="penink-strokes"), "not an edge list but strokes"),
    "another's": (changed(format="theirs"), 'format is "theirs"; "penink-edges" is expected'),
    "no format": (without("format"), '"format" is missing'),
    "format in capitals": (changed(format="PENINK-EDGES"), "format is"),
    "version 2": (changed(version=2), "version is 2"),
    "version true": (changed(version=True), "version is true"),
    "version 1.0": (changed(version=1.0), "version is 1.0"),
    "version as text": (changed(version="1"), "version is"),
    "no version": (without("version"), '"version" is missing'),
    "no width": (without("width"), '"width" is missing'),
    "no height": (without("height"), '"height" is missing'),
    "no vertices": (without("vertices"), '"vertices" is missing'),
    "no edges": (without("edges"), '"edges" is missing'),
    "width 0": (changed(width=0), "width is 0"),
    "a negative height": (changed(height=-30), "height is -30"),
    "half a pixel": (changed(width=40.5), "width is 40.5"),
    "width true": (changed(width=True), "width is true"),
    "width as text": (changed(width="40"), "width is"),
    "width null": (changed(width=None), "width is null"),
    "width beyond 31 bits": (changed(width=2**31), "width is"),
    "width of 400 digits": (changed(width=10**400), "is out of range"),
    "vertices null": (changed(vertices=None), "vertices is null"),
    "vertices an object": (changed(vertices={"0": [0, 0]}), "vertices is an object"),
    "a vertex of one number": (changed(vertices=[[0, 0], [1]]), "vertex 1 is [1]"),
    "a vertex of three": (changed(vertices=[[0, 0, 0]]), "vertex 0 is"),
    "a vertex as text": (changed(vertices=["ab"]), "vertex 0 is"),
    "a vertex as object": (changed(vertices=[{"x": 1, "y": 2}]), "vertex 0 is an object"),
    "a flat list": (changed(vertices=[0, 0, 1, 1]), "vertex 0 is 0"),
    "a coordinate true": (changed(vertices=[[0, 0], [True, 1]]), "vertex 1 holds true"),
    "a coordinate null": (changed(vertices=[[0, None]]), "vertex 0 holds null"),
    "a coordinate as text": (changed(vertices=[["1", 2]]), 'vertex 0 holds "1"'),
    "a coordinate of 400 digits": (changed(vertices=[[10**400, 2]]), "is out of range"),
    "a coordinate an array": (changed(vertices=[[[1], 2]]), "vertex 0 holds [1]"),
    "left of the frame": (
        changed(vertices=[[0, 0], [-0.001, 2]]),
        "vertex 1: (-0.001, 2) is outside the frame 40 x 30",
    ),
    "right of the frame": (changed(vertices=[[40.0001, 2]]), "vertex 0: (40.0001, 2) is outside"),
    "above the frame": (changed(vertices=[[1, -1e-300]]), "vertex 0: (1, -1e-300) is outside"),
    "below the frame": (changed(vertices=[[1, 31]]), "is outside the frame"),
    "a vertex twice": (changed(vertices=[[1, 1], [2, 2], [1.0, 1.0]], edges=[]), "vertices 0 and 2 are the same point"),
    "a vertex twice, once at minus zero": (
        changed(vertices=[[0, 1], [-0.0, 1]], edges=[]),
        "vertices 0 and 1 are the same",
    ),
    "an index too large": (changed(edges=[[0, 1], [1, 4]]), "edge 1: vertex 4 is not in 0..3"),
    "a negative index": (changed(edges=[[0, -1]]), "edge 0: vertex -1 is not in 0..3"),
    "an index in an empty list": (changed(vertices=[]), "vertex 0 is not in an empty list"),
    "an index true": (changed(edges=[[0, True]]), "edge 0 holds true"),
    "an index with a fraction": (changed(edges=[[0, 1.5]]), "edge 0 holds 1.5"),
    "an index with a fraction of zero": (changed(edges=[[0, 1.0]]), "edge 0 holds 1.0"),
    "an index beyond 64 bits": (changed(edges=[[0, 2**64]]), "edge 0 holds 18446744073709551616"),
    "an index as text": (changed(edges=[[0, "1"]]), "edge 0 holds"),
    "an edge of three": (changed(edges=[[0, 1, 2]]), "edge 0 is [0, 1, 2]"),
    "an edge null": (changed(edges=[None]), "edge 0 is null"),
    "edges null": (changed(edges=None), "edges is null"),
    "an edge of no length": (changed(edges=[[0, 1], [2, 2]]), "edge 1 joins vertex 2 to itself"),
    "an edge twice": (changed(edges=[[0, 1], [2, 3], [0, 1]]), "edges 0 and 2 join the same vertices"),
    "an edge there and back": (changed(edges=[[0, 1], [1, 0]]), "edges 0 and 1 join the same vertices"),
    "too few strengths": (changed(strength=[0.5]), "1 strengths for 2 edges"),
    "too many strengths": (changed(strength=[0.5, 0.5, 0.5]), "3 strengths for 2 edges"),
    "a strength above 1": (changed(strength=[0.5, 1.01]), "edge 1: strength 1.01 is not in 0..1"),
    "a negative strength": (changed(strength=[-0.1, 1]), "edge 0: strength -0.1"),
    "a strength true": (changed(strength=[0, True]), "strength 1 holds true"),
    "a strength null": (changed(strength=[0, None]), "strength 1 holds null"),
    "strength null": (changed(strength=None), "strength is null"),
    "strength a number": (changed(strength=0.5), "strength is 0.5"),
    "infinity": (json.dumps(GOOD).replace("10.5", "1e999").encode(), "1e999 is out of range"),
    "NaN": (json.dumps(GOOD).replace("10.5", "NaN").encode(), "NaN is not JSON"),
    "a member twice": (json.dumps(GOOD).replace("{", '{"width": 40, ').encode(), 'member "width" appears twice'),
    "cut short": (json.dumps(GOOD).encode()[:-3], "not JSON"),
    "two documents": (json.dumps(GOOD).encode() * 2, "not JSON"),
    "a vertical tab after it": (json.dumps(GOOD).encode() + b"\x0b", "not JSON"),
    "a form feed within": (json.dumps(GOOD).replace("[10.5", "\f[10.5").encode(), "not JSON"),
    "a form feed before a name": (json.dumps(GOOD).replace('"edges"', '\f"edges"').encode(), "not JSON"),
    "a non-breaking space": (json.dumps(GOOD).replace(" ", "\xa0").encode(), "not JSON"),
    "a note beyond a double": (changed(note=10**309), "is out of range"),
    "nothing": (b"", "empty"),
    "a PGM": (b"P5 1 1 255\n\xff", "not an edge list but a PGM image"),
}


@pytest.mark.parametrize("name", ACCEPTED)
def test_is_read(name, reader):
    document = ACCEPTED[name]
    jsonschema.validate(document, SCHEMA)
    edges = reader(document)
    assert (edges.width, edges.height) == (document["width"], document["height"])
    assert edges.vertices.tolist() == document["vertices"] and edges.edges.tolist() == document["edges"]
    assert edges.vertices.shape[1:] == edges.edges.shape[1:] == (2,)
    assert edges.vertices.dtype == np.float64 and edges.edges.dtype == np.int64
    assert (edges.strength is None) == ("strength" not in document)


@pytest.mark.parametrize("name", REFUSED)
def test_is_refused(name, reader):
    document, complaint = REFUSED[name]
    with pytest.raises(FormatError) as caught:
        reader(document)
    assert complaint in str(caught.value) and str(caught.value).startswith("e.json: ")
    assert str(caught.value).isprintable()


def test_the_schema_is_one_and_refuses_what_it_can():
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    beyond = (
        "frame",
        "same",
        "length",
        "index",
        "twice",
        "strengths",
        "version 1.0",
        "out of range",
    )  # between values: not in a schema
    for name, (document, complaint) in REFUSED.items():
        if isinstance(document, bytes) or any(word in name + complaint for word in beyond):
            continue
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(document, SCHEMA)


def test_a_list_of_too_many_bytes_is_refused_before_it_is_parsed():
    with pytest.raises(LimitError, match=f"more than {edge_list.LEAST_BYTES} bytes .--max-pixels"):
        read(b"[" * (edge_list.LEAST_BYTES + 1))
    with pytest.raises(FormatError, match="nested"):
        edge_list.read(io.BytesIO(b"[" * (edge_list.LEAST_BYTES + 1)), "e.json", max_pixels=10**9)


@pytest.fixture(params=["in bulk", "by json"])
def reader(request, monkeypatch):
    """Both readers, whatever the text: the quick one where it takes it, and json's."""
    if request.param == "by json":
        monkeypatch.setattr(edge_list, "_plain", lambda text: None)
    return read


coordinates = st.integers(0, 400_000).map(lambda n: n / 10**edge_list.DECIMALS)


@st.composite
def lists(draw):
    points = draw(st.lists(st.tuples(coordinates, coordinates), max_size=12, unique=True))
    pairs = [(a, b) for a in range(len(points)) for b in range(a)]
    edges = draw(st.lists(st.sampled_from(pairs), unique=True)) if pairs else []
    strengths = st.lists(st.integers(0, 10_000).map(lambda n: n / 10_000), min_size=len(edges), max_size=len(edges))
    strength = draw(st.none() | strengths)
    return EdgeList(
        draw(st.integers(40, 50)),
        draw(st.integers(40, 2**31 - 1)),
        np.array(points, float).reshape(-1, 2),
        np.array(edges, np.int64).reshape(-1, 2),
        None if strength is None else np.array(strength, float),
    )


def same(a: EdgeList, b: EdgeList) -> bool:
    strengths = (a.strength is None) == (b.strength is None)
    strengths = strengths and (a.strength is None or np.array_equal(a.strength, b.strength))
    whole = (a.width, a.height) == (b.width, b.height)
    return whole and np.array_equal(a.vertices, b.vertices) and np.array_equal(a.edges, b.edges) and strengths


@given(lists())
def test_what_is_written_is_read_as_it_was(edges):
    data = written(edge_list.write, edges)
    jsonschema.validate(json.loads(data), SCHEMA)
    assert same(read(data), edges)
    assert written(edge_list.write, read(data)) == data


@given(lists(), st.data())
def test_what_is_read_in_bulk_is_what_json_reads(edges, data):
    """Whatever a few changed bytes make of a text as it is written: the quick reader agrees with json, or leaves it."""
    text = bytearray(written(edge_list.write, edges))
    for _ in range(data.draw(st.integers(0, 3))):
        at = data.draw(st.integers(0, len(text) - 1))
        text[at : at + data.draw(st.integers(0, 2))] = data.draw(
            st.sampled_from([*b'0123456789.-+eE[]{}, \n"\x00'])
        ).to_bytes()
    quick = edge_list._plain(bytes(text))
    if quick is not None:
        assert same(quick, edge_list._edge_list(strict_json.loads(bytes(text), "e.json")))
    elif text == written(edge_list.write, edges):
        raise AssertionError("left to json")


@pytest.mark.parametrize(
    "number", ["0", "-0", "0.1", "39.99999999999999", "1e1", "1E+1", "0.30000000000000004", "12.000000"]
)
def test_every_way_to_write_a_number_is_the_number_that_json_reads(number, reader):
    text = json.dumps(GOOD).replace("10.5", number).encode()
    assert reader(text).vertices[2, 0] == float(number)


def test_the_bytes_are_these():
    edges = EdgeList(
        4, 3, np.array([[0, -0.0], [1.00004, 2.00006], [4, 3]]), np.array([[0, 1], [2, 1]]), np.array([0.25, 1])
    )
    assert written(edge_list.write, edges).decode() == (
        '{"format": "penink-edges", "version": 1, "width": 4, "height": 3,\n'
        ' "vertices": [\n  [0.0000, 0.0000],\n  [1.0000, 2.0001],\n  [4.0000, 3.0000]],\n'
        ' "edges": [\n  [0, 1],\n  [2, 1]],\n "strength": [\n  0.2500,\n  1.0000]}\n'
    )
    assert written(edge_list.write, EdgeList(4, 3)).endswith(b'"vertices": [],\n "edges": []}\n')


def test_what_would_not_be_read_again_is_not_written():
    """Two vertices closer than the decimals written would come back as one."""
    near = EdgeList(4, 3, np.array([[1, 1], [1.00001, 1]]), np.array([[0, 1]]))
    with pytest.raises(FormatError, match="vertices 0 and 1 are the same point"):
        written(edge_list.write, near)
    with pytest.raises(FormatError, match="outside"):
        written(edge_list.write, EdgeList(4, 3, np.array([[np.nan, 1]])))
