"""Compiled: this room's kernels. Each is imported by one module beside this folder; the build finds them here."""
