"""Which tones a texture can make."""

from __future__ import annotations

from penink_cli.ground.model import Texture


def reachable(texture: Texture, gain_pt: float) -> tuple[float, float]:
    """The lightest and the darkest tone: one stroke a tile, and all of them.

    A set of strokes ends where its last pass does, hatching in layers where its last layer does, and
    is never darker than the closest lines it may draw.
    """
    if texture.oriented:
        from penink_cli.blasting.stroke_set import PASSES

        return 0.0, PASSES[-1][1]
    if texture.layers:
        return 0.0, max(layer.high for layer in texture.layers)
    from penink_cli.blasting import tile

    enters = tile.thresholds(texture, gain_pt)
    darkest = tile.reach(texture, gain_pt)
    return (float(enters[1]) if len(enters) > 1 else darkest), darkest
