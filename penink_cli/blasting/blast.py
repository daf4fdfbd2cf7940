"""Blasting (section 3): a grey image and a stroke texture to strokes of the same tone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from penink_cli.blasting import hatching, marks, stroke_set, tile
from penink_cli.blasting.sheet import Cells, Sheet, coverage, resample
from penink_cli.blasting.threshold import blast_by_threshold
from penink_cli.ground.angles import direction
from penink_cli.ground.device import MEAN
from penink_cli.ground.errors import ParameterError
from penink_cli.ground.model import Directions, EdgeList, Engraving, Floats, Lines, Strokes, Texture

#: The rules by which strokes are chosen.
RULES = ("best", "strict", "threshold", "engrave")
#: The broadest pen that small dark things are filled with.
MARK_PT = 0.5
#: Cells of which so much lies within a point of a small dark thing belong to it.
NEAR_MARK = 0.3
#: Degrees at which a set of strokes lies where no directions are given.
ANGLE = -45.0
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
    threads: int | None = None,
    tick: Callable[[], None] = lambda: None,
) -> Strokes:
    """Strokes of `texture` that give a sheet the tone of an image.

    tone: (h, w) ink coverage, 0 paper … 1 solid ink; it fills the sheet of width_pt × height_pt points.
    edges: discontinuity edges of the image; strokes end at those over which the tone steps strongly.
    pen_pt: the one width of all strokes; by default the texture's, varied a little as a hand does.
    device_dpi: of the printer, which paints every dot that a stroke touches; None where nothing is gained.
    rule: "best", true tone in a closed loop; "strict", the paper's, no stroke that makes any place too dark;
        "threshold", each stroke wherever the tone exceeds the one at which the texture has it enter: what an
        illustration that draws itself does on a device. It knows no seed. "engrave": lines that swell, those of the
        texture if it has them, as "best" draws such a texture.
    outlines: strokes drawn already, whose ink counts; they are not among those returned.
    directions: a field along which hatching and sets of strokes run, in place of fixed angles.
    lines: telling lines of the picture: light ones are left out, and beside the dark ones, which are drawn already and
        among the outlines, hatching keeps clear.
    tick: called now and then, `TICKS` times at the most.

    The width and density of strokes do not depend on the size of the sheet. Equal input gives equal strokes,
    whatever the number of threads. Raises ParameterError for a rule that is none.
    """
    if rule not in RULES:
        raise ParameterError(f"rule {rule!r}: known are {', '.join(RULES)}")
    if texture.oriented and rule != "best":
        raise ParameterError(f"the texture {texture.name} is a set of strokes, for the rule best and not {rule}")
    told = None
    if lines is not None:
        from penink_cli.blasting import telling  # needs the rooms of lines and composition

        tone, told = telling.told(tone, width_pt, height_pt, lines, outlines, threads or 1)
    if rule == "threshold":
        strokes = blast_by_threshold(tone, width_pt, height_pt, edges, texture, pen_pt, device_dpi, outlines)
        tick()
        return replace(strokes, texture=texture.name, seed=seed, device_dpi=device_dpi)
    gain = 72.0 / device_dpi if device_dpi else 0.0
    sheet = Sheet(tone, width_pt, height_pt, gain, threads or 1)
    if outlines is not None:
        hatching.draw_first(sheet, outlines)
    finest = pen_pt or min([*texture.strokes.widths.tolist(), *(layer.pen_pt for layer in texture.layers), MARK_PT])
    small = marks.marks(tone, width_pt, height_pt, finest, MEAN * gain, pen_pt is not None, sheet.ink)
    hatching.draw_first(sheet, small)
    if len(small):  # nor are they thin things to be drawn along
        near = coverage(small, sheet.rows, sheet.columns, 2.0) > NEAR_MARK
        told = near if told is None else told | near
    if texture.oriented:
        examples = texture.strokes
        way = along_one_angle(sheet) if directions is None else field_at(sheet, directions, edges)
        layers = stroke_set.passes(examples)
        strokes = hatching.hatch_sheet(sheet, layers, edges, gain, seed, pen_pt, tick, way, told, examples)
    elif rule == "engrave" or (rule == "best" and texture.engraving is not None and pen_pt is None):
        from penink_cli.blasting.engraving import engrave

        kind = texture.engraving or Engraving(angle=texture.layers[0].angle if texture.layers else Engraving.angle)
        along = None if directions is None or not kind.along else field_at(sheet, directions, edges)
        strokes = engrave(sheet, kind, edges, seed, along, tick)
    elif rule == "best" and texture.layers:
        along = None if directions is None else field_at(sheet, directions, edges)
        strokes = hatching.hatch_sheet(sheet, texture.layers, edges, gain, seed, pen_pt, tick, along, told)
    else:
        enters = tile.thresholds(texture, gain)
        parts = tile.blast_tile(sheet, texture, edges, enters, seed, rule == "strict", pen_pt, tick)
        strokes = Strokes.joined([Strokes(width_pt, height_pt), *parts])
        if rule == "best" and pen_pt is None and len(strokes):
            sheet.clear()  # the best round may not have been the last
            hatching.paint(sheet, strokes)
            strokes = hatching.press(sheet, strokes, seed, tile.crowd(sheet, texture))
    if len(small):
        strokes = Strokes.joined([small, strokes])
    tick()
    return replace(strokes, texture=texture.name, seed=seed, device_dpi=device_dpi)


def along_one_angle(sheet: Sheet) -> tuple[Cells, Cells]:
    """The same for a field of which nothing is known: one angle everywhere, as of plain hatching."""
    c, s = direction(2 * ANGLE)
    whole = np.ones((sheet.rows, sheet.columns), np.float32)
    return whole * np.float32(c), whole * np.float32(s)


def field_at(sheet: Sheet, directions: Directions, edges: EdgeList | None) -> tuple[Cells, Cells]:
    """Cosine and sine of twice the angle of a field in each cell of the sheet, (rows, columns)."""
    from penink_cli.directions.reading import at_size  # the reconstruction is not needed otherwise

    field = at_size(directions, edges, sheet.rows, sheet.columns, sheet.threads)
    return np.asarray(field.cos2, np.float32), np.asarray(field.sin2, np.float32)


def left_over(
    tone: Floats, width_pt: float, height_pt: float, strokes: Strokes, device_dpi: float | None, threads: int | None
) -> Floats:
    """Tone (h, w) less the ink of the strokes on such a sheet, as the eye sees both: positive is too light."""
    sheet = Sheet(tone, width_pt, height_pt, 72.0 / device_dpi if device_dpi else 0.0, threads or 1)
    hatching.draw_first(sheet, strokes)
    return resample(sheet.spread(sheet.error()).astype(np.float64), *tone.shape)


def too_dark(tone: Floats, darkest: float) -> float:
    """The part of an image (h, w) that is darker than a texture's darkest tone by more than the eye can tell."""
    return float(np.count_nonzero(tone > darkest + 0.02)) / tone.size
