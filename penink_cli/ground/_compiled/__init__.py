"""Compiled: what kernels of all rooms cimport."""
