"""The sheet: ink is counted exactly once, as a slow oracle counts it, and what is due follows."""

import gc
import weakref
from itertools import pairwise

import numpy as np
import pytest

from penink_cli.blasting._compiled import due
from penink_cli.blasting.curves import Polylines
from penink_cli.blasting.low_pass import LowPass
from penink_cli.blasting.sheet import CELL_PT, Sheet, Terms, halve, resample
from penink_cli.ground.device import widened
from penink_cli.ground.model import Strokes


def oracle(points, width, sheet):
    """Subpixels whose centre is within half the width of the polyline."""
    h, w = sheet.rows * 8, sheet.columns * 8
    y, x = np.mgrid[:h, :w] + 0.5
    p = points * sheet.scale
    inked = np.zeros((h, w), bool)
    for a, b in pairwise(p):
        d = b - a
        t = np.clip(((x - a[0]) * d[0] + (y - a[1]) * d[1]) / max(d @ d, 1e-12), 0, 1)
        inked |= np.hypot(x - a[0] - t * d[0], y - a[1] - t * d[1]) < width * sheet.pitch / 2
    return inked


@pytest.mark.parametrize("seed", range(12))
def test_painting_counts_what_the_oracle_counts(seed):
    rng = np.random.default_rng(seed)
    side = 20 * CELL_PT
    sheet = Sheet(np.zeros((2, 2)), side, side, 0.0)
    points = rng.uniform(-3, side + 3, (2, 2))
    if seed % 4 == 0:
        points[1, seed % 8 // 4] = points[0, seed % 8 // 4]  # along a row or a column
    width = rng.uniform(0.3, 4)
    fresh = sheet.newly_inked(Polylines(points, np.array([0, 2])), np.array([width]))
    wanted = oracle(points, width, sheet)
    assert abs(int(fresh[0]) - int(wanted.sum())) <= 0.002 * wanted.sum() + 6
    assert round(float(sheet.ink.sum()) * 64) == fresh[0]
    again = sheet.newly_inked(Polylines(points, np.array([0, 2])), np.array([width]))
    assert again[0] == 0


def test_a_device_widens_a_stroke_by_its_pixels():
    sheet = Sheet(np.zeros((2, 2)), 200, 200, 0.24)
    rng = np.random.default_rng(0)
    for angle in (0.0, 44.0):
        along = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
        areas = []
        for start in rng.uniform(20, 40, (40, 2)):
            sheet.clear()
            ink = sheet.newly_inked(Polylines(np.array([start, start + 120 * along]), np.array([0, 2])), np.ones(1))
            areas.append(ink[0] / sheet.pitch**2)
        width = 1 + 0.24 * np.abs(along).sum()
        assert abs(np.mean(areas) - 120 * width - np.pi / 4 * width**2) < 1.5


def test_what_is_due_is_kept_up_to_date():
    rng = np.random.default_rng(3)
    sheet = Sheet(np.full((4, 4), 0.5), 80, 80, 0.12)
    sheet.owe(sheet.tone)
    lines = Polylines(rng.uniform(5, 75, (40, 1, 2)).repeat(30, 1).reshape(-1, 2), np.arange(41) * 30)
    lines = Polylines(lines.points + np.tile(np.linspace(-10, 10, 30), 40)[:, None], lines.first)
    sheet.place(lines, np.full(40, 0.5), [np.arange(40)], Terms())
    kept = sheet.residual.copy()
    sheet.owe(sheet.tone)
    assert np.abs(kept - sheet.residual).max() < 0.04
    assert sheet.residual.mean() < 0.49


@pytest.mark.parametrize("shape", [(1, 1), (5, 33), (70, 50), (40, 16)])
@pytest.mark.parametrize("sigma", [2.03, 2.6])
def test_the_low_pass_stops_at_steps_as_the_oracle_does(shape, sigma):
    rng = np.random.default_rng(shape[0])
    values = rng.random(shape, np.float32)
    guide = np.zeros(shape, np.float32)
    guide[:, shape[1] // 2 :] = 1.0
    guide += rng.random(shape, np.float32) * np.float32(0.3 if shape[0] < 50 else 0.1)
    rows, columns = shape
    low_pass = LowPass(sigma, guide, 0.25, 1)
    radius = len(low_pass.kernel) // 2
    wanted = np.zeros(shape)
    for y in range(rows):
        for x in range(columns):
            for i in range(max(0, y - radius), min(rows, y + radius + 1)):
                for j in range(max(0, x - radius), min(columns, x + radius + 1)):
                    if abs(guide[i, j] - guide[y, x]) < 0.25:
                        wanted[y, x] += low_pass.kernel[i - y + radius, j - x + radius] * values[i, j]
    assert np.abs(low_pass(values) - wanted).max() < 1e-5


@pytest.mark.parametrize("shape", [(12, 9), (4, 9), (12, 3), (5, 4), (25, 30), (1, 1)])
@pytest.mark.parametrize("number", [np.float32, np.float64])
def test_values_are_stretched_by_means_and_between_middles(shape, number):
    """Each axis by itself: a matrix of how much of each value is in each cell, or between which middles it is."""
    values = np.random.default_rng(4).random((12, 9)).astype(number) * 2 - 1

    def matrix(have: int, n: int) -> np.ndarray:
        if n <= have:  # the overlap of cells with values
            begin, end = (np.arange(n)[:, None] + k for k in (0, 1))
            overlap = np.minimum(end * have / n, np.arange(1, have + 1)) - np.maximum(begin * have / n, np.arange(have))
            return np.maximum(overlap, 0) * n / have
        middles = np.clip((np.arange(n) + 0.5) * have / n - 0.5, 0, have - 1)
        return np.maximum(0, 1 - np.abs(middles[:, None] - np.arange(have)))

    wanted = matrix(12, shape[0]) @ values.astype(float) @ matrix(9, shape[1]).T
    assert np.abs(resample(values, *shape, least=-1.0) - wanted).max() < 1e-12
    assert (resample(np.full((12, 9), 1.0, number), *shape) <= 1.0).all()


def test_wider_vectors_change_no_byte():
    """The low-pass, and strokes that are tried and drawn; the same by vectors that every processor has."""
    tone = np.random.default_rng(1).random((60, 90)) * 0.7
    tone[:, :40] = 0.1
    results = []
    for lanes in (16, 32):
        due.take_lanes(lanes)
        sheet = Sheet(tone, 90 * CELL_PT, 60 * CELL_PT, 0.0)
        sheet.owe(sheet.tone)
        along = np.linspace(0, 1, 60)[:, None]
        points = np.concatenate([(3, 3) + along * (70, 45), (80, 2) + along * (-60, 50)])
        lines = Polylines(points, np.array([0, 60, 120]))
        runs, moved = sheet.place(lines, np.array([1.0, 1.5]), [np.arange(2)], Terms())
        results.append((sheet.residual.tobytes(), runs.tolist(), moved.tolist()))
    assert results[0] == results[1] and len(results[0][1]) > 1


def test_no_ink_is_credited_across_a_strong_step():
    tone = np.zeros((40, 40))
    tone[:, 20:] = 1.0
    sheet = Sheet(tone, 40 * CELL_PT, 40 * CELL_PT, 0.0)
    sheet.owe(sheet.tone)
    assert np.abs(sheet.residual[:, :20]).max() < 1e-6
    line = np.array([[21.0, 0.0], [21.0, 40]]) * CELL_PT
    runs, _ = sheet.place(Polylines(line, np.array([0, 2])), np.array([1.0]), [np.arange(1)], Terms(whole=True))
    assert len(runs) == 1 and sheet.residual[:, 21].max() < 0.9
    assert np.abs(sheet.residual[:, :20]).max() < 1e-6


@pytest.mark.parametrize("shape", [(1, 1), (3, 7), (100, 90), (33, 64)])
def test_resampling_keeps_the_mean_of_what_it_shrinks(shape):
    tone = np.random.default_rng(0).random(shape)
    for rows, columns in ((1, 1), (5, 3), (33, 64), (200, 150)):
        out = resample(tone, rows, columns)
        assert out.shape == (rows, columns) and out.min() >= 0 and out.max() <= 1
        if rows <= shape[0] and columns <= shape[1]:
            assert abs(out.mean() - tone.mean()) < 1e-9


def test_halving_repeats_an_odd_row():
    assert halve(np.array([[1.0, 3.0, 5.0]], np.float32)).tolist() == [[2.0, 5.0]]


@pytest.mark.parametrize("gain", [0.0, 0.12])
def test_strokes_that_swell_ink_what_their_outlines_hold(gain):
    """Against the outlines that outputs fill, wider by what a device adds."""
    from penink_cli.outputs.page import lay_out
    from penink_cli.outputs.raster import cover

    rng = np.random.default_rng(4)
    points, widths = [], []
    for y in np.arange(10, 180, 6.0):
        x = np.arange(10.0, 181.0, 2.0)
        wave = np.column_stack([x, y + 2 * np.sin(x / 15 + y)])
        knots = wave[::3]
        widths.append(np.clip(rng.normal(1.2, 0.6, len(knots)), 0.1, 3))
        points.append(wave[: 3 * (len(knots) - 1) + 1])
    first = np.cumsum([0, *map(len, points)])
    strokes = Strokes(192, 192, np.concatenate(points), first, np.ones(len(points))).swelling(np.concatenate(widths))
    sheet = Sheet(np.full((8, 8), 0.5), 192, 192, gain)
    sheet.swell(strokes)
    wider = widened(strokes, 72 / gain) if gain else strokes
    page = np.concatenate(list(cover.bands([wider], lay_out([wider]), 300, 255)))
    assert abs(sheet.ink.mean() - (1 - page.mean() / 255)) < 0.001


def test_a_sheet_is_gone_when_nobody_holds_it():
    """Without a search for circles, of which a drawing makes hardly any."""
    gc.disable()
    try:
        sheet = Sheet(np.full((30, 30), 0.5), 30.0, 30.0, 0.1, 2)
        sheet.owe(sheet.tone)
        held = weakref.ref(sheet)
        del sheet
        assert held() is None
    finally:
        gc.enable()
