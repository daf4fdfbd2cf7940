"""SVG and PDF: every stroke, in place and size, in layers that other programs see."""

import io
import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from penink_cli.outputs import pdf, svg
from penink_cli.outputs.page import lay_out
from tests.outputs.drawings import crosshatch, every_kind, strokes_of
from tests.outputs.rendering import difference, ghostscript

SVG = "{http://www.w3.org/2000/svg}"
INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}"
MM = 25.4 / 72


def written(module, layers, paper=None, margin=0.0, landscape=False, colours=()):
    out = io.BytesIO()
    module.write(out, layers, lay_out(layers, paper, margin, landscape), colours)
    return out.getvalue()


def control_points(d):
    """(3k + 1, 2) of our paths, slowly: M x y, then c or h."""
    words = re.findall(r"[Mch]|-?[0-9.]+", d)
    assert words[0] == "M"
    points = [np.array(words[1:3], float)]
    if words[3] == "h":
        assert words[4:] == [".001"]
        return np.array(points)
    assert words[3] == "c"
    for six in np.array(words[4:], float).reshape(-1, 3, 2):
        points += list(points[-1] + six)
    return np.array(points)


@pytest.mark.parametrize("margin", [0.0, 36.0])
def test_svg_holds_every_stroke_in_millimetres(margin):
    drawing = every_kind()
    root = ET.fromstring(written(svg, [drawing], margin=margin))
    side = (144 + 2 * margin) * MM
    assert root.get("width").endswith("mm")
    assert float(root.get("width")[:-2]) == pytest.approx(side, abs=0.001)
    assert [float(v) for v in root.get("viewBox").split()] == pytest.approx([0, 0, side, side], abs=0.001)
    group = root.find(f"{SVG}g")
    assert (group.get("fill"), group.get("stroke")) == ("none", "#000000")
    assert (group.get("stroke-linecap"), group.get("stroke-linejoin")) == ("round", "round")
    paths = group.findall(f"{SVG}path")
    assert len(paths) == len(drawing)
    for i, path in enumerate(paths):
        assert float(path.get("stroke-width", group.get("stroke-width"))) == pytest.approx(
            drawing.widths[i] * MM, abs=1e-4
        )
        expected = (drawing[i] + margin) * MM
        assert np.abs(control_points(path.get("d")) - expected).max() <= 0.00051


def test_svg_layers_are_what_inkscape_and_vpype_take_for_layers():
    layers = [strokes_of([[[1, 2]]], 1, layer='shadow 7 <&">\x01'), strokes_of([], 1), strokes_of([[[3, 4]]], 1)]
    text = written(svg, layers, colours=[(0.0, 0.0, 0.0), (1.0, 0.5, 0.0)])
    groups = ET.fromstring(text).findall(f"{SVG}g")
    assert [g.get(f"{INKSCAPE}groupmode") for g in groups] == ["layer"] * 3
    assert [g.get(f"{INKSCAPE}label") for g in groups] == ['1 shadow 7 <&">\ufffd', "2", "3"]
    assert [g.get("stroke") for g in groups] == ["#000000", "#ff8000", "#000000"]
    assert not re.search(rb"date|version=\"0|creator", text, re.IGNORECASE)


@pytest.mark.parametrize("drawing", [crosshatch(500, 144), every_kind()], ids=["crosshatch", "every kind"])
def test_pdf_is_the_same_picture(tmp_path, drawing):
    from penink_cli.outputs.raster import cover

    (tmp_path / "a.pdf").write_bytes(written(pdf, [drawing]))
    ours = np.concatenate(list(cover.bands([drawing], lay_out([drawing]), 300, 255)))
    assert difference(ours.astype(float), ghostscript(tmp_path / "a.pdf", 300), 300) < 0.5


def test_pdf_page_layers_and_nothing_that_varies(tmp_path):
    layers = [strokes_of([[[0, 0]], [[144, 144]]], 8, layer="Schatten (ü)"), strokes_of([], 1)]
    text = written(pdf, layers, paper="letter", landscape=True)
    assert b"/MediaBox [0 0 792 612]" in text
    assert text.count(b"/Type /OCG") == 2
    assert not re.search(rb"/(CreationDate|ModDate|Producer|ID)\b", text)
    assert text == written(pdf, layers, paper="letter", landscape=True)
    (tmp_path / "a.pdf").write_bytes(text)
    y, x = np.nonzero(ghostscript(tmp_path / "a.pdf", 72) < 128)
    assert x.mean() == pytest.approx(396, abs=1)
    assert y.mean() == pytest.approx(306, abs=1)


def test_pdf_says_title_author_and_trim_where_they_are_asked_for(tmp_path):
    layers = [strokes_of([[[0, 0]]], 8)]
    out = io.BytesIO()
    pdf.write(out, layers, lay_out(layers, "a6", 0.0), title="Schatten (ü)", author="A. Penman", trim=True)
    text = out.getvalue()
    assert re.search(rb"/TrimBox \[76.819 137.\d+ 220.819 281.\d+\]", text)
    assert b"A. Penman" in text and b"/Title" in text
    (tmp_path / "a.pdf").write_bytes(text)
    assert ghostscript(tmp_path / "a.pdf", 72).min() < 255
    plain = written(pdf, layers, paper="a6")
    assert not re.search(rb"/(Title|Author|TrimBox)", plain)


def test_pdf_pages_larger_than_viewers_take_have_a_larger_unit(tmp_path):
    sheet = strokes_of([[[0, 0], [9000, 0], [18000, 9000], [28800, 14400]]], 300, 28800, 14400)
    text = written(pdf, [sheet])
    assert b"/UserUnit 2" in text
    assert b"/MediaBox [0 0 14400 7200]" in text
    (tmp_path / "a.pdf").write_bytes(text)
    picture = ghostscript(tmp_path / "a.pdf", 7.2)  # a newer Ghostscript obeys UserUnit
    h, w = picture.shape
    assert w in (1440, 2880)
    assert picture[h - 1, w - 1] < 255 > picture[0, 0]


@pytest.mark.parametrize("module", [svg, pdf])
def test_nothing_to_draw(module):
    assert len(written(module, [strokes_of([], 1)])) < 1000
