"""Strokes as SVG, in millimetres, a path for each; a stroke that swells is the path of its outline.

Layers are groups that Inkscape shows as layers. Their labels begin with their number, for vpype
and an AxiDraw take the first digits of a label for the layer's number.
"""

from __future__ import annotations

from collections.abc import Sequence
from xml.sax.saxutils import quoteattr

import numpy as np

from penink_cli.formats.strokes import Sink
from penink_cli.ground.codes import code_of
from penink_cli.ground.decimals import plain
from penink_cli.ground.model import Floats, Ints, Strokes
from penink_cli.ground.units import POINT_MM
from penink_cli.outputs import inks, swelling, words
from penink_cli.outputs.page import Page

DECIMALS = 3  # micrometres
OUTLINE_DECIMALS = 2  # of a millimetre: outlines are off by an eighth of a dot of 600 dpi at the most
BATCH = 20000  # strokes that are turned into text at a time


def write(
    out: Sink,
    layers: Sequence[Strokes],
    page: Page,
    colours: Sequence[tuple[float, float, float]] = (),
    labels: Sequence[str] = (),
    merge: bool = False,
) -> None:
    """Write an SVG 1.1 file; the first layer is at the bottom. Colours: red, green, blue (0 … 1) of each layer.

    Where there are several colours, a layer's ink is transparent: what lies below shows through. labels: of the layers;
    unless given, their numbers and names. merge: one path for strokes of one width that follow one another.
    """
    colours = [colours[i] if i < len(colours) else inks.BLACK for i in range(len(layers))]
    blend = ' style="mix-blend-mode:multiply"' if inks.overprint(colours) else ""
    width, height = plain(page.width * POINT_MM, DECIMALS), plain(page.height * POINT_MM, DECIMALS)
    out.write(
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"\n'
        f'     version="1.1" width="{width}mm" height="{height}mm" viewBox="0 0 {width} {height}">\n'.encode()
    )
    for i, layer in enumerate(layers):
        label = f"{i + 1} {layer.layer}" if layer.layer else f"{i + 1}"
        label = _xml(labels[i] if labels else label)
        colour = code_of(colours[i])
        swells = layer.swells
        layer, wide = (layer.taken(~swells), layer.taken(swells)) if swells.any() else (layer, None)
        pens, counts = np.unique(layer.widths, return_counts=True)
        pen = float(pens[np.argmax(counts)]) if len(pens) else 1.0
        out.write(
            f'<g id="layer{i + 1}" inkscape:groupmode="layer" inkscape:label={quoteattr(label)}\n'
            f'   fill="none" stroke="{colour}" stroke-width="{plain(pen * POINT_MM, 4)}" '
            f'stroke-linecap="round" stroke-linejoin="round"{blend}>\n'.encode()
        )
        batch = max(1, len(layer)) if merge else BATCH
        for start in range(0, len(layer), batch):
            out.write(_paths(layer, start, min(start + batch, len(layer)), page, pen, merge))
        if wide is not None:
            scale = plain(1 / 10**OUTLINE_DECIMALS, OUTLINE_DECIMALS)
            out.write(f'<g fill="{colour}" stroke="none" transform="scale({scale})">\n'.encode())
            for start in range(0, len(wide), BATCH):
                out.write(_outlines(wide.taken(np.arange(start, min(start + BATCH, len(wide)))), page))
            out.write(b"</g>\n")
        out.write(b"</g>\n")
    out.write(b"</svg>\n")


def _paths(layer: Strokes, start: int, stop: int, page: Page, usual: float, merge: bool) -> memoryview:
    """Strokes start … stop - 1, each a path: M x y and cubic segments relative to where they begin.

    merge: those of one width that follow one another are one path, each a subpath.
    """
    first = layer.first[start : stop + 1] - layer.first[start]
    counts = np.diff(first)
    numbers = _relative(layer.points[layer.first[start] : layer.first[stop]], first, page)
    pens, pen = np.unique(layer.widths[start:stop], return_inverse=True)
    begin = b'<path d="M'
    ends = [b"" if p == usual else b' stroke-width="%s"' % plain(p * POINT_MM, 4).encode() for p in pens.tolist()]
    # A dot is a line of a micrometre: some programs do not draw a line without length, and vpype drops it.
    lines = [b'"%s/>\n%s' % (end, begin) for end in ends]
    table = [b" ", b"c", begin, *lines, *(b"h.001" + line for line in lines)]
    after = np.zeros((len(numbers), 2), np.int32)
    after[first[:-1], 1] = 1
    after[first[1:] - 1, 1] = 3 + pen + np.where(counts == 1, len(ends), 0)
    if merge:
        table += [b"M", b"h.001M"]
        goes_on = np.append(pen[1:] == pen[:-1], False)
        after[(first[1:] - 1)[goes_on], 1] = 3 + 2 * len(ends) + (counts[goes_on] == 1)
    body = words.text(numbers.ravel(), after.ravel(), table, DECIMALS)
    return memoryview(begin + bytes(body[: len(body) - len(begin)]))


def _outlines(strokes: Strokes, page: Page) -> memoryview:
    """The outlines of strokes that swell, a path each; filled, by either rule, they are the strokes."""
    points, first = swelling.outlines(strokes)
    numbers = _relative(points, first, page, OUTLINE_DECIMALS)
    begin = b'<path d="M'
    after = np.zeros((len(numbers), 2), np.int32)
    after[first[:-1], 1] = 1
    after[first[1:] - 1, 1] = 2
    body = words.text(numbers.ravel(), after.ravel(), [b" ", b"c", b'z"/>\n' + begin])
    return memoryview((begin + bytes(body[: len(body) - len(begin)])).replace(b" -", b"-"))


def _relative(points: Floats, first: Ints, page: Page, decimals: int = DECIMALS) -> Ints:
    """Points (p, 2) of chains on the page in whole 10^-decimals mm, those of a segment relative to where it begins."""
    grid = words.whole((points + np.array((page.x, page.y))) * (POINT_MM * 10**decimals))
    inner = np.arange(len(grid)) - np.repeat(first[:-1], np.diff(first))
    origin = np.arange(len(grid)) - np.where(inner > 0, (inner - 1) % 3 + 1, 0)
    return np.where((inner > 0)[:, None], grid - grid[origin], grid)


def _xml(name: str) -> str:
    """The name with what XML cannot hold replaced."""
    return "".join(c if c.isprintable() else "\ufffd" for c in name).encode("utf-8", "replace").decode()
