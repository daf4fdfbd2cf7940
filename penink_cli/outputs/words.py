"""Lists of numbers as text, as PostScript, SVG and PDF are made of."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from penink_cli.ground.model import Floats, Ints
from penink_cli.outputs._compiled import words as _words


def text(numbers: Ints, after: npt.NDArray[np.int32], words: Sequence[bytes], decimals: int = 0) -> memoryview:
    """Each of numbers / 10^decimals (n,), without needless zeros, followed by its word, words[after[i]].

    >>> bytes(text(np.array([10, -25, 0]), np.array([0, 0, 1], np.int32), [b" ", b" l"], decimals=1))
    b'1 -2.5 0 l'
    """
    starts = np.cumsum([0, *map(len, words)])
    lengths = np.diff(starts)
    out = np.empty(21 * len(numbers) + int(lengths[after].sum()) + 1, np.uint8)
    size = _words.put(
        np.ascontiguousarray(numbers, np.int64), decimals, np.ascontiguousarray(after),
        np.frombuffer(b"".join(words) or b" ", np.uint8), starts, out,
    )  # fmt: skip
    return out[:size].data


def whole(values: Floats) -> Ints:
    """Values of any shape rounded to the nearest whole numbers."""
    return np.rint(values).astype(np.int64)
