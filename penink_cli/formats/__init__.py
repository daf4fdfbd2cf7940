"""Readers and writers: each module is one on-disk format, defined in README.md beside them."""
