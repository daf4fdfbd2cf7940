"""An illustration as one EPS that draws itself: samples, edges, texture and a renderer in PostScript.

The program in it, `renderer/*.ps`, reads the current matrix and the device's resolution, and draws strokes of constant
width and density for the size that the picture has there. It keeps to a dictionary of its own between save and
restore, leaves the stacks as it found them, and uses no operator that changes the device.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from penink_cli.blasting.screens import Screen
from penink_cli.ground.decimals import plain
from penink_cli.ground.model import Engraving, Illustration
from penink_cli.selfdrawing import packer
from penink_cli.selfdrawing.data import LayerData, is_sent, layers, tile_bytes

SOURCES = (
    "constants.ps", "reconstruct.ps", "texture.ps", "drawing.ps", "outline.ps", "telling.ps", "engrave.ps", "data.ps",
    "page.ps",
)  # fmt: skip
#: Stand-ins for sources that a picture does not need but whose procedures are called all the same.
INSTEAD = {
    "telling.ps": "/PlanTold { } def /PaintTold { } def",
    "outline.ps": "/PlanOutlines { } def /PaintOutlines { } def",
}


def write(illustration: Illustration, packing: str = "flate") -> bytes:
    """The EPS.

    packing: flate, for Level 3 interpreters; lzw, for Level 2; or readable, with its comments. Raises LimitError for
    more samples, edges or lines than a device can draw.
    """
    parts = layers(illustration)
    width, height = illustration.width, illustration.height
    head = (
        "%!PS-Adobe-3.0 EPSF-3.0\n"
        f"%%BoundingBox: 0 0 {math.ceil(width)} {math.ceil(height)}\n"
        f"%%HiResBoundingBox: 0 0 {plain(width, 4)} {plain(height, 4)}\n"
        "%%Creator: penink\n"
        f"%%LanguageLevel: {3 if packing == 'flate' else 2}\n"
        "%%Pages: 1\n%%DocumentData: Clean7Bit\n%%EndComments\n%%Page: 1 1\n"
        "save 300 dict begin\n"
    )
    tail = "end restore\nshowpage\n%%Trailer\n%%EOF\n"
    program = _program(parts)
    page = f"{plain(width, 4)} {plain(height, 4)} Page\n"
    picture = "".join(_picture(parts, ink) for ink in dict.fromkeys(part.color for part in parts))
    if packing == "readable":
        body = program + page
        for i, layer in enumerate(parts):
            data = _bytes(layer)
            lines = [data[k : k + 40].hex() for k in range(0, len(data), 40)]
            source = "/Source currentfile /ASCIIHexDecode filter def"
            body += f"{_opened(i)}/Data {{ {source} {_read(layer)} Source flushfile }} bind def\nData\n"
            body += "\n".join(lines) + "\n>\n" + _closed(layer)
        return (head + body + picture + tail).encode("ascii")
    packed = (packer.strip_postscript(program) + "\n" + page).encode("ascii")
    for i, layer in enumerate(parts):
        packed += f"{_opened(i)}/Source currentfile def/Data{{{_read(layer)}}}bind def Data\n".encode("ascii")
        packed += _bytes(layer) + ("\n" + _closed(layer)).encode("ascii")
    packed += picture.encode("ascii")
    data = packer.deflate(packed) if packing == "flate" else packer.lzw(packed)
    name = "FlateDecode" if packing == "flate" else "LZWDecode"
    body = f"{{ currentfile /ASCII85Decode filter dup /{name} filter cvx exec flushfile }} exec\n"
    return (head + body).encode("ascii") + packer.ascii85(data) + tail.encode("ascii")


def _program(parts: list[LayerData]) -> str:
    """The sources that such layers need, in order."""
    told = any(part.told.lines for part in parts)
    needed = {
        "engrave.ps": any(part.engraving for part in parts), "telling.ps": told,
        "outline.ps": told or any(part.outlined for part in parts),
    }  # fmt: skip
    return "\n".join(packer.source(name) if needed.get(name, True) else INSTEAD.get(name, "") for name in SOURCES)


def _picture(parts: list[LayerData], ink: str) -> str:
    """The layers of one ink, drawn together."""
    red, green, blue = (plain(int(ink[k : k + 2], 16) / 255, 4) for k in (1, 3, 5))
    names = " ".join(f"Layer{i}" for i, part in enumerate(parts) if part.color == ink)
    return f"{red} {green} {blue} setrgbcolor [ {names} ] Picture\n"


def _bytes(layer: LayerData) -> bytes:
    tiles = [tile_bytes(s) for s in layer.table.screens if is_sent(s)]
    return layer.samples + layer.edges + b"".join(tiles) + layer.told.lines


def _read(layer: LayerData) -> str:
    told = layer.told
    return (
        f"{layer.width} {layer.height} {layer.levels} GetSamples "
        f"{layer.chains} {layer.outlined} {layer.vertices} {layer.ends} GetEdges "
        + "".join(_tile(i, s, layer.table.whole) + " " for i, s in enumerate(layer.table.screens) if is_sent(s))
        + f"{told.dark} {told.white} {told.across} {told.down} GetTold"
    )


def _opened(number: int) -> str:
    return f"/Layer{number} 300 dict def Layer{number} begin\n"


def _closed(layer: LayerData) -> str:
    table = layer.table
    screens = " ".join(_screen(i, s) for i, s in enumerate(table.screens))
    if table.fill:
        fill = " ".join(f"[ {_row((one.angle, one.low, one.high))} ]" for one in table.fill)
        screens += f" {plain(table.least_pt, 4)} [ {fill} ] Grow"
    return (
        f"/OutlinePen {plain(layer.outline_pt, 4)} def /Gamma {plain(layer.gamma, 4)} def /Family {layer.family} def\n"
        f"/LinePen {plain(layer.told.choice.pen_pt, 4)} def /LineEven {_bool(layer.told.choice.even)} def\n"
        f"/engraving {_engraving(layer.engraving)} def /black {plain(255 * layer.black, 4)} def\n"
        f"{plain(table.pen_pt, 4)} {plain(table.magnification, 4)} Pens [ {screens} ] Layer\nend\n"
    )


def _engraving(kind: Engraving | None) -> str:
    if kind is None:
        return "null"
    middle = "null null" if kind.centre is None else _row(kind.centre)
    spacing = -kind.lines if kind.lines else kind.spacing_pt
    numbers = _row((spacing, kind.finest_pt, kind.angle))
    return f"[ {numbers} {middle} {plain(kind.waver, 4)} {_bool(kind.blunt)} {plain(kind.crosses, 4)} ]"


def _bool(value: bool) -> str:
    return "true" if value else "false"


def _screen(number: int, screen: Screen) -> str:
    if screen.again is not None:
        return f"Tile0 {plain(screen.again, 4)} Again"
    if screen.layer is None:
        return f"Tile{number}"
    layer = screen.layer
    numbers = (layer.angle, layer.low, layer.high, screen.wave, math.degrees(screen.turn))
    return f"{number} {_row(numbers)} Lines"


def _tile(number: int, screen: Screen, whole: bool) -> str:
    fresh, covers = (_row(v.tolist()) for v in (screen.fresh, screen.covers))
    return (
        f"/Tile{number} {plain(screen.width, 4)} {plain(screen.height, 4)} [ {fresh} ] [ {covers} ] "
        f"{_bool(whole)} {plain(screen.widens, 4)} {_bool(screen.spans is not None)} {len(screen.enters)} GetTile def"
    )


def _row(values: Iterable[float]) -> str:
    return " ".join(plain(value, 4) for value in values)
