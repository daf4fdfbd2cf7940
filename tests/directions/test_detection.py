"""Finding the directions of a picture: by its tones, at its edges, by the user's strokes."""

from __future__ import annotations

import io

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from penink_cli.arrangement.detection import detect_edges
from penink_cli.directions.detection import detect_directions
from penink_cli.directions.polylines import WeightedLines, crossed, of_lines, of_strokes
from penink_cli.directions.reading import at_size
from penink_cli.directions.solving import singular, solved
from penink_cli.formats import directions
from penink_cli.ground.model import ColourImage, Directions, EdgeList, GreyImage, Lines, Strokes
from tests.directions.test_reading import apart, degrees_of
from tests.formats.readers import written


def grey(values: np.ndarray) -> GreyImage:
    return GreyImage(np.rint(255 * np.clip(values, 0, 1)).astype(np.uint8))


def places(height: int, width: int) -> tuple[np.ndarray, np.ndarray]:
    """x and y of each pixel from the picture's middle."""
    y, x = np.mgrid[:height, :width] + 0.5
    return x - width / 2, y - height / 2


def tangent(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return np.rad2deg(np.arctan2(x, -y))


def at_samples(field: Directions, values: np.ndarray) -> np.ndarray:
    """Values of a picture (h, w) at the samples of a field."""
    rows, columns = field.cos2.shape
    return values[
        np.ix_(
            ((np.arange(rows) + 0.5) * values.shape[0] / rows).astype(int),
            ((np.arange(columns) + 0.5) * values.shape[1] / columns).astype(int),
        )
    ]


def test_the_field_of_a_ringed_picture_runs_round():
    """Within 6° in the mean: rings that fade, as those of a pond do, and noise as a camera's."""
    x, y = places(360, 480)
    r = np.hypot(x, y)
    noise = np.random.default_rng(1).normal(0, 0.02, r.shape)
    photo = grey(0.5 + 0.3 * np.cos(r / 4) * np.exp(-r / 300) + noise)
    field = detect_directions(photo, detect_edges(photo.grey))
    off = apart(degrees_of(field), at_samples(field, tangent(x, y)))
    inside = (at_samples(field, r) > 20) & (at_samples(field, np.maximum(abs(x) - 230, abs(y) - 170)) < 0)
    assert off[inside].mean() < 5


@pytest.mark.parametrize("degrees", [0, 30, 45, 90, 120, 170])
def test_stripes_give_their_own_angle(degrees):
    x, y = places(200, 300)
    a = np.deg2rad(degrees)
    field = detect_directions(grey(0.5 + 0.2 * np.sin((x * np.sin(a) - y * np.cos(a)) / 3)), follow=0.9)
    assert apart(degrees_of(field)[8:-8, 8:-8], degrees).max() < 2
    turned = detect_directions(grey(0.5 + 0.2 * np.sin((x * np.sin(a) - y * np.cos(a)) / 3)), follow=0.9, across=True)
    assert apart(degrees_of(turned)[8:-8, 8:-8], degrees + 90).max() < 2


def test_colour_alone_is_form_enough():
    """Red and green stripes of the same lightness: nothing of them is left in grey."""
    x, _ = places(200, 200)
    part = (0.5 + 0.5 * np.sin(x / 4))[..., None]
    colours = part * [200, 80, 90] + (1 - part) * [60, 133, 90]
    photo = ColourImage(np.rint(colours).astype(np.uint8))
    assert apart(degrees_of(detect_directions(photo))[8:-8, 8:-8], 90).max() < 5


def test_two_stripes_beside_an_edge_keep_their_angles():
    """At every size within 12° up to one sample from the edge, at 6° in the mean."""
    x, y = places(240, 320)
    side = x - 0.2 * y > 0
    photo = grey(np.where(side, 0.75 + 0.1 * np.sin(y / 3), 0.25 + 0.1 * np.sin((x + y) / 4)))
    edge = EdgeList(320, 240, np.array([[136.0, 0.0], [184.0, 240.0]]), np.array([[0, 1]]), np.array([0.5]))
    field = detect_directions(photo, edge, follow=0.9)
    for rows in (60, 240):
        found = degrees_of(at_size(field, edge, rows, rows * 4 // 3))
        far = at_samples(at_size(field, None, rows, rows * 4 // 3), (x - 0.2 * y) / np.hypot(1, 0.2) / (320 / 96))
        inner = at_samples(at_size(field, None, rows, rows * 4 // 3), np.maximum(abs(x) - 140, abs(y) - 100)) < 0
        for beside, angle in ((far > 1, 0), (far < -1, -45)):
            off = apart(found[beside & inner], angle)
            assert off.max() < 12 and off.mean() < 3


def test_where_nothing_is_known_strokes_keep_the_angle_and_nothing_is_sure():
    for flat in (GreyImage(np.full((40, 60), 90, np.uint8)), GreyImage(np.zeros((1, 1), np.uint8))):
        field = detect_directions(flat, angle=20)
        assert apart(degrees_of(field), 20).max() < 1e-6
        assert (field.confidence == 1 / 254).all()
        assert directions.read(io.BytesIO(written(directions.write, field)), "d", 10**6).confidence.max() == 1 / 254


def test_follow_goes_from_the_angle_to_the_form():
    x, y = places(150, 200)
    photo = grey(0.5 + 0.2 * np.sin(y / 3 + x / 90))
    off = [apart(degrees_of(detect_directions(photo, follow=f)), -45).mean() for f in (0, 0.2, 0.5, 0.8, 1)]
    assert off[0] < 0.01 and off[-1] > 35 and off == sorted(off)


def test_the_sky_is_not_dragged_round_a_head():
    """A dark disc on an even ground: strokes outside keep the hatch's angle, those within are rounded."""
    x, y = places(300, 400)
    disc = np.hypot(x, y) < 90
    shaded = np.where(disc, 0.45 - 0.002 * (x + y), 0.9)
    photo = grey(gaussian_filter(shaded, 0.7))
    edges = detect_edges(photo.grey)
    field = detect_directions(photo, edges)
    away = at_samples(field, np.hypot(x, y))
    assert apart(degrees_of(field), -45)[(away > 100) & (away < 140)].mean() < 12


def test_strokes_of_the_user_count_whatever_the_photo_says():
    photo = grey(0.5 + 0.3 * np.sin(places(240, 320)[1] / 3))
    along_y = Strokes.of(32, 24, [[[8, 2], [8, 9], [8, 16], [8, 22]]], [0.4])
    field = detect_directions(photo, strokes=along_y)
    angle = degrees_of(field)
    assert apart(angle[20:50, 24], 90).max() < 12 and apart(angle[20:50, 70:88], 0).max() < 5
    assert field.confidence[36, 24] == 1
    empty = Strokes(32, 24)
    assert np.array_equal(detect_directions(photo, strokes=empty).cos2, detect_directions(photo).cos2)


def test_telling_lines_are_evidence():
    flat = GreyImage(np.full((240, 320), 200, np.uint8))
    points = np.array([[40.0, 60.0], [280.0, 60.0], [160.0, 200.0]])
    lines = Lines(
        320, 240, points, np.array([0, 2, 3]), np.array([1.0, 1.0, 0.5]), np.array([5.0, 1.0]), np.zeros(2, bool),
        np.array([0.0, 4.0]),
    )  # fmt: skip
    angle = degrees_of(detect_directions(flat, lines=lines, follow=0.8))
    assert apart(angle[18, 20:75], 0).max() < 15 and apart(angle[60:], -45).max() < 8


def test_lengths_and_angles_of_polylines_by_cell():
    points = np.array([[0, 0], [0.5, 0.5], [0.5, 2], [0.25, 0.1], [0.75, 0.1]])
    vectors, length = crossed(WeightedLines(points, np.array([0, 3, 5]), np.ones(5)), 8, 8)
    assert length.sum() == pytest.approx(4 * np.sqrt(2) + 4 + 4)  # what lies outside is not counted
    assert vectors[1, 1] == pytest.approx([0, np.sqrt(2)], abs=0.1) and vectors[6, 4] == pytest.approx([-1, 0])
    assert vectors[0, 3] == pytest.approx([1, 0])


def test_strokes_become_polylines_in_parts_of_the_sheet():
    chains = [[0, 0], [20, 0], [40, 0], [60, 0]], [[9, 9]], np.arange(14.0).reshape(7, 2)
    strokes = Strokes.of(200, 100, chains, [1, 1, 1])
    found = of_strokes(strokes)
    assert found.first.tolist() == [0, 9, 10, 27]
    assert found.points[8] == pytest.approx([0.3, 0]) and found.points[9] == pytest.approx([0.045, 0.09])
    assert found.points[26] == pytest.approx([0.06, 0.13])
    assert len(of_lines(Lines(10, 10)).points) == 0


def test_knots_are_found_and_calmed():
    y, x = np.mgrid[:20, :30] - [[[9.5]], [[14.5]]]
    whole = np.stack([y * y - x * x, -2 * x * y], axis=-1) / (x * x + y * y)[..., None]  # rings: it turns twice round
    uncut = np.zeros((20, 30)), np.zeros((20, 30))
    half = np.stack([x, y], axis=-1) / np.hypot(x, y)[..., None]
    assert np.argwhere(singular(half, uncut)).tolist() == [[9, 14]]
    assert np.argwhere(singular(-half[:, ::-1], uncut)).tolist() == [[9, 14]]
    assert not singular(half, (np.ones((20, 30)), np.ones((20, 30)))).any()
    assert not singular(whole * 0 + [1, 0], uncut).any()
    rng = np.random.default_rng(5)
    wild = rng.normal(0, 1, (40, 60, 2))
    nothing = np.zeros((40, 60), bool)
    uncut = np.zeros((40, 60)), np.zeros((40, 60))
    calm, _ = solved(3 * wild, np.full((40, 60), 3.0), nothing, uncut, (1, 0), 0.05)
    fixed, _ = solved(3 * wild, np.full((40, 60), 3.0), ~nothing, uncut, (1, 0), 0.05)
    assert singular(calm, uncut).sum() < singular(fixed, uncut).sum() / 3


def test_the_solve_is_that_of_a_dense_one():
    rng = np.random.default_rng(3)
    h, w = 7, 9
    vectors, weight, cut = rng.normal(0, 1, (h, w, 2)), rng.uniform(0, 1, (h, w)), rng.uniform(0, 1, (2, h, w)) < 0.2
    x, part = solved(vectors, weight, np.ones((h, w), bool), (cut[0] * 1.0, cut[1] * 1.0), (0.6, 0.8), 0.1)
    matrix = np.diag((0.3 * weight + 0.1).ravel())
    number = np.arange(h * w).reshape(h, w)
    pairs = zip(
        [*number[:, :-1].ravel(), *number[:-1].ravel()],
        [*number[:, 1:].ravel(), *number[1:].ravel()],
        [*cut[0][:, :-1].ravel(), *cut[1][:-1].ravel()],
        strict=True,
    )
    for a, b, parted in pairs:
        link = 5e-4 if parted else 5.0
        matrix[[a, b], [a, b]] += link
        matrix[[a, b], [b, a]] -= link
    said = np.linalg.solve(matrix, vectors.reshape(-1, 2))
    own = np.linalg.solve(matrix, np.full(h * w, 0.1))
    assert np.abs(x.reshape(-1, 2) - said - own[:, None] * [0.6, 0.8]).max() < 1e-4
    assert np.abs(part.ravel() - np.hypot(*said.T) / (np.hypot(*said.T) + own)).max() < 1e-3


def test_a_field_is_small_and_the_same_every_time(penink, tmp_path, photographs):
    photo, edges, drawing = photographs("chelsea"), tmp_path / "e.json", tmp_path / "own.svg"
    assert not penink("detect-edges", photo, "-o", edges).returncode
    drawing.write_text('<svg viewBox="0 0 451 300" xmlns="http://www.w3.org/2000/svg"><path d="M9 9L400 20"/></svg>')
    call = ("detect-directions", "-e", edges, "--strokes", drawing, photo)
    first, second = penink(*call), penink(*call, "--max-pixels", 10**6)
    assert first.returncode == 0 and not first.stderr and first.stdout == second.stdout
    assert directions.read(io.BytesIO(first.stdout), "d", 10**6).cos2.shape == (64, 96)
    (tmp_path / "d.pgm").write_bytes(first.stdout)
    shown = penink("show-directions", "-e", edges, "--directions", tmp_path / "d.pgm", photo)
    assert shown.returncode == 0 and shown.stdout.count(b"M") >= 72 * 48 and shown.stdout.startswith(b"<?xml")
    (tmp_path / "other.pgm").write_bytes(b"P5 9 9 255\n" + bytes(81))
    refused = penink("show-directions", "--directions", tmp_path / "d.pgm", tmp_path / "other.pgm")
    assert refused.returncode == 1 and not refused.stdout
    told = "a field of 96 x 64 samples; the picture has 9 x 9 pixels, which is another shape"
    assert refused.stderr.decode() == f"penink show-directions: {tmp_path}/d.pgm: {told}\n"
