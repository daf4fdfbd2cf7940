"""The page that draws itself, in Chromium."""

from __future__ import annotations

import numpy as np
import pytest

from penink_cli.selfdrawing import html, postscript
from tests.selfdrawing.chromium import Page
from tests.selfdrawing.pictures import expected_tone, ghostscript, illustration


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "picture.html"
    path.write_bytes(html.write(illustration(), "A <disc>"))
    with Page(path, 600, 600) as opened:
        yield opened


def zoomed(page: Page, zoom: float) -> np.ndarray:
    """The middle of the window, the picture's middle, where the disc's border and the ramp are."""
    page.evaluate(f"view.zoom = {zoom}, view.x = view.y = 300 - 0.7 * size[0] * scale(), repaint()")
    return page.screenshot()[100:500, 100:500]


def test_tone_grid_equals_enlarge(page):
    tone = page.evaluate("Array.from(layers[0].picture.reconstruct(108, 108, 0, 0, 108, 108))")
    off = np.abs(np.array(tone).reshape(108, 108) - expected_tone(illustration().layers[0], 108, 108))
    assert (off <= 1.5).mean() >= 0.999


def test_a_window_has_the_strokes_of_the_whole(page):
    # the part of the grid that a window needs is the same, cell for cell
    assert page.evaluate("""(() => {
      const p = layers[0].picture;
      const whole = p.reconstruct(300, 300, 0, 0, 300, 300), part = p.reconstruct(300, 300, 90, 60, 200, 160);
      return part.every((tone, k) => tone === whole[(60 + Math.floor(k / 110)) * 300 + 90 + k % 110]);
    })()""")


def test_zoom_keeps_width_and_density_of_strokes(page):
    ink, edges = [], []
    for zoom in (1, 6, 24):
        shot = zoomed(page, zoom)[:, 220:] if zoom == 1 else zoomed(page, zoom)
        dark = shot < 128
        ink.append(dark.mean())
        edges.append((dark[:, 1:] != dark[:, :-1]).sum() / max(1, dark.sum()))
    # transitions per dark pixel are one over the strokes' width
    assert max(edges) / min(edges) < 1.25, (ink, edges)


def test_the_same_strokes_as_on_paper(page):
    runs = page.evaluate("""(() => {
      let length = 0;
      draw(layers, 108, 108, [0, 0, 108, 108], (layer, screen, count) => {
        for (let i = 1; i < count; i++) length += Math.hypot(alongX[i] - alongX[i - 1], alongY[i] - alongY[i - 1]);
      }, () => 0);
      return length;
    })()""")
    program = postscript.write(illustration(), "readable").decode()
    count = "  Total 0 Total 0 get tb ta sub step mul add put newpath\n  ta PointAt moveto"
    program = program.replace("  newpath\n  ta PointAt moveto", count)
    program = program.replace("  true Pass\n", "  /Total [ 0 ] def true Pass Total 0 get =\n")
    drawn = float(ghostscript(program.encode(), "-sDEVICE=pbmraw", "-r600", "-sOutputFile=/dev/null").split()[-1])
    assert drawn > 5000
    assert runs == pytest.approx(drawn, rel=0.01)


def test_keys_zoom_and_nothing_complains_or_is_fetched(page):
    page.evaluate("fit()")
    page.evaluate("document.dispatchEvent(new KeyboardEvent('keydown', {key: '+'}))")
    assert page.evaluate("view.zoom") == pytest.approx(1.5)
    page.evaluate("document.dispatchEvent(new KeyboardEvent('keydown', {key: '0'}))")
    assert page.evaluate("view.zoom") == 1
    assert page.console == []
    assert len(page.requests) == 1 and page.requests[0].startswith("file:")


def test_printing_and_saving_are_vectors(page):
    page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    assert page.evaluate("document.querySelector('#paper svg').getAttribute('width')") == "108.00pt"
    page.evaluate("window.dispatchEvent(new Event('afterprint'))")
    assert page.evaluate("document.querySelector('#paper').children.length") == 0
    assert page.evaluate("svg(108, [0, 0, 108, 108], 0)").startswith("<svg xmlns=")


def test_titles_are_escaped():
    assert b"<title>A &lt;disc&gt;</title>" in html.write(illustration(), "A <disc>")
