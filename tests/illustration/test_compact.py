"""The compact members: nothing is lost, nothing depends on order, nothing bad is swallowed."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from penink_cli.formats import compact
from penink_cli.formats._compiled import compact as _compact
from penink_cli.geometry import quantisation, validity
from penink_cli.ground.errors import FormatError, LimitError, PeninkError
from penink_cli.ground.model import Directions, EdgeList, GreyImage
from tests.conftest import ROOT
from tests.illustration.conftest import grey, square, whirl

#: What the format's first version writes, in hexadecimal. A form that gives other bytes is another version.
VECTORS = json.loads((ROOT / "tests/illustration/compact_vectors.json").read_text())


def by_formula() -> dict[str, tuple[bytes, object]]:
    """Contents that a few whole numbers describe: their compact bytes, and what reads them again."""
    y, x = np.mgrid[:12, :16]
    samples = GreyImage(((7 * x * x + 13 * y + x * y) % 64).astype(np.uint8), 63)
    corner = np.array([[2, 2], [12, 3], [13, 10], [3, 9], [8, 6]], float)
    edges = EdgeList(16, 12, corner, np.array([[0, 1], [1, 2], [2, 3], [3, 0], [2, 4]]), np.arange(5) / 16)
    text = b'{"name": "vectors", "numbers": [1, 2, 3]}'
    return {
        "samples": (compact.samples_bytes(samples), samples),
        "edges": (compact.edges_bytes(edges, 256, 192), edges),
        "text": (compact.text_bytes(text), text),
    }


def test_the_bytes_are_those_of_the_first_version():
    assert {name: data.hex() for name, (data, _) in by_formula().items()} == VECTORS


def test_the_first_version_is_read():
    given = {name: content for name, (_, content) in by_formula().items()}
    read = {name: bytes.fromhex(data) for name, data in VECTORS.items()}
    assert np.array_equal(compact.samples_from(read["samples"], 10**6).values, given["samples"].values)
    assert as_set(compact.edges_from(read["edges"])) == as_set(given["edges"])
    assert compact.text_from(read["text"]) == given["text"]


def as_set(edges: EdgeList) -> set[tuple]:
    """Edges by the places of their ends, with strengths."""
    strength = edges.strength if edges.strength is not None else np.zeros(len(edges.edges))
    return {
        (*sorted((tuple(edges.vertices[a]), tuple(edges.vertices[b]))), float(s))
        for (a, b), s in zip(edges.edges, strength)
    }


def random_arrangement(seed: int, columns: int, rows: int) -> EdgeList:
    """What remains of random segments once they are on a coarse grid: many junctions and rings."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 60))
    ends = rng.integers(0, n, (2 * n, 2))
    ends = ends[ends[:, 0] != ends[:, 1]]
    tangle = EdgeList(40, 30, rng.random((n, 2)) * (40, 30), ends, rng.integers(0, 17, len(ends)) / 16)
    return quantisation.quantise(tangle, columns, rows)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32), st.sampled_from([1, 2, 63, 100, 255, 65535]), st.integers(1, 20), st.integers(1, 20))
def test_samples_come_back_exactly(seed, maxval, height, width):
    rng = np.random.default_rng(seed)
    values = rng.integers(0, maxval + 1, (height, width))
    if seed % 2:  # flat stretches
        values = np.repeat(values[:, :1], width, axis=1)
    image = GreyImage(values.astype(np.uint8 if maxval < 256 else np.uint16), maxval)
    back = compact.samples_from(compact.samples_bytes(image), 10**6)
    assert back.maxval == maxval
    assert back.values.dtype == image.values.dtype
    assert np.array_equal(back.values, image.values)


def test_samples_are_small():
    smooth = (np.add.outer(np.arange(128), np.arange(128)) // 5).astype(np.uint8)
    assert len(compact.samples_bytes(GreyImage(smooth, 63))) < 600
    white = GreyImage(np.full((128, 128), 63, np.uint8), 63)
    assert len(compact.samples_bytes(white)) < 30


@pytest.mark.parametrize("seed", range(40))
def test_edges_come_back_exactly_and_in_an_order_of_their_own(seed):
    edges = random_arrangement(seed, 80, 60)
    packed = compact.edges_bytes(edges, 80, 60)
    back = compact.edges_from(packed)
    assert as_set(back) == as_set(edges)
    validity.check(back)
    rng = np.random.default_rng(seed)
    moved, order = rng.permutation(len(edges.vertices)), rng.permutation(len(edges.edges))
    vertices = np.empty_like(edges.vertices)
    vertices[moved] = edges.vertices
    assert edges.strength is not None
    shuffled = EdgeList(40, 30, vertices, moved[edges.edges][order][:, ::-1], edges.strength[order])
    assert compact.edges_bytes(shuffled, 80, 60) == packed


@pytest.mark.parametrize(("rows", "columns"), [(1, 1), (1, 9), (5, 1), (64, 96), (33, 47)])
def test_directions_come_back_within_a_level_and_then_exactly(rows, columns):
    field = whirl(columns, rows)
    packed = compact.directions_bytes(field)
    back = compact.directions_from(packed)
    off = np.degrees(np.arccos(np.clip(back.cos2 * field.cos2 + back.sin2 * field.sin2, -1, 1))) / 2
    assert off.max() < 3.75 / 2 + 1e-6 and np.abs(back.cos2**2 + back.sin2**2 - 1).max() < 1e-9
    assert compact.directions_bytes(back) == packed
    assert len(compact.directions_bytes(whirl(96, 96))) < 1000


def test_the_angles_of_hatching_are_kept_exactly_and_some_confidence_remains():
    double = np.radians([[-90, 0, 90, 180]])
    field = Directions(np.cos(double), np.sin(double), 0.01 + 0 * double)
    back = compact.directions_from(compact.directions_bytes(field))
    assert np.abs(back.cos2 - np.cos(double)).max() < 1e-9 and np.abs(back.sin2 - np.sin(double)).max() < 1e-9
    assert back.confidence.max() == pytest.approx(1 / 7)
    unknown = compact.directions_from(compact.directions_bytes(Directions(0 * double, 0 * double, 1 + 0 * double)))
    assert (unknown.cos2 == 1).all() and (unknown.sin2 == 0).all()


def test_text_comes_back():
    text = b'{"points": [[1.5, 2.25], [3, 4]]}\n' * 50
    packed = compact.text_bytes(text)
    assert compact.text_from(packed) == text
    assert len(packed) < 120
    assert compact.text_from(compact.text_bytes(b"")) == b""


PACKED = {
    "samples": (compact.samples_bytes(grey()), lambda data: compact.samples_from(data, 2000)),
    "edges": (compact.edges_bytes(quantisation.quantise(square(), 384, 256), 384, 256), compact.edges_from),
    "directions": (compact.directions_bytes(whirl()), compact.directions_from),
    "text": (compact.text_bytes(b"the quick brown fox jumps over the lazy dog"), compact.text_from),
}


@pytest.mark.parametrize("kind", PACKED)
def test_truncated_members_are_refused(kind):
    packed, read = PACKED[kind]
    for size in range(len(packed) - 6):
        with pytest.raises(FormatError):
            read(packed[:size])
    with pytest.raises(FormatError, match="after its end"):
        read(packed + b"123456789")


@pytest.mark.parametrize("kind", PACKED)
def test_damaged_members_give_an_error_or_something_sound(kind):
    packed, read = PACKED[kind]
    rng = np.random.default_rng(1)
    for _ in range(300):
        bad = bytearray(packed)
        for at in rng.integers(0, len(bad), 3):
            bad[at] = rng.integers(0, 256)
        try:
            found = read(bytes(bad))
        except PeninkError:
            continue
        if kind == "samples":
            assert found.values.max() <= found.maxval
        if kind == "directions":
            assert np.allclose(found.cos2**2 + found.sin2**2, 1) and found.confidence.max() <= 1


def test_a_few_bytes_cannot_announce_more_than_is_allowed():
    with pytest.raises(LimitError, match="allowed in all"):
        compact.samples_from(compact.SAMPLES + b"\xff\xff\x7f\xff\xff\x7f\x3f" + bytes(20), 10**12)
    with pytest.raises(FormatError, match="truncated"):
        compact.edges_from(compact.EDGES + b"\x10\x10\x10\x10\xff\xff\x7f\x00" + bytes(20))
    with pytest.raises(LimitError, match="16384 x 16384 samples of a direction field"):
        compact.directions_from(compact.DIRECTIONS + b"\x80\x80\x01\x80\x80\x01" + bytes(20))
    with pytest.raises(FormatError, match="0 x 7 samples"):
        compact.directions_from(compact.DIRECTIONS + b"\x00\x07" + bytes(20))
    with pytest.raises(LimitError):
        compact.text_from(compact.TEXT + b"\xff\xff\xff\x7f" + bytes(20))


def test_reading_stops_where_the_bytes_end():
    """Decoding what is announced after that would take minutes for sixteen million of either."""
    text = np.full(1 << 24, 7, np.uint8)
    coder = _compact.Coder(b"few bytes")
    coder.text(text)
    assert coder.overrun and (text[1 << 16 :] == 7).all()
    for shape in ((1 << 12, 1 << 12), (1, 1 << 24)):
        values = np.full(shape, 7, np.int32)
        coder = _compact.Coder(b"few bytes")
        coder.samples(values, 255)
        assert coder.overrun and (values.ravel()[1 << 16 :] == 7).all()
    found = (ROOT / "tests/data/found/compact/text-of-232314-bytes-in-7").read_bytes()
    with pytest.raises(FormatError, match=r"^truncated or damaged$"):
        compact.text_from(found)


@pytest.mark.parametrize(
    "maxval, levels, most", [(255, 64, 63), (63, 64, 63), (40, 64, 40), (65535, 256, 255), (1, 2, 1)]
)
def test_requantising_keeps_paper_and_ink_and_what_is_coarse_already(maxval, levels, most):
    values = np.linspace(0, maxval, 8).round().astype(np.uint16 if maxval > 255 else np.uint8)[None]
    image = compact.requantised(GreyImage(values, maxval), levels)
    assert image.maxval == most
    assert image.values[0, 0] == 0 and image.values[0, -1] == most
    assert np.abs(image.values / most - values / maxval).max() <= 0.5 / most + 1e-12
    again = compact.requantised(image, levels)
    assert np.array_equal(again.values, image.values)
