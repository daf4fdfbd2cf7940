"""Outline strokes that a device draws: those of `render`, with its swelling and clearance."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from penink_cli.ground import pens
from penink_cli.ground.model import EdgeList, GreyImage, Illustration, Layer, OutlineChoice
from penink_cli.illustration.drawing import outline_strokes
from penink_cli.selfdrawing import html, postscript
from tests.selfdrawing.chromium import Page
from tests.selfdrawing.pictures import CROSSHATCH, ghostscript
from tests.selfdrawing.test_same_strokes import CATCH

Pieces = list[tuple[float, np.ndarray]]
WIDENED = 0.14  # points that a printer of 600 dpi adds to a stroke in the mean
PEN = pens.part(128)  # of one of a point, on a print of that width


def lines_alone(apart: float = 40.0, even: bool = False) -> Illustration:
    """White paper; a circle, a long weak line with a corner, and another `apart` pixels (tenths of a point) off."""
    turn = np.arange(48) * 2 * np.pi / 48
    circle = np.column_stack([320 + 200 * np.cos(turn), 640 + 200 * np.sin(turn)])
    one = np.array([(700.0, 300), (1200, 300), (1200, 900)])
    other = one + np.array([-apart, apart])
    vertices = np.vstack([circle, one, other])
    edges = [(i, (i + 1) % 48) for i in range(48)] + [(48, 49), (49, 50), (51, 52), (52, 53)]
    strength = np.array([0.6] * 48 + [0.2] * 2 + [0.1] * 2)
    white = GreyImage(np.full((64, 64), 63, np.uint8), 63)
    layer = Layer(
        white, EdgeList(1280, 1280, vertices, np.array(edges), strength), CROSSHATCH,
        outline=OutlineChoice(pen_pt=1.0, even=even),
    )  # fmt: skip
    return Illustration(128, 128, (layer,))


def on_a_printer(picture: Illustration, width: float) -> Pieces:
    """As broad as they are painted."""
    by = width / picture.width
    page = f"<< /PageSize [{width} {width}] >> setpagedevice {by} dup scale\n".encode()
    catch = CATCH.replace(b"HEIGHT", str(width).encode()).replace(
        b"(S ) print", b"(S ) print currentlinewidth 0 Points Length 20 string cvs print ( ) print"
    )
    out = ghostscript(catch + page + postscript.write(picture), "-sDEVICE=pbmraw", "-r600", "-sOutputFile=/dev/null")
    found = [np.array(part.split(), float) for part in out.decode().split("S ")[1:]]
    gain = 1.4 * 72 / 600
    return [(piece[0] + gain, piece[1:].reshape(-1, 2)) for piece in found]


def on_a_page(picture: Illustration, width: float, tmp_path) -> Pieces:
    path = tmp_path / "picture.html"
    path.write_bytes(html.write(picture, "picture"))
    with Page(path, 300, 300) as page:
        found = page.evaluate(f"""(() => {{
          const out = [];
          const points = (layer, of) => of.map(x => x * layer.magnification);
          const keep = (layer, xs, ys, pen) =>
            out.push([...points(layer, [pen]), points(layer, xs), points(layer, ys)]);
          draw(layers, {width}, {width}, [0, 0, {width}, {width}], 0, 1, () => 0, keep);
          return out;
        }})()""")
    return [(pen, np.column_stack([xs, ys])) for pen, xs, ys in found]


def length(pieces: Pieces) -> float:
    return float(sum(np.hypot(*np.diff(at, axis=0).T).sum() for _, at in pieces))


@pytest.fixture(scope="module")
def pieces() -> Pieces:
    return on_a_printer(lines_alone(), 128)


def test_printer_and_page_draw_the_same_pieces(pieces, tmp_path):
    page = on_a_page(lines_alone(), 128, tmp_path)
    assert len(page) == len(pieces) > 20
    for (pen, at), (other, there) in zip(pieces, page, strict=True):
        assert pen == pytest.approx(other, abs=0.01)
        assert np.abs(at - there).max() < 0.02


def test_they_run_where_those_of_render_do(pieces):
    (layer,) = lines_alone().layers
    ours = np.concatenate([at for _, at in pieces])
    strokes = outline_strokes(layer.edges, 128, 128, replace(layer.outline, pen_pt=PEN))
    theirs = np.concatenate([strokes[i][::3] for i in range(len(strokes))])
    assert cKDTree(ours).query(theirs)[0].max() < 0.8
    assert np.abs(cKDTree(theirs).query(ours)[0]).max() < 4.5  # a curve has few points
    assert length(pieces) == pytest.approx(2 * math.pi * 20 + 2 * 110 - 8, rel=0.03)


def test_they_swell_as_those_of_render(pieces):
    (layer,) = lines_alone().layers
    strokes = outline_strokes(layer.edges, 128, 128, replace(layer.outline, pen_pt=PEN))
    circle = [pen for pen, at in pieces if (at[:, 0] < 60).all()]
    weak = [pen for pen, at in pieces if (at[:, 0] > 60).all()]
    assert np.ptp(circle) > 0.1 * PEN  # the waver; no tips in a ring
    assert np.mean(circle) == pytest.approx(PEN, abs=0.06)
    # a tip has little over half the width of the middle, of a weak edge's pressure
    assert min(weak) < 0.7 * max(weak)
    assert max(weak) < 0.95 * PEN
    assert min(pen for pen, _ in pieces) == pytest.approx(float(strokes.widths.min()), abs=0.1)
    assert max(pen for pen, _ in pieces) == pytest.approx(float(strokes.widths.max()), abs=0.1)


def test_a_technical_pen_does_not_swell():
    drawn = [pen for pen, _ in on_a_printer(lines_alone(even=True), 128)]
    assert drawn == pytest.approx([PEN + WIDENED] * len(drawn), abs=0.01)  # and a printer adds to it


@pytest.mark.parametrize(("apart", "width", "lines"), [(11.0, 128, 1), (40.0, 128, 2), (11.0, 384, 2)])
def test_of_lines_too_close_on_paper_the_stronger_is_drawn(apart, width, lines):
    drawn = [piece for piece in on_a_printer(lines_alone(apart), width) if (piece[1][:, 0] > width / 2).all()]
    one = (50 + 60) * width / 128
    assert length(drawn) == pytest.approx(lines * one, rel=0.15)
