"""Pens that suit the size of a print."""

import numpy as np
import pytest

from penink_cli.ground import pens
from penink_cli.ground.model import GreyImage, Illustration, Layer, OutlineChoice, Strokes
from penink_cli.illustration.layering import layer_strokes
from penink_cli.options.textures import find_texture
from tests.illustration.conftest import square

Y, X = np.mgrid[0:32, 0:32]
GREY = GreyImage((60 + 5 * X).astype(np.uint8))


def test_pens_are_finer_below_four_inches_and_never_finer_than_the_printer():
    assert [pens.part(72 * inches) for inches in (0.3, 1, 4, 24)] == [0.5, 0.5, 1, 1]
    assert pens.part(144) == pytest.approx(np.sqrt(0.5))
    assert pens.finer(0.4, 0.5, None) == 0.2
    assert pens.finer(0.4, 0.5, 300) == pytest.approx(1.5 * 72 / 300)
    assert pens.finer(0.3, 0.5, 100) == 0.3


def drawn(width: float, **options) -> tuple[Strokes, Strokes]:
    layer = Layer(GREY, square(32, 32), find_texture("crosshatch"), "crosshatch", outline=OutlineChoice(pen_pt=0.8))
    ((hatching, outline),) = layer_strokes(Illustration(72, 72, (layer,)), width, device_dpi=None, **options)
    return hatching, outline


def test_small_illustrations_are_rendered_with_finer_pens_unless_told():
    small, large = drawn(72), drawn(300)
    for k in range(2):
        assert np.median(small[k].widths) == pytest.approx(np.median(large[k].widths) / 2, rel=0.1)
    for strokes in drawn(72, pen_pt=0.6):
        assert np.abs(strokes.widths - 0.6).max() < 1e-6
