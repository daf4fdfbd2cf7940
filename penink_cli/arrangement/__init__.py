"""Photo to discontinuity edges: an arrangement of segments that meet only at shared vertices."""
