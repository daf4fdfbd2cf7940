"""Photo to discontinuity edges: an arrangement of segments that meet only at shared vertices.

detection.detect_edges
  gradient.edge_points        where the grey changes fastest, to a fraction of a pixel
  chains.link_chains          points to chains
  smoothing.smooth, unbend    noise averaged along them
  corners.sharpen             corners that blur has rounded
  joints.join_ends            loose ends to what they stop short of
  simplification.simplify     few long segments, on an exact integer grid (planar)
  junctions.settle_junctions  corners and junctions put where the photo, rendered, shows them
  strengths                   the grey step across each edge
"""
