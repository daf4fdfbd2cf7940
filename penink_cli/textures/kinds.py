"""The kinds of texture that can be made, all of which come with the program."""

#: Name -> what it is like.
KINDS = {
    "brick": "a wall, its joints first, then the bricks one by one",
    "contour-rings": "an engraving's lines that swell, in rings about a point",
    "crosshatch": "lines in one direction, and others across them where it is dark",
    "crosshatch4": "lines in up to four directions",
    "engraving": "lines evenly far apart whose width is the tone, along the form (see blast --directions)",
    "engraving-straight": "the same, straight",
    "form": "lines along the form (see blast --directions), others at a slant over them, black where it is darkest",
    "grain": "wandering lines side by side, like the grain of wood",
    "grass": "blades that grow upwards and bend",
    "parallel": "lines in one direction, denser as it gets darker",
    "scribble": "loops of a restless pen",
    "stipple": "dots",
    "wood": "an engraving's lines that waver, as those cut in wood",
}
