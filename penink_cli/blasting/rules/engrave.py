"""Lines that swell: the texture's if it has them, else straight ones at the angle of its first layer."""

from __future__ import annotations

from penink_cli.blasting import engraving
from penink_cli.blasting.task import Begun, Task
from penink_cli.ground.model import Engraving, Strokes, Texture

SETS = False


def follows(texture: Texture) -> bool:
    """Save straight engravings."""
    return texture.engraving is None or texture.engraving.along


def draw(task: Task) -> Strokes:
    """The lines of one engraving."""
    begun = Begun(task)
    return begun.with_small(engraved(task, begun))


def engraved(task: Task, begun: Begun) -> Strokes:
    """The lines alone, on a sheet that has been begun."""
    layers = task.texture.layers
    kind = task.texture.engraving or Engraving(angle=layers[0].angle if layers else Engraving.angle)
    along = begun.field if kind.along else None
    return engraving.engrave(begun.sheet, kind, task.edges, task.seed, along, task.tick, begun.near)
