"""The stages between a photograph or an illustration and its strokes, and the layers of one sheet."""
