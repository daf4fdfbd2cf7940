"""The directions that strokes follow: a line field found in a photograph, and read at any size.

detection.detect_directions
  evidence.tangents   what the photo's tones say, place by place, and how much it counts
  polylines           the user's strokes and telling lines as evidence
  solving.solved      the smooth field that follows the evidence, cut at edges, with few singularities
reading.at_size       the field at any size, by the reconstruction that also enlarges the grey
"""
