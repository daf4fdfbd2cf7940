"""Readers and writers: each module is one on-disk format, defined in README.md beside them.

photo/          photographs of many kinds, read only
pgm             grey: samples, masks, what is blasted
edge_list       edges; lines: telling lines; directions: fields; strokes; texture; style; pens
  strict_json     what all JSON of these is read with
svg_texture     SVG drawings, read as textures
illustration    the manifest, and the files that it names; or both in one `.penink`:
  archive         its members; parts: all members but the manifest in one file
  compact         samples, fields and texts in few bytes; compact_edges, compact_lines; members: what these share
recognise       what a file is, for the error line where it is the wrong one; signatures: how pictures begin
"""
