"""The vector kernels in the make that suits this processor: compiled once for any, and again for AVX2.

All compute the same numbers, each rounded alike, so no byte of output depends on which of them is taken.
"""

from __future__ import annotations

from importlib import import_module
from types import ModuleType

from penink_cli.reconstruction._compiled import scratch as _scratch
from penink_cli.reconstruction._compiled import tile as _tile

MAKES = {
    "separable": {16: "", 32: "_avx2"},
    "fades": {16: "", 32: "_avx2"},
    "sums": {16: "", 32: "_avx2"},
}
VECTOR_BYTES = _scratch.lanes()


def kernel(name: str) -> ModuleType:
    """The compiled kernel of that name, in the best make that can run here."""
    best = max(lanes for lanes in MAKES[name] if lanes <= VECTOR_BYTES)
    return import_module(f"penink_cli.reconstruction._compiled.{name}{MAKES[name][best]}")


def bind(tile: _tile.Tile, scratch: _scratch.Scratch) -> None:
    """Have the sets of pixels of a tile, and the arithmetic on a scratch, computed in the best make."""
    tile.wide = VECTOR_BYTES > 16
    kernel("fades").bind(scratch)
    kernel("sums").bind(scratch)
