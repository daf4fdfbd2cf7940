"""Pictures as files store them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from penink_cli.ground.model.arrays import Floats


@dataclass(frozen=True, eq=False)
class GreyImage:
    """Grey samples exactly as a PGM file stores them.

    values: (h, w), uint8 where maxval ≤ 255, else uint16; 0 is black, maxval is paper white.
    """

    values: npt.NDArray[np.uint8] | npt.NDArray[np.uint16]
    maxval: int = 255

    @property
    def tone(self) -> Floats:
        """Ink coverage (h, w), 0 paper … 1 solid ink."""
        return 1.0 - self.values / float(self.maxval)

    @property
    def grey(self) -> npt.NDArray[np.float32]:
        """Grey (h, w), 0 black … 1 paper white."""
        return np.divide(self.values, self.maxval, dtype=np.float32)

    @classmethod
    def from_grey(cls, grey: npt.NDArray[np.floating], maxval: int = 255) -> GreyImage:
        """The nearest grey levels, half up, to grey (h, w) 0 … 1."""
        levels = np.floor(np.clip(grey, 0, 1) * maxval + 0.5)
        return cls(levels.astype(np.uint8 if maxval < 256 else np.uint16), maxval)


@dataclass(frozen=True, eq=False)
class ColourImage:
    """A photograph in its colours, as stored.

    values: (h, w, 3) red, green, blue, uint8 where maxval ≤ 255, else uint16.
    """

    values: npt.NDArray[np.uint8] | npt.NDArray[np.uint16]
    maxval: int = 255

    @classmethod
    def from_colours(cls, colours: npt.NDArray[np.floating], maxval: int = 255) -> ColourImage:
        """The nearest levels, half up, to colours (h, w, 3) 0 … 1."""
        levels = np.floor(np.clip(colours, 0, 1) * maxval + 0.5)
        return cls(levels.astype(np.uint8 if maxval < 256 else np.uint16), maxval)
