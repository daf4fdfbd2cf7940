"""How to call each subcommand, and small inputs that belong together; every fault test runs over these."""

from __future__ import annotations

import io
import json
import re
import shlex
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from penink_cli.formats import directions, edge_list, pgm
from penink_cli.ground.model import Directions, EdgeList, GreyImage
from penink_cli.main import SUBCOMMANDS, command_of

WIDTH, HEIGHT = 24, 18


@dataclass(frozen=True)
class Call:
    """One way to call a subcommand.

    reads: the file, of `inputs`, that it takes by name or on standard input; None where it reads none.
    arguments: all others; a name of `inputs` stands for that file.
    """

    reads: str | None
    arguments: tuple[str, ...] = ()


# Calls with less to do than the examples of the help texts have, for these small inputs.
OWN = {
    "compose": Call("photo.png", ("--width", "0.35in")),
    "detect-edges": Call("photo.png"),
    "detect-directions": Call("photo.png", ("-e", "photo.edges.json", "--strokes", "photo.strokes.jsonl")),
    "thin-edges": Call("photo.edges.json", ("--photo", "photo.png")),
    "reduce": Call("samples.pgm", ("-e", "photo.edges.json", "--factor", "2")),
    "enlarge": Call("samples.pgm", ("-e", "photo.edges.json", "--scale", "3")),
    "blast": Call("samples.pgm", ("--texture", "crosshatch", "--width", "0.35in", "-e", "photo.edges.json")),
    "to-ps": Call("photo.strokes.jsonl"),
    "to-pgm": Call("photo.strokes.jsonl", ("--dpi", "100")),
    "to-png": Call("photo.strokes.jsonl", ("--dpi", "100")),
    "balance": Call("photo.strokes.jsonl", ("--plate", "1", "--tone", "samples.pgm")),
    "separate": Call("photo.png", ("--grey", "0,0.5")),
    "lines": Call("photo.lines.json", ("--width", "0.35in")),
    "outline": Call("photo.edges.json", ("--width", "0.35in")),
    "render": Call("photo.illustration.json", ("--scale", "1")),
    "draw": Call("photo.png", ("--width", "0.35in", "--texture", "crosshatch")),
    "compare": Call("photo.strokes.jsonl", ("photo.strokes.jsonl",)),
    "style": Call(None, ("show", "true")),
    "texture": Call(None, ("make", "hair", "--pen", "0.5")),
}
# What the files of examples are here, by how their names end.
STANDS_FOR = {
    ".strokes.jsonl": "photo.strokes.jsonl",
    "e.json": "photo.edges.json",
    ".edges.json": "photo.edges.json",
    ".lines.json": "photo.lines.json",
    ".directions.pgm": "photo.directions.pgm",
    ".illustration.json": "photo.illustration.json",
    ".penink": "photo.illustration.json",
    ".png": "photo.png",
    ".jpg": "photo.png",
    ".pgm": "samples.pgm",
}


def from_example(name: str) -> Call:
    """The first example of the subcommand's help text as a call: what it reads comes last there."""
    example = re.search(rf"penink {name} ([^|>\n]*)", command_of(name).help or "")
    assert example, f"{name}: no example in its help text"
    words = [*shlex.split(example[1]), ""]
    if "-o" in words:
        del words[words.index("-o") : words.index("-o") + 2]
    known = [next((file for end, file in STANDS_FOR.items() if word.endswith(end)), word) for word in words if word]
    return Call(known[-1], tuple(known[:-1]))


#: Every subcommand but `completion`, which is no filter: it prints a few words.
CALLS = {name: OWN.get(name) or from_example(name) for name in SUBCOMMANDS if name != "completion"}


def encoded(write: object, value: object) -> bytes:
    out = io.BytesIO()
    write(out, value)  # type: ignore[operator]
    return out.getvalue()


def disc() -> GreyImage:
    """A dark disc with a soft shade on light ground."""
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    inside = (x - 12) ** 2 + (y - 9) ** 2 < 30
    return GreyImage(np.where(inside, 40 + 3 * y, 200 + x).astype(np.uint8))


def rings() -> Directions:
    """Round the disc's middle, more surely the nearer."""
    y, x = np.mgrid[:HEIGHT, :WIDTH] + 0.5 - [[[9]], [[12]]]
    square = x * x + y * y
    return Directions((y * y - x * x) / square, -2 * x * y / square, 1 / (1 + square / 100))


def frame(points: list[tuple[float, float]]) -> EdgeList:
    """A closed chain through the points."""
    n = len(points)
    edges = np.stack([np.arange(n), (np.arange(n) + 1) % n], axis=1)
    return EdgeList(WIDTH, HEIGHT, np.array(points, float), edges, np.full(n, 0.5))


def strokes_text(width: float, height: float, *strokes: tuple[float, list[list[float]]]) -> bytes:
    lines = [{"format": "penink-strokes", "version": 1, "width": width, "height": height}]
    lines += [{"width": pen, "points": points} for pen, points in strokes]
    return "".join(json.dumps(line) + "\n" for line in lines).encode()


def make_inputs(folder: Path) -> None:
    """Write the files that CALLS names."""
    from PIL import Image

    image = disc()
    Image.fromarray(image.values).save(folder / "photo.png")
    (folder / "samples.pgm").write_bytes(encoded(pgm.write, image))
    octagon = [(7.5, 6), (10, 3.5), (14, 3.5), (16.5, 6), (16.5, 12), (14, 14.5), (10, 14.5), (7.5, 12)]
    (folder / "photo.edges.json").write_bytes(encoded(edge_list.write, frame(octagon)))
    (folder / "photo.directions.pgm").write_bytes(encoded(directions.write, rings()))
    drawn = strokes_text(
        72,
        54,
        (0.5, [[3, 3], [10, 3], [20, 8], [30, 9]]),
        (0.4, [[40, 40]]),
        (1, [[5, 50], [9, 40], [60, 40], [70, 5]]),
    )
    (folder / "photo.strokes.jsonl").write_bytes(drawn)
    lines = [{"points": [[2, 3], [9, 4], [20, 12]], "weight": [0.2, 1, 0.4], "rank": 5}]
    lines += [{"points": [[12, 9]], "weight": [1], "rank": 3, "breadth": 3}]
    document = {"format": "penink-lines", "version": 1, "width": WIDTH, "height": HEIGHT, "lines": lines}
    (folder / "photo.lines.json").write_text(json.dumps(document))
    layer = {"samples": "samples.pgm", "edges": "photo.edges.json", "texture": "crosshatch", "outline": {}}
    manifest = {"format": "penink-illustration", "version": 1, "width": 25.2, "height": 18.9, "layers": [layer]}
    (folder / "photo.illustration.json").write_text(json.dumps(manifest))


def arguments(name: str, folder: Path, by_name: bool = True, inputs: Path | None = None) -> list[str]:
    """``name OPTIONS [FILE]``, with the paths of the files in ``folder``."""
    call = CALLS[name]
    known = {path.name for path in (inputs or folder).iterdir()}
    words = [str(folder / word) if word in known else word for word in call.arguments]
    return [name, *words, *([str(folder / call.reads)] if by_name and call.reads else [])]
