"""Textures whose lines swell: what these are like (`Engraving`), and a tile of lines of one width in their stead."""

from __future__ import annotations

from dataclasses import replace

from penink_cli.ground.errors import ParameterError
from penink_cli.ground.model import Engraving, Texture
from penink_cli.textures.hatching import hatching

ANGLE, PEN, LAYERS = -30.0, 0.4, 1


def engraved(
    name: str, kind: Engraving, *, angle: float = ANGLE, pen: float = PEN, spacing: float = 0.0, layers: int = LAYERS,
    seed: int = 0, finest: float = 0.0, lines: int = 0, crosses: float = 1.0,
) -> Texture:  # fmt: skip
    """A texture of lines like `kind`'s, with what is given in their stead (see `kinds`).

    Raises ParameterError for a finest line that is no finer than the lines' distance.
    """
    apart, least = spacing or kind.spacing_pt, finest or kind.finest_pt
    lines_of = replace(
        kind, angle=angle, spacing_pt=apart, finest_pt=least, lines=lines or None, crosses=crosses
    )  # fmt: skip
    if not lines_of.finest_pt < lines_of.spacing_pt:
        raise ParameterError(f"a finest line of {lines_of.finest_pt:g} pt at a spacing of {lines_of.spacing_pt:g}")
    return replace(hatching(name, angle, layers, pen, 0.0, seed), engraving=lines_of)
