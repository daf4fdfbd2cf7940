"""Illustrations that render themselves: the small representation and the code that draws it, in one file.

html.write, postscript.write    a page; an EPS
  data                            samples, edges, texture as the renderer reads them
    lattice                         vertices where 32-bit reals decide as doubles do
    telling                         lines, each with the size from which on there is room for it
  constants                       the renderer's prologue: the numbers that it shares with Python
  packer                          renderer/*.js and *.ps without comments and needless spaces, compressed
"""
