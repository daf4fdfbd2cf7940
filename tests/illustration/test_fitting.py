"""Archives of at most so many bytes."""

import numpy as np
import pytest

from penink_cli.formats import archive, illustration
from penink_cli.ground.errors import LimitError
from penink_cli.ground.model import EdgeList, GreyImage, Illustration, Layer, OutlineChoice
from penink_cli.illustration.fitting import packed_within
from penink_cli.options.illustrations import read_illustration, settled
from penink_cli.options.textures import find_texture


@pytest.fixture(scope="module")
def rich() -> Illustration:
    """A rippled ground with a dark square, its edges, and an edge along nothing."""
    y, x = np.mgrid[0:90, 0:120]
    grey = 170 + 30 * np.sin(x / 6) * np.cos(y / 5) + 8 * np.sin(x * 1.9) * np.sin(y * 1.7)
    grey[(x > 30) & (x < 80) & (y > 20) & (y < 60)] = 40
    vertices = np.array([[31, 21], [80, 21], [80, 60], [31, 60], [90, 70], [110, 80.0]]) * 4
    ends = np.array([[0, 1], [1, 2], [2, 3], [3, 0], [4, 5]])
    edges = EdgeList(480, 360, vertices, ends, np.array([0.5, 0.5, 0.5, 0.5, 0.1]))
    layer = Layer(GreyImage(grey.astype(np.uint8)), edges, find_texture("parallel"), "parallel")
    return settled(Illustration(432, 324, (layer,)))


def test_fewer_bytes_are_a_coarser_drawing(rich, tmp_path):
    whole = archive.pack(illustration.members(rich))
    assert packed_within(rich, len(whole), settled) == whole
    sides, sizes = [], []
    for part in (0.85, 0.6, 0.45):
        packed = packed_within(rich, int(part * len(whole)), settled)
        assert 0.5 * part * len(whole) < len(packed) <= part * len(whole)
        path = tmp_path / "x.penink"
        path.write_bytes(packed)
        (layer,) = read_illustration(str(path), 10**6).layers
        sides.append(layer.samples.values.shape[0])
        sizes.append(0 if layer.edges is None else len(layer.edges.edges))
    assert sides == sorted(sides, reverse=True) and sides[0] > sides[-1]
    assert sizes == sorted(sizes, reverse=True) and sizes[0] <= 5
    assert packed_within(rich, int(0.5 * len(whole)), settled) == packed_within(rich, int(0.5 * len(whole)), settled)


def test_what_is_outlined_stays(rich):
    layer = rich.layers[0]
    outlined = Layer(layer.samples, layer.edges, layer.texture, "parallel", outline=OutlineChoice(min_strength=0.05))
    packed = packed_within(Illustration(432, 324, (outlined,)), 900, settled)
    members = archive.read(packed, "")
    assert (
        len(
            illustration.read(members["illustration.json"], "", members.__getitem__, find_texture, 10**6)
            .layers[0]
            .edges.edges
        )
        == 5
    )


def test_too_few_are_told(rich):
    with pytest.raises(LimitError, match=r"^100 bytes are too few: the least possible is \d+$") as told:
        packed_within(rich, 100, settled)
    least = int(str(told.value).rsplit(" ", 1)[1])
    assert len(packed_within(rich, least, settled)) == least


def test_what_a_small_drawing_does_not_show_is_left_out(rich, tmp_path):
    """A smaller drawing takes fewer bytes, one of any size no more than the whole, and both can be limited besides."""
    whole = len(archive.pack(illustration.members(rich)))
    packed = [packed_within(rich, None, settled, seen_at=72.0 * inches) for inches in (0.5, 2, 30)]
    sizes = [len(one) for one in packed]
    assert sizes == sorted(sizes) and sizes[0] < 0.8 * whole and sizes[-1] <= whole
    assert packed_within(rich, whole, settled, seen_at=36.0) == packed[0]
    between = (sizes[0] + sizes[1]) // 2
    assert len(packed_within(rich, between, settled, seen_at=144.0)) <= between
    path = tmp_path / "x.penink"
    path.write_bytes(packed[0])
    assert read_illustration(str(path), 10**6).width == rich.width
