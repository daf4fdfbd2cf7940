"""Blasting (section 3): a grey image and a stroke texture to strokes of the same tone."""

from __future__ import annotations

from dataclasses import replace

from penink_cli.blasting import hatching, tile
from penink_cli.blasting.sheet import Sheet
from penink_cli.errors import ParameterError
from penink_cli.model import EdgeList, Floats, Strokes, Texture

#: The rules by which strokes are chosen.
RULES = ("best", "strict", "threshold")


def blast(
    tone: Floats,
    width_pt: float,
    height_pt: float,
    edges: EdgeList | None,
    texture: Texture,
    *,
    seed: int = 0,
    pen_pt: float | None = None,
    device_dpi: float | None = 600.0,
    rule: str = "best",
    outlines: Strokes | None = None,
    threads: int | None = None,
) -> Strokes:
    """Strokes of `texture` on a sheet of width_pt × height_pt that have the tone (h, w), 0 paper … 1 ink."""
    if rule not in RULES:
        raise ParameterError(f"rule {rule!r}: known are {', '.join(RULES)}")
    gain = 72.0 / device_dpi if device_dpi else 0.0
    sheet = Sheet(tone, width_pt, height_pt, gain, threads or 1)
    if rule == "best" and texture.layers:
        strokes = hatching.hatch_sheet(sheet, texture.layers, edges, gain, seed, pen_pt)
    else:
        enters = tile.thresholds(texture, gain)
        if rule == "threshold":
            parts = tile.draw_by_threshold(sheet, texture, enters, seed, pen_pt)
        else:
            parts = tile.blast_tile(sheet, texture, enters, seed, rule == "strict", pen_pt)
        strokes = hatching.join(parts, width_pt, height_pt)
        if rule == "best" and pen_pt is None and len(strokes):
            strokes = hatching.press(sheet, strokes, seed)
    return replace(strokes, texture=texture.name, seed=seed)
