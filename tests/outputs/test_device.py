"""The device's gain: what Ghostscript paints, what a screen is told to show and what blasting reckons are one tone."""

import numpy as np
import pytest

from penink_cli.ground.device import disc, narrowed, pen_of, widened
from penink_cli.ground.model import Strokes
from tests.benchmarks.devices import by_ghostscript, dots, flat, gain_of_dots, lines, on_a_screen, on_the_sheet

CLOSE = 0.002  # of full scale


@pytest.mark.parametrize("dpi", [150.0, 300.0, 600.0, 1200.0])
@pytest.mark.parametrize("what", ["dots", "lines", "stipple", "crosshatch"])
def test_four_ways_to_one_tone(what, dpi, tmp_path):
    strokes = {
        "dots": lambda: dots(max(0.4, 108 / dpi), 2.2 * (max(0.4, 108 / dpi) + 72 / dpi)),
        "lines": lambda: lines(13, 150 / dpi, 1200 / dpi),
        "stipple": lambda: flat("stipple", 0.4, dpi),
        "crosshatch": lambda: flat("crosshatch", 0.4, dpi),
    }[what]()
    tones = [by_ghostscript(strokes, dpi, tmp_path, kind) for kind in ("ps", "pdf")]
    tones += [on_a_screen(strokes, dpi), on_the_sheet(strokes, dpi)]
    assert max(tones) - min(tones) <= CLOSE, tones


@pytest.mark.parametrize("kind", ["ps", "pdf"])
@pytest.mark.parametrize("pixels", [1.3, 2.5, 5.0, 5.9, 7.0, 10.0, 15.0, 20.0, 30.0])
def test_a_dot_of_any_size_is_widened_as_the_model_says(pixels, kind, tmp_path):
    assert abs(gain_of_dots(pixels, tmp_path, kind) - (float(disc(np.array(pixels), 1.0)) - pixels)) < 0.035


def test_narrowing_undoes_widening():
    widths = np.array([0.2, 0.5, 1.0, 4.0])
    assert pen_of(disc(widths, 0.12), 0.12) == pytest.approx(widths, abs=1e-12)
    points = np.repeat(np.arange(1.0, 5.0)[:, None], 2, axis=1)
    strokes = Strokes(9.0, 9.0, points, np.arange(5), widths)
    assert narrowed(widened(strokes, 600.0), 600.0).widths == pytest.approx(widths, abs=0.001)


def test_without_the_gain_the_tones_would_differ(tmp_path):
    strokes = dots(0.8, 2.29)
    assert by_ghostscript(strokes, 300.0, tmp_path) - on_a_screen(narrowed(widened(strokes, 300.0), 300.0), 1e5) > 0.02


@pytest.mark.parametrize("dpi", [100.0, 150.0, 200.0, 250.0])
def test_no_stroke_of_a_hatching_is_narrower_than_a_dot(dpi, tmp_path):
    """Which is painted as a hairline: half of the tone would be lacking."""
    strokes = flat("crosshatch", 0.4, dpi)
    assert strokes.widths.min() > 72 / dpi
    assert abs(by_ghostscript(strokes, dpi, tmp_path) - 0.4) < 0.01
