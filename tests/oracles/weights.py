"""The rows of the reconstruction as a linear operator: f(x) = Σ weight · sample, edges held fixed (equation 5).

Given the edges the reconstruction is linear in the samples. This goes point by point, by the kernel of reductions. It
shares the search with the tiles of an enlargement and nothing after it, so the tiles are held to it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from penink_cli.ground import threads as threading
from penink_cli.ground.model import Floats, Ints
from penink_cli.reconstruction._compiled import weights as _weights
from penink_cli.reconstruction.kernels import is_bspline, taps
from penink_cli.reconstruction.paths import Paths


@dataclass(frozen=True, eq=False)
class Weights:
    """Sparse rows of the reconstruction.

    index: (n, 16) samples, row · width + column; one under the border's replication may occur more than once.
    weight: (n, 16) their weights; each row sums to one.
    starved: (n,) 0 … 1, how far plain convolution across the edges has taken over for want of a reachable sample.
    """

    index: Ints
    weight: Floats
    starved: Floats

    def apply(self, samples: Floats) -> Floats:
        """The reconstructed values (n,) for samples of any shape that ravel to the image's."""
        flat = samples.ravel()
        total = np.zeros(len(self.weight))
        for index, weight in zip(self.index.T, self.weight.T):  # in this order: no library chooses another
            total += weight * flat[index]
        return total


def weights(
    paths: Paths, points: Floats, *, radius: float = 1.0, kernel: str = "cubic", threads: int | None = None
) -> Weights:
    """Weights of the 4 × 4 samples around each point, as `enlarge` uses them.

    paths: the edges over the samples. points: (n, 2) in sample units, inside the frame.
    """
    points = np.ascontiguousarray(points, np.float64)
    only_b = is_bspline(kernel)
    x, y = taps(points[:, 0]), taps(points[:, 1])
    n = len(points)
    index, weight, starved = np.empty((n, 16), np.int64), np.empty((n, 16)), np.empty(n)
    # Neighbouring points share the bends remembered for their samples.
    workers = threading.count(threads)

    def run(begin: int, end: int) -> None:
        _weights.Points(paths.finder(), x, y, radius, only_b).scattered(begin, end, index, weight, starved)

    size = max(4096, -(-n // (4 * workers)))
    threading.share(threading.ranges(run, n, size), workers)
    return Weights(index, weight, starved)
