"""A picture for people of what edge detection found, as SVG: zoom in as far as you like."""

from __future__ import annotations

import base64
import io

import numpy as np
import numpy.typing as npt

from penink_cli.formats.strokes import Sink
from penink_cli.ground.model import EdgeList, GreyImage

# Edges are coloured by strength, from faint to strong: the least strength of each class, and its colour.
CLASSES = ((0.0, "#7bafde"), (0.1, "#1965b0"), (0.2, "#f1932d"), (0.4, "#dc050c"))
CONTAMINATED = (255, 214, 90, 110)  # red, green, blue, opacity
_PALE = 0.45  # how much of the photo's contrast is left under the drawing


def write(out: Sink, photo: GreyImage, edges: EdgeList, contaminated: npt.NDArray[np.bool_], scale: float) -> None:
    """Draw photo, contaminated pixels, edges, junctions and open ends.

    contaminated: (h, w) of the photo's size, see `reconstruction/extraction.py`. scale: size of a photo pixel in CSS
    pixels.
    """
    width, height = edges.width, edges.height
    out.write((pale_photo(photo, width, height, scale) + _image(_overlay(contaminated), width, height)).encode())
    pen = max(0.15, 1.2 / scale)
    strength = np.ones(len(edges.edges)) if edges.strength is None else edges.strength
    rank = np.searchsorted([least for least, _ in CLASSES], strength, side="right") - 1
    for k, (_, colour) in enumerate(CLASSES):
        ends = edges.vertices[edges.edges[rank == k]]
        path = "".join(f"M{a[0]:g} {a[1]:g}L{b[0]:g} {b[1]:g}" for a, b in ends)
        out.write(f'<path stroke="{colour}" stroke-width="{pen:g}" d="{path}"/>\n'.encode())
    degree = np.bincount(edges.edges.ravel(), minlength=len(edges.vertices))
    x, y = edges.vertices.T if len(edges.vertices) else np.zeros((2, 0))
    on_frame = (x == 0) | (y == 0) | (x == width) | (y == height)
    _dots(out, edges.vertices[(degree == 1) & ~on_frame], "open ends", "#000", 2.2 * pen, pen)
    _dots(out, edges.vertices[degree > 2], "junctions", "#2a7d32", 2.2 * pen, pen)
    _dots(out, edges.vertices[degree == 2], "vertices", "#000", 0.3 * pen, 0.6 * pen)
    out.write(b"</svg>\n")


def pale_photo(photo: GreyImage, width: int, height: int, scale: float) -> str:
    """The beginning of an SVG document in which a pale photo fills a frame of width × height user units."""
    pale = 255 - (255 - photo.values * (255.0 / photo.maxval)) * _PALE
    head = (
        '<?xml version="1.0" encoding="UTF-8"?>\n<svg xmlns="http://www.w3.org/2000/svg" '
        f'width="{width * scale:g}" height="{height * scale:g}" viewBox="0 0 {width} {height}">\n'
        "<style>path{fill:none;stroke-linecap:round;stroke-linejoin:round}image{image-rendering:pixelated}</style>\n"
    )
    return head + _image(np.rint(pale).astype(np.uint8), width, height)


def _dots(out: Sink, places: npt.NDArray[np.float64], name: str, colour: str, radius: float, pen: float) -> None:
    r = f"{radius:g}"
    round_trip = f"a{r} {r} 0 1 0 {2 * radius:g} 0a{r} {r} 0 1 0 {-2 * radius:g} 0"
    path = "".join(f"M{x - radius:g} {y:g}{round_trip}" for x, y in places)
    out.write(f'<path stroke="{colour}" stroke-width="{pen:g}" d="{path}"><title>{name}</title></path>\n'.encode())


def _overlay(contaminated: npt.NDArray[np.bool_]) -> npt.NDArray[np.uint8]:
    overlay = np.zeros((*contaminated.shape, 4), np.uint8)
    overlay[contaminated] = CONTAMINATED
    return overlay


def _image(pixels: npt.NDArray[np.uint8], width: int, height: int) -> str:
    from PIL import Image

    encoded = io.BytesIO()
    Image.fromarray(pixels).save(encoded, "PNG")
    link = base64.b64encode(encoded.getvalue()).decode()
    return (
        f'<image width="{width}" height="{height}" preserveAspectRatio="none" href="data:image/png;base64,{link}"/>\n'
    )
