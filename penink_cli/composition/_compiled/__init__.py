"""Kernels of composition."""
