"""Measurements. Each module prints figures of one subject; its first line says of which."""
