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


@pytest.mark.parametrize(("blur", "noise", "off"), [(0.6, 1, 0.02), (1.0, 2, 0.02), (1.5, 4, 0.03)])
def test_strengths_are_the_steps_of_rendered_scenes(blur, noise, off):
    """But for a few at junctions, whose nearest outline is another's."""
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


@pytest.mark.parametrize("at", np.linspace(45.5, 50.5, 11))
def test_where_what_lies_behind_a_line_ends_its_step_is_that_of_one_of_both(at):
    """No edge parts the two things behind it."""
    photo = painted(lambda x, y: (y < 24) & (x < at), 0.2, 0.5, 96)
    photo += painted(lambda x, y: (y < 24) & (x > at), 0, 0.6, 96) + painted(lambda x, y: y > 60, 0, 0.4, 96)
    along = np.arange(3, 94, 6.0)
    places = [(x, y) for y in (24, 60) for x in along]
    n = len(along)
    found = strengths(photo, listed(places, [[i, i + 1] for i in range(2 * n - 1) if i != n - 1], 96), 0.6)
    middles = (along[1:] + along[:-1]) / 2
    clear = np.abs(middles - at) > 0.4
    assert np.allclose(found[: n - 1][clear], np.where(middles < at, 0.3, 0.6)[clear], atol=0.02)
    assert np.allclose(found[n - 1 :], 0.4, atol=0.02)


def test_noise_is_averaged_out_along_a_line_and_a_step_that_changes_is_not():
    noise = np.random.default_rng(1).normal(0, 6 / 255, (48, 400))
    y, x = np.mgrid[:48, :400] + 0.5
    off = {}
    for wave in (0.0, 0.15):
        step = 0.3 + wave * np.sin(x / 12)
        photo = (0.3 + step * np.clip(y - 23.5, 0, 1) + noise).astype(np.float32)
        at = np.arange(0, 401, 8)
        line = EdgeList(400, 48, np.column_stack([at, np.full(len(at), 24.0)]), np.column_stack([at, at + 8])[:-1] // 8)
        truth = 0.3 + wave * np.sin((at[:-1] + 4) / 12)
        off[wave] = np.sqrt(np.mean((strengths(photo, line, 0.3, 6 / 255) - truth) ** 2))
        alone = np.sqrt(np.mean((strengths(photo, line, 0.3) - truth) ** 2))
        assert off[wave] < (0.5 if wave == 0 else 1.05) * alone


def test_far_pixels_are_asked_where_the_picture_is_flat_only():
    noise = np.random.default_rng(2).normal(0, 6 / 255, (392, 200))
    _, x = np.mgrid[:392, :200] + 0.5
    places = np.column_stack([np.full(48, 100.0), np.arange(4, 388, 8)])
    # edges apart, each with sides of its own
    alone = EdgeList(200, 392, places, np.arange(48).reshape(24, 2))
    for bend in (0.0, 0.003):  # grey a pixel², beyond which planes do not reach
        photo = np.clip(0.3 + 0.3 * (x > 100) - bend * np.maximum(0, np.abs(x - 100) - 5) ** 2, 0, 1) + noise
        photo = photo.astype(np.float32)
        near, told = (np.sqrt(np.mean((strengths(photo, alone, 0.3, n) - 0.3) ** 2)) for n in (0, 6 / 255))
        assert told < (0.8 if bend == 0 else 1.2) * near, bend


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
