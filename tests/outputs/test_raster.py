"""Strokes as pixels: the area that ink covers."""

import io
import json
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from penink_cli.outputs.page import Page, lay_out
from penink_cli.outputs.raster import cover, png
from tests.outputs.drawings import crosshatch, every_kind, strokes_of, swelling
from tests.outputs.rendering import difference, ghostscript, pixels


def picture(layers, dpi, maxval=255, threads=1, page=None):
    return np.concatenate(list(cover.bands(layers, page or lay_out(layers), dpi, maxval, threads)))


def tone(shot):
    return 100 - shot.mean() / 2.55


def oracle(drawing, dpi, fine=16, more=0.0):
    """Ink by distance: a point is inked if it is within half a pen, and more, of a curve, sampled finely."""
    w, h = cover.size(lay_out([drawing]), dpi)
    y, x = (np.mgrid[: h * fine, : w * fine] + 0.5) * (72 / dpi / fine)
    inked = np.zeros(x.shape, bool)
    t = np.linspace(0, 1, 400)[:, None]
    for i in range(len(drawing)):
        points, widths = drawing[i], drawing.at_knots[drawing.knots[i] : drawing.knots[i + 1]]
        pieces = [
            (1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * d
            for a, b, c, d in (points[k : k + 4] for k in range(0, len(points) - 1, 3))
        ]
        pens = np.concatenate([(1 - t) * a + t * b for a, b in pairwise(widths)])[:, 0] if pieces else widths
        for (px, py), pen in zip(np.concatenate(pieces) if pieces else points, pens):
            inked |= (x - px) ** 2 + (y - py) ** 2 <= (pen / 2 + more) ** 2
    return 255 * (1 - inked.reshape(h, fine, w, fine).mean(axis=(1, 3)))


coordinate = st.floats(-3, 15)


@settings(max_examples=25, deadline=None)
@given(
    st.lists(
        st.one_of(
            st.lists(st.tuples(coordinate, coordinate), min_size=4, max_size=4),
            st.lists(st.tuples(coordinate, coordinate), min_size=1, max_size=1),
            st.tuples(coordinate, coordinate).map(lambda p: [p, p, p, p]),
            st.tuples(coordinate, coordinate, coordinate).map(lambda v: [(v[0], v[2])] * 2 + [(v[1], v[2])] * 2),
        ),
        max_size=3,
    ),
    st.floats(0.2, 4),
    st.none() | st.floats(0, 4),
)
def test_against_the_slow_way(chains, pen, end):
    drawing = strokes_of(chains, pen, 12, 9)
    if end is not None:  # the strokes swell
        drawing = drawing.swelling(np.where(np.isin(np.arange(len(drawing.at_knots)), drawing.knots), pen, end))
    ours = picture([drawing], 72).astype(float)
    light, dark = (oracle(drawing, 72, more=more) for more in (-1e-9, 1e-9))  # a row of points on a side is in or out
    assert (ours - light).max() <= 14 and (dark - ours).max() <= 14  # of 255: the oracle's curves are beads on a string
    assert dark.mean() - 1.5 <= ours.mean() <= light.mean() + 1.5


def test_overlaps_count_once():
    line = [[2, 5], [4, 5], [6, 5], [8, 5]]
    once, often = strokes_of([line], 1.3, 10, 10), strokes_of([line] * 5, 1.3, 10, 10)
    assert np.array_equal(picture([once], 300), picture([often], 300))


def test_a_bar_covers_what_it_covers():
    bar = strokes_of([[[-5, 5], [0, 5], [10, 5], [15, 5]]], 3.0, 10, 10)  # ink from y = 3.5 to 6.5
    assert picture([bar], 72)[:, 4].tolist() == [255, 255, 255, 128, 0, 0, 128, 255, 255, 255]
    assert picture([bar], 72, maxval=1)[:, 4].tolist() == [1, 1, 1, 0, 0, 0, 0, 1, 1, 1]
    assert set(picture([bar], 72, maxval=7).ravel().tolist()) == {0, 4, 7}


@pytest.mark.parametrize("dpi", [10, 100, 333])
def test_any_number_of_threads_and_height_of_bands_gives_the_same_pixels(monkeypatch, dpi):
    layers = [every_kind(), crosshatch(300, 144), swelling()]
    expected = picture(layers, dpi)
    for threads in (2, 3, 8):
        assert np.array_equal(picture(layers, dpi, threads=threads), expected)
    monkeypatch.setattr(cover, "ROOM", 1)
    assert np.array_equal(picture(layers, dpi, threads=2), expected)


def test_ghostscript_agrees(tmp_path):
    from tests.outputs.test_postscript import written

    drawing = crosshatch(1500, 216)
    (tmp_path / "a.eps").write_bytes(written([drawing]))
    theirs = ghostscript(tmp_path / "a.eps", 300, True, "-g900x900")
    assert difference(picture([drawing], 300).astype(float), theirs, 300) < 0.5


def test_a_page_with_a_margin_puts_ink_where_it_belongs():
    dot = strokes_of([[[0, 0]]], 2, 10, 10)
    shot = picture([dot], 72, page=Page(30, 20, 10, 5))
    assert shot.shape == (20, 30)
    assert set(zip(*np.nonzero(shot < 200))) == {(4, 9), (4, 10), (5, 9), (5, 10)}


@pytest.mark.parametrize("bits", range(1, 9))
@pytest.mark.parametrize("width", [1, 7, 16, 33])
def test_png_holds_the_same_pixels(bits, width):
    rng = np.random.default_rng(bits)
    values = rng.integers(0, 2**bits, (21, width), np.uint8)
    out = io.BytesIO()
    png.write(out, (width, 21), 300, bits, [values[:8], values[8:20], values[20:]])
    image = Image.open(io.BytesIO(out.getvalue()))
    image.load()
    assert image.size == (width, 21)
    assert image.info["dpi"] == pytest.approx((300, 300), abs=0.01)
    assert np.abs(pixels(out.getvalue()) - values * (255 / (2**bits - 1))).max() <= 0.5
    assert json.dumps(sorted(image.info)) == '["dpi"]'  # no date, no software


def test_strokes_far_away_cost_nothing_and_do_nothing():
    far = strokes_of([[[1e7, 1e7]], [[-1e7, 5]], [[-1e7, 5], [-1e6, 5], [1e6, 5], [1e7, 5]]], 1, 10, 10)
    shot = picture([far], 72)
    assert (shot[[0, 1, 2, 3, 6, 7, 8, 9]] == 255).all()
    assert (shot[[4, 5]] < 255).all()


def test_strokes_widened_by_the_gain_are_what_a_printer_paints(tmp_path):
    from penink_cli.ground.device import narrowed, widened
    from tests.outputs.test_postscript import written

    drawing = crosshatch(1200, 216)
    size = ("-dGraphicsAlphaBits=1", "-g1800x1800")
    (tmp_path / "a.eps").write_bytes(written([drawing]))
    printed = ghostscript(tmp_path / "a.eps", 600, False, *size)
    assert tone(printed) - tone(picture([drawing], 600)) > 3  # what it is all about
    assert abs(tone(printed) - tone(picture([widened(drawing, 600)], 600))) < 0.5
    (tmp_path / "b.eps").write_bytes(written([narrowed(drawing, 600)]))
    assert abs(tone(ghostscript(tmp_path / "b.eps", 600, False, *size)) - tone(picture([drawing], 600))) < 0.5
    assert len(widened(strokes_of([], 1), 600)) == 0
