"""One module a kind of texture; `textures/registry.py` names them.

Each has a function `make`, whose keywords are the options that the kind takes, with its own defaults:

    angle: of the first layer, degrees, clockwise from the right
    pen: width of the strokes, points
    spacing: of hatching, the least distance of the lines of one layer, points, 0 for no limit; of an engraving, the
        distance of its lines, 0 for the kind's own
    layers: 1 … 4 directions of hatching
    finest: least width of an engraving's lines, points, 0 for the kind's own
    lines: how many lines of an engraving cross the sheet's width, 0 for as many as the spacing makes
    crosses: the tone from which on a second set of an engraving's lines crosses the first, 1 for never
    centre: of rings, in parts of the sheet's width and height
    seed: of the hand that places the strokes
"""
