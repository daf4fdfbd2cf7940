"""True tone in a closed loop, each texture in the way that suits it; what the others need is not loaded."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from penink_cli.blasting import hatching
from penink_cli.blasting.sheet import Sheet
from penink_cli.blasting.task import Begun, Task
from penink_cli.ground.median import median
from penink_cli.ground.model import Strokes, Texture

SETS = True


def follows(texture: Texture) -> bool:
    """Sets, hatching layers, and engravings save straight ones."""
    if texture.engraving is not None and not texture.oriented:
        return texture.engraving.along
    return texture.oriented or bool(texture.layers)


def draw(task: Task) -> Strokes:
    """Sets along the field, lines that swell, hatching by layers, or copies of the tile."""
    begun = Begun(task)
    texture = task.texture
    if texture.oriented:
        strokes = _set(task, begun)
    elif texture.engraving is not None and task.pen_pt is None:
        from penink_cli.blasting.rules.engrave import engraved

        strokes = engraved(task, begun)
    elif texture.layers:
        strokes = _layers(task, begun)
    elif texture.scales is not None:
        strokes = _grown(task, begun)
    else:
        strokes = _tile(task, begun)
    return begun.with_small(strokes)


def _layers(task: Task, begun: Begun) -> Strokes:
    layers, sheet = task.texture.layers, begun.sheet
    strokes = hatching.hatch_sheet(
        sheet, layers, task.edges, task.gain, task.seed, task.pen_pt, task.tick, begun.field, begun.told
    )
    return _pressed(task, begun, strokes)


def _grown(task: Task, begun: Begun) -> Strokes:
    """The tile at its size, as far as it reaches, and a hatching of one size for the rest of the tone."""
    from penink_cli.blasting import scaling, tile

    texture = scaling.at_size(task.texture, task.width_pt, task.natural_pt)
    assert task.texture.scales is not None
    first = Strokes(task.width_pt, task.height_pt)
    if len(texture.strokes):
        most = tile.reach(texture, task.gain)
        first = _tile(replace(task, texture=texture), Begun(replace(task, tone=np.minimum(task.tone, most))))
    sheet = Sheet(task.tone, task.width_pt, task.height_pt, task.gain, task.threads)
    for there in (task.outlines, begun.small, first):
        if there is not None:
            hatching.draw_first(sheet, there)
    pen = float(median(task.texture.strokes.widths))
    layers = tuple(replace(layer, pen_pt=pen) for layer in scaling.FILLS[task.texture.scales.fill])
    filled = hatching.hatch_sheet(
        sheet, layers, task.edges, task.gain, task.seed, task.pen_pt, task.tick, None, begun.told
    )
    return Strokes.joined([first, filled])


def _pressed(task: Task, begun: Begun, strokes: Strokes) -> Strokes:
    if not task.swell:
        return strokes
    from penink_cli.blasting.pressure import swollen

    return swollen(begun.sheet, strokes, task.tone, task.swell)


def _set(task: Task, begun: Begun) -> Strokes:
    from penink_cli.blasting.stroke_set import passes

    examples = task.texture.strokes
    strokes = hatching.hatch_sheet(
        begun.sheet, passes(examples), task.edges, task.gain, task.seed, task.pen_pt, task.tick,
        begun.field or begun.one_angle(), begun.told, examples,
    )  # fmt: skip
    return _pressed(task, begun, strokes)


def _tile(task: Task, begun: Begun) -> Strokes:
    from penink_cli.blasting import tile

    sheet, texture = begun.sheet, task.texture
    enters = tile.thresholds(texture, task.gain)
    parts = tile.blast_tile(sheet, texture, task.edges, enters, task.seed, False, task.pen_pt, task.tick)
    strokes = Strokes.joined([Strokes(task.width_pt, task.height_pt), *parts])
    if task.pen_pt is None and len(strokes):
        sheet.clear()  # the best round may not have been the last
        hatching.paint(sheet, strokes)
        strokes = hatching.press(sheet, strokes, task.seed, tile.crowd(sheet, texture))
    return strokes
