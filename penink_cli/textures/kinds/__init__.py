"""One module a kind of texture; `textures/registry.py` names them.

Each has a function `make`, whose keywords are the options that the kind takes, with its own defaults:

    angle: of the first layer, degrees, clockwise from the right
    pen: width of the strokes, points
    spacing: hatching lines of one layer are nowhere closer, points, 0 for no limit; of an engraving, their distance
    layers: 1 … 4 directions of hatching
    finest: least width of an engraving's lines, points
    lines: so many lines of an engraving to the sheet's width, 0 to go by the spacing
    centre: of rings, parts of the sheet's width and height
    seed: another hand
"""
