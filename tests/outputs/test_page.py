"""The page: papers as they are named, where the sheet lies, and what is said where it does not fit."""

from __future__ import annotations

import io
import re

import numpy as np
import pytest

from penink_cli.ground.errors import ParameterError
from penink_cli.ground.papers import paper_size
from penink_cli.outputs import postscript
from penink_cli.outputs.page import lay_out
from tests.outputs.drawings import strokes_of


def sheet(width, height):
    return strokes_of([[[width / 2, height / 2]]], 1, width, height)


@pytest.mark.parametrize(
    "name", ["a4", "A4", "210x297mm", "210 × 297 mm", "210\u00a0x\t297 mm", "210x297mm\n", "21cmx29.7cm"]
)
def test_a_paper_by_any_name_is_one_word_of_the_comments(name):
    page = lay_out([sheet(100, 100)], name)
    assert (page.width, page.height) == pytest.approx((210 * 72 / 25.4, 297 * 72 / 25.4))
    out = io.BytesIO()
    postscript.write(out, [sheet(100, 100)], page)
    assert re.search(rb"^%%DocumentMedia: [!-~]+ [0-9.]+ [0-9.]+ 0 \(\) \(\)$", out.getvalue(), re.MULTILINE)
    assert re.search(rb"^%%BeginFeature: \*PageSize [!-~]+$", out.getvalue(), re.MULTILINE)


@pytest.mark.parametrize("name", ["8.x11in", "8x11.in", "8.0x11in", "8inx11in"])
def test_one_unit_serves_both_sides(name):
    assert paper_size(name) == (576, 792)


@pytest.mark.parametrize("name", ["", "x", "5x", "x5in", "ax4", "0x5in", "5x5x5in", "1e3x5", "-5x5in", "9999999x5in"])
def test_other_papers_are_refused(name):
    with pytest.raises(ParameterError, match=r"^no paper '"):
        paper_size(name)


@pytest.mark.parametrize("aspect", [0.3, 0.77, 1.0, 1.41, 3.3])
@pytest.mark.parametrize("margin", [0.0, 7.3, 36.0])
def test_a_picture_as_wide_as_is_advised_fits(aspect, margin):
    for inches in np.linspace(3, 40, 60):
        width = 72 * inches
        try:
            lay_out([sheet(width, width * aspect)], "a5", margin)
        except ParameterError as error:
            found = re.search(r"blast it ([0-9.]+)in wide or less", str(error))
            assert found, error
            fits = 72 * float(found[1])
            lay_out([sheet(fits, fits * aspect)], "a5", margin)


def test_a_margin_that_leaves_no_room_is_told():
    with pytest.raises(ParameterError, match="the margin leaves no room"):
        lay_out([sheet(100, 100)], "a6", 200)
