"""Visibility, shortest paths, weights: known lengths, and symmetries."""

from __future__ import annotations

import numpy as np
import pytest

from penink_cli.reconstruction.kernels import taps
from penink_cli.reconstruction.paths import Paths, spill
from tests.oracles import brute
from tests.oracles.weights import weights
from tests.reconstruction.arrangements import HOSTILE, chain, random_edges


def test_the_way_around_a_wall():
    # A wall from (2, 0) to (2, 3) in the frame: in sample units its end is at (1.5, 2.5).
    paths = Paths(chain(6, 6, [(2, 0), (2, 3)]), 6, 6, limit=20.0)
    p, q = np.array([[0.5, 1.5]]), np.array([[2.5, 1.5]])
    assert not paths.visible(p, q)[0]
    assert paths.lengths(p, q)[0] == pytest.approx(2 * np.sqrt(2))
    assert paths.lengths(q, p)[0] == pytest.approx(2 * np.sqrt(2))
    assert paths.lengths(p, q, limit=2.5)[0] == np.inf
    assert paths.visible(p, np.array([[2.5, 4.5]]))[0]


def test_two_bends_and_both_sides_of_a_chain():
    # A U open to the left; from inside to behind its bottom the way leads around a corner of the open end.
    paths = Paths(chain(9, 9, [(2, 2), (6, 2), (6, 5), (2, 5)]), 9, 9, limit=20.0)
    inside, above, right = np.array([[4.0, 3.0]]), np.array([[4.0, 0.0]]), np.array([[7.0, 3.0]])
    ends = np.array([[1.5, 1.5], [5.5, 1.5]])
    first = np.hypot(*(inside - ends[:1]).T)
    assert paths.lengths(inside, above)[0] == pytest.approx(first[0] + np.hypot(*(above - ends[:1]).T)[0])
    expected = first[0] + 4.0 + np.hypot(*(right - ends[1:]).T)[0]
    assert paths.lengths(inside, right)[0] == pytest.approx(expected)


def test_a_closed_wall_has_no_way_out():
    paths = Paths(HOSTILE["closed square"], 6, 5, limit=50.0)
    assert paths.lengths(np.array([[2.0, 2.0]]), np.array([[5.0, 2.0]]))[0] == np.inf


@pytest.mark.parametrize("name", sorted(HOSTILE))
def test_unbounded_lengths_match_the_brute_force(name):
    edges = HOSTILE[name]
    paths = Paths(edges, 6, 5, limit=60.0)
    rng = np.random.default_rng(0)
    grid = np.stack(np.meshgrid(np.arange(6), np.arange(5)), -1).reshape(-1, 2).astype(float)
    p = np.concatenate([rng.uniform(0, 4, (10, 2)), grid[::4]])
    expected = brute.Brute(edges, 6, 5).lengths(p, grid, np.tile(np.arange(30), (len(p), 1)))
    found = paths.lengths(np.repeat(p, 30, axis=0), np.tile(grid, (len(p), 1)), threads=2).reshape(-1, 30)
    assert np.array_equal(np.isinf(found), np.isinf(expected))
    finite = np.isfinite(expected)
    assert np.abs(found[finite] - expected[finite]).max() < 1e-9


def test_weights_sum_to_one_and_say_who_is_starved():
    rng = np.random.default_rng(3)
    points = rng.uniform(-0.5, 4.5, (500, 2))
    for name in ("closed square without a sample", "spiral", "none"):
        rows = weights(Paths(HOSTILE[name], 6, 5), points, threads=2)
        assert np.abs(rows.weight.sum(axis=1) - 1).max() < 1e-12
        assert rows.index.min() >= 0
        assert rows.index.max() < 30
        inside = (np.abs(points - 2.5) < 0.4).all(axis=1)
        if name == "none":
            assert not rows.starved.any()
        if name == "closed square without a sample":
            assert (rows.starved[inside] == 1).all()
            assert rows.starved[~inside].max() < 1


def test_the_ellipse_of_a_unit_radius_spills_over_less_than_one_cell():
    assert spill(1.0) == 1
    assert spill(0.2) == 1
    assert spill(6.0) > 3


def test_taps_are_the_kernels_of_the_appendix():
    x = np.linspace(-0.5, 9.5, 37)
    for widening in (1.0, 1.5, 4.0):
        table = taps(x, widening)
        place = table.first[:, None] + np.arange(table.cubic.shape[1])
        for found, kernel in ((table.cubic, brute.cubic), (table.bspline, brute.bspline)):
            expected = kernel((x[:, None] - place) / widening)
            expected /= expected.sum(axis=1, keepdims=True)
            assert np.abs(found - expected).max() < 1e-12


def test_random_pairs_see_each_other_both_ways():
    rng = np.random.default_rng(5)
    paths = Paths(random_edges(rng, 12, 12, 60), 12, 12)
    p, q = rng.uniform(0, 11, (300, 2)), rng.uniform(0, 11, (300, 2))
    seen = paths.visible(p, q)
    assert np.array_equal(seen, paths.visible(q, p))
    assert seen.any()
    assert not seen.all()
