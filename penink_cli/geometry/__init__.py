"""Arrangements of discontinuity edges as geometry. All is decided exactly; ties by `_compiled/predicates.pyx`.

validity.check         edges that meet only at shared vertices; a sweep
trails                 edges as few long trails, to be written or drawn
edge_index             the edges near a place
walls                  edges drawn into pixels: steps that meet an edge, distances, regions
curves                 smooth curves through points, and few points whose curve follows a path
triangulation          constrained Delaunay, by `meshers`; the regions that edges enclose; walking to a point
  regions                the regions that hold given points
quantisation           vertices on a coarse grid, the arrangement unbroken
  sides                  and each sample on its side
"""
