"""The verbs of strokes: joined, taken, turned and rounded keep every stroke's points with its widths."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from penink_cli.ground.model import Strokes
from penink_cli.ground.shapes import same_shape
from tests.formats.test_strokes import drawings


def listed(strokes):
    """One (points, widths at the knots) a stroke, slowly."""
    widths, knots = strokes.at_knots, strokes.knots
    assert knots[-1] == len(widths)
    return [(strokes[i].tolist(), widths[knots[i] : knots[i + 1]].tolist()) for i in range(len(strokes))]


@settings(deadline=None)
@given(st.lists(drawings(), min_size=1, max_size=3))
def test_joined_is_one_after_the_other(parts):
    whole = Strokes.joined(parts)
    assert listed(whole) == [stroke for part in parts for stroke in listed(part)]
    assert (whole.width, whole.height) == (parts[0].width, parts[0].height)
    assert whole.layer == (parts[0].layer if len({part.layer for part in parts}) == 1 else None)


@settings(deadline=None)
@given(drawings(), st.data())
def test_taken_are_those_strokes_whichever_way_round(strokes, data):
    numbers = st.integers(0, len(strokes) - 1) if len(strokes) else st.nothing()
    which = np.array(data.draw(st.lists(numbers)), np.int64)
    turned = np.array(data.draw(st.lists(st.booleans(), min_size=len(which), max_size=len(which))), bool)
    expected = [listed(strokes)[i] for i in which]
    assert listed(strokes.taken(which)) == expected
    there_and_back = [(p[::-1], w[::-1]) if back else (p, w) for (p, w), back in zip(expected, turned)]
    assert listed(strokes.taken(which, turned)) == there_and_back
    chosen = np.arange(len(strokes)) % 2 == 0
    assert listed(strokes.taken(chosen)) == listed(strokes)[::2]


@settings(deadline=None)
@given(drawings())
def test_of_is_the_inverse_of_taking_apart(strokes):
    parts = listed(strokes)
    widths = [at if len(set(at)) > 1 else at[0] for _, at in parts]
    again = Strokes.of(strokes.width, strokes.height, [points for points, _ in parts], widths)
    assert listed(again) == parts
    assert np.allclose(again.widths, strokes.widths)


def test_a_swelling_stroke_has_its_mean_and_its_widest():
    line = [[0, 0], [1, 0], [2, 0], [3, 0], [4, 0], [5, 0], [6, 0]]
    strokes = Strokes.of(9, 9, [line, line[:4]], [[0.1, 0.9, 0.2], 0.5])
    assert strokes.widths.tolist() == pytest.approx([0.4, 0.5])
    assert strokes.widest.tolist() == [0.9, 0.5]
    assert strokes.swells.tolist() == [True, False]


SIDES = st.integers(1, 5000)


@given(SIDES, SIDES, SIDES, SIDES)
def test_all_resizings_of_a_picture_have_its_shape(width, height, one, other):
    """The longer side of each is what is asked for, the shorter one is rounded."""
    sizes = [
        tuple(max(1, round(side * longer / max(width, height))) for side in (width, height)) for longer in (one, other)
    ]
    assert same_shape(*sizes[0], *sizes[1])
    assert same_shape(*sizes[1], *sizes[0])


@given(st.integers(20, 5000), st.integers(20, 5000))
def test_a_picture_a_tenth_higher_has_another_shape(width, height):
    assert not same_shape(width, height, 2 * width, round(2.2 * height) + 1)
