"""Which tones a texture can make."""

from __future__ import annotations

from penink_cli.blasting import tile
from penink_cli.model import Texture


def reachable(texture: Texture, gain_pt: float) -> tuple[float, float]:
    """The lightest and the darkest tone: one stroke a tile, and all of them.

    Hatching in layers ends where its last layer does, and is never darker than the closest lines it may draw.
    """
    enters = tile.thresholds(texture, gain_pt)
    low = float(enters[1]) if len(enters) > 1 else tile.reach(texture, gain_pt)
    if not texture.layers:
        return low, tile.reach(texture, gain_pt)
    bare = 1.0
    for layer in texture.layers:
        bare = min(bare, 1.0 - layer.high)
    return 0.0, 1.0 - bare
