"""Lines along the form, others at a slant over them where it is dark, and black where it is darkest, with white lines.

Lines along the form tell it best while they are alone. Those over them lie neither square to them, which looks woven,
nor near them, which shimmers.
"""

from __future__ import annotations

from dataclasses import replace

from penink_cli.ground.model import Texture
from penink_cli.textures.hatching import hatching

ENDS, LAP, TURN = (0.65, 0.92), 0.05, 50.0
BLACK = 0.92  # the tone above which all is black


def make(*, angle: float = -45.0, pen: float = 0.4, spacing: float = 0.0, seed: int = 0) -> Texture:
    """Two layers of hatching and a black one, each with its turn from the field."""
    slanted = hatching("form", angle, 2, pen, spacing, seed, turns=(0.0, TURN), ends=ENDS, lap=LAP)
    first, second = slanted.layers
    black = replace(first, low=BLACK, high=1.0, turn=0.0)
    return replace(slanted, layers=(replace(first, turn=0.0), replace(second, turn=TURN), black))
