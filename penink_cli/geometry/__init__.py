"""Arrangements of discontinuity edges as geometry. All is decided exactly; ties by `_compiled/predicates`.

validity.check         edges that meet only at shared vertices; a sweep
trails                 edges as few long trails, for who writes or draws them
edge_index             the edges near a place
walls                  edges drawn into pixels: steps that meet one, distances, regions
curves                 smooth curves through points, and the fewest points for one
triangulation          constrained Delaunay, of meshers; the regions that edges enclose, walking
  regions                those around a point
quantisation           vertices on a coarse grid, the arrangement unbroken
  sides                  and each sample on its side
"""
