"""The directions that strokes follow: a line field found in a photograph, and read at any size."""
