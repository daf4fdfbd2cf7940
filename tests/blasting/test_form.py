"""Hatching along a field of directions: true in tone, along the field, as even as straight hatching."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from penink_cli.blasting.blast import blast
from penink_cli.blasting.shares import BLACK, shares
from penink_cli.formats import directions as directions_format
from penink_cli.ground.model import Directions, EdgeList, Floats, HatchLayer, Strokes
from penink_cli.options.textures import find_texture
from tests.blasting import measures


def field(turn, n: int = 96) -> Directions:
    """turn(x, y) radians, x and y from -1 to 1 over the frame."""
    y, x = (np.mgrid[:n, :n] + 0.5) / n * 2 - 1
    angle = turn(x, y) + np.zeros_like(x)
    return Directions(np.cos(2 * angle), np.sin(2 * angle), np.ones_like(angle))


def circles(x, y):
    return np.arctan2(y, x) + np.pi / 2


def waves(x, y):
    return 0.7 * np.sin(4 * x) + 0.4 * np.sin(3 * y)


def off_angle(strokes: Strokes, turn, margin: float = 10.0) -> Floats:
    """Degrees between the legs of all strokes and the field, a leg of a point or so each."""
    half = np.array([strokes.width, strokes.height]) / 2
    lines = [measures.flattened(strokes, i) for i in range(len(strokes))]
    legs = np.concatenate([np.diff(line, axis=0) for line in lines])
    middle = np.concatenate([(line[1:] + line[:-1]) / 2 for line in lines])
    angle = turn(*((middle - half) / half).T)
    off = np.abs(legs[:, 1] * np.cos(angle) - legs[:, 0] * np.sin(angle)) / np.maximum(np.hypot(*legs.T), 1e-9)
    inside = (np.abs(middle - half) < half - margin).all(axis=1) & (np.hypot(*(middle - half).T) > 15)
    return np.degrees(np.arcsin(np.clip(off[inside], 0, 1)))


@pytest.mark.parametrize("turn", [circles, waves])
@pytest.mark.parametrize("tone", [0.15, 0.45])
def test_strokes_run_along_the_field_and_make_the_tone(turn, tone) -> None:
    wanted = np.full((16, 16), tone)
    strokes = blast(wanted, 216, 216, None, find_texture("parallel"), directions=field(turn))
    off = off_angle(strokes, turn)
    assert off.mean() < 4 and np.percentile(off, 95) < 12
    rms, bias, _ = measures.tone_figures(strokes, wanted)
    assert rms < 0.9 and abs(bias) < 0.3


def test_layers_turn_with_the_field() -> None:
    """Crossing layers keep their angle to each other, or have the one that they ask for."""
    wanted = np.full((16, 16), 0.75)
    crossed = find_texture("crosshatch")
    for layers, turned in ((crossed.layers, 90.0), ((crossed.layers[0], replace(crossed.layers[1], turn=50.0)), 50.0)):
        strokes = blast(wanted, 216, 216, None, replace(crossed, layers=layers), directions=field(waves))
        first = off_angle(strokes, waves)
        second = off_angle(strokes, lambda x, y, turned=turned: waves(x, y) + np.radians(turned))
        nearest = np.minimum(first, second)
        assert nearest.mean() < 5
        assert 0.25 < (first < second).mean() < 0.75


def test_a_field_of_one_angle_is_as_even_as_the_straight_sweep() -> None:
    wanted = np.full((16, 16), 0.2)
    texture = find_texture("parallel")
    along = blast(wanted, 360, 360, None, texture, directions=field(lambda x, y: np.radians(-30)))
    straight = blast(wanted, 360, 360, None, replace(texture, layers=(replace(texture.layers[0], angle=-30),)))
    a, b = measures.evenness(along, -30), measures.evenness(straight, -30)
    assert a["cv"] < 1.15 * b["cv"] and a["spread"] > 0.04 and a["aligned_ends"] <= 0.16
    assert a["doubled"] <= 0.004
    assert measures.lengths(along).mean() == pytest.approx(measures.lengths(straight).mean(), rel=0.1)


@pytest.mark.parametrize("rule", ["strict", "threshold"])
def test_other_rules_know_no_field(rule) -> None:
    wanted = np.full((8, 8), 0.4)
    plain, with_field = (
        blast(wanted, 72, 72, None, find_texture("crosshatch"), rule=rule, directions=d) for d in (None, field(waves))
    )
    assert np.array_equal(plain.points, with_field.points)


def test_threads_and_runs_change_nothing() -> None:
    y, x = np.mgrid[:40, :60] / 40
    wanted = np.clip(0.5 + 0.5 * np.sin(7 * x * y), 0, 1)
    edges = EdgeList(60, 40, np.array([[30.0, 4.0], [30.0, 36.0]]), np.array([[0, 1]]))
    texture = find_texture("form")
    found = [blast(wanted, 432, 288, edges, texture, directions=field(waves), threads=n) for n in (1, 1, 3)]
    for other in found[1:]:
        assert np.array_equal(found[0].points, other.points) and np.array_equal(found[0].widths, other.widths)


def test_strokes_end_at_strong_edges() -> None:
    """Dark on one side and light on the other of an edge that the field runs across."""
    wanted = np.where(np.arange(200) < 100, 0.7, 0.05)[None].repeat(200, axis=0)
    edges = EdgeList(200, 200, np.array([[100.0, 0.0], [100.0, 200.0]]), np.array([[0, 1]]))
    strokes = blast(wanted, 216, 216, edges, find_texture("parallel"), directions=field(lambda x, y: 0.2))
    ends = np.concatenate([measures.flattened(strokes, i)[:, 0] for i in range(len(strokes))])
    spans = [measures.flattened(strokes, i)[:, 0] for i in range(len(strokes))]
    assert not any(x.min() < 106 and x.max() > 110 for x in spans)
    assert ((ends > 105.5) & (ends < 108.5)).any()


def test_black_is_black_and_no_net() -> None:
    """Where black begins the first layer closes up alone; the dark is filled, and leaves what paper is asked for."""
    layers = find_texture("form").layers
    tone = np.full((30, 30), 0.97)
    first, second, black = shares(tone, tone, layers)
    assert (first == BLACK).all() and (second == 0).all() and (black == 0).all()
    for wanted, least, most in ((1.0, 0.0, 0.005), (0.95, 0.04, 0.06), (0.91, 0.07, 0.11)):
        strokes = blast(np.full((16, 16), wanted), 144, 144, None, find_texture("form"), directions=field(waves))
        paper = 1 - measures.rendered(strokes, 600)[60:-60, 60:-60].mean()
        assert least <= paper < most, (wanted, paper)


def test_no_layer_is_drawn_where_it_covers_nothing() -> None:
    wanted = np.zeros((16, 16))
    assert len(blast(wanted, 144, 144, None, find_texture("form"), directions=field(waves))) == 0


def test_lines_of_a_layer_with_a_spacing_are_no_closer() -> None:
    texture = find_texture("parallel")
    layer = HatchLayer(0.0, 0.0, 0.99, 0.4, spacing_pt=3.0)
    strokes = blast(np.full((8, 8), 0.6), 216, 216, None, replace(texture, layers=(layer,)), directions=field(waves))
    ink = (measures.lengths(strokes)).sum() / 216**2
    assert ink < 1.05 / 3.0


def test_grain_wanders_about_the_field() -> None:
    wanted = np.full((8, 8), 0.3)
    off = {
        name: off_angle(blast(wanted, 216, 216, None, find_texture(name), directions=field(waves)), waves)
        for name in ("parallel", "grain")
    }
    assert 2 * off["parallel"].mean() < off["grain"].mean() < 20


def test_ray_gaps_tell_even_lines_from_uneven_ones() -> None:
    """The measure itself: rings 3 pt apart, and the same with every fifth one moved."""

    def rings(radii) -> Strokes:
        turn = np.linspace(0, 2 * np.pi, 121)[:, None] + np.array([0.0, 1 / 3, 2 / 3]) * (2 * np.pi / 120)
        angle = turn.ravel()[: 3 * 120 + 1]
        points = [150 + r * np.column_stack([np.cos(angle), np.sin(angle)]) for r in radii]
        return Strokes(300, 300, np.concatenate(points), np.arange(len(radii) + 1) * 361, np.full(len(radii), 0.4))

    radii = np.arange(30.0, 120.0, 3.0)
    even = measures.ray_gaps(rings(radii))
    assert even["mean"] == pytest.approx(3, abs=0.02) and even["cv"] < 0.02 and even["gaping"] == 0
    uneven = measures.ray_gaps(rings(radii + np.where(np.arange(30) % 5 == 0, 2.2, 0.0)))
    assert uneven["cv"] > 0.3 and uneven["doubled"] > 0.1


def test_the_command_takes_a_field_and_says_where_it_is_of_no_use(penink, tmp_path) -> None:
    grey = tmp_path / "grey.pgm"
    grey.write_bytes(b"P5 24 18 255\n" + bytes(range(0, 216)) * 2)
    with (tmp_path / "d.pgm").open("wb") as out:
        directions_format.write(out, field(waves, 18))
    square = penink("blast", "--directions", tmp_path / "d.pgm", "--width", "1in", grey)
    assert square.returncode == 1 and b"another shape" in square.stderr and not square.stdout
    with (tmp_path / "d.pgm").open("wb") as out:
        found = field(waves, 24)
        directions_format.write(out, Directions(found.cos2[:18], found.sin2[:18], found.confidence[:18]))
    plain = penink("blast", "--width", "1in", grey)
    along = penink("blast", "--directions", tmp_path / "d.pgm", "--width", "1in", grey)
    assert along.returncode == 0 and along.stdout != plain.stdout and not along.stderr
    dots = penink("blast", "-t", "stipple", "--directions", tmp_path / "d.pgm", "--width", "1in", grey)
    assert dots.returncode == 0 and b"stipple is not drawn along directions" in dots.stderr


def test_what_is_dark_has_a_line_along_its_edge():
    """Lines that meet an edge at an angle leave notches before it."""
    side = 120
    a, b = np.array([40.0, 0.0]), np.array([75.0, 120.0])
    y, x = np.mgrid[0:side, 0:side] + 0.5
    tone = np.where((x - a[0]) - y * (b - a)[0] / (b - a)[1] < 0, 0.75, 0.1)
    edges = EdgeList(side, side, np.array([a, b]), np.array([[0, 1]]))
    strokes = blast(tone, side, side, edges, find_texture("form"), directions=field(lambda x, y: 0.2), device_dpi=None)
    page = measures.rendered(strokes, 600)
    rows, columns = np.mgrid[0 : len(page), 0 : page.shape[1]] * (72 / 600)
    away = ((columns - a[0]) - rows * (b - a)[0] / (b - a)[1]) * (b - a)[1] / np.hypot(*(b - a))
    inner = (rows > 5) & (rows < side - 5)
    assert page[inner & (away > -0.15) & (away < 0)].mean() > 0.85
    assert page[inner & (away > 0.15) & (away < 1.5)].mean() < 0.2
