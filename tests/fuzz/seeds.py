"""Small valid files of every format, for the fuzzer to begin with."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator

import numpy as np

from penink_cli.formats import archive, compact, compact_edges, compact_lines, directions, edge_list, lines, parts, pgm
from penink_cli.ground.model import Directions, EdgeList, GreyImage
from tests.faults.calls import encoded, strokes_text

IMAGE = GreyImage((37 * np.arange(20) % 256).astype(np.uint8).reshape(4, 5))
EDGES = EdgeList(5, 4, np.array([[1, 1], [2, 1.5], [3, 3]]), np.array([[0, 1], [1, 2]]), np.array([0.5, 1]))
LINES = {
    "format": "penink-lines", "version": 1, "width": 5, "height": 4, "lines": [
        {"points": [[1, 1], [2.5, 3]], "weight": [0, 0.5], "rank": 1.5, "white": True},
        {"points": [[2, 2]], "weight": [1], "rank": 1, "breadth": 2}],
}  # fmt: skip
TEXTURE = {
    "format": "penink-texture", "version": 1, "name": "t", "width": 9, "height": 9, "whole": False,
    "strokes": [{"priority": 0, "width": 0.4, "points": [[0, 8], [3, 8], [6, 9], [9, 9]]}],
}  # fmt: skip
PENS = {
    "format": "penink-pens", "version": 1, "pens": [
        {"name": "fine", "width": 0.85, "color": "#10A0ff", "speed": 142, "refill": "30cm"},
        {"name": "b", "width": "1mm"}],
}  # fmt: skip
ILLUSTRATION = {
    "format": "penink-illustration", "version": 1, "width": 9, "height": 9,
    "layers": [{"name": "l", "samples": "a", "edges": "a.edges", "pen": 0.5, "outline": {"regions": [[1, 1]]}}],
}  # fmt: skip


def seeds(reader: str) -> Iterator[bytes]:
    """Valid inputs of one of READERS."""
    if reader in ("pgm", "photo"):
        yield encoded(pgm.write, IMAGE)
        yield b"P2 # plain\n2 2\n300\n1 2 3 300\n"
        yield encoded(pgm.write, GreyImage(IMAGE.values.astype(np.uint16) * 9, 4000))
    if reader == "photo":
        from PIL import Image

        yield b"P3 1 1 9 1 2 3"
        picture = Image.fromarray(np.dstack([IMAGE.values] * 4))
        for kind in ("PNG", "TIFF", "WEBP", "JPEG"):
            out = io.BytesIO()
            (picture.convert("RGB") if kind == "JPEG" else picture).save(out, kind)
            yield out.getvalue()
        from tests.formats.photo_cases import cases

        whole = [case for case in cases() if not isinstance(case.wanted, str) and not case.choices.damage]
        yield from (case.data for case in whole if len(case.data) < 4096)
    if reader == "directions":
        yield encoded(directions.write, Directions(np.full((2, 3), 0.6), np.full((2, 3), -0.8), np.full((2, 3), 0.5)))
    if reader == "edges":
        yield encoded(edge_list.write, EDGES)
        yield json.dumps(json.loads(encoded(edge_list.write, EDGES)), indent=1, sort_keys=True).encode()
    if reader == "lines":
        yield json.dumps(LINES).encode()
    if reader == "strokes":
        yield strokes_text(9, 9, (0.5, [[1, 1], [2, 2.5], [-3, 3], [4, 4]]), (1, [[5, 5]]))
        yield b'{"seed":1,"layer":"\\u00e9","version":1,"format":"penink-strokes","height":1e1,"width":9}\r\n'
    if reader == "texture":
        yield json.dumps(TEXTURE).encode()
    if reader == "pens":
        yield json.dumps(PENS).encode()
    if reader == "illustration":
        yield json.dumps(ILLUSTRATION).encode()
    if reader == "archive":
        yield archive.pack({"illustration.json": b"{}", "0.samples": b"PIs1"})
        yield archive.pack({"illustration.json": b"{}", "parts": parts.parts_bytes([b"PIs1", b"PIe2"])})
    if reader == "compact":
        yield parts.parts_bytes([compact.text_bytes(b"a"), b"PIl3"])
        yield compact.samples_bytes(IMAGE)
        yield compact.samples_bytes(IMAGE, EDGES)
        yield compact_edges.edges_bytes(EDGES, 80, 64)
        from tests.illustration.test_compact import VECTORS

        yield bytes.fromhex(VECTORS["PIe1"])
        yield compact_lines.lines_bytes(lines.read(io.BytesIO(json.dumps(LINES).encode()), ""))
        yield compact.text_bytes(b"some text, some text")
