"""Enlargement: against two oracles, and what every output must obey."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from penink_cli.ground.errors import ParameterError
from penink_cli.ground.model import EdgeList, GreyImage
from penink_cli.reconstruction import enlarge as enlarging
from penink_cli.reconstruction import lanes
from penink_cli.reconstruction.enlarge import enlarge, reconstruct
from penink_cli.reconstruction.paths import Paths, reach
from tests.oracles import brute
from tests.oracles.triangulated import Triangulated
from tests.oracles.weights import weights
from tests.reconstruction.arrangements import HOSTILE, chain, edge_list, random_edges, tiny

UNIT = 1 / 65535


def samples_for(rng, height, width):
    return rng.random((height, width))


# ---------------------------------------------------------------------------- oracles


@pytest.mark.parametrize("scale", [3, pytest.param(8, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_arrangements_match_the_brute_force(name, scale):
    edges = HOSTILE[name]
    f = samples_for(np.random.default_rng(1), 5, 6)
    scale = min(scale, 4) if name == "tiny" else scale
    found = reconstruct(f, edges, 6 * scale, 5 * scale)
    expected = brute.reconstruct(f, edges, 6 * scale, 5 * scale)
    assert np.abs(found - expected).max() < UNIT


@pytest.mark.parametrize("name", sorted(set(HOSTILE) - {"tiny"}))
def test_the_two_oracles_agree(name):
    edges = HOSTILE[name]
    f = samples_for(np.random.default_rng(2), 5, 6)
    one = brute.reconstruct(f, edges, 12, 10)
    other = brute.reconstruct(f, edges, 12, 10, graph=Triangulated)
    assert np.abs(one - other).max() < 1e-9


@settings(max_examples=14, deadline=None, derandomize=True)
@given(
    seed=st.integers(0, 2**32),
    width=st.integers(1, 7),
    height=st.integers(1, 7),
    count=st.integers(1, 14),
    lattice=st.sampled_from([None, 1, 2, 4]),
    scale=st.sampled_from([(1, 1), (2, 2), (4, 3), (1.7, 3.3), (8, 8), (0.5, 0.5), (0.7, 1.5), (0.3, 0.3)]),
    radius=st.sampled_from([1.0, 1.0, 0.5, 2.5]),
    kernel=st.sampled_from(["cubic", "cubic", "bspline"]),
)
# Columns of cubic weights that are all zero, beside B-spline weights that are not.
@example(seed=3843, width=2, height=1, count=1, lattice=None, scale=(1, 1), radius=1.0, kernel="bspline")
def test_random_arrangements_match_the_brute_force(seed, width, height, count, lattice, scale, radius, kernel):
    rng = np.random.default_rng(seed)
    edges = random_edges(rng, width, height, count, rng.choice([0.3, 1.0, 3.0]), lattice)
    f = samples_for(rng, height, width)
    size = max(1, int(width * scale[0])), max(1, int(height * scale[1]))
    found = reconstruct(f, edges, *size, radius=radius, kernel=kernel)
    expected = brute.reconstruct(f, edges, *size, radius=radius, kernel=kernel)
    assert np.abs(found - expected).max() < UNIT


@pytest.mark.parametrize("lattice", [None, 2])
def test_a_strong_reduction_matches_the_brute_force(lattice):
    """So many samples a pixel that bends are looked for pixel by pixel, instead of once for each sample."""
    rng = np.random.default_rng(8)
    edges = random_edges(rng, 12, 10, 25, 2.0, lattice)
    f = samples_for(rng, 10, 12)
    assert np.abs(reconstruct(f, edges, 2, 2) - brute.reconstruct(f, edges, 2, 2)).max() < UNIT


@pytest.mark.parametrize("seed", range(2))
def test_random_arrangements_match_the_triangulation(seed):
    rng = np.random.default_rng(seed)
    edges = random_edges(rng, 5, 4, 10, lattice=[None, 2][seed % 2])
    f = samples_for(rng, 4, 5)
    expected = brute.reconstruct(f, edges, 15, 12, graph=Triangulated)
    assert np.abs(reconstruct(f, edges, 15, 12) - expected).max() < UNIT


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("scale", [8, 11, 20, 2.3])
def test_tiles_match_single_points(seed, scale):
    """The slow compiled path, free of tiles and masks, on arrangements too large for the oracles."""
    rng = np.random.default_rng(seed)
    edges = random_edges(rng, 14, 11, 60, lattice=[None, None, 4][seed % 3])
    f = samples_for(rng, 11, 14)
    size = int(14 * scale), int(11 * scale)
    x, y = np.meshgrid(*(enlarging.centres(n, k) for n, k in zip(size, (14, 11))))
    rows = weights(Paths(edges, 14, 11, reach(1.0)), np.c_[x.ravel(), y.ravel()])
    assert np.abs(reconstruct(f, edges, *size) - rows.apply(f).reshape(size[::-1])).max() < 1e-9


def test_sixteen_bits_are_the_double_rounded_and_eight_bits_nearly():
    rng = np.random.default_rng(5)
    edges = random_edges(rng, 12, 9, 40)
    fine = GreyImage(rng.integers(0, 65536, (9, 12)).astype(np.uint16), 65535)
    value = reconstruct(fine.values.astype(float), edges, 96, 72)
    assert np.array_equal(enlarge(fine, edges, 96, 72).values, np.floor(np.clip(value, 0, 65535) + 0.5))
    coarse = GreyImage(rng.integers(0, 256, (9, 12)).astype(np.uint8))
    value = np.clip(reconstruct(coarse.values.astype(float), edges, 96, 72), 0, 255)
    assert np.abs(enlarge(coarse, edges, 96, 72).values - value).max() < 0.5 + 1e-3


# ---------------------------------------------------------------------------- what the definition promises


def test_without_edges_it_is_plain_cubic_convolution():
    f = samples_for(np.random.default_rng(0), 7, 9)
    for edges in (None, edge_list(9, 7, [(0, 0), (9, 0), (9, 7)], [(0, 1), (1, 2)])):
        for size in ((72, 56), (31, 44), (4, 3)):
            assert np.abs(reconstruct(f, edges, *size) - brute.reconstruct(f, HOSTILE["none"], *size)).max() < 1e-12


def test_it_passes_through_reachable_samples():
    rng = np.random.default_rng(3)
    edges = random_edges(rng, 8, 8, 25)
    f = samples_for(rng, 8, 8)
    assert np.abs(reconstruct(f, edges, 24, 24)[1::3, 1::3] - f).max() < 1e-12
    assert np.abs(reconstruct(f, edges, 8, 8) - f).max() < 1e-12


def test_a_constant_stays_constant_whatever_the_edges():
    for name, edges in HOSTILE.items():
        assert np.abs(reconstruct(np.full((5, 6), 0.7), edges, 48, 40) - 0.7).max() < 1e-12, name


def test_nothing_crosses_a_closed_edge():
    edges = HOSTILE["closed square"]
    y, x = np.mgrid[:5, :6] + 0.5
    inside = (x > 1) & (x < 4) & (y > 1) & (y < 4)
    value = reconstruct(inside.astype(float), edges, 60, 50)
    y, x = (np.mgrid[:50, :60] + 0.5) / 10
    assert np.array_equal(value > 0.5, (x > 1) & (x < 4) & (y > 1) & (y < 4))
    assert np.abs(value - np.round(value)).max() < 1e-12


def test_a_place_without_a_sample_takes_the_plain_value():
    f = samples_for(np.random.default_rng(6), 5, 6)
    edges = HOSTILE["closed square without a sample"]
    # A sample at (2.5, 2.5) is outside the square 2.6 … 3.4, and so are all others.
    value, plain = reconstruct(f, edges, 60, 50), reconstruct(f, None, 60, 50)
    assert np.abs(value - plain)[27:33, 27:33].max() < 1e-12
    assert np.abs(value - plain)[20:40, 20:40].max() > 1e-3


def test_mirrored_input_gives_mirrored_output():
    rng = np.random.default_rng(8)
    edges = random_edges(rng, 7, 6, 18)
    f = samples_for(rng, 6, 7)
    flipped = EdgeList(7, 6, (7.0, 0.0) + edges.vertices * (-1.0, 1.0), edges.edges)
    turned = EdgeList(6, 7, edges.vertices[:, ::-1].copy(), edges.edges)
    value = reconstruct(f, edges, 35, 30)
    assert np.abs(reconstruct(f[:, ::-1], flipped, 35, 30)[:, ::-1] - value).max() < 1e-9
    assert np.abs(reconstruct(f.T, turned, 30, 35).T - value).max() < 1e-9


def test_one_edge_list_serves_every_resolution():
    rng = np.random.default_rng(9)
    edges = random_edges(rng, 8, 6, 15)
    photo = EdgeList(80, 60, edges.vertices * 10, edges.edges)
    f = samples_for(rng, 6, 8)
    assert np.abs(reconstruct(f, edges, 40, 30) - reconstruct(f, photo, 40, 30)).max() < 1e-9


def test_around_an_open_end_the_tone_changes_smoothly():
    """Across a dangling edge the value jumps; past its end, the same step across its line changes next to nothing."""
    y, _ = np.mgrid[:12, :12] + 0.5
    f = np.where(y < 6, 0.2, 0.8)
    value = reconstruct(f, chain(12, 12, [(0, 6), (6, 6)]), 192, 192)
    jump = np.abs(value[96] - value[95])
    assert jump[:80].min() > 0.55
    assert jump[97:].max() < 0.12
    assert np.abs(np.diff(jump[97:])).max() < 0.02


# ---------------------------------------------------------------------------- bands, threads, windows, sizes


@pytest.fixture(scope="module")
def picture():
    rng = np.random.default_rng(11)
    return GreyImage(rng.integers(0, 256, (23, 31)).astype(np.uint8)), random_edges(rng, 31, 23, 70)


@pytest.mark.parametrize("soften", [False, True])
@pytest.mark.parametrize("size", [(248, 184), (100, 97), (700, 520), (20, 12)])
@pytest.mark.parametrize("maxval", [255, 65535])
def test_no_byte_depends_on_threads_bands_or_window(picture, soften, size, maxval, monkeypatch):
    image, edges = picture
    whole = enlarge(image, edges, *size, soften=soften, maxval=maxval, threads=1).values
    monkeypatch.setattr(enlarging, "BAND", 3000)
    assert np.array_equal(enlarge(image, edges, *size, soften=soften, maxval=maxval, threads=3).values, whole)
    rng = np.random.default_rng(0)
    for _ in range(6):
        x, y = rng.integers(size[0]), rng.integers(size[1])
        w, h = 1 + rng.integers(size[0] - x), 1 + rng.integers(size[1] - y)
        window = int(x), int(y), int(w), int(h)
        part = enlarge(image, edges, *size, soften=soften, maxval=maxval, window=window, threads=2).values
        assert np.array_equal(part, whole[y : y + h, x : x + w]), window


@pytest.mark.parametrize("maxval", [255, 65535])
def test_no_byte_depends_on_how_many_numbers_the_processor_computes_at_once(picture, maxval, monkeypatch):
    makes = sorted(width for width in lanes.MAKES["sums"] if width <= lanes.VECTOR_BYTES)
    if len(makes) == 1:
        pytest.skip("this processor has neither AVX2 nor AVX-512")
    image, edges = picture
    aligned = random_edges(np.random.default_rng(12), 31, 23, 60, lattice=2)
    for arrangement in (None, edges, aligned):
        for size, way in (((248, 184), {}), ((401, 299), {"radius": 1.7}), ((100, 97), {"soften": True}),
                          ((31, 700), {"kernel": "bspline"})):  # fmt: skip
            found = []
            for width in makes:
                monkeypatch.setattr(lanes, "VECTOR_BYTES", width)
                found.append(enlarge(image, arrangement, *size, maxval=maxval, **way).values)
            assert all(np.array_equal(values, found[0]) for values in found), (size, way)


def test_no_byte_depends_on_the_order_of_edges_and_vertices():
    rng = np.random.default_rng(13)
    image = GreyImage(rng.integers(0, 256, (70, 75)).astype(np.uint8))
    y, x = np.mgrid[:70, :75]  # more than are numbered anew: see `_scene.by_place`
    start = np.c_[x.ravel(), y.ravel()] + rng.uniform(0.1, 0.4, (5250, 2))
    vertices = np.concatenate([start, start + rng.uniform(0.1, 0.5, (5250, 2))])
    lines = np.arange(10500).reshape(2, -1).T
    found = []
    for _ in range(2):
        found.append(enlarge(image, EdgeList(75, 70, vertices, lines), 225, 140, maxval=65535).values)
        order, rank = rng.permutation(10500), np.empty(10500, np.int64)
        rank[order] = np.arange(10500)
        vertices, lines = vertices[order], rank[lines[rng.permutation(5250)]]
    assert np.array_equal(*found)


def test_bands_come_in_order_and_make_up_the_whole(picture, monkeypatch):
    image, edges = picture
    monkeypatch.setattr(enlarging, "BAND", 5000)
    parts = list(enlarging.bands(image, edges, 248, 184, threads=2))
    assert len(parts) > 5
    assert np.array_equal(np.concatenate(parts), enlarge(image, edges, 248, 184).values)


def test_softening_is_cubic_convolution_of_half_the_size(picture):
    image, edges = picture
    for size in ((124, 92), (125, 93)):
        half = reconstruct(image.values.astype(float), edges, -(-size[0] // 2), -(-size[1] // 2))
        expected = reconstruct(half, None, *size)
        found = enlarge(image, edges, *size, soften=True).values
        assert np.abs(found - np.clip(expected, 0, 255)).max() < 0.501


def test_maxval_scales_the_values(picture):
    image, edges = picture
    for maxval in (1, 100, 255, 256, 1000, 65535):
        found = enlarge(image, edges, 90, 70, maxval=maxval)
        exact = reconstruct(image.values.astype(float), edges, 90, 70) * maxval / 255
        assert found.maxval == maxval
        assert found.values.dtype == (np.uint8 if maxval < 256 else np.uint16)
        assert np.abs(found.values - np.clip(exact, 0, maxval)).max() <= 0.501


def test_one_sample():
    image = GreyImage(np.array([[77]], np.uint8))
    edges = edge_list(1, 1, [(0.1, 0.2), (0.9, 0.7)], [(0, 1)])
    assert (enlarge(image, edges, 40, 30).values == 77).all()
    assert (enlarge(image, edges, 1, 1, soften=True).values == 77).all()


@pytest.mark.parametrize("size", [(40, 30), (5, 4)])
def test_planes_of_one_picture_are_what_each_is_alone(size):
    """Enlarged, and made smaller."""
    planes = np.random.default_rng(2).random((3, 9, 11))
    edges = edge_list(11, 9, [(1, 1), (9, 7), (6, 1)], [(0, 1), (2, 1)])
    together = reconstruct(planes, edges, *size)
    assert together.shape == (3, *size[::-1])
    for plane, found in zip(planes, together):
        assert (reconstruct(plane, edges, *size) == found).all()


def test_hundreds_of_tiny_edges_in_one_cell():
    edges = tiny(np.random.default_rng(0), 6, 5, 24)  # 576: crowded, so that the cell has a grid of its own
    f = samples_for(np.random.default_rng(1), 5, 6)
    value = reconstruct(f, edges, 48, 40)
    x, y = np.meshgrid(np.arange(18, 30) / 8 + 1 / 16 - 0.5, np.arange(20, 26) / 8 + 1 / 16 - 0.5)
    rows = weights(Paths(edges, 6, 5), np.c_[x.ravel(), y.ravel()])
    assert np.abs(rows.apply(f).reshape(6, 12) - value[20:26, 18:30]).max() < 1e-9


def test_windows_outside_and_unknown_kernels_are_refused(picture):
    image, edges = picture
    with pytest.raises(ParameterError, match="window 90,0,20,10 is not within the 100 x 100 pixels"):
        enlarge(image, edges, 100, 100, window=(90, 0, 20, 10))
    with pytest.raises(ParameterError, match="'sinc' is not one of cubic, bspline"):
        enlarge(image, edges, 100, 100, kernel="sinc")
