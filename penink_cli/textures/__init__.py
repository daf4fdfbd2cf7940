"""The stroke textures that penink ships, in tiles/, and what makes them.

registry.KINDS       the kinds, a line each; make.make calls the maker of one
  kinds/NAME.make      the maker of a kind
    hatching             straight or wavy lines in layers
    filling              strokes until the tile is black, every prefix of them evenly spaced (even)
    engraved             lines that swell
    sets                 examples, for strokes along a field
    normal               normal deviates from a seed
"""
