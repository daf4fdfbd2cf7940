"""The device's gain: what Ghostscript paints, what a screen is told to show and what blasting reckons are one tone."""

import pytest

from penink_cli.ground.device import narrowed, widened
from tests.benchmarks.devices import by_ghostscript, dots, flat, lines, on_a_screen, on_the_sheet

CLOSE = 0.002  # of full scale


@pytest.mark.parametrize("dpi", [300.0, 600.0])
@pytest.mark.parametrize("what", ["dots", "lines", "stipple", "crosshatch"])
def test_three_ways_to_one_tone(what, dpi, tmp_path):
    strokes = {
        "dots": lambda: dots(0.8, 2.29),
        "lines": lambda: lines(13, 0.5, 4.0),
        "stipple": lambda: flat("stipple", 0.4, dpi),
        "crosshatch": lambda: flat("crosshatch", 0.4, dpi),
    }[what]()
    tones = [by_ghostscript(strokes, dpi, tmp_path), on_a_screen(strokes, dpi), on_the_sheet(strokes, dpi)]
    assert max(tones) - min(tones) <= CLOSE, tones


def test_without_the_gain_the_tones_would_differ(tmp_path):
    strokes = dots(0.8, 2.29)
    assert by_ghostscript(strokes, 300.0, tmp_path) - on_a_screen(narrowed(widened(strokes, 300.0), 300.0), 1e5) > 0.02
