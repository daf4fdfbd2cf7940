"""Fewer samples, none of which mixes two sides of an edge."""

import numpy as np
import pytest

from penink_cli.ground.model import EdgeList
from penink_cli.reconstruction import reduction
from penink_cli.reconstruction._compiled import fit as _fit
from penink_cli.reconstruction.enlarge import reconstruct
from penink_cli.reconstruction.fit import fit_samples
from penink_cli.reconstruction.reduction import reduce
from tests.reconstruction.arrangements import comb, random_edges, spiral, star


@pytest.mark.parametrize("x", [14.0, 14.5, 16.0, 17.3])
@pytest.mark.parametrize("fit", ["none", "lsq"])
def test_sides_do_not_mix(x, fit):
    grey = np.where(np.arange(32) + 0.5 < x, 0.25, 0.75) * np.ones((24, 1))
    edges = EdgeList(32, 24, np.array([[x, 0.0], [x, 24]]), np.array([[0, 1]]))
    reduced = reduce(grey, edges, 8, 6, fit=fit)
    expected = np.where((np.arange(8) + 0.5) * 4 < x, 0.25, 0.75) * np.ones((6, 1))
    away = np.abs((np.arange(8) + 0.5) * 4 - x) > 1e-9
    assert np.abs(reduced - expected)[:, away].max() < 0.01


def test_a_slope_is_kept():
    grey = np.linspace(0.1, 0.9, 40) * np.ones((20, 1))
    reduced = reduce(grey, EdgeList(40, 20), 10, 5)
    assert np.abs(np.diff(reduced[:, 3:-3], axis=1) - 0.8 * 4 / 39).max() < 1e-3


def test_any_size():
    assert reduce(np.full((17, 23), 0.5), EdgeList(23, 17), 5, 3).shape == (3, 5)


@pytest.mark.parametrize("size", [(2, 1), (2, 6), (4, 3), (7, 2)])
def test_grids_of_fewer_samples_than_a_pixel_depends_on(size):
    photo = np.where(np.arange(21) < 9, 0.25, 0.75) * np.ones((19, 1), np.float32)
    edges = EdgeList(21, 19, np.array([[9.0, 0], [9.0, 19]]), np.array([[0, 1]]))
    reduced = reduce(photo, edges, *size, photo=photo, fit="lsq", blur=0.0)
    assert reduced.shape == size[::-1]
    beyond = (np.arange(size[0]) + 0.5) * 21 / size[0] > 9
    assert np.abs(reduced - np.where(beyond, 0.75, 0.25)).max() < 0.02


def test_the_fit_is_the_same_for_any_number_of_threads():
    random = np.random.default_rng(7)
    photo = random.random((90, 120)).astype(np.float32)
    ends = np.column_stack([random.uniform(1, 119, 40), random.uniform(1, 89, 40)])
    ends = ends[np.argsort(ends[:, 0])]  # edges left to right, which cannot cross
    edges = EdgeList(120, 90, ends, np.array([[k, k + 1] for k in range(0, 38)]))
    one, two, five = (reduce(photo, edges, 60, 45, photo=photo, fit="lsq", threads=n) for n in (1, 2, 5))
    assert np.array_equal(one, two) and np.array_equal(one, five)


def test_of_many_pixels_a_sample_a_smaller_view_is_fitted_to(monkeypatch):
    y, x = np.mgrid[:300, :400].astype(np.float32)
    photo = np.where((x - 190) ** 2 + (y - 160) ** 2 < 90**2, 0.2 + 0.001 * x, 0.8 - 0.0005 * y).astype(np.float32)
    turn = np.arange(40) * 2 * np.pi / 40
    circle = np.column_stack([190.5 + 90 * np.cos(turn), 160.5 + 90 * np.sin(turn)])
    edges = EdgeList(400, 300, circle, np.column_stack([np.arange(40), (np.arange(40) + 1) % 40]))
    quick = reduce(photo, edges, 16, 12, photo=photo, fit="lsq", blur=0.0)
    monkeypatch.setattr(reduction, "_ENOUGH", 1000)
    assert np.abs(quick - reduce(photo, edges, 16, 12, photo=photo, fit="lsq", blur=0.0)).max() < 0.005


@pytest.mark.parametrize(
    "edges",
    [
        random_edges(np.random.default_rng(5), 96, 80, 60, length=12.0),
        star(96, 80, 41.0, 39.0, 9, 30.0),
        spiral(96, 80, 3.0, 8.0),
        comb(96, 80, 30, 2.6),
    ],
)
@pytest.mark.parametrize("size", [(24, 20), (37, 31)])
def test_the_matrix_of_the_fit_is_the_reconstruction(edges, size, monkeypatch):
    blocks = []
    monkeypatch.setattr(_fit, "solve", lambda *arguments: blocks.append([np.array(part) for part in arguments]))
    samples = np.random.default_rng(6).random(size[::-1])
    fit_samples(np.zeros((80, 96), np.float32), edges, samples, 0.5, threads=1)
    assert len(blocks) == 1
    weight, columns, rows = blocks[0][:3]
    five = np.arange(5)
    touched = samples[rows[:, None, None, None] + five[:, None], columns[:, None, None] + five]
    pixels = (weight.reshape(80, 96, 5, 5) * touched).sum(axis=(2, 3))
    expected = reconstruct(samples, edges, 192, 160).reshape(80, 2, 96, 2).mean(axis=(1, 3))
    assert np.abs(pixels - expected).max() < 1e-4


def test_the_fit_undoes_what_the_camera_did():
    # A blurred step, sampled on a grid that has no sample on the blur's own scale.
    from scipy.ndimage import gaussian_filter

    sharp = np.where(np.arange(64) < 29.0, 0.2, 0.8) * np.ones((48, 1))
    photo = gaussian_filter(sharp, 0.9).astype(np.float32)
    edges = EdgeList(64, 48, np.array([[29.0, 0.0], [29.0, 48.0]]), np.array([[0, 1]]))
    wrong = []
    for fit in ("none", "lsq"):
        again = reconstruct(reduce(photo, edges, 16, 12, photo=photo, fit=fit, blur=0.9).astype(float), edges, 64, 48)
        wrong.append(np.abs(again - sharp)[:, 22:36].max())
    assert wrong[1] < 0.5 * wrong[0] and wrong[1] < 0.03
