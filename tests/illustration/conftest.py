"""A small illustration of two layers, on disk as loose files."""

from __future__ import annotations

import io
import json
from pathlib import Path

import numpy as np
import pytest

from penink_cli.formats import directions, edge_list, pgm
from penink_cli.ground.model import Directions, EdgeList, GreyImage


def square(width: int = 96, height: int = 64, strength: float = 0.7) -> EdgeList:
    """A square with an open whisker, strengths rising along it."""
    vertices = np.array([[20.3, 12.2], [70.1, 14.9], [66.6, 50.4], [22.9, 47.7], [88.0, 60.0]])
    edges = np.array([[0, 1], [1, 2], [2, 3], [3, 0], [2, 4]])
    return EdgeList(width, height, vertices, edges, np.array([1, 0.9, 0.8, 0.7, 0.2]) * strength)


def grey(columns: int = 24, rows: int = 16) -> GreyImage:
    """A dark square on a light gradient, 8 bits."""
    y, x = np.mgrid[0:rows, 0:columns]
    values = 200 + 2 * x
    values[(x > 5) & (x < 17) & (y > 3) & (y < 12)] = 60
    return GreyImage(values.astype(np.uint8), 255)


def whirl(columns: int = 24, rows: int = 16) -> Directions:
    """Rings round a place off the middle, surer near it."""
    y, x = np.mgrid[0:rows, 0:columns] - np.array([7.2, 10.7])[:, None, None]
    square = x * x + y * y
    return Directions((y * y - x * x) / square, -2 * x * y / square, 1 / (1 + square / 50))


def save_edges(path: Path, edges: EdgeList) -> None:
    out = io.BytesIO()
    edge_list.write(out, edges)
    path.write_bytes(out.getvalue())


def save_grey(path: Path, image: GreyImage) -> None:
    head = f"P5 {image.values.shape[1]} {image.values.shape[0]} {image.maxval}\n".encode()
    path.write_bytes(head + image.values.astype(">u2" if image.maxval > 255 else "u1").tobytes())
    with path.open("rb") as stream:
        assert np.array_equal(pgm.read(stream, str(path), 10**6).values, image.values)


@pytest.fixture
def loose(tmp_path: Path) -> Path:
    """The manifest of a two-layer illustration."""
    shade = GreyImage(np.where(grey().values > 100, 255, 120).astype(np.uint8), 255)
    save_grey(tmp_path / "square.pgm", grey())
    save_grey(tmp_path / "shade.pgm", shade)
    save_edges(tmp_path / "square.edges.json", square())
    with (tmp_path / "square.directions.pgm").open("wb") as out:
        directions.write(out, whirl())  # type: ignore[arg-type]
    manifest = {
        "format": "penink-illustration",
        "version": 1,
        "width": 96,
        "height": 64,
        "layers": [
            {"name": "shade", "samples": "shade.pgm", "texture": "parallel", "seed": 3},
            {
                "samples": "square.pgm",
                "edges": "square.edges.json",
                "directions": "square.directions.pgm",
                "outline": {"min_strength": 0.25},
            },
        ],
    }
    path = tmp_path / "two.illustration.json"
    path.write_text(json.dumps(manifest))
    return path
