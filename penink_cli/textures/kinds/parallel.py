"""Lines in one direction, denser as it gets darker."""

from __future__ import annotations

from penink_cli.ground.model import Texture
from penink_cli.textures.hatching import hatching


def make(*, angle: float = -45.0, pen: float = 0.4, spacing: float = 0.0, layers: int = 1, seed: int = 0) -> Texture:
    """Hatching of one layer, or more."""
    return hatching("parallel", angle, layers, pen, spacing, seed)
