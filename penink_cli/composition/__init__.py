"""From a photograph to the grey that a drawing of it is made from.

compose.compose
  mixing     rims left out; red, green and blue weighed for contrast
  relief     a base of broad tones, and the detail upon it
  exposure   the base moved towards an illustrator's tones
  filters    what these smooth and shrink by
separation   the plates of several inks: how much of each, and how its hatching is turned (turns)
"""
