"""Clean samples: what an edge contaminates is replaced from its own side."""

import numpy as np
from scipy.ndimage import gaussian_filter

from penink_cli.model import EdgeList
from penink_cli.reconstruction.extraction import extract_samples


def edge_at(x, width=32, height=32):
    return EdgeList(width, height, np.array([[x, 0.0], [x, height]]), np.array([[0, 1]]))


def test_a_blurred_step_becomes_a_sharp_one():
    sharp = np.where(np.arange(32) < 15, 0.2, 0.8) * np.ones((32, 1))
    clean = extract_samples(gaussian_filter(sharp, 0.8), edge_at(15.0), margin=3)
    assert np.abs(clean - sharp).max() < 0.005


def test_value_and_slope_are_carried_to_the_edge():
    x = np.arange(32) + 0.5
    sharp = np.where(x < 15, 0.3 + 0.01 * x, 0.9 - 0.01 * x) * np.ones((32, 1))
    clean = extract_samples(gaussian_filter(sharp, 0.6), edge_at(15.0), margin=2)
    assert np.abs(clean - sharp)[2:-2, 2:-2].max() < 0.015


def test_far_from_edges_nothing_changes():
    grey = np.random.default_rng(3).random((32, 32)).astype(np.float32)
    clean = extract_samples(grey, edge_at(8.0), margin=2)
    assert np.array_equal(clean[:, 11:], grey[:, 11:])


def test_a_region_without_a_clean_pixel_keeps_its_own_grey():
    grey = np.full((32, 32), 0.1)
    grey[10:13, 10:13] = 0.9
    square = np.array([[10.0, 10], [13, 10], [13, 13], [10, 13]])
    edges = EdgeList(32, 32, square, np.array([[0, 1], [1, 2], [2, 3], [3, 0]]))
    clean = extract_samples(grey, edges, margin=4)
    assert np.allclose(clean[10:13, 10:13], 0.9) and np.allclose(clean[0:10], 0.1)


def test_without_edges_the_picture_is_its_own_sample():
    grey = np.random.default_rng(3).random((5, 7)).astype(np.float32)
    assert np.array_equal(extract_samples(grey, EdgeList(7, 5)), grey)
