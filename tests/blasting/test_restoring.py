"""What was made sharper gets back the tone of its picture, and neither bare paper nor solid black is touched."""

import numpy as np
import skimage.data

from penink_cli.blasting.blast import blast
from penink_cli.blasting.restoring import restored
from penink_cli.options.textures import find_texture
from tests.blasting import measures


def astray() -> tuple[np.ndarray, np.ndarray]:
    """A photograph's tone (256, 256), and the same with twelve discs lighter or darker by .2."""
    true = 1 - np.asarray(skimage.data.camera(), float)[:256, 100:356] / 255
    y, x = np.mgrid[:256, :256]
    rng, sharp = np.random.default_rng(2), true.copy()
    for k, (row, column) in enumerate(rng.uniform(20, 236, (12, 2))):
        sharp[np.hypot(y - row, x - column) < 9] += 0.2 * (-1) ** k
    return true, np.clip(sharp, 0, 1)


def test_a_drawing_has_the_tone_of_the_picture_and_not_what_is_astray():
    true, sharp = astray()
    texture = find_texture("crosshatch")
    for given, most in ((None, 5.0), (true, 0.95)):  # black without its grain takes .02 of it
        drawn = blast(sharp, 216, 216, None, texture, true=given)
        rms, bias, _ = measures.tone_figures(drawn, true)
        assert rms < most and abs(bias) < 0.3
        assert given is not None or rms > 1.5


def test_paper_stays_white_and_black_solid():
    true = np.full((128, 128), 0.4)
    sharp = np.tile(np.repeat([0.0, 1.0, 0.3], [40, 40, 48]), (128, 1))
    found = restored(sharp, true, 128, 128, 1)
    assert np.array_equal(found[:, :80], sharp[:, :80])
    assert abs(found[:, 100:].mean() - 0.4) < 0.005


def test_a_step_stays_where_it_is():
    """Of a picture with its step, which has it softer, nothing runs across."""
    sharp = np.tile(np.repeat([0.2, 0.8], 64), (128, 1))
    ramp = np.clip((np.arange(128) - 59.5) / 8, 0, 1) * 0.6 + 0.2
    found = restored(sharp, np.tile(ramp, (128, 1)), 64, 64, 1)
    assert found[:, :62].max() < 0.27 and found[:, 66:].min() > 0.73
    assert np.abs(np.diff(found, axis=1)).max() > 0.5


def test_any_size_and_any_number_of_threads():
    true, sharp = astray()
    one = restored(sharp, true[::2, ::2], 216, 216, 1)
    assert one.shape == sharp.shape
    assert restored(sharp, true[::2, ::2], 216, 216, 3).tobytes() == one.tobytes()
