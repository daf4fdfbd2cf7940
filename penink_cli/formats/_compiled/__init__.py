"""Kernels of the formats."""
