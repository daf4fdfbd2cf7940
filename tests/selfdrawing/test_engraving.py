"""Lines that swell, in the EPS and the page, as `render` draws them."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from penink_cli.ground.model import Directions, EdgeList, GreyImage, Illustration, Layer
from penink_cli.options.textures import find_texture
from penink_cli.selfdrawing import html, postscript
from tests.blasting import measures
from tests.selfdrawing.chromium import Page
from tests.selfdrawing.drawn import by_page, by_printer, by_render, middles, page_svg, seen
from tests.selfdrawing.pictures import ghostscript, illustration


@pytest.mark.parametrize("texture", ["engraving-straight", "contour-rings"])
def test_all_three_have_the_same_tone(texture, tmp_path):
    picture = illustration(texture=find_texture(texture), inches=2)
    ours = [seen(tone) for tone in (by_render(picture), by_printer(picture, tmp_path), by_page(picture, tmp_path))]
    rows, columns = (min(tone.shape[k] for tone in ours) for k in (0, 1))
    render, printer, page = (100 * tone[:rows, :columns] for tone in ours)
    for theirs in (printer, page):
        assert abs(float((theirs - render).mean())) < 0.5
        assert np.sqrt(((theirs - render) ** 2).mean()) < 1.2
    assert np.sqrt(((printer - page) ** 2).mean()) < 0.7


def test_a_finer_distance_is_told_apart(tmp_path):
    """The measure of the test above sees another spacing's tone as the same, and another tone as another."""
    picture = illustration(texture=find_texture("engraving-straight"), inches=2)
    (layer,) = picture.layers
    lighter = replace(layer, samples=GreyImage(np.minimum(layer.samples.values + 2, 63), 63))
    a, b = (seen(by_printer(replace(picture, layers=(one,)), tmp_path)) for one in (layer, lighter))
    assert 100 * (a - b).mean() > 2


def flat(tone: float, texture: str, field: Directions | None = None, inches: float = 2.0) -> Illustration:
    samples = GreyImage(np.full((24, 24), round((1 - tone) * 63), np.uint8), 63)
    layer = Layer(samples, None, find_texture(texture), levels=64, directions=field)
    return Illustration(72 * inches, 72 * inches, (layer,))


def around(n: int = 48) -> Directions:
    """Rings about the middle."""
    y, x = (np.mgrid[:n, :n] + 0.5) / n - 0.5
    angle = np.arctan2(y, x) + np.pi / 2
    return Directions(np.cos(2 * angle), np.sin(2 * angle), np.ones((n, n)))


@pytest.mark.parametrize("tone", [0.05, 0.15, 0.3, 0.6, 0.9])
def test_flat_tones_are_true_on_a_printer(tone, tmp_path):
    for texture in ("engraving-straight", "contour-rings", "wood"):
        picture = flat(tone, texture)
        wanted = 1 - picture.layers[0].samples.values[0, 0] / 63
        assert seen(by_printer(picture, tmp_path)).mean() == pytest.approx(wanted, abs=0.015), texture


def test_what_is_black_is_solid(tmp_path):
    def within(tone: np.ndarray) -> float:
        return float((tone[100:-100, 100:-100] > 0.5).mean())

    black = flat(0.97, "form")
    assert within(by_printer(black, tmp_path)) > 0.999 and within(by_page(black, tmp_path)) > 0.999
    dark = flat(0.85, "form")  # and what is not is not
    assert 0.8 < within(by_printer(dark, tmp_path)) < 0.9 and 0.8 < within(by_page(dark, tmp_path)) < 0.9
    crossed = by_printer(flat(0.97, "crosshatch"), tmp_path)  # a texture without black
    assert within(crossed) < 0.995


@pytest.mark.parametrize("field", [None, Directions(np.ones((4, 4)), np.zeros((4, 4)), np.ones((4, 4)))])
def test_a_second_set_crosses_the_first(field, tmp_path):
    texture = find_texture("engraving" if field else "engraving-straight")
    assert texture.engraving is not None
    samples = GreyImage(np.full((24, 24), round(0.3 * 63), np.uint8), 63)
    drawn = []
    for crosses in (0.4, 1.0):
        kind = replace(texture, engraving=replace(texture.engraving, crosses=crosses, angle=0.0))
        picture = Illustration(144, 144, (Layer(samples, None, kind, levels=64, directions=field),))
        drawn.append(
            [by_render(picture), by_page(picture, tmp_path)] + ([] if field else [by_printer(picture, tmp_path)])
        )
    for crossed, once in zip(*drawn):
        assert seen(crossed).mean() == pytest.approx(1 - 19 / 63, abs=0.015)
        # a line across: ink where lines run level and leave white between them
        bare = [(tone[200:-200, 200:-200].mean(axis=1) < 0.2).mean() for tone in (crossed, once)]
        assert bare[0] == 0 and bare[1] > 0.1


def strokes(text: str) -> list[np.ndarray]:
    return [np.array(d.replace("z", "").replace("h.001", "").split(), float).reshape(-1, 2) * 72 / 25.4
            for d in re.findall(r' d="M([^"]*)"', text)]  # fmt: skip


@pytest.mark.parametrize("texture", ["engraving", "form"])
def test_a_page_draws_along_the_field(texture, tmp_path):
    picture = flat(0.3, texture, around(), 3)
    text = page_svg(picture, tmp_path, picture.width)
    assert seen(by_page(picture, tmp_path)).mean() == pytest.approx(0.3, abs=0.02)
    off, weight = [], []
    for points in strokes(text):
        half = points if texture == "form" else points[: len(points) // 2]  # of an outline one side
        step = np.diff(half, axis=0)
        middle = (half[1:] + half[:-1]) / 2 - 108
        apart = np.hypot(*middle.T)
        far = apart > 14  # a ring smaller than a stroke is none
        cosine = np.abs((step * middle).sum(axis=1))[far] / np.maximum(np.hypot(*step.T) * apart, 1e-9)[far]
        off.append(np.degrees(np.arcsin(np.minimum(cosine, 1))))
        weight.append(np.hypot(*step.T)[far])
    assert np.average(np.concatenate(off), weights=np.concatenate(weight)) < 6


def test_a_pages_lines_lie_evenly_where_they_curve(tmp_path):
    y, x = (np.mgrid[:96, :96] + 0.5) / 48 - 1
    angle = 0.6 * np.sin(4.8 * x) + 0.4 * np.sin(3.6 * y)
    field = Directions(np.cos(2 * angle), np.sin(2 * angle), np.ones_like(angle))
    picture = flat(0.35, "engraving", field, 5)
    figures = measures.ray_gaps(middles(page_svg(picture, tmp_path, picture.width), picture.width, picture.height))
    assert figures["cv"] < 0.12 and figures["gaping"] < 0.01  # as the phase has them they are at .13 to .15


def test_lines_stay_where_they_are_when_the_picture_is_moved(tmp_path):
    picture = flat(0.3, "engraving", around(), 3)
    (tmp_path / "a.html").write_bytes(html.write(picture, "x"))
    ask = "(view.zoom = 6, view.x = {x}, view.y = {x}, repaint())"
    with Page(tmp_path / "a.html", 400, 400) as page:
        shots = []
        for x in (-700, -740):
            page.evaluate(ask.format(x=x))
            shots.append(page.screenshot().astype(float))
        page.evaluate("(layers[0].phases = null, repaint())")
        anew = page.screenshot().astype(float)
    first, second = shots[0][60:340, 60:340], shots[1][20:300, 20:300]
    moved = np.abs(first - second).mean()
    assert moved < 12 and np.abs(shots[1] - anew)[60:340, 60:340].mean() > 2 * moved


def test_in_haste_it_draws_about_the_same(tmp_path):
    (tmp_path / "a.html").write_bytes(html.write(flat(0.3, "form", around(), 3), "x"))
    with Page(tmp_path / "a.html", 400, 400) as page:
        tones = []
        for call in ("repaint()", "(layers[0].phases = null, repaint(2))"):
            page.evaluate(call)
            tones.append(page.screenshot()[40:330, 40:330].mean())
        assert tones[1] == pytest.approx(tones[0], abs=4)
        before = page.evaluate("painted.count")
        page.evaluate("zoomAt(1.2, 200, 200)")
        page.until(f"painted.count > {before + 1}")  # twice, coarsely and then finely
        assert page.evaluate("painted.every") == 1 and page.console == []


def test_a_printer_draws_it_straight(tmp_path):
    one, other = flat(0.3, "form", around()), flat(0.3, "form")
    assert postscript.write(one) == postscript.write(other)


def test_it_says_so_in_one_line(tmp_path, capfd):
    from penink_cli.formats.archive import pack
    from penink_cli.formats.illustration import members
    from penink_cli.main import _run

    (layer,) = flat(0.3, "form", around()).layers
    picture = Illustration(144, 144, (replace(layer, texture_name="form"),))
    (tmp_path / "a.penink").write_bytes(pack(members(picture)))
    assert _run(["to-ps", "--self", str(tmp_path / "a.penink"), "-o", str(tmp_path / "a.eps")]) == 0
    said = capfd.readouterr().err
    assert said.count("\n") == 1 and "layer 1 is drawn straight" in said


def test_saved_shapes_are_closed_and_within_the_frame(tmp_path):
    picture = illustration(texture=find_texture("contour-rings"))
    text = page_svg(picture, tmp_path, 108)
    assert "clip" not in text
    shapes = re.findall(r'<path d="([^"]*)"', text)
    assert len(shapes) > 50 and all(d.startswith("M") and d.endswith("z") for d in shapes)
    points = np.concatenate(strokes(text))
    assert points.min() >= 0 and points.max() <= 108.001


def hostile() -> dict[str, Illustration]:
    grey = GreyImage(np.full((1, 1), 20, np.uint8), 63)
    nowhere = Directions(np.zeros((1, 1)), np.zeros((1, 1)), np.zeros((1, 1)))
    cross = EdgeList(2, 2, np.array([[0.0, 1.0], [2.0, 1.0]]), np.array([[0, 1]]))
    strip = GreyImage(np.arange(200, dtype=np.uint8).reshape(1, 200) % 64, 63)
    many = find_texture("engraving-straight")
    assert many.engraving is not None
    many = replace(many, engraving=replace(many.engraving, lines=3))
    far_off = find_texture("contour-rings")
    assert far_off.engraving is not None
    far_off = replace(far_off, engraving=replace(far_off.engraving, centre=(-3.0, 9.0)))
    return {
        "one sample": Illustration(72, 72, (Layer(grey, cross, find_texture("engraving"), directions=nowhere),)),
        "no direction": Illustration(40, 40, (Layer(grey, None, find_texture("form"), directions=nowhere),)),
        "a strip": Illustration(400, 2, (Layer(strip, None, find_texture("form"), directions=around(9)),)),
        "three lines": Illustration(72, 72, (Layer(grey, cross, many),)),
        "a middle far off": Illustration(72, 72, (Layer(grey, None, far_off),)),
        "less than a line": Illustration(1, 1, (Layer(grey, cross, find_texture("contour-rings")),)),
        "two layers": Illustration(72, 72, (Layer(grey, cross, find_texture("engraving")), Layer(grey, None, many))),
    }


@pytest.mark.parametrize("name", hostile())
def test_hostile_illustrations_are_drawn(name, tmp_path):
    picture = hostile()[name]
    assert ghostscript(postscript.write(picture), "-sDEVICE=pbmraw", "-r300", "-sOutputFile=/dev/null") == b""
    text = page_svg(picture, tmp_path, picture.width)
    assert "NaN" not in text and "undefined" not in text
