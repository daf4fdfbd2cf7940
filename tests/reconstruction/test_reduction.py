"""Fewer samples, none of which mixes two sides of an edge."""

import numpy as np
import pytest

from penink_cli.model import EdgeList
from penink_cli.reconstruction.reduction import reduce


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
