"""A picture for people of a direction field, as SVG: short lines over the photo."""

from __future__ import annotations

import numpy as np

from penink_cli.formats.strokes import Sink
from penink_cli.ground.model import Directions, GreyImage
from penink_cli.outputs.edge_picture import pale_photo

# Lines are coloured by confidence, from unknown to sure: the least confidence of each class, and its colour.
CLASSES = ((0.0, "#f1932d"), (0.25, "#b997c7"), (0.5, "#4c72c4"), (0.75, "#12357a"))
_LENGTH, _PEN = 0.9, 0.16  # in parts of the distance between the middles of lines


def write(out: Sink, photo: GreyImage, directions: Directions, scale: float) -> None:
    """Draw the photo and a line in the middle of each sample of the field.

    scale: size of a photo pixel in CSS pixels.
    """
    height, width = photo.values.shape
    rows, columns = directions.cos2.shape
    out.write(pale_photo(photo, width, height, scale).encode())
    # cosine and sine of half the angle; the half between -90° and 90° is taken, whose cosine is not negative
    cosine = np.sqrt(np.maximum(0, (1 + directions.cos2.astype(np.float64)) / 2))
    sine = np.copysign(np.sqrt(np.maximum(0, (1 - directions.cos2.astype(np.float64)) / 2)), directions.sin2)
    reach = _LENGTH / 2 * min(width / columns, height / rows)
    y, x = np.mgrid[:rows, :columns] + 0.5
    x, y, dx, dy = x * width / columns, y * height / rows, reach * cosine, reach * sine
    rank = np.searchsorted([least for least, _ in CLASSES], directions.confidence, side="right") - 1
    for k, (_, colour) in enumerate(CLASSES):
        ends = np.stack([x - dx, y - dy, 2 * dx, 2 * dy], axis=-1)[rank == k]
        path = "".join(f"M{a:.2f} {b:.2f}l{c:.2f} {d:.2f}" for a, b, c, d in ends.tolist())
        pen = 2 * reach * _PEN / _LENGTH
        out.write(f'<path stroke="{colour}" stroke-width="{pen:.4g}" d="{path}"/>\n'.encode())
    out.write(b"</svg>\n")
