"""Clean samples: what an edge contaminates is replaced from its own side."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from penink_cli.geometry.walls import walls
from penink_cli.ground.model import EdgeList
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


def slow_reach(met, i, j, reach):
    """The pixels that a walk from (i, j) comes to within reach along each axis, one step at a time."""
    height, width = met.shape
    reached, waiting = {(i, j)}, [(i, j)]
    while waiting:
        y, x = waiting.pop()
        for ny, nx, open_ in (
            (y, x + 1, not met[y, x] & 1),
            (y, x - 1, x > 0 and not met[y, x - 1] & 1),
            (y + 1, x, not met[y, x] & 2),
            (y - 1, x, y > 0 and not met[y - 1, x] & 2),
        ):
            inside = 0 <= ny < height and 0 <= nx < width and abs(ny - i) <= reach and abs(nx - j) <= reach
            if open_ and inside and (ny, nx) not in reached:
                reached.add((ny, nx))
                waiting.append((ny, nx))
    return sorted(reached)


def slow_samples(grey, edges, margin):
    """What `extract_samples` says, by numpy's least squares over the pixels that `slow_reach` finds."""
    height, width = grey.shape
    a, b = edges.vertices[edges.edges[:, 0]], edges.vertices[edges.edges[:, 1]]
    y, x = np.mgrid[:height, :width] + 0.5
    distance = np.full(grey.shape, np.inf)
    for p, q in zip(a, b):
        d = q - p
        t = np.clip(((x - p[0]) * d[0] + (y - p[1]) * d[1]) / (d @ d), 0, 1)
        distance = np.minimum(distance, np.hypot(x - p[0] - t * d[0], y - p[1] - t * d[1]))
    met = walls(edges, width, height)
    out = grey.copy()
    for i, j in zip(*np.nonzero(distance <= margin)):
        for reach in (5, 10, 20, 24):
            at = np.array([k for k in slow_reach(met, i, j, reach) if distance[k] > margin])
            if len(at):
                break
        else:
            out[i, j] = np.nan  # no clean pixel anywhere: another rule
            continue
        offset = at - (i, j)
        w = np.exp(-(offset**2).sum(axis=1) / (2 * 1.5**2))
        w /= w.sum()
        value = grey[at[:, 0], at[:, 1]]
        centre, mean = w @ offset, w @ value
        spread = (w[:, None] * (offset - centre)).T @ (offset - centre) + 0.3 * np.eye(2)
        slope = np.linalg.solve(spread, (w * (value - mean)) @ (offset - centre))
        room = 0.5 * np.ptp(value)
        out[i, j] = np.clip(mean - slope @ centre, value.min() - room, value.max() + room)
    return np.clip(out, 0, 1)


@pytest.mark.parametrize("seed", range(6))
def test_samples_are_those_of_a_slow_walk(seed):
    random = np.random.default_rng(seed)
    width, height = int(random.integers(20, 150)), 24
    grey = gaussian_filter(random.random((height, width)), 1)
    x = np.sort(random.uniform(0.5, width - 0.5, 14))
    vertices = np.column_stack([x, random.uniform(0.5, height - 0.5, 14)])
    edges = EdgeList(width, height, vertices, np.array([[k, k + 1] for k in range(13) if k % 5 != 4]))
    clean = extract_samples(grey, edges, margin=1.3)
    slow = slow_samples(grey, edges, 1.3)
    assert np.isnan(slow).mean() < 0.05 and np.nanmax(np.abs(clean - slow)) < 1e-5
