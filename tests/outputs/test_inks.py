"""Coloured layers: transparent inks in pixels, PDF and SVG; a plate a page in PostScript."""

from __future__ import annotations

import io
import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
import skimage.color
from PIL import Image

from penink_cli.formats import strokes
from penink_cli.ground import colour as curve
from penink_cli.outputs import inks, pdf, postscript, svg
from penink_cli.outputs.page import lay_out
from tests.outputs.drawings import strokes_of
from tests.outputs.rendering import ghostscript

CYAN, YELLOW = "#00aeef", "#fff200"


def colour(code):
    return tuple(int(code[i : i + 2], 16) / 255 for i in (1, 3, 5))


def crossed():
    """A broad cyan stroke across a broad yellow one, each of them over itself too."""
    across = [[10, 72], [50, 72], [90, 72], [134, 72]]
    down = [[72, 10], [72, 50], [72, 90], [72, 134]]
    return [
        replace(strokes_of([down, down], 40, layer="yellow"), color=YELLOW),
        replace(strokes_of([across, across], 40, layer="cyan"), color=CYAN),
    ]


#: Where (row, column) in a picture of 144 pixels lies what: yellow alone, cyan alone, both, paper.
PLACES = {"yellow": (30, 72), "cyan": (72, 30), "both": (72, 72), "paper": (20, 20)}


def expected():
    """sRGB of each, 0 … 255: the product of what the inks let through, by scikit-image's curve."""
    light = {name: skimage.color.rgb2xyz(np.array([[colour(code)]])) for name, code in (("y", YELLOW), ("c", CYAN))}
    rgb = {name: value @ np.linalg.inv(skimage.color.rgb2xyz(np.eye(3)[None])[0]) for name, value in light.items()}
    both = skimage.color.xyz2rgb(rgb["y"] * rgb["c"] @ skimage.color.rgb2xyz(np.eye(3)[None])[0])[0, 0]
    return {
        "yellow": 255 * np.array(colour(YELLOW)), "cyan": 255 * np.array(colour(CYAN)), "both": 255 * both,
        "paper": np.full(3, 255.0),
    }  # fmt: skip


def check(picture, slack):
    for name, wanted in expected().items():
        assert np.abs(picture[PLACES[name]].astype(float) - wanted).max() <= slack, name


def files(tmp_path):
    paths = []
    for layer in crossed():
        paths.append(tmp_path / f"{layer.layer}.strokes.jsonl")
        with paths[-1].open("wb") as out:
            strokes.write(out, layer)
    return [str(path) for path in paths]


def test_the_curve_is_srgbs():
    values = np.linspace(0, 1, 1001)
    back = curve.encoded(curve.linear(values))
    assert np.abs(back - values).max() < 1e-12
    xyz = skimage.color.rgb2xyz(np.repeat(values[:, None], 3, axis=1)[None])[0, :, 1]
    assert np.abs(curve.linear(values) - xyz).max() < 1e-3


def test_pixels_show_the_product_of_inks_and_half_of_one_by_light(tmp_path, penink):
    shot = np.asarray(Image.open(io.BytesIO(penink("to-png", "--dpi", "72", *files(tmp_path)).stdout)))
    assert shot.shape == (144, 144, 3)
    check(shot, 1)
    half = next(inks.pixels([iter([np.array([[128]], np.uint8)])], [(0.0, 0.0, 0.0)], 255))
    assert abs(int(half[0, 0, 0]) - 188) <= 1  # half of the light


def test_black_alone_stays_grey(tmp_path, penink):
    _, cyan = files(tmp_path)
    grey = Image.open(io.BytesIO(penink("to-png", "--dpi", "20", "--color", "black", cyan).stdout))
    assert grey.mode == "L"
    red = Image.open(io.BytesIO(penink("to-png", "--dpi", "20", "--color", "red", cyan).stdout))
    assert red.getpixel((20, 20)) == (255, 0, 0)


def test_pdf_multiplies_layers_and_not_a_layer_with_itself(tmp_path):
    out = io.BytesIO()
    layers = crossed()
    pdf.write(out, layers, lay_out(layers), [colour(layer.color) for layer in layers])
    (tmp_path / "a.pdf").write_bytes(out.getvalue())
    import subprocess

    command = ["gs", "-q", "-dBATCH", "-dNOPAUSE", "-sDEVICE=ppmraw", "-r72", "-sOutputFile=-", str(tmp_path / "a.pdf")]
    done = subprocess.run(command, capture_output=True, check=True)
    check(np.asarray(Image.open(io.BytesIO(done.stdout))), 4)  # sRGB's curve is not quite a power


def test_svg_blends_where_there_are_several_inks():
    layers = crossed()
    for colours, blends in (([colour(YELLOW), colour(CYAN)], True), ([colour(CYAN)] * 2, False)):
        out = io.BytesIO()
        svg.write(out, layers, lay_out(layers), colours)
        groups = ET.fromstring(out.getvalue()).findall("{http://www.w3.org/2000/svg}g")
        assert [g.get("style") for g in groups] == [("mix-blend-mode:multiply" if blends else None)] * 2
        assert [g.get("stroke") for g in groups] == ["#" + "".join(f"{round(255 * v):02x}" for v in c) for c in
                                                     (colours * 2)[:2]]  # fmt: skip


@pytest.mark.parametrize("paper", [None, "a6"])
def test_separations_are_a_plate_a_page_in_black(tmp_path, paper):
    out = io.BytesIO()
    layers = crossed()
    page = lay_out(layers, paper)
    page = page if paper else replace(page, paper="plate")
    postscript.write(out, layers, page, [colour(layer.color) for layer in layers], separations=True)
    text = out.getvalue()
    assert re.findall(rb"%%Page: (.*)\n", text) == [b"(yellow) 1", b"(cyan) 2"]
    assert b"%%Pages: 2\n" in text
    assert b"setrgbcolor" not in text
    for number, layer in enumerate(layers, 1):
        (tmp_path / "all.ps").write_bytes(text)
        options = (f"-dFirstPage={number}", f"-dLastPage={number}")
        plate = ghostscript(tmp_path / "all.ps", 72, True, *options)
        out = io.BytesIO()
        postscript.write(out, [layer], page)
        (tmp_path / "one.ps").write_bytes(out.getvalue())
        assert np.array_equal(plate, ghostscript(tmp_path / "one.ps", 72))
