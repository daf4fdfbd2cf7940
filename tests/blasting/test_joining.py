"""Lines that face each other end to end become one, others do not."""

import numpy as np

from penink_cli.blasting.curves import starts
from penink_cli.blasting.joining import joined
from penink_cli.blasting.level_lines import LevelLines

SPACING = 1.5


def lines(*each, ring=()):
    points = [np.asarray(line, float) for line in each]
    return LevelLines(
        np.concatenate(points), starts(np.array([len(line) for line in points])),
        np.array([i in ring for i in range(len(points))]),
    )  # fmt: skip


def level(y, begin, end):
    step = 1 if end > begin else -1
    return np.column_stack([np.arange(begin, end, step), np.full(abs(end - begin), y)])


def rows(count=5):
    return [level(SPACING * k, 0, 80) for k in range(count)]


def test_two_ends_a_little_aside_are_one_line_whichever_way_they_run():
    for other in (level(3.4, 44, 80), level(3.4, 79, 43)):
        each = rows()
        each[2] = level(3.0, 0, 40)
        out = joined(lines(*each, other), SPACING)
        assert len(out.ring) == 5
        points = out.points[out.first[2] : out.first[3]]
        step = np.diff(points, axis=0)
        assert sorted(points[[0, -1], 0]) == [0, 79]
        assert np.hypot(*step.T).min() > 0.5 and np.hypot(*step.T).max() < 1.5
        assert np.abs(step[:, 1]).max() < 0.2  # by and by


def test_ends_that_overlap_give_back_what_is_doubled():
    each = rows()
    each[2] = level(2.7, 0, 42)
    out = joined(lines(*each, level(3.3, 38, 80)), SPACING)
    assert len(out.ring) == 5
    x = out.points[out.first[2] : out.first[3], 0]
    assert (np.diff(x) > 0).all()


def test_no_line_is_crossed():
    """One ends below a line and the other begins above it."""
    each = rows()
    each[1] = level(1.5, 0, 40)
    bent = level(3.0, 0, 80)
    bent[:, 1] -= 1.5 * np.clip((bent[:, 0] - 37) / 6, 0, 1)
    each[2] = bent
    out = joined(lines(*each, level(3.0, 43, 80)), SPACING)
    assert len(out.ring) == 6


def test_what_lies_far_off_or_askew_stays_apart_and_rings_stay_rings():
    for other in (level(3.0, 60, 80), np.column_stack([np.linspace(41, 60, 20), np.linspace(3, 22, 20)])):
        each = rows()
        each[2] = level(3.0, 0, 40)
        assert len(joined(lines(*each, other), SPACING).ring) == 6
    turn = np.linspace(0, 2 * np.pi, 60)
    ring = np.column_stack([np.cos(turn), np.sin(turn)]) * 9
    out = joined(lines(ring, ring * 1.15, ring=(0, 1)), SPACING)
    assert out.ring.all() and len(out.points) == 120
    nothing = LevelLines(np.zeros((0, 2)), np.zeros(1, np.int64), np.zeros(0, bool))
    assert len(joined(nothing, SPACING).ring) == 0
