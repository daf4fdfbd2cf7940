"""Every subcommand with the least, the flattest and the most of inputs: a right answer, or one line that says why."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest

from penink_cli.formats import directions, edge_list, pgm
from penink_cli.ground.model import Directions, EdgeList, GreyImage
from tests.faults.calls import CALLS, encoded, strokes_text
from tests.faults.test_outputs import one_line


def grid(width: int, height: int) -> EdgeList:
    """All sides of all pixels: nowhere a neighbour that is not across an edge."""
    y, x = np.mgrid[: height + 1, : width + 1]
    place = np.arange((width + 1) * (height + 1)).reshape(height + 1, width + 1)
    across = np.stack([place[:, :-1].ravel(), place[:, 1:].ravel()], axis=1)
    down = np.stack([place[:-1].ravel(), place[1:].ravel()], axis=1)
    vertices = np.stack([x.ravel(), y.ravel()], axis=1).astype(float)
    return EdgeList(width, height, vertices, np.concatenate([across, down]))


def border(width: int, height: int) -> EdgeList:
    corners = np.array([[0, 0], [width, 0], [width, height], [0, height]], float)
    return EdgeList(width, height, corners, np.array([[0, 1], [1, 2], [2, 3], [3, 0]]))


def one(width: int, height: int) -> EdgeList:
    """From corner to corner."""
    return EdgeList(width, height, np.array([[0, 0], [width, height]], float), np.array([[0, 1]]), np.array([1.0]))


def image(name: str) -> GreyImage:
    flat = {"constant": 128, "black": 0, "white": 255}
    if name in flat:
        return GreyImage(np.full((9, 12), flat[name], np.uint8))
    shapes = {"one pixel": (1, 1), "one row": (1, 12), "one column": (9, 1), "two pixels": (1, 2), "two by two": (2, 2)}
    if name in shapes:
        h, w = shapes[name]
        return GreyImage((37 * np.arange(h * w) % 256).astype(np.uint8).reshape(h, w))
    if name == "checkerboard":
        return GreyImage((np.indices((9, 12)).sum(axis=0) % 2 * 255).astype(np.uint8))
    if name == "maxval 1":
        return GreyImage((np.indices((9, 12)).sum(axis=0) % 2).astype(np.uint8), 1)
    if name == "16 bits":
        return GreyImage((np.arange(108) * 600).astype(np.uint16).reshape(9, 12), 65535)
    raise KeyError(name)


IMAGES = (
    "one pixel", "one row", "one column", "two pixels", "two by two", "constant", "black", "white", "checkerboard",
    "maxval 1", "16 bits",
)  # fmt: skip
EDGES = {"none": EdgeList, "one": one, "border": border, "all": grid}

DRAWINGS = {
    "no stroke": strokes_text(10, 10),
    "one dot": strokes_text(10, 10, (1, [[5, 5]])),
    "a stroke of no length": strokes_text(10, 10, (1, [[5, 5]] * 4)),
    "a stroke outside the sheet": strokes_text(10, 10, (1, [[-50, -50], [-60, -50], [-70, -50], [-80, -50]])),
    "a sheet of almost nothing": strokes_text(0.001, 0.001, (0.0001, [[0, 0]])),
    "the largest sheet": strokes_text(1e7, 1e7, (1, [[1e7, 1e7], [0, 0], [-1e7, 3], [1e7, -1e7]])),
    "a pen wider than the sheet": strokes_text(10, 10, (1e4, [[5, 5], [5, 6], [5, 7], [5, 8]])),
}

# How files begin that these tests do not read.
BEGINS = {
    "to-ps": b"%!PS", "to-svg": b"<?xml", "to-pdf": b"%PDF", "to-png": b"\x89PNG", "to-html": b"<!", "pack": b"PK",
    "draw": b"%!PS", "show-edges": b"<?xml", "show-directions": b"<?xml", "measure": b"tone",
}  # fmt: skip

DESERVED = (
    b": warning: the drawing is ", b": warning: the photo uses ", b": warning: a drawing without a stroke",
    b": warning: the edges are of a picture of ",
)  # fmt: skip

of_images = [name for name, call in CALLS.items() if call.reads in ("samples.pgm", "photo.png")]
of_edges = [name for name, call in CALLS.items() if call.reads == "photo.edges.json"]
of_strokes = [name for name, call in CALLS.items() if call.reads == "photo.strokes.jsonl" and name != "compare"]


def checked(name: str, out: bytes) -> None:
    """The output is a valid file of its kind."""
    if out.startswith(b"P5"):
        pgm.read(io.BytesIO(out), name, 10**6)
    elif b"penink-edges" in out[:40]:
        edge_list.read(io.BytesIO(out), name)
    elif b"penink-lines" in out[:40]:
        from penink_cli.formats import lines

        lines.read(io.BytesIO(out), name)
    elif b"penink-strokes" in out[:40]:
        from penink_cli.formats import strokes

        strokes.read(io.BytesIO(out), name)
    else:
        assert out.startswith(BEGINS.get(name, b"")), out[:20]


def complaints(err: bytes) -> bytes:
    """What is on standard error but for the warnings that most of these small and empty things deserve."""
    return b"".join(line for line in err.splitlines(True) if not any(warning in line for warning in DESERVED))


def words(name: str, folder: Path) -> list[str]:
    """The call's arguments, its files in ``folder``."""
    return [str(folder / word) if (folder / word).exists() else word for word in CALLS[name].arguments]


@pytest.mark.parametrize("name", of_images)
@pytest.mark.parametrize("kind", IMAGES)
def test_images(name, kind, server, inputs, tmp_path):
    given = image(kind)
    height, width = given.values.shape
    field = Directions(np.ones((height, width)), np.zeros((height, width)), np.full((height, width), 0.5))
    (tmp_path / "photo.directions.pgm").write_bytes(encoded(directions.write, field))
    (tmp_path / "photo.strokes.jsonl").write_bytes(strokes_text(width, height, (1, [[width / 2, height / 2]])))
    for edges in EDGES.values():
        (tmp_path / "photo.edges.json").write_bytes(encoded(edge_list.write, edges(width, height)))
        done = server.run(name, *words(name, tmp_path), stdin=encoded(pgm.write, given))
        assert (done.status, complaints(done.err)) == (0, b"")
        checked(name, done.out)
        if "-e" not in CALLS[name].arguments:
            break


@pytest.mark.parametrize("name", of_edges)
@pytest.mark.parametrize("kind", EDGES)
def test_edge_lists(name, kind, server, inputs):
    for width, height in ((1, 1), (1, 9), (12, 1), (12, 9)):
        done = server.run(name, *words(name, inputs), stdin=encoded(edge_list.write, EDGES[kind](width, height)))
        assert (done.status, complaints(done.err)) == (0, b"")
        checked(name, done.out)


@pytest.mark.parametrize("name", of_strokes)
@pytest.mark.parametrize("kind", DRAWINGS)
def test_drawings(name, kind, server, inputs):
    done = server.run(name, *words(name, inputs), stdin=DRAWINGS[kind])
    if done.status:
        assert done.status == 1 and not done.out and kind == "the largest sheet"
        one_line(done.err, name)
    else:
        assert not done.err
        checked(name, done.out)


@pytest.mark.parametrize("kind", DRAWINGS)
def test_a_drawing_is_the_same_as_itself(kind, server, tmp_path):
    (tmp_path / "a.jsonl").write_bytes(DRAWINGS[kind])
    done = server.run("compare", str(tmp_path / "a.jsonl"), stdin=DRAWINGS[kind])
    assert done.status == (1 if kind == "the largest sheet" else 0)
    assert not done.err or kind == "the largest sheet"


@pytest.mark.parametrize(
    "name", [n for n in of_images if CALLS[n].reads == "samples.pgm" and "-e" in CALLS[n].arguments]
)
def test_an_edge_list_of_another_shape_serves(name, server, tmp_path):
    """Edges keep the frame of their photograph: samples of any size fill it, one row of a tall frame too."""
    for frame in ((1, 1000), (1000, 1), (2**31 - 1, 2**31 - 1), (1, 1)):
        (tmp_path / "photo.edges.json").write_bytes(encoded(edge_list.write, one(*frame)))
        done = server.run(name, *words(name, tmp_path), stdin=encoded(pgm.write, image("constant")))
        assert (done.status, done.err) == (0, b""), frame
        checked(name, done.out)
