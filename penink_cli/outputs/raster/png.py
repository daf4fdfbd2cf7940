"""PNG files, grey or coloured, written in bands, with the resolution and without date or program's name.

An imaging library would need the whole picture at once, and time to be loaded.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable

import numpy as np

from penink_cli.formats.strokes import Sink
from penink_cli.outputs.raster.cover import Band


def write(
    out: Sink, size: tuple[int, int], dpi: float, bits: int, bands: Iterable[Band], coloured: bool = False
) -> None:
    """Write a PNG of width × height pixels.

    bands: (rows, width) values 0 … 2^bits - 1 from the top. PNG has 1, 2, 4 and 8 bits; values of another depth are
    stretched to 8. coloured: the bands are (rows, width, 3) of sRGB, and bits is 8.
    """
    width, height = size
    depth = bits if bits in (1, 2, 4) else 8
    stretch = ((2**depth - 1) / (2**bits - 1) * np.arange(2**bits) + 0.5).astype(np.uint8)
    out.write(b"\x89PNG\r\n\x1a\n")
    _chunk(out, b"IHDR", struct.pack(">IIBBBBB", width, height, depth, 2 if coloured else 0, 0, 0, 0))
    per_metre = min(round(dpi / 0.0254), 2**31 - 1)
    _chunk(out, b"pHYs", struct.pack(">IIB", per_metre, per_metre, 1))
    deflate = zlib.compressobj(6)
    for band in bands:
        rows = band if depth == bits else stretch[band]
        if depth < 8:
            places = np.arange(8 // depth, dtype=np.uint8)[::-1] * depth
            padded = np.pad(rows, ((0, 0), (0, -width % len(places))))
            rows = np.bitwise_or.reduce(padded.reshape(len(rows), -1, len(places)) << places, axis=2).astype(np.uint8)
        rows = rows.reshape(len(rows), -1)
        filtered = np.zeros((len(rows), rows.shape[1] + 1), np.uint8)  # each row begins with its filter: none
        filtered[:, 1:] = rows
        _chunk(out, b"IDAT", deflate.compress(filtered.data))
    _chunk(out, b"IDAT", deflate.flush())
    _chunk(out, b"IEND", b"")


def _chunk(out: Sink, kind: bytes, content: bytes) -> None:
    if kind == b"IDAT" and not content:
        return
    check = zlib.crc32(content, zlib.crc32(kind))
    out.write(struct.pack(">I", len(content)) + kind + content + struct.pack(">I", check))
