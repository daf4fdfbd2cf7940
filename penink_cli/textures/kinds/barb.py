"""Short hooks along the form, as of feathers."""

from __future__ import annotations

from penink_cli.ground.model import Texture
from penink_cli.textures.sets import oriented

#: Control points x, y of chains of cubics, points.
EXAMPLES = (
    (0, 0, 3, 0, 7, 0.6, 10, 2.5),
    (0, 0, 2.6, 0.4, 5.4, 1.2, 8.5, 2.9),
    (0, 0, 4, 0.3, 8.5, 0.4, 12, 1.7),
    (0, 0, 3, -0.2, 6.5, 0.1, 9.5, 1.4),
)


def make(*, pen: float = 0.4) -> Texture:
    """The set, drawn with one pen."""
    return oriented("barb", EXAMPLES, pen)
