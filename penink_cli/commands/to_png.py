"""``penink to-png``: to-pgm's twin."""

from penink_cli.commands.to_pgm import to_png

__all__ = ["to_png"]
