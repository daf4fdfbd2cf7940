"""Textures: what strokes are made from."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from penink_cli.ground.model.arrays import Floats
from penink_cli.ground.model.strokes import Strokes


@dataclass(frozen=True)
class HatchLayer:
    """One layer of hatching, for rules that lay strokes as densely as the tone asks instead of from a tile.

    angle: direction of the strokes in degrees, from x towards y (clockwise on paper).
    low, high: the layer begins where the picture's tone exceeds `low`, and has brought it to `high` where it ends.
    pen_pt: width of the strokes, points.
    spacing_pt: the strokes' centre lines are nowhere closer than this, points; 0 for no limit.
    wave_pt, wave_length_pt: how far the strokes wander sideways, as the grain of wood does, and over what length.
    turn: degrees from the field of directions to the strokes, where there is a field; None for the difference of angle
        from the first layer's.
    """

    angle: float
    low: float
    high: float
    pen_pt: float = 0.4
    spacing_pt: float = 0.0
    wave_pt: float = 0.0
    wave_length_pt: float = 0.0
    turn: float | None = None


@dataclass(frozen=True)
class Engraving:
    """Lines that swell: evenly far apart, their width the tone.

    spacing_pt: distance of their middles, points. finest_pt: the least width of a line.
    angle: degrees, clockwise from the right, where lines are straight. along: they run along a field if there is one.
    centre: x and y in parts of the sheet's width and height of the point about which they are rings, None for none.
    waver: how much straight lines waver, 0 not at all, 1 as the grain of wood. blunt: ends do not taper.
    lines: how many lines cross the sheet's width, whatever its size; None for as many as spacing_pt leaves room for.
    crosses: the tone from which on a second set of lines crosses the first, 1 for never.
    """

    spacing_pt: float = 1.46
    finest_pt: float = 0.16
    angle: float = -30.0
    along: bool = True
    centre: tuple[float, float] | None = None
    waver: float = 0.0
    blunt: bool = False
    lines: int | None = None
    crosses: float = 1.0


@dataclass(frozen=True, eq=False)
class Scales:
    """What a texture is on a sheet that is wider or narrower than it was made for: the same wall, seen larger.

    natural_pt: width of the picture in which the tile has its own size. least_pt: no side of the tile is smaller.
    fill: name of the hatching, of its own size always, that brings on the tone that these strokes do not reach.
    strokes, priorities: (s,) those that grow with the picture, their pens not. spans: (s, 2) each is there where the
        picture is from so many to less than so many times as wide as natural.
    fixed: (t,) bool, those of the texture's strokes that do not grow; the others are among these.
    """

    natural_pt: float
    least_pt: float
    fill: str
    strokes: Strokes
    priorities: Floats
    spans: Floats
    fixed: npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Texture:
    """A stroke texture: a tile of prioritized strokes that repeats in x and y.

    strokes: those of one tile in order of priority, lowest (drawn first) first; strokes.width and
        strokes.height are the tile's size in points. A stroke may reach over the tile's border.
    priorities: (s,) ascending.
    whole: strokes are drawn whole or not at all (stipple dots, mortar), never trimmed to a run.
    layers: what the tile is an instance of where that is plain hatching, in the order of drawing.
    engraving: lines that swell; the tile stands for them where only strokes of one width can be drawn.
    oriented: no tile but a set of examples, each with its first point on a line of the field and +x along the line.
    scales: how it grows with the picture, None where it does not; strokes are those of the natural size.
    """

    name: str
    strokes: Strokes
    priorities: Floats
    whole: bool = False
    layers: tuple[HatchLayer, ...] = ()
    engraving: Engraving | None = None
    oriented: bool = False
    scales: Scales | None = None


def turned(texture: Texture, degrees: float) -> Texture:
    """The texture with its hatching turned clockwise; a tile without hatching layers is as it was."""
    if not degrees:
        return texture

    def around(angle: float) -> float:
        angle += degrees
        return angle - 360.0 if angle > 180.0 else angle + 360.0 if angle < -180.0 else angle

    layers = tuple(replace(layer, angle=around(layer.angle)) for layer in texture.layers)
    engraving = texture.engraving and replace(texture.engraving, angle=around(texture.engraving.angle))
    return replace(texture, layers=layers, engraving=engraving)
