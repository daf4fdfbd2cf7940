"""The device's gain: what Ghostscript paints, what a screen is told to show and what blasting reckons are one tone."""

import pytest

from penink_cli.ground.device import narrowed, widened
from tests.benchmarks.devices import by_ghostscript, dots, flat, lines, on_a_screen, on_the_sheet

CLOSE = 0.002  # of full scale
# Ghostscript paints dots as polygons, whose corners become more in leaps: overlapping dots of one size add that up.
OF_POLYGONS = {("stipple", 150.0): 0.006, ("stipple", 1200.0): 0.003}


@pytest.mark.parametrize("dpi", [150.0, 300.0, 600.0, 1200.0])
@pytest.mark.parametrize("what", ["dots", "lines", "stipple", "crosshatch"])
def test_three_ways_to_one_tone(what, dpi, tmp_path):
    strokes = {
        "dots": lambda: dots(max(0.4, 108 / dpi), 2.2 * (max(0.4, 108 / dpi) + 72 / dpi)),
        "lines": lambda: lines(13, 150 / dpi, 1200 / dpi),
        "stipple": lambda: flat("stipple", 0.4, dpi),
        "crosshatch": lambda: flat("crosshatch", 0.4, dpi),
    }[what]()
    tones = [by_ghostscript(strokes, dpi, tmp_path), on_a_screen(strokes, dpi), on_the_sheet(strokes, dpi)]
    assert max(tones) - min(tones) <= OF_POLYGONS.get((what, dpi), CLOSE), tones


def test_without_the_gain_the_tones_would_differ(tmp_path):
    strokes = dots(0.8, 2.29)
    assert by_ghostscript(strokes, 300.0, tmp_path) - on_a_screen(narrowed(widened(strokes, 300.0), 300.0), 1e5) > 0.02


@pytest.mark.parametrize("dpi", [100.0, 150.0, 200.0, 250.0])
def test_no_stroke_of_a_hatching_is_narrower_than_a_dot(dpi, tmp_path):
    """Which is painted as a hairline: half of the tone would be lacking."""
    strokes = flat("crosshatch", 0.4, dpi)
    assert strokes.widths.min() > 72 / dpi
    assert abs(by_ghostscript(strokes, dpi, tmp_path) - 0.4) < 0.01
