"""Ridges of the gradient: those of scikit-image's Canny detector, which is slower and another's."""

import numpy as np
import pytest
import skimage.data
from scipy.ndimage import gaussian_filter
from skimage.feature import canny

from penink_cli.arrangement._compiled import ridges
from penink_cli.ground.gaussian import smoothed

PICTURES = {
    "noise": lambda: np.random.default_rng(1).random((90, 70)),
    "camera": lambda: skimage.data.camera()[100:300, 150:400] / 255,
    "grass": lambda: skimage.data.grass()[:150, :150] / 255,
    "squares": lambda: np.kron(np.indices((5, 6)).sum(axis=0) % 2, np.ones((12, 12))),
    "slope": lambda: np.add.outer(np.arange(40), np.arange(50)) / 90,
    "row": lambda: np.linspace(0, 1, 40)[None],
}


@pytest.mark.parametrize("name", PICTURES)
@pytest.mark.parametrize("sigma", [0.6, 1.0, 1.6])
def test_ridges_are_those_of_canny(name, sigma):
    grey = PICTURES[name]().astype(np.float32)
    smooth, found = smoothed(grey, sigma), np.zeros(grey.shape, np.uint8)
    assert np.abs(smooth - gaussian_filter(grey, sigma, mode="nearest")).max() <= 1e-6
    count = ridges.ridges(smooth, 0.2, found)
    assert count == found.sum()
    wanted = canny(grey, sigma, 0.2, 0.2, mode="nearest") if min(grey.shape) > 2 else np.zeros(grey.shape, bool)
    assert np.count_nonzero(found != wanted) <= 0.001 * wanted.sum()  # ties may fall another way by a last bit
