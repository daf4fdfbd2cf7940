"""Compiled loops of this room; each is imported by one module beside this folder."""
