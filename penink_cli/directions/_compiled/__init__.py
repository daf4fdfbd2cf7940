"""Compiled: this room's kernels. The build finds them here."""
