"""Wandering lines side by side, like the grain of wood."""

from __future__ import annotations

from penink_cli.ground.model import Texture
from penink_cli.textures.hatching import hatching


def make(*, angle: float = -8.0, pen: float = 0.4, spacing: float = 0.0, layers: int = 1, seed: int = 0) -> Texture:
    """Hatching whose lines wander five points over an inch."""
    return hatching("grain", angle, layers, pen, spacing, seed, wave=5.0, wave_length=72.0)
