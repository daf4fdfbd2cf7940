"""Corners and junctions settled by what the picture shows."""

import numpy as np
import pytest
from penink_cli.arrangement._compiled.place import Place
from scipy.ndimage import gaussian_filter, label

from penink_cli.arrangement._compiled import regions as _regions
from penink_cli.arrangement._compiled import window as _window
from penink_cli.arrangement.detection import detect_edges
from penink_cli.arrangement.junctions import _taps
from penink_cli.ground import threads
from tests.benchmarks._scenes import Scene, disc, polygon, random_scene
from tests.benchmarks.edges import along

FINE = _regions.FINENESS


def seen_by(tip, blur, size=20, grey=(0.3, 0.7)):
    """A photo of the wedge right of tip, its arms going to the frame, and its edges."""
    at = (np.arange(size * 12) + 0.5) / 12
    x, y = at[None] - tip[0], at[:, None] - tip[1]
    fine = np.where(np.abs(y) < 0.8 * x, grey[1], grey[0])
    lens = gaussian_filter(fine, 12 * blur, mode="nearest")
    photo = lens.reshape(size, 12, size, 12).mean(axis=(1, 3)).astype(np.float32)
    far = 30.0
    vertices = np.array([tip, (tip[0] + far, tip[1] - 0.8 * far), (tip[0] + far, tip[1] + 0.8 * far)])
    return photo, vertices, np.array([(0, 1), (0, 2)], np.int32)


def left_over(photo, place, blur, rounds, held=()):
    """What the window of all of the photo leaves unexplained, vertices settled."""
    window = _window.Window(photo, _taps(blur), float(np.hypot(blur, np.sqrt(1 / 12))))
    return window.fitted(place, (0, 0, 20, 20), 3, rounds, held)


def slow_left_over(photo, vertices, ends, blur):
    """The same model with regions by scipy, the blur as a matrix and least squares by numpy."""
    size = len(photo)
    at = (np.arange(size * FINE) + 0.5) / FINE
    tip = vertices[0]
    wedge = np.abs(at[:, None] - tip[1]) < 0.8 * (at[None] - tip[0])
    regions = [label(wedge)[0] == 1, ~wedge]
    taps = _taps(blur)
    reach = len(taps) // 2
    camera = np.zeros((size, size * FINE))
    for i in range(size):
        for d, tap in zip(range(-reach, reach + 1), taps):
            camera[i, np.clip(FINE * i + FINE // 2 + d, 0, size * FINE - 1)] += tap
    columns = [camera @ region @ camera.T for region in regions]
    columns += list(np.mgrid[:size, :size] - size / 2)
    design = np.stack(columns, -1).reshape(-1, 4)
    rest = photo.ravel() - 0.5 - design @ np.linalg.lstsq(design, photo.ravel() - 0.5, rcond=None)[0]
    return float(rest @ rest)


@pytest.mark.parametrize("blur", [0.4, 0.9])
@pytest.mark.parametrize("off", [(0.0, 0.0), (0.8, 0.0), (-0.5, 1.1)])
def test_a_window_is_rendered_as_regions_seen_through_the_camera(blur, off):
    photo, vertices, ends = seen_by((8.3, 9.6), blur)
    vertices = vertices + off
    found = left_over(photo, Place(vertices, ends), blur, 0)
    assert found == pytest.approx(slow_left_over(photo, vertices, ends, blur), rel=1e-2, abs=1e-5)


@pytest.mark.parametrize("off", [(0.7, 0.2), (-0.6, -0.8), (2.0, 0.0)])
def test_a_tip_settles_where_it_is(off):
    photo, vertices, ends = seen_by((8.3, 9.6), 0.8)
    place = Place(vertices + np.array([off, (0, 0), (0, 0)]), ends, {0})
    left = left_over(photo, place, 0.8, 12)
    assert np.hypot(*(place.at()[0] - vertices[0])) < 0.15
    assert left < 0.01


def test_what_is_known_holds_a_vertex():
    photo, vertices, ends = seen_by((8.3, 9.6), 0.8)
    place = Place(vertices + np.array([(0.7, 0.2), (0, 0), (0, 0)]), ends, {0})
    x, y = place.at()[0]
    left_over(photo, place, 0.8, 12, (1e6 * np.array([1.0, 0.0, 1.0, x, y, x * x + y * y]),))
    assert np.abs(place.at()[0] - (x, y)).max() < 1e-3


def test_too_many_regions_are_refused():
    photo, _, _ = seen_by((8.3, 9.6), 0.8)
    lines = [(x, y) for x in range(1, 15) for y in (0.0, 20.0)]
    assert left_over(photo, Place(lines, np.arange(28).reshape(-1, 2)), 0.8, 0) < 0


@pytest.mark.parametrize(("blur", "noise"), [(0.5, 0), (1.0, 2), (1.5, 2)])
def test_a_tip_of_forty_degrees_is_closed(blur, noise):
    scene = Scene(100, [polygon([(20, 50), (80, 28.2), (80, 71.8)], (0.8, 0, 0))])
    edges = detect_edges(scene.photo(blur, noise, 3))
    ends = np.bincount(edges.edges.ravel())
    seen = along(edges)
    assert (ends == 2).all()
    for corner in scene.shapes[0].corners:
        assert np.hypot(*(seen - corner).T).min() < 1


def closed(scene, edges, places):
    """Whether edges come within a pixel of each place, and none ends near it."""
    seen = along(edges)
    ends = edges.vertices[np.bincount(edges.edges.ravel(), minlength=len(edges.vertices)) == 1]
    return all(
        np.hypot(*(seen - place).T).min() < 1 and not (np.hypot(*(ends - place).T) < 3).any() for place in places
    )


@pytest.mark.parametrize(("blur", "noise"), [(0.5, 2), (1.0, 0), (1.0, 2)])
def test_a_corner_close_to_a_junction_is_no_bevel(blur, noise):
    below = polygon([(30, 30), (60, 33), (57, 70), (27, 66)], (0.75, 0, 0))
    above = polygon([(62.5, 40), (90, 34), (90, 80), (50, 84), (52, 45)], (0.15, 0, 0))
    scene = Scene(100, [below, above])
    corners, tees = scene.junctions()
    assert len(tees) == 2
    assert closed(scene, detect_edges(scene.photo(blur, noise, 5)), [*corners, *tees])


@pytest.mark.parametrize("radius", [3, 5])
def test_what_is_round_stays_round(radius):
    scene = Scene(60, [disc(30.3, 29.8, radius, (0.2, 0, 0))])
    edges = detect_edges(scene.photo(0.7, 1, 2))
    off = np.hypot(*(along(edges) - (30.3, 29.8)).T) - radius
    assert len(edges.edges) >= 8
    assert np.sqrt(np.mean(off**2)) < 0.15


def test_the_result_does_not_depend_on_threads(monkeypatch):
    scene = random_scene(7, size=120)
    photo = scene.photo(1.0, 2, 7)
    found = []
    for count in (1, 3):
        monkeypatch.setattr(threads, "count", lambda asked, count=count: count)
        edges = detect_edges(photo)
        found.append((edges.vertices.tobytes(), edges.edges.tobytes()))
    assert found[0] == found[1]


def test_only_what_a_drawing_shows_is_settled(monkeypatch):
    """Strong edges that go on for half an inch are; weak ones stay as found, and so do short ones."""
    strong = Scene(100, [polygon([(20, 50), (80, 28.2), (80, 71.8)], (0.8, 0, 0))]).photo(1.0, 2, 3)
    weak = 0.5 + (strong - 0.5) * 0.5

    def found(photo, **told):
        edges = detect_edges(photo, low=0.05, high=0.1, **told)
        return edges.vertices.tobytes(), edges.edges.tobytes()

    whole = {"strong": found(strong), "weak": found(weak)}
    assert found(strong, seen_at=72.0) == whole["strong"]
    left, short = found(weak, seen_at=72.0), found(strong, seen_at=3.0)
    monkeypatch.setattr("penink_cli.arrangement.detection.settle_junctions", lambda *told: None)
    assert left == found(weak) != whole["weak"]
    assert short == found(strong) != whole["strong"]
