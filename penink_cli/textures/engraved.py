"""Textures whose lines swell (`Engraving`), each with a tile of lines of one width for where lines cannot swell."""

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
    """A texture of lines like `kind`'s, but for the options that are given (see `kinds`).

    Raises ParameterError for a finest line that is not finer than the spacing.
    """
    apart, least = spacing or kind.spacing_pt, finest or kind.finest_pt
    if not least < apart:
        raise ParameterError(f"a finest line of {least:g} pt at a spacing of {apart:g}")
    engraving = replace(kind, angle=angle, spacing_pt=apart, finest_pt=least, lines=lines or None, crosses=crosses)
    return replace(hatching(name, angle, layers, pen, 0.0, seed), engraving=engraving)
