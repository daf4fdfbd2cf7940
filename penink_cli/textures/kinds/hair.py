"""Long hairs along the form, from the root."""

from __future__ import annotations

from penink_cli.ground.model import Texture
from penink_cli.textures.sets import oriented

#: Control points x, y of chains of cubics, points.
EXAMPLES = (
    (0, 0, 12, 0.6, 26, 1.7, 38, 3.2),
    (0, 0, 10, -0.9, 20, -0.6, 31, 0.8),
    (0, 0, 10, 0.8, 19, 1.3, 27, 0.6, 35, -0.1, 42, -0.4, 50, 0.9),
    (0, 0, 9, 0.2, 17, 0.6, 25, 1.6),
    (0, 0, 8, -0.4, 17, -1.2, 24, -0.8, 31, -0.4, 36, 0.6, 42, 0.4),
)


def make(*, pen: float = 0.35) -> Texture:
    """The set, drawn with one pen."""
    return oriented("hair", EXAMPLES, pen)
