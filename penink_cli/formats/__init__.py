"""Readers and writers: each module is one on-disk format, defined in README.md beside them.

photo/          photographs of many kinds, read only
pgm             grey: samples, masks, what is blasted
edge_list       edges; lines: telling lines; directions: fields; strokes; texture; style; pens
  strict_json     what all JSON of these is read with
svg_texture     drawings read as textures
illustration    the manifest, and what it names; or all of that in one file:
  archive         the members of a `.penink`; parts: all but the manifest in one of them
  compact         samples, fields, texts in few bytes; compact_edges, compact_lines; members: what they share
recognise       what a file is, for the error line of who gave the wrong one; signatures: how pictures begin
"""
