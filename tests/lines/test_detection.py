"""Telling lines found in pictures whose lines are known."""

from __future__ import annotations

import numpy as np
import pytest
import skimage.data

from penink_cli.formats import lines as lines_format
from penink_cli.ground.model import Directions, Lines
from penink_cli.lines import oriented
from penink_cli.lines._compiled import oriented as kernel
from penink_cli.lines.detection import detect_lines
from tests.formats.readers import written

SIZE = 200


def picture(*strokes: tuple[tuple[float, float], tuple[float, float]], width: float = 2.0, ground: float = 0.9):
    """Dark lines of that width (pixels) on light ground, softly sampled."""
    y, x = np.mgrid[:SIZE, :SIZE] + 0.5
    ink = np.zeros((SIZE, SIZE))
    for (ax, ay), (bx, by) in strokes:
        dx, dy = bx - ax, by - ay
        t = np.clip(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy), 0, 1)
        ink = np.maximum(ink, np.clip(width / 2 + 0.5 - np.hypot(x - ax - t * dx, y - ay - t * dy), 0, 1))
    return (ground - 0.7 * ink).astype(np.float32)


def off(lines: Lines, i: int, a: tuple[float, float], b: tuple[float, float]) -> float:
    """How far line i strays from the straight one through a and b, but for its tips."""
    d = np.array(b) - a
    n = np.array([-d[1], d[0]]) / np.hypot(*d)
    return float(np.percentile(np.abs((lines[i] - a) @ n), 95))


@pytest.mark.parametrize("angle", [0, 7.5, 22, 45, 61, 90, 133, 170])
def test_a_line_is_found_where_it_is_from_end_to_end(angle):
    d = 70 * np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    a, b = tuple(100.3 - d), tuple(100.3 + d)
    lines = detect_lines(picture((a, b)), white=False)
    assert lines.rank[0] > 2 and (lines.rank[1:] < 0.4 * lines.rank[0]).all()
    assert off(lines, 0, a, b) < 0.5
    assert np.hypot(*(lines[0][-1] - lines[0][0])) == pytest.approx(140, abs=8)


def test_lines_cross():
    ends = [((20, 30), (180, 160)), ((30, 170), (170, 25))]
    lines = detect_lines(picture(*ends), white=False)
    for a, b in ends:
        best = min(range(2), key=lambda i: off(lines, i, a, b))
        assert off(lines, best, a, b) < 0.7
        assert np.hypot(*(lines[best][-1] - lines[best][0])) > 0.9 * np.hypot(*(np.array(b) - a))


def test_light_lines_on_dark_ground_are_white_and_edges_are_not():
    grey = 1 - picture(((20, 100), (180, 110)))
    lines = detect_lines(grey, black=False)
    assert len(lines) and lines.white.all() and off(lines, 0, (20, 100), (180, 110)) < 0.5
    step = np.where(np.arange(SIZE) < 90, 0.2, 0.8)[None, :].repeat(SIZE, axis=0).astype(np.float32)
    assert not len(detect_lines(step, black=False))
    assert not detect_lines(1 - grey, white=False).white.any()


@pytest.mark.parametrize("diameter", [3, 5, 8, 11])
def test_a_dark_disc_is_a_spot_of_its_size_and_nothing_else(diameter):
    """A pupil, with a catchlight, is no tick and no ring."""
    y, x = np.mgrid[: 4 * SIZE, : 4 * SIZE] / 4 + 1 / 8
    grey = np.where(np.hypot(x - 101, y - 98) < diameter / 2, 0.1, 0.8)
    if diameter > 6:
        grey[np.hypot(x - 100, y - 97) < 0.8] = 0.9
    grey = grey.reshape(SIZE, 4, SIZE, 4).mean(axis=(1, 3)).astype(np.float32)
    lines = detect_lines(grey, white=False)
    spots = np.flatnonzero(lines.breadth > 0)
    assert spots.tolist() == [0]
    assert np.hypot(*(lines[0][0] - (101, 98))) < 0.6
    assert lines.breadth[0] == pytest.approx(diameter, abs=1.0)
    assert (lines.rank[1:] < 0.8).all()


@pytest.mark.parametrize("grey", [np.full((60, 80), 0.5), np.zeros((1, 1)), np.ones((1, 40)), np.zeros((3, 2))])
def test_even_ground_has_no_lines(grey):
    lines = detect_lines(grey.astype(np.float32))
    assert len(lines) == 0 and (lines.width, lines.height) == grey.shape[::-1]


@pytest.mark.parametrize("noise", [0.01, 0.03])
def test_noise_has_hardly_any_lines(noise):
    """Skies have grain; no line of usual rank may come of it."""
    grey = np.random.default_rng(5).normal(0.7, noise, (400, 500)).astype(np.float32)
    lines = detect_lines(grey)
    assert np.count_nonzero(lines.rank >= 0.8) <= 3


def test_faint_lines_across_the_field_are_left_away():
    """Short faint lines stay where they run along the field that is given, and go where they run across it."""
    grey = np.full((SIZE, SIZE), 0.5, np.float32)
    for y in range(20, 190, 24):
        grey = np.minimum(grey, 0.5 - 0.1 * (0.9 - picture(((60, y), (95, y)), width=3)))

    def ranks(cos2: float) -> float:
        def field(rows: int, columns: int) -> Directions:
            ones = np.ones((rows, columns))
            return Directions(cos2 * ones, 0 * ones, ones)

        return float(np.sum(detect_lines(grey, white=False, directions=field).rank))

    assert ranks(1) > 0.5 and ranks(-1) < 0.5 * ranks(1)


def test_threads_change_nothing_and_what_is_found_is_written_as_it_is():
    grey = skimage.data.coins().astype(np.float32) / 255
    data = [written(lines_format.write, detect_lines(grey, threads=n)) for n in (1, 3)]
    assert data[0] == data[1]


def test_the_list_is_of_the_picture_and_not_of_its_pixels():
    """Twice the pixels, the same lines."""
    grey = skimage.data.astronaut()[:, :, 1].astype(np.float32) / 255
    twice = np.kron(grey, np.ones((2, 2), np.float32))
    small, large = (detect_lines(photo, white=False) for photo in (grey, twice))
    assert large.width == 2 * small.width
    strong = [lines.points[np.repeat(lines.rank > 2, np.diff(lines.first))] for lines in (small, large)]
    away = np.array([np.hypot(*(strong[1] / 2 - p).T).min() for p in strong[0]])
    assert np.percentile(away, 90) < 3


def test_even_ground_answers_with_nothing_in_every_direction():
    bank = oriented.responses(np.full((20, 30), 0.7, np.float32), 0.75, 2.0, 1)
    assert bank.shape == (oriented.DIRECTIONS, 20, 30) and np.abs(bank).max() < 1e-6


def test_wider_vectors_change_no_byte():
    picture = np.random.default_rng(3).random((20, 91)).astype(np.float32)  # wide enough for all loops
    banks = []
    for lanes in (16, 32):
        kernel.take_lanes(lanes)
        banks.append(oriented.responses(picture, 0.75, 2.0, 1).tobytes())
    assert banks[0] == banks[1]


def test_a_line_answers_most_in_its_own_direction():
    """Filters are numbered from x towards y, as all angles are."""
    for k in (0, 5, 12, 19):
        angle = np.pi * k / oriented.DIRECTIONS
        d = 90 * np.array([np.cos(angle), np.sin(angle)])
        bank = oriented.responses(picture((tuple(100 - d), tuple(100 + d))), 0.75, 2.0, 1)
        assert int(np.argmax(bank[:, 98:102, 98:102].max(axis=(1, 2)))) == k


def test_a_line_on_light_ground_is_finer():
    grey = np.full((300, 400), 0.95)
    grey[:, 200:] = 0.45
    for x in (100, 300):  # as much darker than the ground
        grey[40:260, x - 1 : x + 2] -= 0.3
    lines = detect_lines(grey, white=False)
    weight = {}
    for i in range(len(lines)):
        points = lines[i]
        if np.ptp(points[:, 1]) > 150:
            weight[round(float(points[:, 0].mean()), -2)] = lines.weight[lines.first[i] : lines.first[i + 1]].mean()
    assert 0 < weight[100] < 0.6 * weight[300]
