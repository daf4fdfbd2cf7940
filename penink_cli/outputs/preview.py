"""The preview of an EPS, for programs that run no PostScript: a small grey picture in its comments (EPSI).

By Adobe's EPS specification, section 6: pixels fill the bounding box from its top-left corner, a byte each, 0 for white
and 255 for black, in hexadecimal digits after a %.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from penink_cli.ground.colour import XYZ
from penink_cli.ground.model import Strokes
from penink_cli.outputs.page import Page
from penink_cli.outputs.raster import cover

BYTES = 40  # of the picture on a line
SIDE = 1000  # most pixels of a side: in larger pictures a pixel is more than a point


def comments(
    layers: Sequence[Strokes], page: Page, box: tuple[int, int, int, int],
    colours: Sequence[tuple[float, float, float]] = (),
) -> Iterator[bytes]:  # fmt: skip
    """The lines of the preview. page: where the sheet lies. box: the EPS's bounding box, in whole points, y up.

    colours: red, green and blue (0 … 1) of each layer, black if there is none. A layer covers what lies below.
    """
    left, bottom, right, top = box
    dpi = min(72.0, 72.0 * SIDE / max(right - left, top - bottom))
    shown = Page(right - left, top - bottom, page.x - left, page.y + top - page.height)
    width, height = cover.size(shown, dpi)
    ink = np.zeros((height, width))
    for i, layer in enumerate(layers):
        dark = 1.0 - _grey(colours[i]) if i < len(colours) else 1.0
        share = 1.0 - np.concatenate(list(cover.bands([layer], shown, dpi, 255))) / 255
        ink = ink * (1.0 - share) + dark * share
    picture = np.rint(ink * 255).astype(np.uint8).tobytes()
    lines = [picture[i : i + BYTES] for i in range(0, len(picture), BYTES)]
    yield b"%%%%BeginPreview: %d %d 8 %d\n" % (width, height, len(lines))
    yield from (b"%" + line.hex().encode() + b"\n" for line in lines)
    yield b"%%EndPreview\n"


def _grey(colour: tuple[float, float, float]) -> float:
    """The grey, 0 … 1, that shows a colour of sRGB: its coded channels, weighed as luminance is."""
    red, green, blue = (share * part for share, part in zip(XYZ[1], colour, strict=True))
    return min(red + green + blue, 1.0)
