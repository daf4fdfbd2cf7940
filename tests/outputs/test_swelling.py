"""Strokes that swell: every output fills what a disc of their width covers on its way."""

import io
import re
import shutil
import subprocess

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from penink_cli.ground.model import Strokes
from penink_cli.outputs import pdf, postscript, svg, swelling
from penink_cli.outputs.page import lay_out
from penink_cli.outputs.raster import cover
from penink_cli.travel.order import ordered_each
from tests.outputs import drawings
from tests.outputs.rendering import difference, ghostscript, pixels

DPI = 300


def covered(strokes, dpi=DPI):
    return np.concatenate(list(cover.bands([strokes], lay_out([strokes]), dpi, 255))).astype(float)


def filled(strokes, dpi=DPI, fine=5):
    """The outlines filled by the even-odd rule, each by itself: in is what has an odd number of sides to its left."""
    points, first = swelling.outlines(strokes)
    w, h = cover.size(lay_out([strokes]), dpi)
    inked = np.zeros((h * fine, w * fine), bool)
    t = np.linspace(0, 1, 20)[:, None]
    for i in range(len(first) - 1):
        p = points[first[i] : first[i + 1]]
        assert np.array_equal(p[0], p[-1])
        curve = [
            (1 - t) ** 3 * p[k] + 3 * (1 - t) ** 2 * t * p[k + 1] + 3 * (1 - t) * t**2 * p[k + 2] + t**3 * p[k + 3]
            for k in range(0, len(p) - 1, 3)
        ]
        at = np.concatenate(curve) * (dpi / 72 * fine) - 0.5
        a, b = at[:-1], at[1:]
        low, high = (np.ceil(f(a[:, 1], b[:, 1])).astype(int) for f in (np.minimum, np.maximum))
        rows = np.concatenate([np.arange(lo, hi) for lo, hi in zip(low, high)])
        side = np.repeat(np.arange(len(a)), high - low)
        x = a[side, 0] + (rows - a[side, 1]) / (b[side, 1] - a[side, 1]) * (b[side, 0] - a[side, 0])
        within = (rows >= 0) & (rows < h * fine)
        if not within.any():
            continue
        rows, x = rows[within], np.clip(np.ceil(x[within]), 0, w * fine).astype(int)
        top, left = rows.min(), x.min()
        crossings = np.zeros((rows.max() + 1 - top, x.max() + 1 - left), np.uint8)
        np.add.at(crossings, (rows - top, x - left), 1)
        odd = np.cumsum(crossings, axis=1, dtype=np.uint8)[:, :-1] % 2 == 1
        inked[top : top + odd.shape[0], left : left + odd.shape[1]] |= odd
    return 255 * (1 - inked.reshape(h, fine, w, fine).mean(axis=(1, 3)))


def written(module, strokes, **options):
    out = io.BytesIO()
    module.write(out, [strokes], lay_out([strokes]), **options)
    return out.getvalue()


def as_postscript(strokes, compress=False):
    return written(postscript, strokes, compress=compress, order=ordered_each)


def engraved(count=60, side=288.0, every=5.0):
    """Gently waving lines at 1.5 pt, a knot every 5 pt, their width between 0.16 and 1.3 pt: as an engraving is."""
    x = np.linspace(4, side - 4, 3 * int((side - 8) / every) + 1)
    lines = [np.stack([x, 20 + 1.5 * i + 6 * np.sin(x / 40 + i / 30)], axis=1) for i in range(count)]
    tones = [0.7 + 0.5 * np.sin(x[::3] / 23 + i / 9) for i in range(count)]
    return Strokes.of(side, side, lines, [np.clip(t, 0.16, 1.3) for t in tones])


@pytest.mark.parametrize("drawing", [drawings.swelling(), engraved()], ids=["swelling", "engraved"])
def test_outlines_are_the_strokes_under_either_rule(drawing):
    ours = covered(drawing)
    theirs = filled(drawing)
    assert difference(ours, theirs, DPI) < 0.25
    assert abs((ours - theirs).mean()) < 0.25


point = st.tuples(st.floats(4, 32), st.floats(4, 32))


@settings(max_examples=15, deadline=None)
@given(st.lists(point, min_size=7, max_size=7), st.lists(st.floats(0, 6), min_size=3, max_size=3))
def test_outlines_of_anything(points, widths):
    if not max(widths) > 0:
        return
    drawing = Strokes.of(36, 36, [points], [widths])
    assert difference(covered(drawing), filled(drawing), DPI) < 1.5  # in the whole of a sheet of half an inch


@pytest.mark.parametrize("drawing", [drawings.swelling(), engraved()], ids=["swelling", "engraved"])
@pytest.mark.parametrize("kind", ["ps", "compressed", "pdf", "svg"])
def test_renderers_agree(tmp_path, drawing, kind):
    ours = covered(drawing)
    side = ours.shape[0]
    if kind == "svg":
        if not shutil.which("rsvg-convert"):
            pytest.skip("no rsvg-convert")
        (tmp_path / "a.svg").write_bytes(written(svg, drawing))
        command = ["rsvg-convert", "-d", str(DPI), "-p", str(DPI), "-b", "white", str(tmp_path / "a.svg")]
        theirs = pixels(subprocess.run(command, capture_output=True, check=True).stdout)
    elif kind == "pdf":
        (tmp_path / "a.pdf").write_bytes(written(pdf, drawing))
        theirs = ghostscript(tmp_path / "a.pdf", DPI)
    else:
        (tmp_path / "a.eps").write_bytes(as_postscript(drawing, kind == "compressed"))
        theirs = ghostscript(tmp_path / "a.eps", DPI, True, f"-g{side}x{side}")
    assert difference(ours, theirs, DPI) < 0.5
    assert abs((ours - theirs).mean()) < 0.5


def test_postscript_is_small():
    drawing = engraved()
    knots = len(drawing.at_knots)
    assert len(as_postscript(drawing)) / knots <= 40
    assert len(as_postscript(drawing, compress=True)) / knots <= 14


def test_postscript_of_even_strokes_has_no_word_of_those_that_swell():
    assert b"/t {" not in as_postscript(drawings.every_kind())
    both = Strokes.joined([drawings.swelling(), drawings.every_kind()])
    text = as_postscript(both)
    assert b"}t\n" in text and b" w\n" in text


def test_an_svg_of_both_kinds_has_a_path_for_each_even_stroke():
    both = Strokes.joined([drawings.swelling(), drawings.every_kind()])
    text = written(svg, both).decode()
    swells = int(both.swells.sum())
    assert len(re.findall(r"<path", text)) >= len(both)
    assert text.count('z"/>') >= swells > 0
    assert text.count('<g fill="#000000" stroke="none" transform="scale(0.01)">') == 1


@pytest.mark.parametrize("pen", [0.2, 0.5, 1.2])
def test_passes_cover_the_width_with_one_pen(pen):
    drawing = engraved()
    wide = drawing.swelling(np.maximum(drawing.at_knots, pen))
    lines = swelling.passes(wide, pen)
    assert lines.knot_widths is None
    assert set(lines.widths.tolist()) == {pen}
    assert difference(covered(wide), covered(lines), DPI) < 0.5


def test_passes_leave_even_strokes_alone():
    even = drawings.every_kind()
    lines = swelling.passes(even, 0.1)
    assert np.array_equal(lines.points, even.points) and np.array_equal(lines.widths, even.widths)
