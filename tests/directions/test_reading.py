"""Reading a field at a size: the same directions at every size, sharp at edges."""

from __future__ import annotations

import numpy as np
import pytest

from penink_cli.directions.reading import at_size
from penink_cli.ground.model import Directions, EdgeList


def field_of(degrees: np.ndarray, confidence: float = 1.0) -> Directions:
    double = np.deg2rad(2 * degrees)
    return Directions(np.cos(double), np.sin(double), np.full(degrees.shape, confidence))


def degrees_of(field: Directions) -> np.ndarray:
    return np.rad2deg(np.arctan2(field.sin2, field.cos2)) / 2


def apart(a: np.ndarray, b: np.ndarray | float) -> np.ndarray:
    """Angles between directions, which are equal where half a turn apart."""
    return np.abs((a - b + 90) % 180 - 90)


def waves(rows: int, columns: int) -> np.ndarray:
    y, x = (np.mgrid[:rows, :columns] + 0.5) / [[[rows]], [[columns]]]
    return 60 * np.sin(5 * x + 2 * y) + 40 * np.cos(7 * y)


EDGE = EdgeList(90, 60, np.array([[41.0, 0.0], [52.0, 60.0]]), np.array([[0, 1]]))


def beside_the_edge(rows: int, columns: int) -> np.ndarray:
    """How far the centre of each pixel lies to the right of EDGE, in samples of a field of 30 × 45."""
    y, x = (np.mgrid[:rows, :columns] + 0.5) * [[[60 / rows]], [[90 / columns]]]
    return (x - 41 - 11 * y / 60) / 2


def test_at_its_own_size_it_is_itself():
    angle = waves(20, 30)
    assert apart(degrees_of(at_size(field_of(angle), None, 20, 30)), angle).max() < 0.001


@pytest.mark.parametrize("edges", [None, EDGE])
def test_small_and_large_drawings_find_the_same_directions(edges):
    """At 1, 4 and 24 inches, a node every .9 pt: compared where centres coincide."""
    field = field_of(waves(64, 96))
    large = degrees_of(at_size(field, edges, 59 * 9, 89 * 9))
    for rows, step in ((59, 9), (59 * 3, 3)):
        small = degrees_of(at_size(field, edges, rows, rows // 59 * 89))
        assert apart(small, large[step // 2 :: step, step // 2 :: step]).max() < 0.01


def test_two_fields_beside_an_edge_keep_apart():
    side = beside_the_edge(30, 45)
    angle = np.where(side > 0, 70.0, -10.0)
    for scale in (1, 4, 11):
        found = degrees_of(at_size(field_of(angle), EDGE, 30 * scale, 45 * scale))
        far = beside_the_edge(30 * scale, 45 * scale)
        assert apart(found[far > 0], 70).max() < 0.01 and apart(found[far <= 0], -10).max() < 0.01


def test_vectors_are_of_length_1_and_what_disagrees_is_not_trusted():
    field = at_size(field_of(np.array([[0.0, 90.0]]), 0.8), None, 40, 79)
    assert np.abs(field.cos2**2 + field.sin2**2 - 1).max() < 1e-6
    assert field.confidence[20, 39] < 0.001 and field.confidence[20, 0] > 0.79
    nothing = at_size(Directions(np.zeros((2, 2)), np.zeros((2, 2)), np.ones((2, 2))), None, 5, 5)
    assert (nothing.cos2 == 1).all() and not nothing.confidence.any()


@pytest.mark.parametrize("rows", [7, 100])
def test_no_value_depends_on_threads_or_window(rows):
    field = field_of(waves(30, 45), 0.7)
    whole = at_size(field, EDGE, rows, 150, threads=1)
    part = at_size(field, EDGE, rows, 150, threads=3, window=(11, 2, 100, 4))
    for a, b in zip(vars(whole).values(), vars(part).values(), strict=True):
        assert np.array_equal(a[2:6, 11:111], b)
