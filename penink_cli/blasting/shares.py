"""How much of a tone each layer of hatching is to cover."""

from __future__ import annotations

import numpy as np

from penink_cli.ground.model import Floats, HatchLayer

#: Where a layer sets in, the layer before it gives way by GIVES_WAY of what it has brought. So the new layer begins
#: with lines close enough to be seen as a layer. BACK_AFTER of tone later the layer before is back.
GIVES_WAY, BACK_AFTER = 0.2, 0.35
#: Where black begins, the first layer's lines close up to this coverage, so that they overlap; strokes where it is not
#: quite black are then left out one by one. Layers that cross in the dark would be a grainy net.
BLACK = 1.4
#: How much darker than the onset of black a place must be to be black amid surroundings that are not.
BLACKER = 0.03
#: The cells to either side of black's border over which the first layer closes up and the others go on into the black.
CLOSES_UP = 3
#: A place that is darker than a layer's onset by this has the layer by itself; else its surroundings must pass the
#: onset too.
ALONE = 0.1


def shares(
    tone: Floats, around: Floats, layers: tuple[HatchLayer, ...], alone: float = ALONE, feather: float = 0.0
) -> list[Floats]:
    """How much each layer is to cover (same shape as tone), so that layers that cross at random make the tone.

    tone: ink coverage 0 … 1. around: (same shape) the mean tone of the surroundings; a spot with room for a stroke or
    two begins no layer, unless it is darker than the layer's onset by more than `alone`.

    feather: the range of tone over which a new layer comes in, so that its lines do not all start along one border.

    A last layer whose `high` is 1 is black: where it begins, the first layer goes on alone and covers everything.

    A layer takes up the tone until the next one sets in, and gives way a little there, as an illustrator opens the
    hatch where he begins to cross it. Otherwise the first lines of the next layer would be stray strokes over an even
    hatch.
    """
    if len(layers) > 1 and layers[-1].high >= 1.0:
        begin = layers[-1].low
        black = (tone > begin) & ((around > begin) | (tone > begin + BLACKER))
        first, *others = shares(tone, around, layers[:-1], alone, feather)
        part = box_mean(black.astype(np.float64), CLOSES_UP)
        others = [np.where(part < 0.999, cover, 0.0) for cover in others]
        return [first + (BLACK - first) * part, *others, np.zeros_like(tone)]
    out = []
    bare = np.ones_like(tone)
    before = 0.0
    here = tone > layers[0].low
    for i, layer in enumerate(layers):
        reached = np.minimum(tone, layer.high)
        after = np.zeros_like(here)
        if i + 1 < len(layers):
            onset = layers[i + 1].low
            after = here & (tone > onset) & ((around > onset) | (tone > onset + alone))
            t = np.clip((tone - onset) / BACK_AFTER, 0.0, 1.0)
            less = GIVES_WAY * (layer.high - before) * (1.0 - t * t * (3.0 - 2.0 * t))
            if feather:
                dark = np.maximum(np.minimum(tone, around) - onset, tone - onset - alone)
                t = np.clip(dark / feather, 0.0, 1.0)
                less = less - (1.0 - t * t * (3.0 - 2.0 * t)) * (less - layer.high + tone)
            reached = np.where(after, layer.high - less, tone)
        cover = np.clip(np.where(here, 1.0 - (1.0 - reached) / bare, 0.0), 0.0, 1.0)
        bare = bare * (1.0 - cover)
        out.append(cover)
        before, here = layer.high, after
    return out


def box_mean(values: Floats, reach: int) -> Floats:
    """Means over squares of 2 reach + 1 cells a side, the values at the border repeated beyond it."""
    for _ in range(2):
        total = np.cumsum(np.pad(values, ((reach + 1, reach), (0, 0)), mode="edge"), axis=0)
        values = ((total[2 * reach + 1 :] - total[: -2 * reach - 1]) / (2 * reach + 1)).T
    return values
