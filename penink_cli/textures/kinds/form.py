"""Lines along the form, others at a slant over them where it is dark, and black where it is darkest.

Lines along the form show it best while they are alone. The lines over them are turned by TURN: at a right angle both
look woven, and at a small one they make a moiré.
"""

from __future__ import annotations

from dataclasses import replace

from penink_cli.ground.model import Texture
from penink_cli.textures.hatching import hatching

ENDS, LAP, TURN = (0.65, 0.92), 0.05, 50.0  # of the two layers of lines, as `hatching` has them; degrees
BLACK = 0.92  # the tone above which all is black


def make(*, angle: float = -45.0, pen: float = 0.4, spacing: float = 0.0, seed: int = 0) -> Texture:
    """Two layers of hatching and a black one, each with its turn from the field."""
    slanted = hatching("form", angle, 2, pen, spacing, seed, turns=(0.0, TURN), ends=ENDS, lap=LAP)
    first, second = slanted.layers
    black = replace(first, low=BLACK, high=1.0, turn=0.0)
    return replace(slanted, layers=(replace(first, turn=0.0), replace(second, turn=TURN), black))
