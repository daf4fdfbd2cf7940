"""Strokes to pictures. `registry.OUTPUTS` is the table of all outputs; the module of each has a `write`.

page             where the sheet lies on the paper
postscript       EPS, or a page for a printer; preview: the small picture in an EPS
  postscript_arrays  the arrays of numbers that a page consists of, and the procedures that draw these
svg              with penwork: strokes shared out among a plotter's pens
pdf
  swelling         the outlines of strokes that swell, where only shapes can be filled
  words            lists of numbers as text
raster/          pixels; inks: the colour of pixels that several inks cover
edge_picture     edges over their photo, to be looked at; direction_picture: a field over its photo
"""
