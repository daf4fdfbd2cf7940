"""An illustration as one web page that draws itself: samples, edges, texture and a renderer in JavaScript.

The page fetches nothing: it works from a local file with the network off. The program is `renderer/*.js`.
"""

from __future__ import annotations

import html
import json
import re
import zlib
from typing import Any

from penink_cli.blasting.screens import Screen
from penink_cli.ground.decimals import plain
from penink_cli.ground.model import Engraving, Illustration
from penink_cli.selfdrawing import packer
from penink_cli.selfdrawing.data import LayerData, is_sent, layers, tile_bytes

SOURCES = (
    "unpack.js", "constants.js", "reconstruct.js", "drawing.js", "outline.js", "telling.js", "phase.js", "follow.js",
    "even.js", "engrave.js", "data.js", "raster.js", "page.js",
)  # fmt: skip
#: Stand-ins for sources that a page does not need but whose functions are called all the same.
INSTEAD = {
    "telling.js": "const tellingOf = () => [], tellingOn = () => [], lighten = () => {};",
    "outline.js": "const outlinesOf = () => [];",
}


def write(illustration: Illustration, title: str, readable: bool = False, reload: bool = False) -> bytes:
    """The page, UTF-8.

    readable: the program is not packed, and keeps its comments. reload: the page loads itself again when its file
    changes. Raises LimitError for more samples, edges or lines than a device can draw.
    """
    parts = layers(illustration)
    data = b"".join(map(_bytes, parts))
    program = _program(parts)
    call = f"start({plain(illustration.width, 4)},{plain(illustration.height, 4)},{_layers(parts)},"
    if readable:
        script = f"{program}\nunpack({_quoted(data)}).then(bytes => {call}bytes));"
    else:
        code = packer.strip_javascript(program).encode("utf-8")
        script = (
            packer.strip_javascript(packer.source("unpack.js"))
            + f"\nunpack({_quoted(code + data)}).then(bytes=>{{\nconst script=document.createElement(\"script\");\n"
            f"script.textContent=new TextDecoder().decode(bytes.subarray(0,{len(code)}));\n"
            f"document.body.append(script);\n"
            f"{call}bytes.subarray({len(code)}));\n}});"
        )
    if reload:
        following = packer.source("reload.js")
        mark = f"{zlib.crc32(script.encode('utf-8')):08x}"
        following = following if readable else packer.strip_javascript(following)
        script = f"{following}\nif (!reloading(\"{mark}\")) {{\n{script}\n}}"
    parts_of_page = {"TITLE": html.escape(title), "PROGRAM": script}  # in one go: either may hold the other's name
    page = re.sub("|".join(parts_of_page), lambda found: parts_of_page[found[0]], packer.source("page.html"))
    return page.encode("utf-8")


def _program(parts: list[LayerData]) -> str:
    """The sources that such layers need, in order."""
    along, engraved = any(part.field for part in parts), any(part.engraving for part in parts)
    needed = {
        "phase.js": along or engraved, "follow.js": along or engraved, "engrave.js": engraved,
        "even.js": any(part.engraving and part.field for part in parts),
        "telling.js": any(part.told.lines for part in parts), "outline.js": any(part.outlined for part in parts),
    }  # fmt: skip
    return "\n".join(packer.source(name) if needed.get(name, True) else INSTEAD.get(name, "") for name in SOURCES)


def _bytes(layer: LayerData) -> bytes:
    tiles = [tile_bytes(s) for s in layer.table.screens if is_sent(s)]
    field = layer.field.angles if layer.field else b""
    return b"".join([layer.samples, layer.edges, *tiles, field, layer.told.lines])


def _quoted(data: bytes) -> str:
    packed = packer.deflate(data)
    return f'"{packer.letters(packed)}",{len(packed)}'


def _layers(parts: list[LayerData]) -> str:
    return json.dumps([_description(part) for part in parts], separators=(",", ":"))


def _description(layer: LayerData) -> dict[str, Any]:
    told = layer.told
    return {
        "w": layer.width,
        "h": layer.height,
        "levels": layer.levels,
        "chains": layer.chains,
        "outlined": layer.outlined,
        "outlinePen": layer.outline_pt,
        "gamma": layer.gamma,
        "family": layer.family,
        "field": [layer.field.width, layer.field.height] if layer.field else [0, 0],
        "form": layer.form,
        "black": layer.black,
        "ink": layer.color,
        "engraving": _engraving(layer.engraving),
        "told": [told.dark, told.white],
        "lineGrid": [told.across, told.down],
        "linePen": told.choice.pen_pt,
        "lineEven": told.choice.even,
        "pen": round(layer.table.pen_pt, 4),
        "magnification": round(layer.table.magnification, 4),
        "screens": [_screen(s, layer.table.whole) for s in layer.table.screens],
        "fill": [[one.angle, one.low, one.high] for one in layer.table.fill],
        "least": layer.table.least_pt,
    }


def _engraving(kind: Engraving | None) -> Any:
    if kind is None:
        return None
    return {
        "spacing": kind.spacing_pt, "finest": kind.finest_pt, "angle": kind.angle, "centre": kind.centre,
        "waver": kind.waver, "blunt": kind.blunt, "lines": kind.lines,
        "crosses": kind.crosses,
    }  # fmt: skip


def _screen(screen: Screen, whole: bool) -> Any:
    if screen.layer is not None:
        layer = screen.layer
        return [layer.angle, layer.low, layer.high, screen.wave, screen.turn, round(screen.widens, 4)]
    if screen.again is not None:
        return {"again": screen.again}
    return {
        "tile": [screen.width, screen.height],
        "fresh": [round(v, 4) for v in screen.fresh.tolist()],
        "covers": [round(v, 4) for v in screen.covers.tolist()],
        "whole": whole,
        "widens": round(screen.widens, 4),
        "strokes": len(screen.enters),
        "grows": screen.spans is not None,
    }
