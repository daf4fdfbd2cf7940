"""The compact members: nothing is lost, nothing depends on order, nothing bad is swallowed."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from penink_cli.formats import compact, compact_edges, compact_lines, parts
from penink_cli.formats._compiled import coder as _coder
from penink_cli.formats._compiled import samples as _samples
from penink_cli.geometry import quantisation, validity
from penink_cli.ground.errors import FormatError, LimitError, PeninkError
from penink_cli.ground.model import Directions, EdgeList, GreyImage, Lines
from tests.conftest import ROOT
from tests.illustration.conftest import grey, square, whirl

#: What each version of a form wrote, in hexadecimal. A form that gives other bytes is another version.
VECTORS = json.loads((ROOT / "tests/illustration/compact_vectors.json").read_text())
CORNERS = np.array([[2, 2], [12, 3], [13, 10], [3, 9], [8, 6]], float)
EDGES = EdgeList(16, 12, CORNERS, np.array([[0, 1], [1, 2], [2, 3], [3, 0], [2, 4]]), np.arange(5) / 16)
#: The mean by length of each stretch between junctions: the ring and the whisker.
LEVELLED = EdgeList(16, 12, CORNERS, EDGES.edges, np.array([1, 1, 1, 1, 4]) / 16)

#: Of one byte more than magic, of none, and of more than a number of seven bits says.
PARTS = [b"PIs1\0", b"PIe2", b"PIt1" + bytes(range(140))]

TOLD = Lines(
    64, 48, np.array([[4, 4], [20.5, 9], [31, 20], [50, 30], [40, 40], [10, 40]]), np.array([0, 3, 5, 6]),
    np.array([0.2, 0.9, 0.4, 0.5, 0.5, 1]), np.array([7.25, 2, 1.5]), np.array([False, True, False]),
    np.array([0, 0, 3.0]),
)  # fmt: skip


def by_formula() -> dict[str, tuple[bytes, object]]:
    """Contents that a few whole numbers describe: their compact bytes, and what reads them again."""
    y, x = np.mgrid[:12, :16]
    samples = GreyImage(((7 * x * x + 13 * y + x * y) % 64).astype(np.uint8), 63)
    text = b'{"name": "vectors", "numbers": [1, 2, 3]}'
    return {
        "PIs1": (b"", samples),
        "PIs2": (b"", samples),
        "PIs3": (compact.samples_bytes(samples, EDGES), samples),
        "PIe1": (b"", EDGES),
        "PIe2": (compact_edges.edges_bytes(EDGES, 256, 192), LEVELLED),
        "PId1": (b"", whirl(12, 8)),
        "PId2": (compact.directions_bytes(whirl(12, 8)), whirl(12, 8)),
        "PIl1": (b"", TOLD),
        "PIl2": (b"", TOLD),
        "PIl3": (compact_lines.lines_bytes(TOLD), TOLD),
        "PIt1": (compact.text_bytes(text), text),
        "PIp1": (parts.parts_bytes(PARTS), PARTS),
    }


def test_the_bytes_are_those_of_the_versions_that_are_written():
    assert set(VECTORS) == set(by_formula())
    for name, (data, _) in by_formula().items():
        assert data[:4].decode() in (name, "")
        assert not data or data.hex() == VECTORS[name], name


@pytest.mark.parametrize("name", VECTORS)
def test_every_version_is_read(name):
    data, given = bytes.fromhex(VECTORS[name]), by_formula()[name][1]
    if isinstance(given, list):
        assert parts.parts_from(data) == given
    elif isinstance(given, GreyImage):
        assert np.array_equal(compact.samples_from(data, 10**6, EDGES).values, given.values)
    elif isinstance(given, EdgeList):
        assert as_set(compact_edges.edges_from(data)) == as_set(given)
    elif isinstance(given, Directions):
        back = compact.directions_from(data)
        assert (back.cos2 * given.cos2 + back.sin2 * given.sin2).min() > np.cos(np.radians(5.625)) - 1e-9
    elif isinstance(given, Lines):
        back, smoothed = compact_lines.lines_from(data), name == "PIl3"
        assert np.abs(back.points - given.points).max() <= (0.11 if smoothed else 0.04)
        assert np.abs(back.weight - given.weight).max() <= (0.42 if smoothed else 1 / 6)
        assert np.abs(back.rank / given.rank - 1).max() <= 0.1 and np.array_equal(back.white, given.white)
        assert np.abs(back.breadth - given.breadth).max() <= 0.05
    else:
        assert compact.text_from(data) == given


def as_set(edges: EdgeList) -> set[tuple]:
    """Edges by the places of their ends, with strengths."""
    strength = edges.strength if edges.strength is not None else np.zeros(len(edges.edges))
    return {
        (*sorted((tuple(edges.vertices[a]), tuple(edges.vertices[b]))), float(s))
        for (a, b), s in zip(edges.edges, strength)
    }


def levelled(edges: EdgeList) -> EdgeList:
    """As it is kept: one strength a stretch."""
    return compact_edges.edges_from(compact_edges.edges_bytes(edges, 80, 60))


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


def hidden_by_formula(edges: EdgeList, w: int, h: int) -> np.ndarray:
    """Which of six neighbours each sample cannot see, by whole numbers and the tie rule written out."""

    def sign(*values):
        return next((1 if v > 0 else -1 for v in values if v), 0)

    at = [(round(x * w / edges.width * 16), round(y * h / edges.height * 16)) for x, y in edges.vertices.tolist()]
    cuts = np.zeros((h, w), np.uint8)
    for i in range(h):
        for j in range(w):
            for k, (dx, dy) in enumerate([(-1, 0), (0, -1), (-1, -1), (1, -1), (-2, 0), (0, -2)]):
                if not (0 <= j + dx < w and i + dy >= 0):
                    continue
                p, q = (16 * j + 8, 16 * i + 8), (16 * (j + dx) + 8, 16 * (i + dy) + 8)
                for a, b in ((at[a], at[b]) for a, b in edges.edges):
                    side = [
                        sign((b[0] - a[0]) * (s[1] - a[1]) - (b[1] - a[1]) * (s[0] - a[0]), a[1] - b[1], b[0] - a[0])
                        for s in (p, q)
                    ]
                    view = [
                        sign((q[0] - p[0]) * (v[1] - p[1]) - (q[1] - p[1]) * (v[0] - p[0]), q[1] - p[1], p[0] - q[0])
                        for v in (a, b)
                    ]
                    if side[0] != side[1] and view[0] != view[1]:
                        cuts[i, j] |= 1 << k
    return cuts


@pytest.mark.parametrize("seed", range(8))
def test_what_an_edge_hides_is_exact(seed):
    """Also of edges through samples and of vertices in line with two of them: the odd seeds have little else."""
    rng = np.random.default_rng(seed)
    w, h, step = 5 + seed, 9, 8 if seed % 2 else 1
    points = rng.integers(0, (16 * w // step + 1, 16 * h // step + 1), (24, 2)) * float(step)
    points[0], points[1] = (0, 8), (16 * w, 8)
    edges = EdgeList(16 * w, 16 * h, points, np.arange(24).reshape(12, 2))
    assert np.array_equal(compact._hidden(edges, w, h), hidden_by_formula(edges, w, h))


def test_samples_beside_an_edge_are_told_by_their_own_side():
    """Two smooth fields that meet along a slanted edge, with noise in neither: the edge saves what it hides."""
    edges = EdgeList(128, 128, np.array([[30, 0], [100, 128.0]]), np.array([[0, 1]]))
    y, x = np.mgrid[0:64, 0:64] + 0.5
    right = (2 * x - 30) * 128 > 2 * y * 70
    values = np.where(right, 8 + (x + y) / 8, 50 - y / 8).astype(np.uint8)
    image = GreyImage(values, 63)
    alone, beside = compact.samples_bytes(image), compact.samples_bytes(image, edges)
    assert len(beside) < 0.8 * len(alone)
    assert np.array_equal(compact.samples_from(beside, 10**6, edges).values, values)
    with pytest.raises(FormatError, match="the layer has none"):
        compact.samples_from(beside, 10**6)


def test_edges_that_would_take_long_hide_nothing():
    """A fan across all samples, again and again: more cells than a picture's edges pass."""
    n = 3000
    vertices = np.concatenate([[[0, 0]], np.column_stack([np.full(n, 4096.0), np.linspace(1, 4096, n)])])
    fan = EdgeList(4096, 4096, vertices, np.column_stack([np.zeros(n, int), np.arange(1, n + 1)]))
    assert not compact._hidden(fan, 256, 256).any()
    few = EdgeList(4096, 4096, vertices, fan.edges[::100])
    assert compact._hidden(few, 256, 256).any()


def test_vertices_are_as_coarse_as_the_photo_allows():
    """A step stays within .4 pixels of the photo, where 16 to the spacing can do that, and never moves twice."""
    frame = EdgeList(640, 480, np.array([[3.07, 4.21], [400.3, 200.7]]), np.array([[0, 1]]))
    for columns, points in ((64, 16), (101, 16), (128, 16), (200, 8), (400, 4), (640, 4)):
        rows = columns * 3 // 4
        assert compact_edges.points_to_spacing(frame, columns, rows) == points
        assert points == 16 or max(640 / columns, 480 / rows) / points <= 0.4
        moved = quantisation.quantise(frame, points * columns, points * rows, points)
        assert compact_edges.on_grid(moved, columns, rows) == points
        assert compact_edges.on_grid(frame, columns, rows) is None


def test_samples_are_small():
    smooth = (np.add.outer(np.arange(128), np.arange(128)) // 5).astype(np.uint8)
    assert len(compact.samples_bytes(GreyImage(smooth, 63))) < 600
    white = GreyImage(np.full((128, 128), 63, np.uint8), 63)
    assert len(compact.samples_bytes(white)) < 30


@pytest.mark.parametrize("seed", [*range(10), *(pytest.param(k, marks=pytest.mark.slow) for k in range(10, 40))])
def test_edges_come_back_exactly_and_in_an_order_of_their_own(seed):
    edges = random_arrangement(seed, 80, 60)
    packed = compact_edges.edges_bytes(edges, 80, 60)
    back = compact_edges.edges_from(packed)
    assert {edge[:2] for edge in as_set(back)} == {edge[:2] for edge in as_set(edges)}
    assert as_set(levelled(back)) == as_set(back)
    validity.check(back)
    rng = np.random.default_rng(seed)
    moved, order = rng.permutation(len(edges.vertices)), rng.permutation(len(edges.edges))
    vertices = np.empty_like(edges.vertices)
    vertices[moved] = edges.vertices
    assert edges.strength is not None
    shuffled = EdgeList(40, 30, vertices, moved[edges.edges][order][:, ::-1], edges.strength[order])
    assert compact_edges.edges_bytes(shuffled, 80, 60) == packed


@pytest.mark.parametrize(("rows", "columns"), [(1, 1), (1, 9), (5, 1), (64, 96), (33, 47)])
def test_directions_come_back_within_a_level_and_then_exactly(rows, columns):
    field = whirl(columns, rows)
    packed = compact.directions_bytes(field)
    back = compact.directions_from(packed)
    off = np.degrees(np.arccos(np.clip(back.cos2 * field.cos2 + back.sin2 * field.sin2, -1, 1))) / 2
    assert off.max() < 5.625 / 2 + 1e-6 and np.abs(back.cos2**2 + back.sin2**2 - 1).max() < 1e-9
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
    "samples of 256 levels": (
        compact.samples_bytes(GreyImage(255 - 3 * grey().values, 255)),
        lambda data: compact.samples_from(data, 2000),
    ),
    "samples beside edges": (
        compact.samples_bytes(grey(), square()),
        lambda data: compact.samples_from(data, 2000, square()),
    ),
    "edges": (compact_edges.edges_bytes(quantisation.quantise(square(), 384, 256), 384, 256), compact_edges.edges_from),
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
        if kind.startswith("samples"):
            assert found.values.max() <= found.maxval
        if kind == "directions":
            assert np.allclose(found.cos2**2 + found.sin2**2, 1) and found.confidence.max() <= 1


def test_a_few_bytes_cannot_announce_more_than_is_allowed():
    with pytest.raises(LimitError, match="allowed in all"):
        compact.samples_from(compact.SAMPLES + b"\xff\xff\x7f\xff\xff\x7f\x3f" + bytes(20), 10**12)
    with pytest.raises(FormatError, match="truncated"):
        compact_edges.edges_from(compact_edges.EDGES + b"\x10\x10\x10\x10\xff\xff\x7f\x00" + bytes(20))
    with pytest.raises(LimitError, match="16384 x 16384 samples of a direction field"):
        compact.directions_from(compact.DIRECTIONS + b"\x80\x80\x01\x80\x80\x01" + bytes(20))
    with pytest.raises(FormatError, match="0 x 7 samples"):
        compact.directions_from(compact.DIRECTIONS + b"\x00\x07" + bytes(20))
    with pytest.raises(LimitError):
        compact.text_from(compact.TEXT + b"\xff\xff\xff\x7f" + bytes(20))


def test_reading_stops_where_the_bytes_end():
    """Decoding what is announced after that would take minutes for sixteen million of either."""
    text = np.full(1 << 24, 7, np.uint8)
    coder = _coder.Coder(b"few bytes")
    coder.text(text)
    assert coder.overrun and (text[1 << 16 :] == 7).all()
    for shape in ((1 << 12, 1 << 12), (1, 1 << 24)):
        values = np.full(shape, 7, np.int32)
        coder = _coder.Coder(b"few bytes")
        _samples.by_neighbours(coder, values, 255)
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
