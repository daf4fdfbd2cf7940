"""Solid black: what is darker than hatching can be is filled, row by row, with clean borders.

Layers that cross each other in the dark are a grainy net, and strokes that close up leave flecks of white where they
end. Here the dark is found first: as far as it is black, and where it meets light, up to half way between them. Rows of
a pen that overlap fill it, save white lines (`reserved`); hatching begins beside it.

Textures that have a way of their own to be black keep it, save around small light things: what is finer than its
strokes no texture leaves out.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from penink_cli.blasting import bordered, marks, small
from penink_cli.blasting.gaps import Gaps
from penink_cli.blasting.light import LightThings
from penink_cli.blasting.sheet import Cells, resample
from penink_cli.composition.filters import Picture, blurred, by_rows
from penink_cli.ground import threads as threading
from penink_cli.ground.masks import near, parts, sizes
from penink_cli.ground.model import Floats, Strokes

#: The tone from which on it is black where a texture ends in black, and where one can be as dark as DARKEST itself.
BLACK, DARKEST = 0.94, 0.97
#: The tone from which on the dark is black with white lines in it, where it is a thing of its own.
LINED = 0.78
#: A dark thing is as wide somewhere as ROOM_PT, of an area of BROAD_PT2 or more, square points.
ROOM_PT, BROAD_PT2 = 14.0, 2000.0
#: Along such a part of its border the tone falls by FALL within OUTLINE_PT. A border within a smooth tone would be one
#: of nothing in the picture.
OUTLINED, FALL, OUTLINE_PT = 0.85, 0.2, 4.0
#: What of it is lighter, down to the tone THING, has white lines too if such a part of the thing is dark.
THING, MOSTLY = 0.65, 0.6
#: Hatching amid a dark thing that is smaller than this becomes black with white lines too, square points.
HOLE_PT2 = 1500.0
#: The border of a dark thing is that of the tone under a Gaussian of this σ.
CALM_PT = 1.5
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
#: Black that is smaller than this where the tone around is at least AROUND would be a blot: it is hatched.
BLOT_PT2, AROUND = 40.0, 0.8
#: Hatching that is smaller than this would be a fleck in the black: it is filled.
FLECK_PT2 = 25.0
#: What is rather dark than light and smaller than this would be a bead on the black's border: it is filled.
BEAD_PT2 = 5.0
#: A dark part that hangs together, at most NEARLY less dark than black, is hatched whole unless SHARE of it is black.
NEARLY, SHARE = 0.04, 0.25
#: The pen that fills. It is fine because rows may lie as far as its width from a border that runs along them.
PEN_PT = 0.35


def filled(
    value: Picture | None, width_pt: float, height_pt: float, pen_pt: float | None, gain_pt: float,
    gaps: Gaps | None = None, known: bordered.Shape | None = None,
) -> Strokes:  # fmt: skip
    """Strokes that fill what `found` has found, save gaps in it, on a sheet of that size.

    pen_pt: the one pen there is, None for one that suits. gain_pt: how much wider the device paints it.
    known: its shape, where that is known.
    """
    chains: list[Floats] = []
    widths: list[float] = []
    if value is not None:
        scale, pen = _scale(value, width_pt, height_pt), PEN_PT if pen_pt is None else pen_pt
        bordered.fill(value, scale, pen, gain_pt, chains, widths, pen_pt is not None, gaps, known)
    return Strokes.of(width_pt, height_pt, chains, widths)


def shape(value: Picture, width_pt: float, height_pt: float, pen_pt: float | None, gain_pt: float) -> bordered.Shape:
    """The shape of what `found` has found; the arguments are those of `filled`."""
    return bordered.shape(value, _scale(value, width_pt, height_pt), PEN_PT if pen_pt is None else pen_pt, gain_pt)


def _scale(value: Picture, width_pt: float, height_pt: float) -> Floats:
    return np.array([width_pt / value.shape[1], height_pt / value.shape[0]])


def found(
    tone: Floats, width_pt: float, height_pt: float, ink: Cells, black: float = BLACK,
    light: LightThings | None = None, everywhere: bool = True, broad: float = 1.0, threads: int = 1,
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
    return _dark(tone, px, (black, broad), close, alone, ink, threads)


def _dark(
    tone: Floats, px: float, black: tuple[float, float], close: marks.Mask | None, alone: marks.Mask | None, ink: Cells,
    threads: int,
) -> Picture:  # fmt: skip
    """A tone (h, w) that exceeds `marks.LEVEL` where it is to be filled, and is 0 where nothing is near.

    px: pixels in a point. black: the two tones of `found`; ink: as there.
    close: what is close to small light things, where there are any.
    alone: the only places that may be filled, None for all.
    """
    h, w = tone.shape
    rows, columns = np.arange(h) * ink.shape[0] // h, np.arange(w) * ink.shape[1] // w
    there = ink[rows][:, columns]
    value, smooth, begins = _values(tone, px, black, close, alone is None, there, threads)
    if alone is not None:
        value[~alone] = 0.0
    core = smooth > begins
    blots = None
    if alone is None:
        blots, flecks = threading.at_once(
            partial(_blots, smooth, core, begins, px), partial(_flecks, value, smooth, px), threads=threads
        )
        value[flecks] = np.nextafter(np.float32(marks.LEVEL), np.float32(1))
    del smooth, begins
    inside = value > marks.LEVEL
    part, count = parts(inside)
    area, size = (sizes(part, count, mask) for mask in (core, inside))
    keep = area >= LEAST_PT2 * px * px
    keep &= sizes(part, count, there > marks.INKED) < marks.INKED * size
    if blots is not None:
        keep &= sizes(part, count, blots) < 0.5 * area
    keep[0] = False
    # up to the places between which the border lies
    value[~near(~keep[part], 1.5, strictly=True, threads=threads)] = 0.0
    return np.clip(value, 0, 1, out=value)


def _values(
    tone: Floats, px: float, black: tuple[float, float], close: marks.Mask | None, everywhere: bool, ink: Cells,
    threads: int,
) -> tuple[Picture, Picture, Picture]:  # fmt: skip
    """How black it is, of which more than `marks.LEVEL` is; the tone, smoothed; the tone that black begins with.

    ink: (h, w) what lies there already.
    """
    tones: Picture = tone.astype(np.float32)  # of single precision: the whole sheet is looked at several times
    fall = FALLS_PT * px
    smooth = blurred(tones, SMOOTH_PT * px, threads)
    if everywhere:
        smooth = _without_grain(smooth, px, threads)
    if black[1] >= black[0]:
        begins = np.broadcast_to(np.float32(black[0]), smooth.shape)
    else:
        begins = _begins(smooth, *black, px, threads)
    falls = near(smooth >= LIGHT, fall, strictly=True, threads=threads)
    falls &= near(smooth <= begins, fall, strictly=True, threads=threads)

    def blackness(tones: Picture, smooth: Picture, begins: Picture, falls: marks.Mask) -> Picture:
        value = smooth - begins
        # how much darker a place is than what black begins with there, half way up or down where it does
        # (smoothed outside, it would reach out)
        darker = np.where(smooth > marks.LEVEL, np.maximum(tones, smooth), tones) - np.float32(marks.LEVEL)
        np.copyto(value, darker, where=falls)
        value += marks.LEVEL
        return value

    value = by_rows(blackness, tones, smooth, begins, falls, threads=threads)
    if close is not None:
        np.copyto(value, tones, where=close & falls)  # smoothed, it would be smaller
    del tones, falls  # there are many of this size at this moment
    if black[1] < black[0]:
        by_itself = small.black_from(smooth, ink, px, threads)
        np.maximum(value, smooth - by_itself + marks.LEVEL, out=value)
        begins = np.minimum(begins, by_itself)
    return value, smooth, begins


def _without_grain(tone: Picture, px: float, threads: int) -> Picture:
    """The tone (h, w), in the dark as it is around but for what differs more than grain; px: pixels in a point.

    Beside light things it stays as it is: they have borders of their own.
    """
    dark = ~near(tone >= LIGHT, FALLS_PT * px, threads=threads)
    total = blurred(tone * dark, WIDE_PT * px, threads)
    weight = blurred(dark.astype(np.float32), WIDE_PT * px, threads)

    def smoothed(tone: Picture, total: Picture, weight: Picture, dark: marks.Mask) -> Picture:
        around = np.asarray(total / np.maximum(weight, np.float32(1e-6)), np.float32)
        rest = tone - around
        rest -= np.clip(rest, -NOISE, NOISE)
        around += rest
        np.copyto(around, tone, where=~dark)
        return around

    return by_rows(smoothed, tone, total, weight, dark, threads=threads)


def _begins(smooth: Picture, black: float, broad: float, px: float, threads: int) -> Picture:
    """The tone (h, w) that black begins with, of which there is to be more where it is broad and has an outline.

    smooth: (h, w) the tone. px: pixels in a point.
    """
    calm = blurred(smooth, CALM_PT * px, threads)

    def things(least: float, share: float) -> marks.Mask:
        """Where there is a thing that is so dark."""
        room, some = ROOM_PT / 2 * px, calm > np.float32(least)
        for _ in range(2):  # the discs that there is room for
            some = near(some, room, threads=threads)
        part, count = parts(some)
        area, dark = (sizes(part, count, each) for each in (some, calm > np.float32(broad)))
        border = some & near(some, 1.0, threads=threads)
        outline = border & near(smooth >= np.float32(least - FALL), OUTLINE_PT * px, threads=threads)
        length, told = (sizes(part, count, each) for each in (border, outline))
        chosen = (area >= BROAD_PT2 * px * px) & (told >= OUTLINED * length) & (dark >= share * area)
        chosen[0] = False
        return np.asarray(chosen[part])

    begins = np.full(smooth.shape, black, np.float32)
    whole, mostly = threading.at_once(lambda: things(broad, 0.0), lambda: things(THING, MOSTLY), threads=threads)
    begins[whole] = broad
    begins[mostly] = THING
    # and what little hatching there would be amid it
    hatched = begins == np.float32(black)
    hole, count = parts(hatched)
    size, light = (sizes(hole, count, some) for some in (hatched, calm < THING))
    begins[((size < HOLE_PT2 * px * px) & (light == 0))[hole] & hatched] = THING
    return begins


def _blots(tone: Picture, core: marks.Mask, black: Picture, px: float) -> marks.Mask:
    """The black in the dark that is too little of it to be filled, (h, w); core: where the tone exceeds `black`."""
    of, count = parts(core)
    little = (sizes(of, count, core) < BLOT_PT2 * px * px)[of]
    thing, count = parts(tone > black - np.float32(NEARLY))
    whole, dark = (sizes(thing, count, mask) for mask in (thing > 0, core))
    little |= (dark < SHARE * whole)[thing]
    deep = blurred(tone, WIDE_PT * px, 1) >= AROUND  # dark all around
    return np.asarray(core & little & deep)


def _flecks(value: Picture, tone: Picture, px: float) -> marks.Mask:
    """Small dark holes in the black, which is where value exceeds the level, (h, w).

    Beside light things the black has its grain, so that the smallest are filled however dark: they would be beads
    along its border, as hatching has no room in them.
    """
    empty = value <= marks.LEVEL
    hole, count = parts(empty)
    size = sizes(hole, count, empty)
    lightest = [sizes(hole, count, tone < least) == 0 for least in (AROUND, marks.LEVEL)]
    little = [size < area * px * px for area in (FLECK_PT2, BEAD_PT2)]
    fleck = (lightest[0] & little[0]) | (lightest[1] & little[1])
    fleck[0] = False
    return np.asarray(fleck[hole])
