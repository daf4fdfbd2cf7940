"""From a photograph to the grey, or the colours, that a drawing of it is made from.

compose.compose
  mixing     rims left out; red, green and blue weighed for contrast
  detail     a base of broad tones, and the detail upon it; relief: where there is some
  exposure   the base moved towards an illustrator's tones
  small      pupils and the like, as dark as they are
  recolouring  the photograph's colours at the grey's lightness, for a drawing in several inks
  filters    blurs, means and enlarging, which all of these use; kernel `tones`: what they do to each pixel
separation   the plates of several inks: how much of each ink, and by what angle its hatching is turned (turns)
"""
