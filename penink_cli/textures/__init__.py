"""The stroke textures that penink ships, in tiles/, and what makes them.

registry.KINDS       the kinds, a line each; make.make calls the one wanted
  kinds/NAME.make      one kind
    hatching             straight or wavy lines in layers
    filling              strokes of which every prefix is evenly spaced (even), until the tile is black
    engraved             lines that swell
    sets                 examples, for strokes along a field
    normal               normal deviates from a seed
"""
