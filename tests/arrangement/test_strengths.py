"""The strength of an edge is the grey step across it: of the thing itself, not of its blurred picture."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from penink_cli.arrangement.detection import detect_edges
from penink_cli.arrangement.strengths import strengths
from penink_cli.ground import threads
from penink_cli.ground.model import EdgeList
from tests.benchmarks._scenes import random_scene, true_steps


def painted(inside, low=0.2, high=0.8, size=48, blur=0.6):
    """A photo (size, size) of what `inside` (x, y in pixels) says is `high`, seen through a lens."""
    y, x = (np.mgrid[: 8 * size, : 8 * size] + 0.5) / 8
    fine = np.where(inside(x, y), high, low)
    fine = gaussian_filter(fine, 8 * blur, mode="nearest")
    return fine.reshape(size, 8, size, 8).mean(axis=(1, 3)).astype(np.float32)


def listed(places, joined, size=48):
    return EdgeList(size, size, np.array(places, float), np.array(joined))


@pytest.mark.parametrize(("blur", "noise", "off"), [(0.6, 1, 0.02), (1.0, 2, 0.025), (1.5, 4, 0.15)])
def test_strengths_are_the_steps_of_rendered_scenes(blur, noise, off):
    """But for a few at junctions, whose nearest outline is another's, and for what noise hides."""
    far = []
    for seed in (0, 2, 5, 9):
        scene = random_scene(seed)
        edges = detect_edges(scene.photo(blur, noise, seed).astype(np.float32))
        near, truth = true_steps(scene, edges)
        far.append(np.abs(edges.strength - truth)[near])
    far = np.concatenate(far)
    assert len(far) > 250 and np.mean(far > 0.02) <= off and np.median(far) < 0.01


@pytest.mark.parametrize("turn", [0.0, 0.3, 0.8])
def test_a_line_thinner_than_the_blur_has_its_whole_step(turn):
    """No pixel of it is clean; what the other side has added is reckoned out."""
    c, s = np.cos(turn), np.sin(turn)
    photo = painted(lambda x, y: np.abs((x - 24) * c + (y - 24) * s) < 1)
    ends = [(24 + k * c - t * s, 24 + k * s + t * c) for k in (-1, 1) for t in (-14, 14)]
    found = strengths(photo, listed(ends, [[0, 1], [2, 3]]), 0.6)
    assert np.abs(found - 0.6).max() < 0.03
    assert photo.max() - 0.2 < 0.54  # and no pixel shows it


def test_what_lies_beyond_another_edge_is_of_another_thing():
    """A strip of three pixels between a step and a much greater one."""
    photo = painted(lambda x, y: x < 20) + painted(lambda x, y: x > 23, 0, 0.15)
    found = strengths(photo, listed([(20, 4), (20, 44), (23, 4), (23, 44)], [[0, 1], [2, 3]]), 0.6)
    assert np.allclose(found, [0.6, 0.15], atol=0.02)


def test_a_loose_end_has_two_sides():
    """What is found around the end, on the other side of the edge's line, is not of this side."""
    photo = painted(lambda x, y: x < 24)
    places = [(24, y) for y in (0, 20, 22, 24)]
    found = strengths(photo, listed(places, [[0, 1], [1, 2], [2, 3]]), 0.6)
    assert np.allclose(found, 0.6, atol=(0.02, 0.02, 0.06))  # beyond the end the step is blurred, and no edge says so


def test_a_corner_s_short_edge_has_the_step_of_the_long_ones():
    photo = painted(lambda x, y: (x < 24) & (y < 24))
    places = [(24, 0), (24, 23.6), (23.6, 24), (0, 24)]
    found = strengths(photo, listed(places, [[0, 1], [1, 2], [2, 3]]), 0.6)
    assert np.allclose(found, 0.6, atol=0.03)


def test_a_side_without_a_pixel_is_told():
    photo = painted(lambda x, y: x < 24)
    found = strengths(photo, listed([(0.1, 3), (0.1, 40), (24, 3), (24, 40)], [[0, 1], [2, 3]]), 0.6)
    assert found[0] < 0 and abs(found[1] - 0.6) < 0.02


def test_the_negative_has_the_same_strengths_and_so_have_more_threads():
    photo = random_scene(3).photo(0.6, 1.0, 3).astype(np.float32)
    edges = detect_edges(photo)
    before = threads.limit(1)
    try:
        alone = strengths(photo, edges, 0.6)
        threads.limit(4)
        assert np.array_equal(strengths(photo, edges, 0.6), alone)
    finally:
        threads.limit(before)
    assert np.abs(strengths(1 - photo, edges, 0.6) - alone).max() < 1e-5
