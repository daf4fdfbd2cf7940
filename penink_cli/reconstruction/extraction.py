"""One clean sample for each pixel of a photo: the paper's section 3, second step.

A pixel that an edge, through the pixel's area or the photo's blur, reaches is an average over
both sides and unfit as a sample. It is replaced by an extrapolation from uncontaminated pixels
that can be reached without crossing an edge.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from penink_cli.geometry import walls
from penink_cli.ground import exact
from penink_cli.ground import threads as threading
from penink_cli.ground.model import EdgeList
from penink_cli.reconstruction._compiled import clean as _clean
from penink_cli.reconstruction.camera import camera_blur

_SPREAD = 1.5
_STIFFNESS = 0.3
_BAND_ROWS = 64


def extract_samples(
    grey: npt.NDArray[np.floating],
    edges: EdgeList,
    margin: float | None = None,
    report: Callable[[str], None] = lambda line: None,
) -> npt.NDArray[np.float32]:
    """Replace contaminated pixels by what their side of the edges says.

    Args:
        grey: (h, w), 0 … 1.
        edges: in the frame of the same picture.
        margin: pixels nearer than this to an edge are contaminated; estimated where None.
        report: is told, in a line, the margin chosen and how many pixels it takes.

    Returns:
        (h, w) float32, 0 … 1.

    """
    values = np.ascontiguousarray(grey, np.float32)
    height, width = values.shape
    if not len(edges.edges):
        return values
    margin = contamination(camera_blur(values, edges)) if margin is None else margin
    distance = walls.distances(edges, width, height, margin)
    report(f"chosen: --margin {float(margin)}; {np.mean(distance <= margin):.1%} of the pixels are replaced")
    ground = walkable(edges, width, height, distance > margin)
    out = np.empty_like(values)
    steps = math.ceil(margin) + 3
    reach = _clean.MAX_REACH
    table = exact.exp(np.array([-d * d / (2 * _SPREAD * _SPREAD) for d in range(-reach, reach + 1)]))

    def rows(first: int, last: int) -> None:
        _clean.extrapolate(values, ground, distance, margin, first, last, steps, _SPREAD, _STIFFNESS, table, out)

    threading.share(threading.ranges(rows, height, _BAND_ROWS), threading.count(None))
    return np.clip(out, 0, 1, out=out)


def walkable(edges: EdgeList, width: int, height: int, clean: npt.NDArray[np.bool_] | None = None) -> _clean.Ground:
    """The steps between pixel centres of an image of width × height that cross no edge, and the pixels that count."""
    met = walls.walls(edges, width, height)
    right, down = met & walls.RIGHT == 0, met & walls.DOWN == 0
    right[:, -1] = False
    down[-1] = False
    return _clean.Ground(_words(right), _words(down), _words(clean if clean is not None else met < 4))


def _words(bits: npt.NDArray[np.bool_]) -> npt.NDArray[np.uint64]:
    """Rows of bits (h, w) as words of 64, with an empty one before and two after."""
    height, width = bits.shape
    octets = np.zeros((height, 8 * ((width + 63) // 64 + 3)), np.uint8)
    octets[:, 8 : 8 + (width + 7) // 8] = np.packbits(bits, axis=1, bitorder="little")
    return octets.view("<u8").astype(np.uint64, copy=False)


def contaminated(grey: npt.NDArray[np.floating], edges: EdgeList, margin: float | None = None) -> npt.NDArray[np.bool_]:
    """Which pixels (h, w) `extract_samples` replaces."""
    margin = contamination(camera_blur(grey, edges)) if margin is None else margin
    return walls.distances(edges, grey.shape[1], grey.shape[0], margin) <= margin


def contamination(blur: float) -> float:
    """How far from an edge a photo's pixels are mixtures: half a pixel's diagonal, and the blur as far as it tells.

    Farther out less than a tenth of the step is left, and clean pixels run short: at 2.5 pixels instead
    of 1.3 the samples of a camera's sharp photo lose 2 dB.
    """
    return 0.7 + 1.3 * blur
