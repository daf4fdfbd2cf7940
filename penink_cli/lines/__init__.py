"""Telling lines: found in a photograph, ranked, chosen for a size on paper, and drawn."""
