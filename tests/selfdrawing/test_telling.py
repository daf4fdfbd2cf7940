"""Telling lines, in the EPS and the page, as `lines` draws them."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial import cKDTree

from penink_cli.blasting.constants import WIDENED
from penink_cli.ground.model import GreyImage, Illustration, Layer, LineChoice, Lines
from penink_cli.lines.choice import chosen
from penink_cli.lines.strokes import line_strokes
from penink_cli.options.textures import find_texture
from penink_cli.selfdrawing import data, postscript, telling
from tests.selfdrawing.drawn import by_printer, page_svg
from tests.selfdrawing.pictures import ghostscript
from tests.selfdrawing.test_outlines import on_a_printer
from tests.selfdrawing.test_same_strokes import CATCH


def some_lines(n: int = 60, seed: int = 5) -> Lines:
    """Arcs, a ring, a spot, and light ones, on a photo of 400 × 300 pixels."""
    rng = np.random.default_rng(seed)
    points, sizes, weight = [], [], []
    for k in range(n):
        many = 1 if k == 3 else int(rng.integers(4, 20))
        turn = np.linspace(0, 2 * np.pi if k == 2 else rng.uniform(0.5, 2), many)
        at = rng.uniform((60, 60), (340, 240)) + rng.uniform(8, 40) * np.column_stack([np.cos(turn), np.sin(turn)])
        points.append(np.clip(at, 0, (400, 300)))
        sizes.append(many)
        weight.append(rng.uniform(0, 1, many))
    breadth = np.zeros(n)
    breadth[3] = 9.0
    first = np.concatenate([[0], np.cumsum(sizes)])
    white = np.arange(n) % 5 == 4
    rank = rng.uniform(0.6, 8, n)
    return Lines(400, 300, np.concatenate(points), first, np.concatenate(weight), rank, white, breadth)


def drawing(lines: Lines | None, tone: float = 0.0, line: LineChoice | None = None) -> Illustration:
    samples = GreyImage(np.full((30, 40), round(63 * (1 - tone)), np.uint8), 63)
    layer = Layer(samples, None, find_texture("engraving-straight"), levels=64, lines=lines, line=line or LineChoice())
    return Illustration(288, 216, (layer,))


@pytest.mark.parametrize("step", range(0, len(telling.LADDER), 2))
def test_each_step_of_the_ladder_has_the_lines_there_is_room_for(step):
    lines, width = some_lines(), telling.LADDER[step]
    which, steps = telling.told(lines, LineChoice())
    drawn = set(which[(steps <= step) & ~lines.white[which]].tolist())
    wanted = set(chosen(lines, width, width * 0.75, LineChoice()).tolist())
    assert wanted <= drawn and len(drawn - wanted) <= 2  # a line may have lost its place to others again


def test_more_room_more_lines():
    lines = some_lines()
    _, steps = telling.told(lines, LineChoice())
    counts = [int((steps <= step).sum()) for step in range(len(telling.LADDER))]
    assert counts == sorted(counts) and counts[0] < counts[-1]


def along(lines: list[np.ndarray]) -> np.ndarray:
    """Points a third of a point apart on polylines."""
    dense = []
    for line in lines:
        for a, b in pairwise(line):
            n = max(1, int(np.hypot(*(b - a)) * 3))
            dense.append(a + (b - a) * (np.arange(n + 1) / n)[:, None])
    return np.concatenate(dense)


@pytest.mark.parametrize("width", [204.0, 576.0])
def test_all_three_draw_the_same_lines(width, tmp_path):
    lines = some_lines()
    picture = drawing(lines)
    height = width * 0.75
    ours = line_strokes(lines, width, height, LineChoice())
    curves = []
    for i in range(len(ours)):
        p = ours[i]
        t = np.linspace(0, 1, 8)[:, None]
        for k in range(0, len(p) - 1, 3):
            a, b, c, d = p[k : k + 4]
            curves.append((1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t * t * (1 - t) * c + t**3 * d)
    wanted = along(curves)
    page = f"<< /PageSize [{width} {height}] >> setpagedevice {width / 288} dup scale\n".encode()
    program = CATCH.replace(b"HEIGHT", str(height).encode()) + page + postscript.write(picture)
    out = ghostscript(program, "-sDEVICE=pbmraw", "-r600", "-sOutputFile=/dev/null").decode()
    printed = along([np.array(part.split(), float).reshape(-1, 2) for part in out.split("S ")[1:]])
    shapes = [np.array(d[:-1].split(), float).reshape(-1, 2) * 72 / 25.4
              for d in re.findall(r'<path d="M([^"]*)"', page_svg(picture, tmp_path, width))]  # fmt: skip
    assert len(shapes) > 10
    # a printer strokes the lines' middles; a page fills them, half the width from there
    for found, near in ((printed, 0.5), (along(shapes), 1.6)):
        assert (cKDTree(found).query(wanted)[0] <= near).mean() > 0.98
        assert (cKDTree(wanted).query(found)[0] <= near + 0.4).mean() > 0.96


@pytest.mark.parametrize(("even", "more"), [(False, 0.0), (True, WIDENED)])
def test_they_are_painted_as_broad_as_they_are_meant(even, more):
    """A printer adds nothing that is not allowed for, but to a technical pen, which is as broad as it is."""
    choice = LineChoice(pen_pt=1.1, even=even)
    printed = on_a_printer(drawing(some_lines(), line=choice), 288.0)
    ours = line_strokes(some_lines(), 288, 216, choice)
    long = np.array([np.hypot(*np.diff(at, axis=0).T).sum() for _, at in printed])
    mean = float((np.array([pen for pen, _ in printed]) * long).sum() / long.sum())
    area, way = 0.0, 0.0
    for i in range(len(ours)):
        knots = ours[i][::3]
        legs = np.hypot(*np.diff(knots, axis=0).T)
        widths = ours.at_knots[ours.knots[i] : ours.knots[i + 1]]
        area, way = area + float((legs * (widths[1:] + widths[:-1]) / 2).sum()), way + float(legs.sum())
    assert mean == pytest.approx(area / way + more, abs=0.03)


def test_they_weigh_in_the_tone_and_light_ones_take_from_it(tmp_path):
    lines = some_lines()
    tones = {}
    for name, kept in (("none", None), ("dark", ~lines.white), ("white", lines.white)):
        told = None if kept is None else lines.chosen(np.flatnonzero(kept))
        tones[name] = float(by_printer(drawing(told, 0.7), tmp_path).mean())
    assert tones["dark"] == pytest.approx(tones["none"], abs=0.012)
    assert tones["white"] < tones["none"] - 0.002


def test_even_lines_have_one_width(tmp_path):
    text = page_svg(drawing(some_lines(), 0, LineChoice(pen_pt=2, even=True)), tmp_path, 288)
    wider = page_svg(drawing(some_lines(), 0, LineChoice(pen_pt=2)), tmp_path, 288)
    assert text != wider and len(re.findall("<path", text)) > 10


def test_steps_too_long_for_a_byte_are_taken_in_parts():
    lines = Lines(5000, 20, np.array([[0.0, 0.0], [5000.0, 20.0]]), np.array([0, 2]), np.array([0.0, 1.0]),
                  np.array([9.0]), np.array([False]), np.array([0.0]))  # fmt: skip
    raw = telling.line_bytes(lines, np.array([0]), np.array([3]))
    count = int.from_bytes(raw[3:5], "big")
    x, y, dx, dy = int.from_bytes(raw[5:7], "big"), int.from_bytes(raw[7:9], "big"), 0, 0
    for k in range(count - 1):
        dx, dy = dx + raw[9 + 2 * k] - 128, dy + raw[10 + 2 * k] - 128
        x, y = x + dx, y + dy
    assert (x, y) == telling.grid(lines) and len(raw) == 9 + 2 * (count - 1) + count
    weights = raw[-count:]
    assert weights[0] == 0 and weights[-1] == 15 and list(weights) == sorted(weights)


def test_hostile_lines_are_drawn(tmp_path):
    same = np.array([[3.0, 3.0]] * 4)
    points = np.concatenate([same, [[0.0, 0.0], [7.0, 7.0]], [[3.5, 3.5]]])
    rank, breadth = np.array([5.0, 4.0, 3.0]), np.array([0.0, 0.0, 900.0])
    lines = Lines(7, 7, points, np.array([0, 4, 6, 7]), np.zeros(7), rank, np.zeros(3, bool), breadth)
    picture = drawing(lines, 0.4)
    assert ghostscript(postscript.write(picture), "-sDEVICE=pbmraw", "-r300", "-sOutputFile=/dev/null") == b""
    assert "NaN" not in page_svg(picture, tmp_path, 288)
    (none,) = data.layers(drawing(replace(lines, rank=np.zeros(3), white=np.ones(3, bool))))
    assert none.told.dark == 0 and none.told.white == 0
