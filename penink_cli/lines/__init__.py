"""Telling lines: found in a photograph, ranked, chosen for a size on paper, and drawn.

detection.detect_lines
  oriented.responses   a bank of filters in 24 directions, fine and coarse
  tracing.traces       lines followed, each on the layers of its own direction
  spots                small round dark things
choice                 the lines that there is room for at a size
strokes                lines as swelling strokes
"""
