"""Parts of masks and distances in them: scipy's."""

import numpy as np
import pytest
from scipy import ndimage

from penink_cli.ground.masks import distance, labelled


@pytest.mark.parametrize("share", [0.0, 0.1, 0.4, 0.7, 0.97])
@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (40, 60)])
def test_parts_and_distances_are_scipys(share, shape):
    mask = np.random.default_rng(round(100 * share)).random(shape) < share
    part, boxes = labelled(mask)
    wanted, count = ndimage.label(mask, np.ones((3, 3), int))
    assert len(boxes) == count and np.array_equal(part, wanted)
    sides = [[box[0].start, box[0].stop, box[1].start, box[1].stop] for box in ndimage.find_objects(wanted)]
    assert boxes.tolist() == sides
    if not mask.all():
        assert np.array_equal(distance(mask), ndimage.distance_transform_edt(mask))


def test_nothing_is_near_where_nothing_is_outside():
    assert (distance(np.ones((3, 4), bool)) > 1e100).all()
