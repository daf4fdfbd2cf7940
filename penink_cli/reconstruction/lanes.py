"""The vector kernels in the make that suits this processor: compiled once for any, and once more for AVX2.

Both compute the same numbers, each rounded alike, so no byte of output depends on which of them is taken.
"""

from __future__ import annotations

from importlib import import_module
from types import ModuleType

from penink_cli.reconstruction import _desk, _tile

WIDE = _desk.has_wide_lanes()


def kernel(name: str) -> ModuleType:
    """The compiled kernel of that name, in the better make if it can run here."""
    return import_module(f"penink_cli.reconstruction.{name}_avx2" if WIDE else f"penink_cli.reconstruction.{name}")


def furnish(tile: _tile.Tile, desk: _desk.Desk) -> None:
    """Have the sets of pixels of a tile, and the arithmetic on a desk, computed in the better make."""
    tile.wide = WIDE
    kernel("_fades").furnish(desk)
    kernel("_sums").furnish(desk)
