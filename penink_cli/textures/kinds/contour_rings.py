"""An engraving's lines that swell, in rings about a point."""

from __future__ import annotations

from penink_cli.ground.model import Engraving, Texture
from penink_cli.textures.engraved import engraved


def make(
    *, pen: float = 0.4, spacing: float = 0.0, seed: int = 0, finest: float = 0.0, lines: int = 0,
    centre: tuple[float, float] = (0.5, 0.5),
) -> Texture:  # fmt: skip
    """Rings about `centre`."""
    kind = Engraving(along=False, centre=centre)
    return engraved("contour-rings", kind, pen=pen, spacing=spacing, seed=seed, finest=finest, lines=lines)
