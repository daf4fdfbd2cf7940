"""Blasting (section 3): a grey image and a stroke texture to strokes of the same tone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from penink_cli.blasting import hatching, rules
from penink_cli.blasting.sheet import Sheet, resample
from penink_cli.blasting.task import Task, read_field
from penink_cli.ground import threads as threading
from penink_cli.ground.errors import ParameterError
from penink_cli.ground.model import Directions, EdgeList, Floats, Lines, Strokes, Texture
from penink_cli.ground.recall import recalled

#: How often a blast calls its `tick`, at the most.
TICKS = 5


def blast(
    tone: Floats,
    width_pt: float,
    height_pt: float,
    edges: EdgeList | None,
    texture: Texture,
    *,
    seed: int = 0,
    pen_pt: float | None = None,
    device_dpi: float | None = 600.0,
    rule: str = "best",
    outlines: Strokes | None = None,
    directions: Directions | None = None,
    lines: Lines | None = None,
    swell: float = 0.0,
    natural_pt: float | None = None,
    true: Floats | None = None,
    solid: float | None = None,
    threads: int | None = None,
    tick: Callable[[], None] = lambda: None,
) -> Strokes:
    """Strokes of `texture` that give a sheet the tone of an image.

    tone: (h, w) ink coverage, 0 paper … 1 solid ink; it fills the sheet of width_pt × height_pt points.
    edges: discontinuity edges of the image; strokes end at those over which the tone steps strongly.
    pen_pt: the one width of all strokes; by default the texture's, varied a little as a hand does.
    device_dpi: of the printer, which paints every dot that a stroke touches; None where nothing is gained.
    rule: one of `RULES`, by which strokes are chosen; its module in `rules/` tells more.
    outlines: strokes drawn already, whose ink counts; they are not among those returned.
    directions: a field along which hatching and sets of strokes run, in place of fixed angles.
    lines: telling lines of the picture: light ones are left out, and beside the dark ones, which are drawn already and
        among the outlines, hatching keeps clear.
    swell: how much strokes of a hatching or a set swell along their way where the tone does, see `pressure`.
    natural_pt: width of the picture at which a texture that grows with it has its own size; None for what that says.
    true: (any size) an image of the same frame whose tone the drawing is to have, where `tone` is sharper but astray.
    solid: the tone from which on all is filled where the texture reaches black; None for one from which black on white
        looks black.
    tick: called now and then, `TICKS` times at the most.

    The width and density of strokes do not depend on the size of the sheet. Equal input gives equal strokes,
    whatever the number of threads. Raises ParameterError for a rule that is none.
    """
    chosen = rules.rule(rule)
    if texture.oriented and not chosen.SETS:
        raise ParameterError(f"the texture {texture.name} is a set of strokes, for the rule best and not {rule}")
    if true is not None:
        from penink_cli.blasting.restoring import restored

        tone = restored(tone, true, width_pt, height_pt, threads or 1)
    workers = threads or 1
    # Reading the field takes a fifth of a blast, and the other steps before hatching hardly use a second thread.
    with threading.meanwhile(
        lambda: read_field(directions, edges, width_pt, height_pt, workers), workers if chosen.follows(texture) else 1
    ) as field:
        told = None
        if lines is not None:
            from penink_cli.blasting import telling  # needs the rooms of lines and composition

            bare, shown = tone, lines
            tone, told = recalled(
                "telling", (bare, width_pt, height_pt, shown, outlines),
                lambda: telling.told(bare, width_pt, height_pt, shown, outlines, workers),
            )  # fmt: skip
        task = Task(
            tone=tone, width_pt=width_pt, height_pt=height_pt, edges=edges, texture=texture, seed=seed, pen_pt=pen_pt,
            device_dpi=device_dpi, outlines=outlines, field=field, told=told, swell=swell, natural_pt=natural_pt,
            solid=solid, threads=workers, tick=tick,
        )  # fmt: skip
        strokes: Strokes = chosen.draw(task)
    tick()
    return replace(strokes, texture=texture.name, seed=seed, device_dpi=device_dpi)


def left_over(
    tone: Floats, width_pt: float, height_pt: float, strokes: Strokes, device_dpi: float | None, threads: int | None
) -> Floats:
    """Tone (h, w) less the ink of the strokes on such a sheet, as the eye sees both: positive is too light."""
    sheet = Sheet(tone, width_pt, height_pt, 72.0 / device_dpi if device_dpi else 0.0, threads or 1)
    hatching.draw_first(sheet, strokes)
    return resample(sheet.spread(sheet.error()).astype(np.float64), *tone.shape, least=-1.0)


def too_dark(tone: Floats, darkest: float) -> float:
    """The part of an image (h, w) that is darker than a texture's darkest tone by more than the eye can tell."""
    return float(np.count_nonzero(tone > darkest + 0.02)) / tone.size
