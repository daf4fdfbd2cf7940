"""Hatching and telling lines on one sheet."""

from __future__ import annotations

import numpy as np

from penink_cli.blasting.blast import blast
from penink_cli.blasting.sheet import coverage
from penink_cli.blasting.telling import told
from penink_cli.ground.model import LineChoice, Lines, Strokes
from penink_cli.lines.strokes import line_strokes
from penink_cli.options.textures import find_texture

SIDE = 144.0


def lines(white: bool) -> Lines:
    """One line, from left to right, across the middle of a picture of 100 × 100 pixels."""
    points = np.column_stack([np.linspace(10, 90, 21), np.full(21, 50.0)])
    return Lines(100, 100, points, np.array([0, 21]), np.ones(21), np.array([9.0]), np.array([white]), np.zeros(1))


def rows(strokes: Strokes) -> np.ndarray:
    """Ink of each row of points of the sheet, over the middle of the line."""
    return coverage(strokes, 144, 144)[:, 30:114].mean(axis=1)


def test_light_lines_are_left_out_where_it_is_dark_and_only_there():
    for tone, shown in ((0.75, True), (0.2, False)):
        asked = np.full((288, 288), tone)
        left, near = told(asked, SIDE, SIDE, lines(white=True), None, 1)
        assert near.any() == shown and not near[: 130 * near.shape[0] // 288].any()
        assert (left[143:145, 100:200].mean() < 0.5 * tone) == shown
        assert np.allclose(left[:130], tone, atol=1e-6)
        drawn = rows(blast(asked, SIDE, SIDE, None, find_texture("crosshatch"), lines=lines(white=True)))
        assert (drawn[71:73].min() < 0.5 * drawn[40:60].mean()) == shown


def test_what_lies_between_light_lines_is_no_thin_dark_thing():
    """It stands out from them alone; a stroke along it would be a bar beside a whisker."""
    asked = np.full((288, 288), 0.58)
    both = [lines(white=True).points + np.array((0.0, shift)) for shift in (-1.8, 1.8)]
    two = Lines(
        100, 100, np.concatenate(both), np.array([0, 21, 42]), np.ones(42),
        np.array([9.0, 8.0]), np.array([True, True]), np.zeros(2),
    )  # fmt: skip
    left, near = told(asked, SIDE, SIDE, two, None, 1)
    middle = near.shape[0] // 2
    assert left[143:145, 100:200].mean() > 0.5 and left[136:139, 100:200].min() < 0.3
    assert near[middle - 1 : middle + 1, 40:100].all()


def test_dark_lines_are_ink_that_counts_and_take_nothing_else_away():
    asked = np.full((288, 288), 0.4)
    ink = line_strokes(lines(white=False), SIDE, SIDE, LineChoice())
    assert np.array_equal(told(asked, SIDE, SIDE, lines(white=False), ink, 1)[0], asked)
    drawn = rows(blast(asked, SIDE, SIDE, None, find_texture("crosshatch"), outlines=ink, lines=lines(white=False)))
    whole = rows(Strokes.joined([ink, blast(asked, SIDE, SIDE, None, find_texture("crosshatch"), outlines=ink)]))
    assert drawn[64:80].mean() < whole[64:80].mean()
    assert abs(whole[60:84].mean() - whole[20:50].mean()) < 0.03


def test_thin_things_are_not_drawn_where_a_line_tells_of_them():
    asked = np.full((288, 288), 0.05)
    asked[142:146, 30:260] = 0.9
    ink = line_strokes(lines(white=False), SIDE, SIDE, LineChoice())

    def along(given: Lines | None) -> int:
        drawn = blast(asked, SIDE, SIDE, None, find_texture("crosshatch"), outlines=ink, lines=given)
        ys = [np.ptp(drawn[i][:, 1]) for i in range(len(drawn)) if abs(drawn[i][:, 1].mean() - 72) < 1.5]
        return sum(1 for y in ys if y < 1.0)

    assert along(lines(white=False)) < along(None)


def test_swelling_ink_is_counted_as_it_is_drawn():
    swelling = Strokes.of(SIDE, SIDE, [[[20, 72], [50, 72], [90, 72], [120, 72]]], [[0.5, 8.0]])
    there = coverage(swelling, 144, 144)
    assert there[:, 20:40].sum() < 0.5 * there[:, 90:110].sum()
    pieces = swelling.by_segments()
    assert np.allclose(pieces[len(pieces) // 2][0], (70, 72), atol=2) and np.diff(pieces.widths).max() < 0.16
