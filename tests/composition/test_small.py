"""Small dark things keep their darkness where the exposure lightens darks, less so in texture; grain is none."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter, minimum_filter

from penink_cli.composition import small
from penink_cli.composition.compose import Choice, compose
from penink_cli.composition.filters import closed, lowest
from penink_cli.composition.small import small_darks
from penink_cli.formats import photo
from penink_cli.ground.model import GreyImage

RNG = np.random.default_rng(12)
PX = 2  # pixels a point


def disc(shape: tuple[int, int], y: float, x: float, radius: float) -> np.ndarray:
    """Where a disc is, all in points."""
    i, j = np.ogrid[: shape[0] * PX, : shape[1] * PX]
    return (i + 0.5 - y * PX) ** 2 + (j + 0.5 - x * PX) ** 2 < (radius * PX) ** 2


@pytest.mark.parametrize("reach", [1, 2, 3, 6, 9])
def test_the_least_value_of_an_octagon(reach):
    grey = RNG.random((40, 53), np.float32)
    point = np.zeros((2 * reach + 9, 2 * reach + 9), np.float32)
    point[reach + 4, reach + 4] = -1
    octagon = lowest(point, reach)[4:-4, 4:-4] < 0
    assert octagon.shape == (2 * reach + 1,) * 2
    assert octagon[reach].all() and octagon[:, reach].all()
    i, j = np.indices(octagon.shape) - reach
    assert octagon[i * i + j * j < (0.9 * reach) ** 2].all()
    assert not octagon[i * i + j * j > (1.09 * reach + 1) ** 2].any()
    assert np.array_equal(lowest(grey, reach), minimum_filter(grey, footprint=octagon, mode="nearest"))


def test_closed_leaves_what_is_broad():
    grey = np.ones((60, 80), np.float32)
    grey[:, 40:] = 0.2
    grey[20:24, 10:14] = 0.1
    grey[40:44] = 0.4
    found = closed(grey, 5)
    assert (found[:, :40] == 1).all()
    assert (found[:30, 46:] == np.float32(0.2)).all()


def test_a_pupil_is_one_and_a_coat_or_an_iris_is_none():
    grey = np.full((120 * PX, 160 * PX), 0.6, np.float32)
    grey[:, 100 * PX :] = 0.1  # a coat
    grey[disc((120, 160), 30, 30, 3)] = 0.08
    grey[disc((120, 160), 80, 30, 3)] = 0.35
    share = small_darks(grey, float(PX), 1)
    assert share[disc((120, 160), 30, 30, 2)].min() > 0.95
    assert share[~disc((120, 160), 30, 30, 4)].max() == 0


@pytest.mark.parametrize("seed", range(3))
def test_grain_is_none_and_fur_is_less(seed, monkeypatch):
    rng = np.random.default_rng(seed)
    grain = np.clip(rng.normal(0.5, 0.06, (120 * PX, 160 * PX)), 0, 1).astype(np.float32)
    assert small_darks(grain, float(PX), 1).mean() < 1e-4
    hairs = gaussian_filter(rng.standard_normal(grain.shape), (4 * PX, 0.8 * PX))
    fur = np.clip(0.5 + 0.16 * hairs / hairs.std(), 0, 1).astype(np.float32)
    share = small_darks(fur, float(PX), 1).mean()
    monkeypatch.setattr(small, "_OFTEN", 0.0)  # as if each hair were alone
    assert share < 0.75 * small_darks(fur, float(PX), 1).mean()


@pytest.mark.parametrize("breadth", [4, 6])
def test_composing_leaves_a_bar_as_dark_as_it_was(breadth):
    """Half the picture is dark, so that the exposure makes such a grey a middling one."""
    grey = np.full((120 * PX, 200 * PX), 0.55)
    grey[:, 90 * PX :] = np.linspace(0.04, 0.2, 110 * PX)
    bar = (slice(50 * PX, (50 + breadth) * PX), slice(20 * PX, 70 * PX))
    grey[bar] = 0.14
    grey[:10, :10] = 1
    image = GreyImage(np.round(grey * 255).astype(np.uint8))
    found = compose(image, Choice(200.0), photo.grey_of)
    like = found[:, 90 * PX :][np.abs(grey[:, 90 * PX :] - 0.14) < 0.002]
    assert like.mean() > 0.35  # what is broad is lightened
    inner = found[bar][PX:-PX, 4 * PX : -4 * PX]
    assert inner.max() < 0.21
