"""A Gaussian low-pass that stops at strong steps of a guide, as what is due and what the eye sees are reckoned with.

This module alone imports the compiled kernel `due` for it.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from penink_cli.blasting._compiled import due as _due
from penink_cli.ground import threads as threading
from penink_cli.ground.model import Floats

Cells = npt.NDArray[np.float32]

#: Rows that are low-passed at a time, on one thread, and cells that are at once, see `_due`.
BAND, BLOCK = 64, 16


def gaussian(sigma: float, radius: int) -> Floats:
    """(2 radius + 1,) weights that sum to 1, the same on every machine."""
    w = np.array([round(math.exp(-0.5 * (k / sigma) ** 2), 9) for k in range(-radius, radius + 1)])
    return w / math.fsum(w)


class LowPass:
    """kernel: a Gaussian of σ cells that sums to 1, (2 r + 1, 16); profile: its values by distance in quarters of a
    cell. Each row of the kernel ends in zeros, up to where loops of a fixed length may run; σ is 2.8 at the most.

    guide: (rows, columns); cells that differ by `step` or more in it have no part in each other.
    threads: how many run it.
    """

    def __init__(self, sigma: float, guide: Cells, step: float, threads: int):
        radius = math.ceil(2.5 * sigma)
        g = gaussian(sigma, radius)
        peak = float(g[radius]) ** 2
        profile = [round(peak * math.exp(-0.5 * (k / 4 / sigma) ** 2), 9) for k in range(4 * radius + 1)]
        self.kernel = np.zeros((2 * radius + 1, BLOCK), np.float32)
        self.kernel[:, : 2 * radius + 1] = np.outer(g, g)
        self.profile = np.array(profile)
        self.step = step
        self._line = g.astype(np.float32)
        self._radius = radius
        self._threads = threads
        self._guide = self._padded(guide)
        self._plain = self._blocks_without_steps(guide)

    def _padded(self, values: Cells) -> Cells:
        """With nothing around it, as far as the kernel reaches from whole blocks."""
        r, (rows, columns) = self._radius, values.shape
        out = np.zeros((rows + 2 * r, -(-columns // BLOCK) * BLOCK + 2 * r + 1), np.float32)
        out[r : r + rows, r : r + columns] = values
        return out

    def _blocks_without_steps(self, guide: Cells) -> npt.NDArray[np.uint8]:
        """(rows, blocks of a row): there is no step within the kernel's reach of any cell of the block."""
        near = self._radius
        fits = np.ones(guide.shape, bool)
        for pick, sign in ((np.maximum, 1), (np.minimum, -1)):
            extreme = np.pad(guide, near, mode="edge")
            for axis in (0, 1):
                # the extreme of 2, 4, 8 in a row; the two last ones that overlap make 2 r + 1
                width, size = 1, 2 * near + 1
                while width < size:
                    by = min(width, size - width)
                    first, second = [slice(None)] * 2, [slice(None)] * 2
                    first[axis], second[axis] = slice(None, -by), slice(by, None)
                    extreme = pick(extreme[tuple(first)], extreme[tuple(second)])
                    width += by
            fits &= sign * (extreme - guide) < np.float32(self.step)
        wide = np.ones((len(guide), -(-guide.shape[1] // BLOCK) * BLOCK), bool)
        wide[:, : guide.shape[1]] = fits
        plain = np.logical_and.reduce(wide.reshape(len(guide), -1, BLOCK), axis=2)
        return np.asarray(plain, np.uint8)

    def __call__(self, values: Cells) -> Cells:
        """G * values (rows, columns), nothing beyond the frame."""
        out = np.empty_like(values)
        padded = self._padded(values)

        def band(top: int, bottom: int) -> None:
            scratch = np.empty((bottom - top + 2 * self._radius + 1, padded.shape[1]), np.float32)
            _due.gather(
                padded, self._guide, self.kernel, self._line, self.step, self._plain, scratch, out, top, bottom
            )

        threading.share(threading.ranges(band, len(values), BAND), self._threads)
        return out
