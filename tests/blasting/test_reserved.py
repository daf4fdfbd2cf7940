"""White lines in the black: true in tone, along the field, long, closed by black, and none where it is black."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter, label

from penink_cli.blasting import bordered, curves
from penink_cli.blasting.blast import blast
from penink_cli.blasting.gaps import Gaps
from penink_cli.blasting.sheet import coverage
from penink_cli.blasting.solids import PEN_PT
from penink_cli.ground.model import Strokes
from penink_cli.options.textures import find_texture
from tests.blasting import measures
from tests.blasting.test_form import field, waves

SIDE = 216.0


def coat(tone: float) -> np.ndarray:
    """Tone (432, 432) of a dark thing with an outline, on light ground; it reaches three sides of the frame."""
    y, x = (np.mgrid[:432, :432] + 0.5) / 432 * 2 - 1
    return np.where(y > 0.3 * np.cos(3 * x) - 0.4, tone, 0.2)


@pytest.fixture(scope="module")
def drawn() -> Strokes:
    return blast(coat(0.93), SIDE, SIDE, None, find_texture("form"), directions=field(waves))


def whites(strokes: Strokes) -> np.ndarray:
    """What is bare inside the coat, 16 subpixels a point, as a 600 dpi printer leaves it."""
    bare = coverage(strokes, int(16 * SIDE), int(16 * SIDE), 72 / 600 * 1.25) == 0
    inner = np.kron(coat(1.0), np.ones((8, 8))) == 1
    edge = 48
    inner = gaussian_filter(inner.astype(np.float32), 12) > 0.999
    inner[-edge:] = inner[:, :edge] = inner[:, -edge:] = False
    return bare & inner


@pytest.mark.parametrize("tone", [0.87, 0.93, 0.96])
@pytest.mark.parametrize("pen", [None, 0.85])
def test_the_tone_of_the_dark_is_true(tone, pen) -> None:
    wanted = coat(tone)
    strokes = blast(wanted, SIDE, SIDE, None, find_texture("form"), directions=field(waves), pen_pt=pen)
    error = measures.tone_error(strokes, wanted)[150:280, 20:280]  # well inside
    assert abs(error.mean()) < 0.5 and np.sqrt((error * error).mean()) < 1.0


def test_the_dark_is_black_with_long_white_lines_along_the_field(drawn) -> None:
    parts, count = label(whites(drawn), np.ones((3, 3)))
    assert count > 10
    long = 0
    for k in range(1, count + 1):
        y, x = np.nonzero(parts == k)
        if np.hypot(np.ptp(x), np.ptp(y)) > 9 * 16:
            long += len(x)
            # about as thin everywhere
            assert len(x) / np.hypot(np.ptp(x), np.ptp(y)) < 0.7 * 16
    assert long > 0.9 * (parts > 0).sum()


def test_what_is_quite_black_has_none() -> None:
    strokes = blast(coat(0.995), SIDE, SIDE, None, find_texture("form"), directions=field(waves))
    assert whites(strokes).sum() == 0


def test_a_dark_without_an_outline_is_hatched() -> None:
    """Its border would be that of nothing in the picture."""
    y = (np.mgrid[:432, :432][0] + 0.5) / 432
    strokes = blast(0.5 + 0.4 * y, SIDE, SIDE, None, find_texture("form"), directions=field(waves))
    assert (strokes.widths == PEN_PT).mean() < 0.1
    strokes = blast(coat(0.88), SIDE, SIDE, None, find_texture("form"), directions=field(waves))
    assert (strokes.widths == PEN_PT).mean() > 0.5


def test_a_lighter_part_of_a_dark_thing_is_drawn_as_the_rest() -> None:
    """A coat with a fold of .7, which is a third of it: lines in the black, not a net of crossed ones beside it."""
    x = np.linspace(-1, 1, 432)[None]
    fold = gaussian_filter(np.where(np.abs(x) < 0.3, 0.7, 0.92) * np.ones((432, 1)), 20)
    tone = np.where(coat(1.0) == 1, fold, 0.2)
    strokes = blast(tone, SIDE, SIDE, None, find_texture("form"), directions=field(waves))
    bare = whites(strokes)[:, 1360:2096]
    parts = label(bare, np.ones((3, 3)))[0]
    sizes = np.bincount(parts.ravel())[1:]
    assert sizes[sizes > 16 * 12 * 4].sum() > 0.9 * sizes.sum()  # of lines of over 12 pt, where a net leaves flecks


@pytest.mark.parametrize("tone", [0.85, 0.92])
def test_narrow_things_are_hatched(tone) -> None:
    """An eyelid, a cat's nose: white lines across a narrow thing would be the stripes of a zebra."""
    x, y = np.arange(432), np.arange(432)[:, None]
    wanted = np.where(np.abs(y - 200 - 20 * np.sin(x / 60)) < 12, tone, 0.2)
    strokes = blast(wanted, SIDE, SIDE, None, find_texture("form"), directions=field(waves))
    assert (strokes.widths == PEN_PT).mean() < 0.1


def test_nothing_leaves_the_frame(drawn) -> None:
    for i, width in enumerate(drawn.widths.tolist()):
        line = measures.flattened(drawn, i)
        assert line.min() - width / 2 > -0.05 and line.max() + width / 2 < SIDE + 0.05


def test_threads_change_nothing(drawn) -> None:
    again = blast(coat(0.93), SIDE, SIDE, None, find_texture("form"), directions=field(waves), threads=3)
    assert np.array_equal(again.points, drawn.points) and np.array_equal(again.widths, drawn.widths)


@pytest.mark.parametrize("gain", [0.0, 0.15])
def test_a_gap_is_as_wide_as_it_says_and_closed(gain) -> None:
    """One that bends, tapers, and is painted by a device that widens strokes."""
    t = np.linspace(0, 1, 41)
    points = np.column_stack([20 + 40 * t, 40 + 6 * np.sin(4 * t)])
    half = 0.25 * np.minimum(np.minimum(t, 1 - t) * 8, 1)
    gaps = Gaps(curves.Polylines(points, np.array([0, len(points)])), half)
    chains, widths = [], []
    tone = np.zeros((160, 160), np.float32)
    tone[20:140, 20:140] = 1.0
    bordered.fill(tone, np.array([0.5, 0.5]), 0.35, gain, chains, widths, False, gaps)
    ink = coverage(Strokes.of(80, 80, chains, widths), 80 * 24, 80 * 24, gain)[24 * 12 : 24 * 68, 24 * 12 : 24 * 68]
    parts, count = label(ink == 0, np.ones((3, 3)))
    assert sorted(np.bincount(parts.ravel())[1:])[:-1] <= [4] * (count - 1)  # the points of its ends
    area = (1 - ink).sum() / 24**2
    legs = np.hypot(*np.diff(points, axis=0).T)
    assert area == pytest.approx(((half[1:] + half[:-1]) * legs).sum(), rel=0.12)


def test_gaps_know_their_direction() -> None:
    points = np.array([[0.0, 0], [3, 4], [6, 8], [9, 0], [6, -4]])
    gaps = Gaps(curves.Polylines(points, np.array([0, 3, 5])), np.full(5, 0.1))
    c, s = gaps.direction()
    # the second one lies askew to the first and is half as long
    doubled = np.array([2 * (9 - 16) + 9 - 16, 2 * 24 + 24.0])
    assert np.array([c * c - s * s, 2 * c * s]) == pytest.approx(doubled / np.hypot(*doubled))
