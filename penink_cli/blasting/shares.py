"""How much of a tone each layer of hatching is to cover."""

from __future__ import annotations

import numpy as np

from penink_cli.ground.model import Floats, HatchLayer

#: Where a layer sets in, the one before it gives way by this part of what it has brought, and so the new one begins
#: with lines near enough to each other to be seen as a layer; by this much more tone it has come back.
GIVES_WAY, BACK_AFTER = 0.2, 0.35
#: So much darker than where the next layer sets in, a place has it for itself; less, and what lies around it must be
#: as dark.
ALONE = 0.1


def shares(tone: Floats, around: Floats, layers: tuple[HatchLayer, ...]) -> list[Floats]:
    """How much each layer is to cover (same shape as tone), so that crossing at random they make the tone.

    around: (same shape) the mean tone of the surroundings; a layer is not begun for a spot that has room for a stroke
    or two of it.

    A layer takes up the tone until the next one sets in. Were it just to stop there, the first lines of the next would
    be stray strokes over an even hatch; an illustrator opens the hatch a little as he begins to cross it.
    """
    out = []
    bare = np.ones_like(tone)
    before = 0.0
    here = tone > layers[0].low
    for i, layer in enumerate(layers):
        reached = np.minimum(tone, layer.high)
        after = np.zeros_like(here)
        if i + 1 < len(layers):
            onset = layers[i + 1].low
            after = here & (tone > onset) & ((around > onset) | (tone > onset + ALONE))
            t = np.clip((tone - onset) / BACK_AFTER, 0.0, 1.0)
            less = GIVES_WAY * (layer.high - before) * (1.0 - t * t * (3.0 - 2.0 * t))
            reached = np.where(after, layer.high - less, tone)
        cover = np.clip(np.where(here, 1.0 - (1.0 - reached) / bare, 0.0), 0.0, 1.0)
        bare = bare * (1.0 - cover)
        out.append(cover)
        before, here = layer.high, after
    return out
