"""The paper's rule: no stroke that makes any place too dark, in order of priority."""

from __future__ import annotations

from penink_cli.blasting import tile
from penink_cli.blasting.task import Begun, Task
from penink_cli.ground.model import Strokes, Texture

SETS = False


def follows(texture: Texture) -> bool:
    """A tile lies as it lies."""
    return False


def draw(task: Task) -> Strokes:
    """The strokes of the texture's tile that fit."""
    begun = Begun(task)
    enters = tile.thresholds(task.texture, task.gain)
    parts = tile.blast_tile(
        begun.sheet, task.texture, task.edges, enters, task.seed, True, task.pen_pt, task.tick
    )
    return begun.with_small(Strokes.joined([Strokes(task.width_pt, task.height_pt), *parts]))
