"""The EPS, the page and `render` with the threshold rule draw the same strokes from the same illustration."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from penink_cli.blasting.constants import PIXEL, WIDENED
from penink_cli.ground.device import widened
from penink_cli.ground.model import Illustration, OutlineChoice
from penink_cli.illustration.layering import layer_strokes
from penink_cli.options.textures import find_texture
from penink_cli.selfdrawing import html, postscript
from tests.selfdrawing.chromium import Page
from tests.selfdrawing.pictures import CROSSHATCH, ghostscript, illustration, two_layers

# every path that is stroked, in points from the top-left corner of a sheet as high as HEIGHT
CATCH = b"""%!
/Show { transform matrix defaultmatrix itransform HEIGHT exch sub exch 20 string cvs print ( ) print 20 string cvs
  print ( ) print } bind def
/stroke { (S ) print { Show } { Show } { 6 copy Show Show Show pop pop pop pop pop pop } { } pathforall newpath } def
"""


def on_a_printer(picture: Illustration, width: float) -> list[np.ndarray]:
    height = width * picture.height / picture.width
    by = width / picture.width
    page = f"<< /PageSize [{width} {height}] >> setpagedevice {by} dup scale\n".encode()
    program = CATCH.replace(b"HEIGHT", str(height).encode()) + page + postscript.write(picture)
    out = ghostscript(program, "-sDEVICE=pbmraw", "-r600", "-sOutputFile=/dev/null").decode()
    return [np.array(part.split(), float).reshape(-1, 2) for part in out.split("S ")[1:]]


def on_a_page(picture: Illustration, width: float, tmp_path) -> list[np.ndarray]:
    path = tmp_path / "picture.html"
    path.write_bytes(html.write(picture, "picture"))
    height = width * picture.height / picture.width
    with Page(path, 300, 300) as page:
        text = page.evaluate(f"svg({width}, [0, 0, {width}, {height}], 72 / 600)")
    lines = [d.replace("h.001", "").split() for d in re.findall(r' d="M([^"]*)"', text)]
    return [np.array(line, float).reshape(-1, 2) * 72 / 25.4 for line in lines]


def by_render(picture: Illustration, width: float) -> list[np.ndarray]:
    layers = tuple(replace(layer, rule="threshold") for layer in picture.layers)
    drawn = layer_strokes(replace(picture, layers=layers), width)
    return [strokes[i][::3] for strokes, _ in drawn for i in range(len(strokes))]


def ends(found: list[np.ndarray], width: float, height: float) -> np.ndarray:
    """Where strokes begin and end (n, 4), of those that the border does not cut."""
    at = np.array([[*p[0], *p[-1]] for p in found])
    return at[((at > 0.5) & (at < [width - 0.5, height - 0.5] * 2)).all(axis=1)]


def part_alike(ours: np.ndarray, theirs: np.ndarray, within: float) -> float:
    return float((cKDTree(theirs).query(ours, p=np.inf)[0] <= within).mean())


@pytest.mark.parametrize(
    ("texture", "width"), [(CROSSHATCH, 108.0), (CROSSHATCH, 250.0), (find_texture("grain"), 108.0),
                           (find_texture("stipple"), 108.0), (find_texture("scribble"), 108.0),
                           (find_texture("brick"), 60.0), (find_texture("brick"), 300.0)],
    ids=["crosshatch", "crosshatch, larger", "grain", "stipple", "scribble", "brick, smaller", "brick, larger"],
)  # fmt: skip
def test_all_three_draw_the_same_strokes(texture, width, tmp_path):
    picture = illustration(texture=texture)
    ours = ends(by_render(picture, width), width, width)
    assert len(ours) > 100
    for theirs in (on_a_printer(picture, width), on_a_page(picture, width, tmp_path)):
        theirs = ends(theirs, width, width)
        assert len(theirs) == pytest.approx(len(ours), rel=0.01)
        assert part_alike(ours, theirs, 0.03) > 0.985
        assert part_alike(theirs, ours, 0.03) > 0.985


@pytest.mark.parametrize("below", [CROSSHATCH, find_texture("stipple")], ids=["of one texture", "of two"])
def test_all_three_add_layers_up_alike(below, tmp_path):
    picture = two_layers(below, CROSSHATCH)
    ours = ends(by_render(picture, 108), 108, 108)
    for theirs in (on_a_printer(picture, 108), on_a_page(picture, 108, tmp_path)):
        theirs = ends(theirs, 108, 108)
        assert len(theirs) == pytest.approx(len(ours), rel=0.01)
        assert part_alike(ours, theirs, 0.03) > 0.985
        assert part_alike(theirs, ours, 0.03) > 0.985


def test_pens_are_finer_on_a_small_print(tmp_path):
    """On paper under 4 in all three have finer pens, by the root of its width, but not under so many dots."""
    picture = illustration(outline=OutlineChoice(pen_pt=0.8))
    path = tmp_path / "picture.html"
    path.write_bytes(html.write(picture, "picture"))
    layers = tuple(replace(layer, rule="threshold") for layer in picture.layers)
    for width, part in ((72, 0.5), (144, np.sqrt(0.5)), (288, 1.0)):
        ((hatching, outline),) = layer_strokes(replace(picture, layers=layers), width, device_dpi=600)
        # with what a printer adds to a slanting stroke, less what it adds to this one
        widens = WIDENED - np.sqrt(2) * PIXEL
        assert np.median(hatching.widths) == pytest.approx(0.4 * part + widens, abs=0.006)
        with Page(path, 300, 300) as page:
            text = page.evaluate(f"svg({width}, [0, 0, {width}, {width}], 72 / 600)")
        usual = float(re.search(r'stroke-width="([^"]*)"', text)[1]) * 72 / 25.4
        assert usual == pytest.approx(float(np.median(hatching.widths)), abs=0.02)
        assert widened(outline, 600).widths.max() == pytest.approx(0.8 * part, rel=0.2)
    with Page(path, 300, 300) as page:
        coarse = page.evaluate("svg(72, [0, 0, 72, 72], 72 / 600, 1)")
    assert float(re.search(r'stroke-width="([^"]*)"', coarse)[1]) * 72 / 25.4 > 0.35


def test_other_strokes_are_told_apart():
    picture = illustration()
    ours = ends(by_render(picture, 108), 108, 108)
    assert part_alike(ours, ours + 0.1, 0.03) < 0.2
    assert part_alike(ours, ends(by_render(picture, 110), 108, 108), 0.03) < 0.6
