"""Edges from pictures: where they are, how they are joined, and that they never cross."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import gaussian_filter

from penink_cli.arrangement import detection
from penink_cli.arrangement.detection import detect_edges
from tests.geometry.crossings import crossings


def disc(size=64, centre=(31.3, 30.8), radius=17.4, low=0.2, high=0.8, blur=0.7):
    """A disc rendered with 8 x 8 points a pixel, then blurred."""
    at = (np.arange(size * 8) + 0.5) / 8
    inside = (at[None] - centre[0]) ** 2 + (at[:, None] - centre[1]) ** 2 < radius**2
    fine = np.where(inside, high, low)
    return gaussian_filter(fine.reshape(size, 8, size, 8).mean(axis=(1, 3)), blur)


def test_a_disc_is_one_ring_on_its_rim():
    edges = detect_edges(disc())
    degree = np.bincount(edges.edges.ravel(), minlength=len(edges.vertices))
    assert (degree == 2).all()
    a, b = edges.vertices[edges.edges[:, 0]], edges.vertices[edges.edges[:, 1]]
    for t in (0, 0.25, 0.5, 0.75):
        distance = np.hypot(*(a + t * (b - a) - (31.3, 30.8)).T) - 17.4
        assert np.abs(distance).max() < 0.2


def test_a_square_has_its_corners():
    fine = np.zeros((512, 512))
    fine[130:390, 122:402] = 1  # 64 pixels of 8 x 8 points
    grey = gaussian_filter(0.2 + 0.6 * fine.reshape(64, 8, 64, 8).mean(axis=(1, 3)), 1.0)
    edges = detect_edges(grey)
    for x in (122 / 8, 402 / 8):
        for y in (130 / 8, 390 / 8):
            assert np.hypot(*(edges.vertices - (x, y)).T).min() < 0.3


def test_noise_and_texture_leave_no_edges():
    noise = np.random.default_rng(5).normal(0.5, 4 / 255, (128, 128))
    assert len(detect_edges(noise).edges) == 0


def test_strength_is_the_grey_step():
    edges = detect_edges(disc(low=0.3, high=0.7))
    assert np.median(edges.strength) == pytest.approx(0.4, abs=0.06)


def test_edges_run_to_the_frame():
    grey = np.full((40, 60), 0.2)
    grey[:, 25:] = 0.7
    edges = detect_edges(grey)
    assert edges.vertices[:, 1].min() == 0 and edges.vertices[:, 1].max() == 40
    assert np.abs(edges.vertices[:, 0] - 25).max() < 0.1


@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (9, 1), (2, 2), (3, 3), (5, 4)])
def test_tiny_and_flat_pictures_have_no_edges_that_fail(shape):
    assert len(detect_edges(np.full(shape, 0.5)).edges) == 0
    detect_edges(np.random.default_rng(1).random(shape))


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.02, 0.1, 0.3]), st.sampled_from([0.1, 0.5, 1.0, 3.0]))
def test_edges_never_cross(seed, high, tolerance):
    random = np.random.default_rng(seed)
    grey = random.random((random.integers(3, 40), random.integers(3, 40)))
    edges = detect_edges(grey, sigma=0.6, high=high, tolerance=tolerance, min_length=2)
    assert not crossings(edges)


def test_a_new_vertex_has_no_strength_of_an_unrelated_place(monkeypatch):
    """Where sides tell nothing slopes do; those of points that settling has placed are no points' that were found."""
    monkeypatch.setattr(detection, "strengths", lambda grey, edges, *_: np.full(len(edges.edges), -1.0))
    y, x = np.mgrid[:120, :240] + 0.5
    weak = 0.5 + 0.06 * np.sign(np.sin(x / 9)) * np.sign(np.sin(y / 7)) * (x < 110)
    strong = 0.9 * (np.hypot(x - 180, y - 60) < 40)
    photo = gaussian_filter(np.where(x < 120, weak, strong), 0.7)
    edges = detect_edges(photo.astype(np.float32), low=0.03, high=0.06)
    left = edges.vertices[edges.edges][:, :, 0].max(axis=1) < 108
    assert left.sum() > 40 and edges.strength[left].max() < 0.3 and edges.strength[~left].max() > 0.5
