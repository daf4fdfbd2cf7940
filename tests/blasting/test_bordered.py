"""The borders of what is filled: scikit-image's contours, in the same order."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import ndimage
from skimage.measure import find_contours

from penink_cli.blasting.bordered import _contours


@pytest.mark.parametrize("sigma", [0.0, 0.7, 2.0])
@pytest.mark.parametrize("shape", [(1, 1), (1, 30), (17, 2), (40, 60)])
def test_contours_are_those_of_scikit_image(sigma, shape):
    for seed in range(8):
        image = ndimage.gaussian_filter(np.random.default_rng(seed).random(shape), sigma)
        image = np.pad(image - np.median(image) + 0.5 + 1e-4, 1).astype(np.float32)
        wanted = find_contours(image, 0.5)
        found = _contours(image, 0.5)
        assert len(found) == len(wanted)
        assert all(np.array_equal(one, other) for one, other in zip(found, wanted))


def test_pixels_at_the_level_are_below_it():
    """No place stands twice in a row, and rings that meet in such a pixel stay apart."""
    for seed in range(20):
        image = np.pad(np.random.default_rng(seed).integers(0, 9, (12, 15)) / 8, 1).astype(np.float32)
        rings = _contours(image, 0.5)
        lower = _contours(np.where(image == 0.5, np.float32(0.5 - 1e-6), image), 0.5)
        assert len(rings) == len(lower)
        for ring, other in zip(sorted(rings, key=_middle), sorted(lower, key=_middle)):
            assert np.array_equal(ring[0], ring[-1])
            assert (np.diff(ring, axis=0) != 0).any(axis=1).all()
            assert np.abs(ring[:, None] - other[None]).sum(axis=2).min(axis=1).max() < 1e-4


def _middle(ring):
    return tuple(np.round((ring.min(axis=0) + ring.max(axis=0)) / 2, 3))


def test_there_are_none_where_nothing_exceeds_the_level():
    assert not _contours(np.zeros((5, 6), np.float32), 0.5)
    assert not _contours(np.full((5, 6), 0.5, np.float32), 0.5)
