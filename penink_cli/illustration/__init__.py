"""Illustrations drawn: their layers, together on one sheet.

layering.layer_strokes    layers of one colour share the sheet, their tones adding up
  drawing                   one layer: its grey at the size it is blasted at, its lines, its outlines
fitting.packed_within     an illustration in at most so many bytes
overlays                  a photograph taken apart into layers
"""
