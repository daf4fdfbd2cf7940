"""Vertices on a grid: still an arrangement, still the same picture."""

from __future__ import annotations

import numpy as np
import pytest

from penink_cli.geometry import quantisation, sides, validity
from penink_cli.ground.model import EdgeList


def distance_to(points: np.ndarray, edges: EdgeList) -> np.ndarray:
    """From each point to the nearest edge: slow and obvious."""
    a, b = edges.vertices[edges.edges[:, 0]], edges.vertices[edges.edges[:, 1]]
    along = ((points[:, None] - a) * (b - a)).sum(-1) / ((b - a) ** 2).sum(-1)
    nearest = a + np.clip(along, 0, 1)[..., None] * (b - a)
    return np.hypot(*(points[:, None] - nearest).transpose(2, 0, 1)).min(axis=1)


def fan(seed: int, n: int = 80) -> EdgeList:
    """Thin wedges and near-parallel lines that a coarse grid is bound to tangle, though none of them cross."""
    rng = np.random.default_rng(seed)
    y = np.sort(rng.random(n)) * 8 + 1
    left = np.column_stack([np.full(n, 1.0), y])
    right = np.column_stack([np.full(n, 38.0), y * 2 + 5])
    vertices = np.concatenate([left, right])
    ends = np.column_stack([np.arange(n), n + np.arange(n)])
    return EdgeList(40, 30, vertices, ends, rng.random(n))


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("cells", [(40, 30), (160, 120), (77, 91)])
def test_the_result_is_an_arrangement_on_the_grid_and_near_the_original(seed, cells):
    edges = fan(seed)
    validity.check(edges)
    found = quantisation.quantise(edges, *cells)
    validity.check(found)
    on_grid = found.vertices * (cells[0] / 40, cells[1] / 30)
    assert np.allclose(on_grid, np.rint(on_grid), atol=1e-9)
    cell = np.hypot(40 / cells[0], 30 / cells[1])
    t = np.linspace(0, 1, 40)[:, None, None]
    for one, other in ((edges, found), (found, edges)):
        ends = one.vertices[one.edges]
        points = (ends[:, 0] * (1 - t) + ends[:, 1] * t).reshape(-1, 2)
        assert distance_to(points, other).max() < 2 * cell  # nothing lost, nothing invented


def test_what_is_on_the_grid_stays():
    edges = fan(0)
    once = quantisation.quantise(edges, 160, 120)
    twice = quantisation.quantise(once, 160, 120)
    assert np.array_equal(once.vertices, twice.vertices)
    assert np.array_equal(once.edges, twice.edges)
    assert np.array_equal(once.strength, twice.strength)


def test_of_edges_that_coincide_the_stronger_stays():
    vertices = np.array([[1, 1], [9, 1], [1.01, 1.01], [9.01, 1.01]])
    edges = EdgeList(10, 10, vertices, np.array([[0, 1], [2, 3]]), np.array([0.2, 0.9]))
    found = quantisation.quantise(edges, 10, 10)
    assert found.edges.tolist() == [[0, 1]]
    assert found.strength.tolist() == [0.9]


def test_nothing_stays_nothing():
    assert len(quantisation.quantise(EdgeList(10, 10), 10, 10).edges) == 0


def passed_on_the_left(edges: EdgeList, samples: np.ndarray) -> np.ndarray:
    """(edges, samples): 1 where an edge passes a sample (not: ends by it) and has it to its left, -1 to its right."""
    a, b = (edges.vertices[edges.edges[:, k]][:, None] for k in (0, 1))
    turn = (b - a)[..., 0] * (samples - a)[..., 1] - (b - a)[..., 1] * (samples - a)[..., 0]
    along = ((samples - a) * (b - a)).sum(-1) / np.maximum(((b - a) ** 2).sum(-1), 1e-9)
    return np.where((along > 0.05) & (along < 0.95), np.sign(turn), 0)


def test_samples_stay_on_their_sides_of_the_edges():
    samples = np.stack(np.meshgrid(np.arange(24) + 0.5, np.arange(24) + 0.5), axis=-1).reshape(-1, 2)
    ends = np.column_stack([np.arange(60), (np.arange(60) + 1) % 60])
    changed = {"beside samples": 0, "nearest": 0}
    for seed in range(12):
        rng = np.random.default_rng(seed)
        turn = np.sort(rng.random(60)) * 2 * np.pi
        exact = 16 * (12 + rng.uniform(5, 11) * np.column_stack([np.cos(turn), np.sin(turn)]))
        before = passed_on_the_left(EdgeList(24, 24, exact / 16, ends), samples)
        beside = sides.rounded_beside_samples(exact, ends, 16)
        assert np.abs(beside - exact).max() <= 2.5
        for how, grid in (("beside samples", beside), ("nearest", np.rint(exact))):
            after = passed_on_the_left(EdgeList(24, 24, grid / 16.0, ends), samples)
            changed[how] += int(((after != before) & (after != 0) & (before != 0)).sum())
        found = quantisation.quantise(EdgeList(24, 24, exact / 16, ends), 24 * 16, 24 * 16, 16)
        again = quantisation.quantise(found, 24 * 16, 24 * 16, 16)
        assert np.array_equal(found.vertices, again.vertices)
    assert changed["beside samples"] == 0
    assert changed["nearest"] > 0  # or nothing is shown
