"""Blades of grass along the form, from the tip."""

from __future__ import annotations

from penink_cli.ground.model import Texture
from penink_cli.textures.sets import oriented

#: Control points x, y of chains of cubics, points.
EXAMPLES = (
    (0, 0, 3, 2.2, 10, 3.6, 24, 3.9),
    (0, 0, 5, 1.6, 12, 2.3, 19, 2.2),
    (0, 0, 2, 3.4, 11, 5.2, 29, 5.4),
    (0, 0, 6, 0.7, 11, 0.9, 16, 0.6),
    (0, 0, 7, 1.0, 16, 1.2, 27, 0.2),
)


def make(*, pen: float = 0.4) -> Texture:
    """The set, drawn with one pen."""
    return oriented("grass", EXAMPLES, pen)
