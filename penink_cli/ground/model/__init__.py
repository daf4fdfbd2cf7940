"""The values that the rooms of the project hand to one another.

One coordinate decision holds everywhere: x right, y down, the origin at the top-left
*corner*. The pixel in row i, column j covers the unit square whose top-left corner is
(j, i), and its sample sits at (j + ½, i + ½). Only modules that speak to something
with another convention (scikit-image's integer centres, PostScript's y up) convert.

images        GreyImage, ColourImage
edges         EdgeList; lines: Lines and which are drawn; directions: Directions
strokes       Strokes, with its verbs: joined, taken, rounded, by_segments
textures      Texture and what it may be besides a tile: HatchLayer, Engraving, Scales
illustration  Illustration, its Layers
arrays        the kinds of arrays that these values are made of

Nothing here knows of files, options or algorithms.
"""

from penink_cli.ground.model.arrays import Floats, Ints
from penink_cli.ground.model.directions import Directions
from penink_cli.ground.model.edges import EdgeList
from penink_cli.ground.model.illustration import Illustration, Layer, OutlineChoice
from penink_cli.ground.model.images import ColourImage, GreyImage
from penink_cli.ground.model.lines import LineChoice, Lines
from penink_cli.ground.model.strokes import HEADER, Strokes
from penink_cli.ground.model.textures import Engraving, HatchLayer, Scales, Texture, turned

__all__ = [
    "HEADER",
    "ColourImage",
    "Directions",
    "EdgeList",
    "Engraving",
    "Floats",
    "GreyImage",
    "HatchLayer",
    "Illustration",
    "Ints",
    "Layer",
    "LineChoice",
    "Lines",
    "OutlineChoice",
    "Scales",
    "Strokes",
    "Texture",
    "turned",
]
