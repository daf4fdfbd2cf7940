"""The vector kernels in the make that suits this processor: compiled once for any, again for AVX2 and for AVX-512.

All compute the same numbers, each rounded alike, so no byte of output depends on which of them is taken.
"""

from __future__ import annotations

from importlib import import_module
from types import ModuleType

from penink_cli.reconstruction._compiled import desk as _desk
from penink_cli.reconstruction._compiled import tile as _tile

MAKES = {
    "separable": {16: "", 32: "_avx2"},  # runs of eight columns at a time do not fill a vector of sixteen
    "fades": {16: "", 32: "_avx2", 64: "_avx512"},
    "sums": {16: "", 32: "_avx2", 64: "_avx512"},
}
LANES = _desk.lanes()


def kernel(name: str) -> ModuleType:
    """The compiled kernel of that name, in the best make that can run here."""
    best = max(lanes for lanes in MAKES[name] if lanes <= LANES)
    return import_module(f"penink_cli.reconstruction._compiled.{name}{MAKES[name][best]}")


def furnish(tile: _tile.Tile, desk: _desk.Desk) -> None:
    """Have the sets of pixels of a tile, and the arithmetic on a desk, computed in the best make."""
    tile.wide = LANES > 16
    kernel("fades").furnish(desk)
    kernel("sums").furnish(desk)
