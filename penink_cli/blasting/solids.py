"""Solid black: what is darker than hatching can be is filled, row by row, with clean borders.

Layers that cross each other in the dark are a grainy net, and strokes that close up leave flecks of white where they
end. Here the dark is found first: as far as it is black, and where it meets light, up to half way between them. Rows of
a pen that overlap fill it, save white lines (`reserved`); hatching begins beside it.

Textures that have a way of their own to be black keep it, save around small light things: what is finer than its
strokes no texture leaves out.
"""

from __future__ import annotations

import numpy as np

from penink_cli.blasting import bordered, marks
from penink_cli.blasting.gaps import Gaps
from penink_cli.blasting.light import LightThings
from penink_cli.blasting.sheet import Cells, resample
from penink_cli.composition.filters import Picture, blurred
from penink_cli.ground.masks import labelled, near, sizes
from penink_cli.ground.model import Floats, Strokes

#: The tone from which on it is black where a texture ends in black, and where one can be as dark as DARKEST itself.
BLACK, DARKEST = 0.94, 0.97
#: The tone from which on the dark is black with white lines in it, where it is a thing of its own.
LINED = 0.78
#: A thing is so wide somewhere, of BROAD_PT2 square points or more, and along OUTLINED of its border the tone falls by
#: FALL within OUTLINE_PT: where it ended in a smooth tone its border would be that of nothing in the picture. What of
#: it is less dark, down to the tone THING, is drawn the same way if MOSTLY is its dark part, and so is hatching of less
#: than HOLE_PT2 amid it. Its border is that of the tone under a Gaussian of σ CALM_PT.
ROOM_PT, BROAD_PT2, OUTLINED, FALL, OUTLINE_PT = 14.0, 2000.0, 0.85, 0.2, 4.0
THING, MOSTLY, HOLE_PT2, CALM_PT = 0.65, 0.6, 1500.0, 1.5
#: How far black is filled around small light things.
BESIDE_PT = 3.0
#: Whether it is black is told by the tone under a Gaussian of σ SMOOTH_PT. Where the tone falls below LIGHT within
#: FALLS_PT, black ends where half of the fall is done.
SMOOTH_PT, LIGHT, FALLS_PT = 0.5, 0.6, 1.4
#: What differs from the dark around (σ WIDE_PT, of what is darker than LIGHT alone) by no more than NOISE is grain or a
#: shade of the same dark: black has no holes and no islands of it.
WIDE_PT, NOISE = 3.0, 0.04
#: The least area that is filled, square points; hatching draws the rest.
LEAST_PT2 = 3.0
#: Where the tone around is at least AROUND, black smaller than BLOT_PT2 would be a blot in the hatching: it is hatched.
#: Hatching smaller than FLECK_PT2 would be a fleck in the black, and anything rather dark than light smaller than
#: BEAD_PT2 a bead: both are filled. Nor is a dark thing filled here and there. A part that hangs together, at most
#: NEARLY less dark than black, is hatched whole unless SHARE of it is black.
AROUND, BLOT_PT2, FLECK_PT2, BEAD_PT2 = 0.8, 40.0, 25.0, 5.0
NEARLY, SHARE = 0.04, 0.25
#: The pen that fills. It is fine because rows may lie as far as its width from a border that runs along them.
PEN_PT = 0.35


def filled(
    value: Picture | None, width_pt: float, height_pt: float, pen_pt: float | None, gain_pt: float,
    gaps: Gaps | None = None,
) -> Strokes:  # fmt: skip
    """Strokes that fill what `found` has found, save gaps in it, on a sheet of that size.

    pen_pt: the one pen there is, None for one that suits. gain_pt: how much wider the device paints it.
    """
    chains: list[Floats] = []
    widths: list[float] = []
    if value is not None:
        h, w = value.shape
        bordered.fill(
            value, np.array([width_pt / w, height_pt / h]), PEN_PT if pen_pt is None else pen_pt, gain_pt, chains,
            widths, pen_pt is not None, gaps,
        )  # fmt: skip
    return Strokes.of(width_pt, height_pt, chains, widths)


def found(
    tone: Floats, width_pt: float, height_pt: float, ink: Cells, black: float = BLACK,
    light: LightThings | None = None, everywhere: bool = True, broad: float = 1.0,
) -> Picture | None:  # fmt: skip
    """What is as good as black in the tone (h, w): an image that exceeds `marks.LEVEL` there; None for nothing.

    ink: (rows, columns) what is on the sheet already: what that covers is drawn.
    black: the tone from which on it is, and broad: the same of what is broad and has an outline, if that is less.
    light: small light things if there are any, around which alone it is filled unless `everywhere`.
    """
    h, w = tone.shape
    if not (tone > min(black, broad)).any() or not (everywhere or light):
        return None
    fine = max(1.0, marks.FINE * width_pt / w)
    if fine > 1:
        h, w = round(h * fine), round(w * fine)
        tone = resample(tone, h, w)
    px = w / width_pt
    close = resample(light.within(FALLS_PT).astype(np.float64), h, w) > 0 if light else None
    alone = None
    if light and not everywhere:
        alone = resample(light.within(BESIDE_PT).astype(np.float64), h, w) > 0.5
    return _dark(tone, px, (black, broad), close, alone, ink)


def _dark(
    tone: Floats, px: float, black: tuple[float, float], close: marks.Mask | None, alone: marks.Mask | None, ink: Cells
) -> Picture:
    """A tone (h, w) that exceeds `marks.LEVEL` where it is to be filled, and is 0 where nothing is near.

    px: pixels in a point. black: the two tones of `found`; ink: as there.
    close: what is close to small light things, where there are any.
    alone: the only places that may be filled, None for all.
    """
    value, smooth, begins = _values(tone, px, black, close, alone is None)
    if alone is not None:
        value[~alone] = 0.0
    core = smooth > begins
    blots = None
    if alone is None:
        deep = blurred(smooth, WIDE_PT * px, 1) >= AROUND  # dark all around
        blots = _blots(smooth, core, deep, begins, px)
        value[_flecks(value, smooth, px)] = np.nextafter(np.float32(marks.LEVEL), np.float32(1))
    del smooth, begins
    inside = value > marks.LEVEL
    part, boxes = labelled(inside)
    area, size = (sizes(part, len(boxes), mask) for mask in (core, inside))
    keep = area >= LEAST_PT2 * px * px
    h, w = tone.shape
    rows, columns = np.arange(h) * ink.shape[0] // h, np.arange(w) * ink.shape[1] // w
    keep &= sizes(part, len(boxes), (ink > marks.INKED)[rows][:, columns]) < marks.INKED * size
    if blots is not None:
        keep &= sizes(part, len(boxes), blots) < 0.5 * area
    keep[0] = False
    value[~near(~keep[part], 1.5, strictly=True)] = 0.0  # up to the places between which the border lies
    return np.clip(value, 0, 1, out=value)


def _values(
    tone: Floats, px: float, black: tuple[float, float], close: marks.Mask | None, everywhere: bool
) -> tuple[Picture, Picture, Picture | np.float32]:
    """How black it is, of which more than `marks.LEVEL` is; the tone, smoothed; the tone that black begins with."""
    tones: Picture = tone.astype(np.float32)  # of single precision: the whole sheet is looked at several times
    fall = FALLS_PT * px
    smooth = blurred(tones, SMOOTH_PT * px, 1)
    if everywhere:
        smooth = _without_grain(smooth, px)
    begins = np.float32(black[0]) if black[1] >= black[0] else _begins(smooth, *black, px)
    falls = near(smooth >= LIGHT, fall, strictly=True) & near(smooth <= begins, fall, strictly=True)
    value = smooth - begins
    # how much darker a place is than what black begins with there, half way up or down where it does
    darker = np.where(smooth > marks.LEVEL, np.maximum(tones, smooth), tones)  # smoothed outside, it would reach out
    darker -= marks.LEVEL
    np.copyto(value, darker, where=falls)
    value += marks.LEVEL
    if close is not None:
        np.copyto(value, tones, where=close & falls)  # smoothed, it would be smaller
    return value, smooth, begins


def _without_grain(tone: Picture, px: float) -> Picture:
    """The tone (h, w), in the dark as it is around but for what differs more than grain; px: pixels in a point.

    Beside light things it stays as it is: they have borders of their own.
    """
    dark = ~near(tone >= LIGHT, FALLS_PT * px)
    around = blurred(tone * dark, WIDE_PT * px, 1)
    around /= np.maximum(blurred(dark.astype(np.float32), WIDE_PT * px, 1), 1e-6)
    rest = tone - around
    rest -= np.clip(rest, -NOISE, NOISE)
    around += rest
    np.copyto(around, tone, where=~dark)
    return around


def _opened(mask: marks.Mask, radius: float) -> marks.Mask:
    """The discs of that radius, pixels, that a mask (h, w) has room for."""
    return near(near(mask, radius), radius)


def _begins(smooth: Picture, black: float, broad: float, px: float) -> Picture:
    """The tone (h, w) that black begins with, of which there is to be more where it is broad and has an outline.

    smooth: (h, w) the tone. px: pixels in a point.
    """
    calm = blurred(smooth, CALM_PT * px, 1)
    begins = np.full(smooth.shape, black, np.float32)
    for least, share in ((broad, 0.0), (THING, MOSTLY)):
        part, boxes = labelled(_opened(calm > np.float32(least), ROOM_PT / 2 * px))
        area, dark = (sizes(part, len(boxes), some) for some in (part > 0, calm > np.float32(broad)))
        border = (part > 0) & near(part > 0, 1.0)
        outline = border & near(smooth >= np.float32(least - FALL), OUTLINE_PT * px)
        length, told = (sizes(part, len(boxes), some) for some in (border, outline))
        chosen = (area >= BROAD_PT2 * px * px) & (told >= OUTLINED * length) & (dark >= share * area)
        chosen[0] = False
        begins[chosen[part]] = least
    # and what little hatching there would be amid it
    hole, boxes = labelled(begins == np.float32(black))
    size, light = (sizes(hole, len(boxes), some) for some in (hole > 0, calm < THING))
    begins[((size < HOLE_PT2 * px * px) & (light == 0))[hole] & (hole > 0)] = THING
    return begins


def _blots(tone: Picture, core: marks.Mask, deep: marks.Mask, black: Picture | np.float32, px: float) -> marks.Mask:
    """The black in the dark that is too little of it to be filled, (h, w).

    core: where the tone exceeds `black`; deep: where it is dark all around.
    """
    of, boxes = labelled(core)
    little = (sizes(of, len(boxes), core) < BLOT_PT2 * px * px)[of]
    thing, boxes = labelled(tone > black - np.float32(NEARLY))
    whole, dark = (sizes(thing, len(boxes), mask) for mask in (thing > 0, core))
    little |= (dark < SHARE * whole)[thing]
    return np.asarray(core & little & deep)


def _flecks(value: Picture, tone: Picture, px: float) -> marks.Mask:
    """Small dark holes in the black, which is where value exceeds the level, (h, w).

    Beside light things the black has its grain, so that the smallest are filled however dark: they would be beads
    along its border, as hatching has no room in them.
    """
    hole, boxes = labelled(value <= marks.LEVEL)
    size = sizes(hole, len(boxes), hole > 0)
    lightest = [sizes(hole, len(boxes), tone < least) == 0 for least in (AROUND, marks.LEVEL)]
    little = [size < area * px * px for area in (FLECK_PT2, BEAD_PT2)]
    fleck = (lightest[0] & little[0]) | (lightest[1] & little[1])
    fleck[0] = False
    return np.asarray(fleck[hole])
