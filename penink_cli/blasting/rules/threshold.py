"""Each stroke wherever the tone exceeds the one at which its texture has it enter.

That is what an illustration that draws itself does on a device. It knows no seed. What a device does not do: things too
small for strokes that lie where they lie are drawn, or left out, as by the other rules.
"""

from __future__ import annotations

from penink_cli.blasting.task import Begun, Task
from penink_cli.blasting.threshold import blast_by_threshold
from penink_cli.ground.model import Strokes, Texture

SETS = False


def follows(texture: Texture) -> bool:
    """A device is sent no field."""
    return False


def draw(task: Task) -> Strokes:
    """The strokes of the texture's screens."""
    strokes = blast_by_threshold(
        task.tone, task.width_pt, task.height_pt, task.edges, task.texture, task.pen_pt, task.device_dpi, task.outlines,
        task.natural_pt,
    )  # fmt: skip
    return Begun(task).with_small(strokes)
