"""How much of a tone each layer of hatching is to cover."""

from __future__ import annotations

import numpy as np

from penink_cli.ground.model import Floats, HatchLayer

#: Where a layer sets in, the one before it gives way by this part of what it has brought, and so the new one begins
#: with lines near enough to each other to be seen as a layer; by this much more tone it has come back.
GIVES_WAY, BACK_AFTER = 0.2, 0.35
#: Where black begins, the lines of the first layer close up until they overlap by so much; what is not quite black is
#: then left out, stroke by stroke. Layers that cross each other in the dark are a grainy net instead.
BLACK = 1.4
#: How much darker than where black begins a place must be to be black amid what is not.
BLACKER = 0.03
#: Over so many cells on either side the first layer closes up, and the others go on into the black.
CLOSES_UP = 3
#: So much darker than where the next layer sets in, a place has it for itself; less, and what lies around it must be
#: as dark.
ALONE = 0.1


def shares(
    tone: Floats, around: Floats, layers: tuple[HatchLayer, ...], alone: float = ALONE, feather: float = 0.0
) -> list[Floats]:
    """How much each layer is to cover (same shape as tone), so that crossing at random they make the tone.

    around: (same shape) the mean tone of the surroundings; a layer is not begun for a spot that has room for a stroke
    or two of it, unless that is darker than where the layer begins by more than `alone`.

    feather: over so much tone the new layer begins, so that its lines start here and there and not along one border.

    A last layer whose `high` is 1 is black: where it begins the first layer goes on alone, and covers all there is.

    A layer takes up the tone until the next one sets in. Were it just to stop there, the first lines of the next would
    be stray strokes over an even hatch; an illustrator opens the hatch a little as he begins to cross it.
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
