"""Compiled loops of blasting; each is imported by one module alone."""
