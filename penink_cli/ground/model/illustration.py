"""Illustrations, and the layers that they are made of."""

from __future__ import annotations

from dataclasses import dataclass, field

from penink_cli.ground.model.directions import Directions
from penink_cli.ground.model.edges import EdgeList
from penink_cli.ground.model.images import GreyImage
from penink_cli.ground.model.lines import LineChoice, Lines
from penink_cli.ground.model.textures import Texture


@dataclass(frozen=True)
class OutlineChoice:
    """Which edges of a layer become outline strokes, and how they are drawn.

    pen_pt: width of the strokes, points.
    even: one width from end to end, as a technical pen draws; otherwise a hand's slight swelling.
    min_strength: least mean strength (0 … 1) of a chain; edges without strengths are all taken.
    min_length: least length of a chain, in the edge list's pixels.
    regions: x, y in the edge list's pixels; where there are any, only edges around the regions that hold them.
    """

    pen_pt: float = 0.7
    even: bool = False
    min_strength: float = 0.0
    min_length: float = 0.0
    regions: tuple[tuple[float, float], ...] = ()


@dataclass(frozen=True, eq=False)
class Layer:
    """One overlay of an illustration: grey, edges, and the strokes it is to be drawn with.

    samples: fill the illustration's frame, as do those of every layer, whatever their numbers.
    levels: how many grey levels the samples are kept at.
    texture_name: the shipped texture's name, None for a texture of the illustration's own.
    pen_pt: one pen for all hatching, None for the texture's own widths.
    gamma, rule, seed, swell: as `blast` takes them.
    outline: None for no outline strokes.
    directions: what the hatching follows, None where it lies at the texture's angles.
    lines, line: its telling lines, None for none, and how they are drawn.
    color: of its ink, ``#rrggbb``, None for black. Inks of different colours are transparent and know nothing of each
        other: each is drawn as if it had the sheet to itself.
    turn: degrees by which `texture` has been turned, and by which strokes along the field are to be, so that the
        hatching of several inks crosses.
    """

    samples: GreyImage
    edges: EdgeList | None
    texture: Texture
    texture_name: str | None = None
    name: str | None = None
    levels: int = 16
    pen_pt: float | None = None
    gamma: float = 1.0
    rule: str = "best"
    seed: int = 0
    outline: OutlineChoice | None = None
    directions: Directions | None = None
    lines: Lines | None = None
    line: LineChoice = field(default_factory=LineChoice)
    swell: float = 0.0
    color: str | None = None
    turn: float = 0.0


@dataclass(frozen=True, eq=False)
class Illustration:
    """The representation itself (section 2): layers, bottom first, on a page of natural size width × height points."""

    width: float
    height: float
    layers: tuple[Layer, ...]
