"""The picture of what edge detection found: its drawing says what the edge list says."""

import base64
import io
from xml.etree import ElementTree

import numpy as np
from PIL import Image

from penink_cli.ground.model import EdgeList, GreyImage
from penink_cli.outputs import edge_picture

SVG = "{http://www.w3.org/2000/svg}"


def drawn(edges, contaminated, scale=3.0):
    out = io.BytesIO()
    grey = np.tile(np.arange(edges.width, dtype=np.uint8), (edges.height, 1))
    edge_picture.write(out, GreyImage(grey, 255), edges, contaminated, scale)
    return ElementTree.fromstring(out.getvalue())


def moves(path):
    """The places that a path starts at."""
    return [tuple(map(float, part.split("a")[0].split("L")[0].split())) for part in path.get("d").split("M")[1:]]


def titled(root, title):
    return next(p for p in root.iter(f"{SVG}path") if (t := p.find(f"{SVG}title")) is not None and t.text == title)


# A tee: from the frame to a junction and on to an open end, with a branch to another open end.
TEE = EdgeList(
    20, 12,
    np.array([[0.0, 6], [10, 6], [15, 6], [10, 2]]), np.array([[0, 1], [1, 2], [1, 3]]), np.array([0.05, 0.15, 0.9]),
)  # fmt: skip


def test_every_edge_is_drawn_in_the_colour_of_its_strength():
    root = drawn(TEE, np.zeros((12, 20), bool))
    found = {p.get("stroke"): p.get("d") for p in root.iter(f"{SVG}path") if p.find(f"{SVG}title") is None}
    colours = [colour for _, colour in edge_picture.CLASSES]
    assert found == {colours[0]: "M0 6L10 6", colours[1]: "M10 6L15 6", colours[2]: "", colours[3]: "M10 6L10 2"}


def test_open_ends_and_junctions_are_ringed():
    root = drawn(TEE, np.zeros((12, 20), bool))
    pen = 1.2 / 3
    ends = {(round(x + 2.2 * pen, 6), y) for x, y in moves(titled(root, "open ends"))}
    assert ends == {(15, 6), (10, 2)}  # and not the one on the frame
    assert [(round(x + 2.2 * pen, 6), y) for x, y in moves(titled(root, "junctions"))] == [(10, 6)]


def test_contaminated_pixels_are_tinted_over_a_pale_photo():
    contaminated = np.zeros((12, 20), bool)
    contaminated[5:7, 3:9] = True
    photo, tint = (
        np.asarray(Image.open(io.BytesIO(base64.b64decode(image.get("href").split(",")[1]))))
        for image in drawn(TEE, contaminated).iter(f"{SVG}image")
    )
    assert np.array_equal(tint[..., 3] > 0, contaminated)
    assert photo.min() > 130 and (np.diff(photo[0].astype(int)) >= 0).all()


def test_the_size_on_the_screen_is_asked_for():
    root = drawn(TEE, np.zeros((12, 20), bool), scale=5)
    assert (root.get("width"), root.get("height"), root.get("viewBox")) == ("100", "60", "0 0 20 12")
