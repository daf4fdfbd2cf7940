"""Lines in one direction, and others across them where it is dark."""

from __future__ import annotations

from penink_cli.ground.model import Texture
from penink_cli.textures.hatching import hatching


def make(*, angle: float = -45.0, pen: float = 0.4, spacing: float = 0.0, layers: int = 2, seed: int = 0) -> Texture:
    """Hatching of two layers, or as many as are wanted."""
    return hatching("crosshatch" if layers <= 2 else f"crosshatch{layers}", angle, layers, pen, spacing, seed)
