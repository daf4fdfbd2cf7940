"""Sets of oriented strokes: along the field, true in tone up to black, the same however they are reckoned."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from penink_cli.blasting.blast import blast
from penink_cli.blasting.screens import table
from penink_cli.blasting.stroke_set import smooth
from penink_cli.ground.errors import ParameterError
from penink_cli.ground.model import Strokes
from penink_cli.options.textures import find_texture
from penink_cli.textures.sets import as_set
from tests.blasting import measures
from tests.blasting.test_form import circles, field, off_angle, waves
from tests.textures.shipped import SETS


@pytest.mark.parametrize("name", SETS)
def test_a_set_makes_every_tone_up_to_black(name):
    ramp = np.linspace(0, 1, 96)[None].repeat(32, axis=0)
    strokes = blast(ramp, 432, 144, None, find_texture(name), directions=field(waves))
    rms, bias, _ = measures.tone_figures(strokes, ramp)
    assert rms < 0.8 and abs(bias) < 0.2
    black = blast(np.full((8, 8), 0.98), 100, 100, None, find_texture(name), directions=field(circles))
    assert measures.tone_figures(black, np.full((8, 8), 0.98))[0] < 1.5


@pytest.mark.parametrize("turn", [circles, waves])
def test_examples_are_bent_along_the_field(turn):
    strokes = blast(np.full((16, 16), 0.35), 216, 216, None, find_texture("fur"), directions=field(turn))
    off = off_angle(strokes, turn)
    assert off.mean() < 8 and np.percentile(off, 95) < 22  # the examples are curved, and turned by up to ten


def test_in_the_dark_a_second_pass_crosses_the_first():
    light, dark = (
        blast(np.full((8, 8), tone), 144, 144, None, find_texture("hair"), directions=field(waves))
        for tone in (0.5, 0.9)
    )
    assert off_angle(light, waves).mean() < 8 < off_angle(dark, waves).mean()


def test_without_a_field_strokes_lie_at_one_angle():
    strokes = blast(np.full((8, 8), 0.4), 144, 144, None, find_texture("barb"))
    ends = strokes.points[strokes.first[1:] - 1] - strokes.points[strokes.first[:-1]]
    assert np.median(np.degrees(np.arctan2(ends[:, 1], ends[:, 0])) % 180) == pytest.approx(135, abs=4)


def test_strokes_are_as_many_to_the_inch_at_every_size():
    fur = find_texture("fur")
    small, large = (blast(np.full((8, 8), 0.4), s, s, None, fur, directions=field(waves)) for s in (144, 288))
    assert len(large) / len(small) == pytest.approx(4, rel=0.08)
    assert np.median(large.widths) == pytest.approx(np.median(small.widths), rel=0.03)


def test_equal_input_gives_equal_strokes():
    tone = np.random.default_rng(1).random((20, 20))
    one, two, other = (
        blast(tone, 200, 200, None, find_texture("fur"), directions=field(waves), threads=threads, seed=seed)
        for threads, seed in ((1, 0), (3, 0), (1, 1))
    )
    assert np.array_equal(one.points, two.points) and np.array_equal(one.widths, two.widths)
    assert len(other.points) != len(one.points) or not np.array_equal(other.points, one.points)


def test_one_pen_draws_all():
    strokes = blast(np.full((8, 8), 0.4), 216, 216, None, find_texture("fur"), directions=field(waves), pen_pt=0.85)
    assert set(strokes.widths.tolist()) == {0.85}
    rms, bias, _ = measures.tone_figures(strokes, np.full((8, 8), 0.4))
    assert rms < 2 and abs(bias) < 0.4


@pytest.mark.parametrize("name", SETS)
def test_one_pen_is_as_dark_as_it_should(name):
    """Short strokes of a broad pen that fill what is left were too dark by up to 2 %."""
    ramp = np.linspace(0.1, 0.8, 96)[None].repeat(64, axis=0)
    strokes = blast(ramp, 432, 288, None, find_texture(name), directions=field(waves), pen_pt=0.85)
    assert abs(measures.tone_figures(strokes, ramp)[1]) < 0.5


@pytest.mark.parametrize("rule", ["strict", "threshold"])
def test_other_rules_know_no_sets(rule):
    with pytest.raises(ParameterError, match=f"fur is a set of strokes, for the rule best and not {rule}"):
        blast(np.full((4, 4), 0.4), 50, 50, None, find_texture("fur"), rule=rule)
    with pytest.raises(ParameterError, match="only blast and render can lay"):
        table(find_texture("fur"))


def test_curves_pass_the_points_they_are_made_of():
    line = np.column_stack([np.linspace(0, 30, 21), np.sin(np.linspace(0, 3, 21))])
    points, first = smooth(np.concatenate([line, line[:2], line[:6]]), np.array([0, 21, 23, 29]))
    assert (np.diff(first) % 3 == 1).all() and np.diff(first).tolist() == [16, 4, 4]
    assert points[first[:-1]].tolist() == [line[0].tolist()] * 3
    assert points[first[1:] - 1].tolist() == [line[20].tolist(), line[1].tolist(), line[5].tolist()]
    curve = measures.flattened(Strokes(1, 1, points, first, np.ones(3)), 0)
    assert np.abs(curve[:, 1] - np.interp(curve[:, 0], *line.T)).max() < 0.05


def test_what_leads_nowhere_is_no_example():
    fur = find_texture("fur")
    chains = [[[5, 5]], [[9, 1], [6, 1], [3, 2], [0, 2]], [[1, 1]] * 4]
    drawing = replace(fur, strokes=Strokes.of(9, 9, chains, [1, 1, 1]))
    found, left_out = as_set(drawing)
    assert left_out == 2 and len(found.strokes) == 1
    assert (found.strokes[0] - found.strokes[0][0]).tolist() == [[0, 0], [3, 0], [6, -1], [9, -1]]
