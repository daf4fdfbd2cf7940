"""Strokes as pixels: how much of each pixel ink covers, and the files that hold such pictures."""
