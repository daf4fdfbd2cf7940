"""Parts of masks and distances in them: scipy's."""

import math

import numpy as np
import pytest
from scipy import ndimage

from penink_cli.ground.masks import distance, filled, grown, labelled, near, opened, part_at, sizes


@pytest.mark.parametrize("share", [0.0, 0.1, 0.4, 0.7, 0.97])
@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (40, 60), (170, 23)])
def test_parts_and_distances_are_scipys(share, shape):
    mask = np.random.default_rng(round(100 * share)).random(shape) < share
    part, boxes = labelled(mask)
    wanted, count = ndimage.label(mask, np.ones((3, 3), int))
    assert len(boxes) == count and np.array_equal(part, wanted)
    sides = [[box[0].start, box[0].stop, box[1].start, box[1].stop] for box in ndimage.find_objects(wanted)]
    assert boxes.tolist() == sides
    other = np.random.default_rng(1).random(shape) < 0.5
    assert sizes(part, count, other).tolist() == ndimage.sum_labels(other, wanted, range(count + 1)).tolist()
    if not mask.all():
        away = ndimage.distance_transform_edt(mask)
        assert np.array_equal(distance(mask), away)
        for reach in (0.0, 0.9, 1.0, 1.5, math.sqrt(5), 3.0, 18.5, 30.0, 160.0):
            assert np.array_equal(near(mask, reach, threads=2), away <= reach)
            assert np.array_equal(near(mask, reach, strictly=True), away < reach)


@pytest.mark.parametrize("share", [0.0, 0.2, 0.5, 0.8, 1.0])
@pytest.mark.parametrize("radius", [1.0, 1.5, 2.0, 3.7])
def test_masks_are_filled_opened_and_grown_as_scipys(share, radius):
    rng = np.random.default_rng(round(100 * share))
    mask = ndimage.binary_dilation(rng.random((31, 44)) < share / 4, iterations=3)
    assert np.array_equal(filled(mask), ndimage.binary_fill_holes(mask))
    r = int(radius)
    y, x = np.ogrid[-r : r + 1, -r : r + 1]
    assert np.array_equal(opened(mask, radius), ndimage.binary_opening(mask, x * x + y * y <= radius * radius))
    assert np.array_equal(grown(mask, r), ndimage.binary_dilation(mask, iterations=r))
    part, _ = ndimage.label(mask)
    for row, column in ((0, 0), (15, 20), (30, 43)):
        assert np.array_equal(part_at(mask, row, column), (part == part[row, column]) & mask)


def test_nothing_is_near_where_nothing_is_outside():
    assert (distance(np.ones((3, 4), bool)) > 1e100).all()
    assert not near(np.ones((3, 4), bool), 7.0).any()
