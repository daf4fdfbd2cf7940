"""The kinds of texture that can be made, all of which come with the program.

A line here and a module in `kinds/` make a kind; that of `contour-rings` is contour_rings.py. `make manual` packs the
kind's tile into `tiles/`; until then the tile is made whenever it is asked for.
"""

#: Name -> what it is like.
KINDS = {
    "barb": "short hooks along the form, as of feathers",
    "brick": "a wall that grows with the picture, its joints first, then the bricks one by one",
    "contour-rings": "an engraving's lines that swell, in rings about a point",
    "crosshatch": "lines in one direction, and others across them where it is dark",
    "crosshatch4": "lines in up to four directions",
    "engraving": "lines evenly far apart whose width is the tone, along the form (see blast --directions)",
    "engraving-straight": "the same, straight",
    "form": "lines along the form (see blast --directions), others at a slant over them, black where it is darkest",
    "fur": "short hairs along the form",
    "grain": "wandering lines side by side, like the grain of wood",
    "grass": "blades of grass along the form",
    "hair": "long hairs along the form",
    "lawn": "blades of grass that grow upwards and bend",
    "parallel": "lines in one direction, denser as it gets darker",
    "scribble": "loops of a restless pen",
    "shingle": "a roof of rounded shingles that grows with the picture",
    "stipple": "dots",
    "wood": "an engraving's lines that waver, as those cut in wood",
}
