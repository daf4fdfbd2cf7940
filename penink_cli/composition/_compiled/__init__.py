"""Compiled loops of composition."""
