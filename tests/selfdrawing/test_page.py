"""The page that draws itself, in Chromium."""

from __future__ import annotations

import base64
import io
import re
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image
from scipy.ndimage import gaussian_filter

from penink_cli.ground.model import Illustration
from penink_cli.options.textures import find_texture
from penink_cli.selfdrawing import html, packer, postscript
from tests.selfdrawing.chromium import Page
from tests.selfdrawing.crossings import crossings
from tests.selfdrawing.pictures import CROSSHATCH, expected_tone, ghostscript, illustration, two_layers


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "picture.html"
    path.write_bytes(html.write(illustration(), "A <disc>"))
    with Page(path, 600, 600) as opened:
        yield opened


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


def middle_tone(page: Page, zoom: float) -> np.ndarray:
    """A place of middle tone, away from edges."""
    there = "view.x = 300 - 0.4 * size[0] * scale(), view.y = 300 - 0.8 * size[1] * scale()"
    page.evaluate(f"(view.zoom = {zoom}, {there}, repaint())")
    return page.screenshot()[:540]


def test_zoom_keeps_width_and_density_of_strokes(page):
    widths, densities = [], []
    for zoom in (1, 4, 24):
        width, density, patches = crossings(middle_tone(page, zoom))
        assert patches > 15
        widths.append(width)
        densities.append(density)
    assert max(widths) / min(widths) < 1.04
    assert widths[0] == pytest.approx(1.08, abs=0.05)  # a pen of 0.54 units of 2 pixels
    assert max(densities) / min(densities) < 1.1


def test_strokes_that_grow_with_the_picture_are_told_apart(page):
    shot = middle_tone(page, 4)
    larger = np.kron(shot[100:300, 100:300], np.ones((2, 2), np.uint8))
    assert crossings(larger)[0] > 1.5 * crossings(shot)[0]
    assert crossings(larger)[1] < 0.7 * crossings(shot)[1]


def test_the_same_strokes_as_on_paper(page):
    runs = page.evaluate("""(() => {
      let length = 0;
      draw(layers, 108, 108, [0, 0, 108, 108], 0, 1, (layer, screen, count) => {
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


def view(page: Page) -> list[float]:
    """Zoom, and the place of the picture's corner."""
    return page.evaluate("[view.zoom, view.x, view.y]")


def press(page: Page, key: str, **more: Any) -> None:
    for kind in ("keyDown", "keyUp"):
        page.call("Input.dispatchKeyEvent", type=kind, key=key, **more)


def test_keys_zoom_and_move(page):
    page.evaluate("(fit(), canvas.focus())")
    press(page, "+", text="+")
    press(page, "+", text="+")
    zoom, x, y = view(page)
    assert zoom == pytest.approx(2.25)
    press(page, "ArrowRight")
    press(page, "ArrowUp")
    assert view(page) == pytest.approx([2.25, x - 80, y + 80])
    press(page, "-", text="-")
    assert view(page)[0] == pytest.approx(1.5)
    press(page, "0", text="0")
    assert view(page)[0] == 1
    before = page.evaluate("painted.count")
    press(page, "+", text="+")
    page.until(f"painted.count > {before}")  # and is drawn anew
    assert page.evaluate("document.querySelector('output').value") == "1.5×"


def test_buttons_are_reached_by_tab_and_named(page):
    page.evaluate("document.querySelector('[value=s]').focus()")
    names = []
    while "Save SVG" not in names and len(names) < 12:  # from the last on around: past the window itself
        press(page, "Tab", code="Tab", windowsVirtualKeyCode=9)
        focused = "document.activeElement"
        name = page.evaluate(f"{focused} === document.body ? '' : {focused}.ariaLabel || {focused}.textContent")
        names += [name] if name else []
    assert names[0].startswith("A <disc>, a pen-and-ink illustration")
    assert names[1:] == ["Zoom in", "Zoom out", "Show all of it", "Print", "Save SVG"]
    page.evaluate("(fit(), document.querySelector('button').focus())")
    press(page, "Enter", text="\r", code="Enter", windowsVirtualKeyCode=13)
    assert view(page)[0] == pytest.approx(1.5)


def test_the_wheel_zooms_about_the_pointer(page):
    page.evaluate("fit()")
    _, x, _ = view(page)
    page.call("Input.dispatchMouseEvent", type="mouseWheel", x=200, y=250, deltaX=0, deltaY=-500)
    page.until("view.zoom > 2")
    zoom, now, _ = view(page)
    assert 200 - now == pytest.approx((200 - x) * zoom, rel=0.01)


def test_two_fingers_zoom_and_one_moves(page):
    page.evaluate("fit()")

    def touch(kind: str, *at: tuple[float, float]) -> None:
        points = [{"x": x, "y": y, "id": k} for k, (x, y) in enumerate(at)]
        page.call("Input.dispatchTouchEvent", type=kind, touchPoints=points)

    touch("touchStart", (250, 300), (350, 300))
    touch("touchMove", (200, 300), (400, 300))
    touch("touchMove", (150, 300), (450, 300))
    touch("touchEnd")
    page.until("view.zoom > 2.5")
    zoom, x, y = view(page)
    assert zoom == pytest.approx(3, rel=0.02)
    touch("touchStart", (300, 300))
    touch("touchMove", (330, 320))
    touch("touchEnd")
    page.until(f"view.x > {x} + 20")
    assert view(page) == pytest.approx([zoom, x + 30, y + 20], abs=1)


def test_after_a_move_fresh_strokes_are_drawn(page):
    page.evaluate("fit()")
    before = page.evaluate("painted.count")
    press(page, "+", text="+")
    page.until(f"painted.count > {before} && canvas.style.transform === ''")
    shown = page.screenshot()[100:500, 100:500]
    page.evaluate("repaint()")
    assert np.array_equal(shown, page.screenshot()[100:500, 100:500])


def test_it_prints_strokes_at_the_printers_resolution(page, tmp_path):
    page.evaluate("(view.zoom = 4, repaint())")  # the whole is printed, whatever is seen
    pdf = tmp_path / "page.pdf"
    inches = {"marginTop": 0, "marginBottom": 0, "marginLeft": 0, "marginRight": 0, "paperWidth": 4, "paperHeight": 4}
    pdf.write_bytes(base64.b64decode(page.call("Page.printToPDF", **inches)["data"]))
    images = subprocess.run(["pdfimages", "-list", pdf], capture_output=True, text=True, check=True).stdout
    assert images.count("\n") == 2  # a head of two lines, and none
    out = tmp_path / "printed.pgm"
    subprocess.run(["gs", "-q", "-dBATCH", "-dNOPAUSE", "-r600", "-sDEVICE=pgmraw", "-dLastPage=1",
                    f"-sOutputFile={out}", pdf], check=True)  # fmt: skip
    paper = np.asarray(Image.open(out))
    wanted = expected_tone(illustration().layers[0], 108, 108).mean() / 255
    rows, columns = np.nonzero(paper < 128)
    assert np.ptp(columns) == pytest.approx(900, abs=6) and np.ptp(rows) == pytest.approx(900, abs=6)
    cut = paper[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]
    assert 1 - cut.mean() / 255 == pytest.approx(wanted, abs=0.02)
    assert page.evaluate("document.querySelector('#paper').children.length") == 0  # gone after it


@pytest.mark.parametrize("sheet", [(8.27, 11.69), (8.5, 11)], ids=["A4", "Letter"])
@pytest.mark.parametrize("shape", [(9, 16), (1, 1), (16, 9)], ids=str)
def test_one_picture_is_printed_on_one_sheet(sheet, shape, tmp_path):
    wide, tall = (72 * 1.2 * side for side in shape)  # larger than the sheet, one way or the other, but for the square
    small = illustration()
    path = tmp_path / "picture.html"
    path.write_bytes(html.write(Illustration(wide, tall, small.layers), "picture"))
    with Page(path, 300, 300) as opened:
        made = opened.call("Page.printToPDF", paperWidth=sheet[0], paperHeight=sheet[1])["data"]
    pdf = tmp_path / "page.pdf"
    pdf.write_bytes(base64.b64decode(made))
    gs = ["gs", "-q", "-dBATCH", "-dNOPAUSE", "-r50", "-sDEVICE=pgmraw"]
    subprocess.run([*gs, f"-sOutputFile={tmp_path}/a%d.pgm", pdf], check=True)
    assert [path.name for path in tmp_path.glob("*.pgm")] == ["a1.pgm"]
    rows, columns = np.nonzero(np.asarray(Image.open(tmp_path / "a1.pgm")) < 128)
    extent = np.ptp(columns) / np.ptp(rows)
    assert extent == pytest.approx(shape[0] / shape[1], rel=0.03)  # all of it
    room = min(72 * (sheet[0] - 0.9) / wide, 72 * (sheet[1] - 0.9) / tall, 1)
    assert np.ptp(columns) == pytest.approx(50 / 72 * wide * room, rel=0.06)  # and no smaller than need be


def test_every_dot_has_a_length_that_plotters_see(tmp_path):
    dots = svg_of(illustration(texture=find_texture("stipple")), tmp_path, 108)
    paths = re.findall(r'<path d="M([^"]*)"', dots)
    assert len(paths) > 300 and all(d.endswith("h.001") or len(set(zip(*[iter(d.split())] * 2))) > 1 for d in paths)
    assert sum(d.endswith("h.001") for d in paths) > 0.9 * len(paths)


def test_layers_and_frame_of_what_is_saved(tmp_path):
    saved = svg_of(two_layers(find_texture("stipple"), CROSSHATCH), tmp_path, 108)
    root = ElementTree.fromstring(saved)
    label = "{http://www.inkscape.org/namespaces/inkscape}label"
    assert [group.attrib[label] for group in root] == ["1", "2"] and "clip" not in saved
    assert root.attrib["width"] == "38.1mm" and root.attrib["viewBox"] == "0 0 38.1 38.1"
    pens = {group.attrib["stroke-width"] for group in root}
    for path in root.iter("{http://www.w3.org/2000/svg}path"):
        half = float(path.attrib.get("stroke-width", max(pens, key=float))) / 2
        at = np.array(path.attrib["d"][1:].replace("h.001", "").split(), float)
        assert at.min() >= half - 0.02 and at.max() <= 38.1 - half + 0.02


def test_layers_have_their_inks_and_know_nothing_of_others(tmp_path):
    below, above = two_layers(CROSSHATCH, CROSSHATCH).layers
    picture = Illustration(108, 108, (replace(below, color="#ff0000"), replace(above, color="#0000ff")))
    root = ElementTree.fromstring(svg_of(picture, tmp_path, 108))
    assert [group.attrib["stroke"] for group in root] == ["#ff0000", "#0000ff"]
    alone = ElementTree.fromstring(svg_of(Illustration(108, 108, (below,)), tmp_path, 108))
    assert [path.attrib["d"] for path in root[0]] == [path.attrib["d"] for path in alone[0]]
    ppm = tmp_path / "a.ppm"
    device = ("-sDEVICE=ppmraw", "-r150", "-dEPSCrop", f"-sOutputFile={ppm}")
    assert ghostscript(postscript.write(picture), *device) == b""
    colours = {tuple(c) for c in np.asarray(Image.open(ppm)).reshape(-1, 3).tolist()}
    assert {(255, 0, 0), (0, 0, 255), (255, 255, 255)} == colours


def svg_of(picture: Illustration, tmp_path: Path, width: float) -> str:
    path = tmp_path / "picture.html"
    path.write_bytes(html.write(picture, "picture"))
    with Page(path, 300, 300) as opened:
        return str(opened.evaluate(f"svg({width}, [0, 0, {width}, {width * picture.height / picture.width}], 0)"))


def test_readers_without_scripts_are_told():
    told = re.search(rb"<noscript>(.*?)</noscript>", html.write(illustration(), "x"), re.DOTALL)
    assert told and b"scripts" in told[1]


def test_no_name_is_declared_twice():
    text = "\n".join(packer.source(name) for name in html.SOURCES)
    names = re.findall(r"^(?:async )?(?:function|const|let|class) (\w+)", text, re.MULTILINE)
    assert len(names) > 50 and len(names) == len(set(names))


def test_it_saves_what_is_seen_as_svg(page, tmp_path):
    page.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path))
    page.evaluate("(view.zoom = 4, view.x = view.y = -500, repaint(), document.querySelector('[value=s]').click())")
    files: list[Path] = []
    while not (files := list(tmp_path.glob("*.svg"))):
        page.until("true")
    root = ElementTree.parse(files[0]).getroot()
    assert root.attrib["viewBox"] == "0 0 105.833 105.833"  # 600 pixels of two a point
    out = subprocess.run(["rsvg-convert", "-d", "192", "-p", "192", files[0]], capture_output=True, check=True).stdout
    drawn = np.asarray(Image.open(io.BytesIO(out)).convert("LA"))
    saved = 255 - (255 - drawn[..., 0].astype(int)) * drawn[..., 1] // 255
    scaled = Image.fromarray(saved.astype(np.uint8)).resize((600, 600), Image.Resampling.BOX)
    off = gaussian_filter(np.asarray(scaled, float), 2) - gaussian_filter(page.screenshot().astype(float), 2)
    assert np.abs(off[20:500, 20:400]).mean() < 6


def test_nothing_complains_or_is_fetched(page):
    assert page.console == []
    assert [url for url in page.requests if not url.startswith("blob:")] == page.requests[:1]
    assert page.requests[0].startswith("file:")


@pytest.mark.parametrize("title", ["PROGRAM", "TITLE", "the PROGRAM of TITLE"])
def test_a_title_may_be_what_stands_for_it_in_the_page(title):
    page = html.write(illustration(), title).decode()
    assert f"<title>{title}</title>" in page and page.replace(title, "x") == html.write(illustration(), "x").decode()


def test_titles_are_escaped():
    assert b"<title>A &lt;disc&gt;</title>" in html.write(illustration(), "A <disc>")


def test_a_page_follows_its_file(tmp_path):
    path, newer = tmp_path / "picture.html", tmp_path / "newer.html"
    path.write_bytes(html.write(illustration(), "before", reload=True))
    newer.write_bytes(html.write(illustration(inches=1.0), "after", readable=True, reload=True))
    with Page(path, 300, 300) as page:
        page.until("(window.looks ||= 0, window.onmessage ??= () => looks++, looks > 2)")  # the same, so far
        assert page.evaluate("document.title") == "before"
        newer.rename(path)
        page.until("document.title === 'after' && document.body.dataset.ready === 'yes'")
        assert not page.console
