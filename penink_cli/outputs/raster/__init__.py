"""Strokes as pixels.

cover    how much of each pixel ink covers, in bands from the top
png      the bands as a PNG file
"""
