"""Samples of few levels are eased: ramps are ramps, what is detail or behind an edge stays."""

from __future__ import annotations

import numpy as np

from penink_cli.ground.model import EdgeList, GreyImage
from penink_cli.reconstruction.easing import eased

LEVELS = 16


def rounded(grey: np.ndarray) -> GreyImage:
    return GreyImage.from_grey(grey, LEVELS - 1)


def test_a_slow_ramp_is_a_ramp_again():
    y, x = np.mgrid[:80, :120]
    ramp = 0.2 + 0.5 * (x + 0.4 * y) / 150
    samples = rounded(ramp)
    stairs = np.abs(samples.grey - ramp)[8:-8, 16:-16]
    left = np.abs(eased(samples, None).grey - ramp)[8:-8, 16:-16]
    assert stairs.max() > 0.03
    assert left.max() < 0.012 and left.mean() < 0.15 * stairs.mean()


def test_no_sample_leaves_what_it_was_rounded_from():
    rng = np.random.default_rng(4)
    y, x = np.mgrid[:60, :70]
    grey = np.clip(0.5 + 0.4 * np.sin(x / 17) * np.cos(y / 23) + rng.normal(0, 0.02, x.shape), 0, 1)
    samples = rounded(grey)
    back = eased(samples, None)
    assert np.abs(back.grey - samples.grey).max() <= 0.5 / (LEVELS - 1) + 1e-3


def test_detail_and_paper_stay():
    """A checkerboard of two levels, and a wide white ground with a dark dot in it."""
    board = GreyImage((7 + np.add.outer(np.arange(20), np.arange(20)) % 2).astype(np.uint8), LEVELS - 1)
    assert np.array_equal(eased(board, None).grey, board.grey)
    paper = np.full((30, 30), LEVELS - 1, np.uint8)
    paper[14:16, 14:16] = 2
    dot = GreyImage(paper, LEVELS - 1)
    assert np.array_equal(eased(dot, None).grey, dot.grey)


def test_an_edge_keeps_two_plateaus_apart():
    values = np.where(np.arange(40) < 20, 8, 9)[None].repeat(30, axis=0).astype(np.uint8)
    samples = GreyImage(values, LEVELS - 1)
    edge = EdgeList(40, 30, np.array([[20.0, 0.0], [20.0, 30.0]]), np.array([[0, 1]]))
    assert np.array_equal(eased(samples, edge).grey, samples.grey)
    assert np.abs(eased(samples, None).grey - samples.grey).max() > 0.02


def test_many_levels_are_left_alone():
    many = GreyImage(np.arange(200, dtype=np.uint8).reshape(10, 20), 255)
    assert eased(many, None) is many
