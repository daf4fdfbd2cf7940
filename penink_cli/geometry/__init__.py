"""Arrangements of discontinuity edges as geometry: validity, trails, triangulation, regions, sides, quantisation."""
