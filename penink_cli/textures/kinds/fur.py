"""Short hairs along the form, from the root."""

from __future__ import annotations

from penink_cli.ground.model import Texture
from penink_cli.textures.sets import oriented

#: Control points x, y of chains of cubics, points.
EXAMPLES = (
    (0, 0, 7, 0.2, 14, 1.0, 21, 2.4),
    (0, 0, 5, 0.9, 10, 1.2, 15, 0.7),
    (0, 0, 8, -0.5, 17, 0.4, 25, 2.5),
    (0, 0, 6, 1.3, 12, 1.7, 18, 0.9),
    (0, 0, 4, 0.3, 8, 0.6, 12, 1.5),
    (0, 0, 5, -0.3, 11, 0.2, 16, -0.4),
)


def make(*, pen: float = 0.4) -> Texture:
    """The set, drawn with one pen."""
    return oriented("fur", EXAMPLES, pen)
