"""Positions averaged along chains, corners given back, and which chains tell something."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter, gaussian_filter1d

from penink_cli.arrangement._compiled import smoothing as _smoothing
from penink_cli.arrangement.chains import Chains
from penink_cli.arrangement.detection import detect_edges
from penink_cli.arrangement.smoothing import smooth
from penink_cli.ground.model import EdgeList


def painted(size, inside, low=0.3, high=0.7, blur=0.8, noise=0.0, seed=0):
    """A shape, inside(x, y), rendered with 4 × 4 points a pixel, blurred, with noise of so many levels."""
    at = (np.arange(size * 4) + 0.5) / 4
    fine = np.where(inside(at[None], at[:, None]), high, low)
    grey = gaussian_filter(fine.reshape(size, 4, size, 4).mean(axis=(1, 3)), blur)
    return grey + np.random.default_rng(seed).normal(0, noise / 255, grey.shape)


def places(edges: EdgeList, step=0.2):
    """Points (n, 2) along the edges."""
    found = [
        a + (np.arange(n)[:, None] + 0.5) / n * (b - a)
        for a, b in edges.vertices[edges.edges]
        for n in [max(1, round(np.hypot(*(b - a)) / step))]
    ]
    return np.concatenate(found)


def test_a_smooth_run_is_the_least_of_its_sum():
    random = np.random.default_rng(1)
    n = 40
    given, weight = random.normal(0, 1, (n, 2)), random.uniform(0.01, 2, n)
    found = given.copy()
    _smoothing.smooth(found, weight, np.array([0, 3, n], np.int32), np.empty((n, 4)))
    assert np.array_equal(found[:3], given[:3])  # too short to have a third difference
    third = np.diff(np.eye(n - 3), 3, axis=0)
    slow = np.linalg.solve(np.diag(weight[3:]) + third.T @ third, weight[3:, None] * given[3:])
    assert np.abs(found[3:] - slow).max() < 1e-9


@pytest.mark.parametrize("ring", [True, False])
def test_noise_is_averaged_and_a_circle_is_not_drawn_inward(ring):
    random = np.random.default_rng(2)
    angle = np.arange(100) * 2 * np.pi / 100
    circle = 16 * np.column_stack([np.cos(angle), np.sin(angle)])
    chains = Chains(np.arange(100, dtype=np.int32), np.array([0, 100], np.int32), np.array([ring]))
    noise = gaussian_filter1d(random.normal(0, 1, 100), 1.2, mode="wrap")  # as the gradient's: neighbours share it
    noise *= 0.2 / noise.std()
    off = np.hypot(*smooth(circle * (1 + noise[:, None] / 16), chains, np.full(100, 0.31)).T) - 16
    assert abs(off.mean()) < 0.05 and off.std() < 0.14


def test_what_errors_do_not_explain_is_kept():
    wave = np.column_stack([np.arange(200.0), np.sin(np.arange(200) * 1.2)])
    chains = Chains(np.arange(200, dtype=np.int32), np.array([0, 200], np.int32), np.array([False]))
    assert np.abs(smooth(wave, chains, np.full(200, 0.02)) - wave).max() < 0.1


def test_positions_under_noise():
    grey = painted(80, lambda x, y: (x - 40.3) ** 2 + (y - 39.6) ** 2 < 25**2, blur=1.5, noise=4)
    off = np.hypot(*(places(detect_edges(grey)) - (40.3, 39.6)).T) - 25
    assert np.median(np.abs(off)) < 0.15 and np.quantile(np.abs(off), 0.95) < 0.35


def test_an_acute_tip_is_given_back():
    grey = painted(80, lambda x, y: (np.abs(y - 40.2) < 0.5 * (x - 12.5)) & (x < 70))
    assert np.hypot(*(detect_edges(grey).vertices - (12.5, 40.2)).T).min() < 1


def test_a_noisy_disc_has_no_corners():
    grey = painted(60, lambda x, y: (x - 30) ** 2 + (y - 30) ** 2 < 12.5**2, low=0.5, high=0.35, blur=1.5, noise=4)
    off = np.hypot(*(places(detect_edges(grey)) - 30).T) - 12.5
    assert np.abs(off).max() < 1


def test_a_short_edge_between_two_outlines_is_kept():
    def scene(x, y):
        return ((x - 30) ** 2 + (y - 40) ** 2 < 18**2) | ((x - 80) ** 2 + (y - 40) ** 2 < 18**2)

    grey = painted(112, scene, low=0.5, high=0.05)
    at = np.arange(112) + 0.5
    between = (at[None] > 46) & (at[None] < 64) & (at[:, None] > 40)  # a fainter step in the gap
    grey = np.where(between & (grey > 0.45), grey + 0.15, grey)
    gap = places(detect_edges(grey))
    assert ((np.abs(gap[:, 1] - 40) < 1.5) & (np.abs(gap[:, 0] - 55) < 2)).any()


def test_letters_are_kept_and_fur_is_not():
    random = np.random.default_rng(3)
    stroke = (np.arange(96)[:, None] // 4 % 3 == 0) & (np.arange(96) // 8 % 2 == 0)
    letters = gaussian_filter(np.where(stroke, 0.2, 0.9), 0.5)
    fur = gaussian_filter(random.normal(0, 1, (160, 160)), (3, 0.8))
    fur = 0.5 + 0.15 * fur / fur.std()
    assert len(places(detect_edges(letters), 1.0)) > 500
    assert len(detect_edges(fur).edges) < 0.02 * fur.size
