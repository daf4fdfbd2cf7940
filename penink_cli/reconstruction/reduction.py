"""Fewer samples, each of which speaks only for what it can reach (the paper's section 3, third step)."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import numpy.typing as npt

from penink_cli.geometry import edge_index, walls
from penink_cli.ground import threads as threading
from penink_cli.ground.errors import ParameterError
from penink_cli.ground.model import EdgeList, Floats
from penink_cli.reconstruction._compiled import clean as _clean
from penink_cli.reconstruction.camera import camera_blur
from penink_cli.reconstruction.extraction import walkable
from penink_cli.reconstruction.fit import AREA, POINT, fit_plain, fit_samples
from penink_cli.reconstruction.shrinking import shrunk

FITS = ("none", "lsq")

_NEAR = 2.25  # samples: nearer to an edge planes are fitted; there a plain fit mixes in 1 % of the step, at 2.1 3 %
_ENOUGH = 12  # pixels a sample along each axis that are fitted to; more change 0.01 dB and take longer
_CELL = 4.0  # pixels: the cells of the index of edges
_BAND_ROWS = 16  # rows of samples that are a thread's task
_SPREAD, _STIFFNESS = 0.28, 0.5  # in parts of the factor; broader planes smooth away what the grid could hold


def reduce(
    samples: npt.NDArray[np.floating],
    edges: EdgeList,
    width: int,
    height: int,
    *,
    photo: npt.NDArray[np.floating] | None = None,
    fit: str = "none",
    blur: float | None = None,
    threads: int | None = None,
) -> npt.NDArray[np.float32]:
    """Reduce samples to a grid of width × height over the same frame.

    Away from edges the new samples are those of the plain cubic reconstruction that comes nearest
    to the old ones. Near edges each is the value, at its place, of a plane fitted to the old samples
    that it can reach without crossing an edge; with fit "lsq" these are then fitted to the photo.

    Args:
        samples: (h, w) clean samples, 0 … 1.
        edges: in the frame of the image.
        width, height: the new grid, no larger than the old.
        photo: (any h, any w) what "lsq" fits to; the samples themselves where None.
        fit: "none" or "lsq".
        blur: standard deviation of the photo's blur in its pixels; measured where None.
        threads: the bytes are the same for any number.

    Returns:
        (height, width) float32, 0 … 1.

    Raises ParameterError for another fit.

    """
    return Reduction(samples, edges, fit, threads).to(width, height, photo, blur)


class Reduction:
    """Samples to be reduced, to one grid or to several: which old samples reach one another is found once for all."""

    def __init__(
        self, samples: npt.NDArray[np.floating], edges: EdgeList, fit: str = "none", threads: int | None = None
    ) -> None:
        """samples, edges, fit, threads: as of `reduce`; raises as that does."""
        if fit not in FITS:
            raise ParameterError(f"fit {fit!r} is not one of {', '.join(FITS)}")
        self._values = np.ascontiguousarray(samples, np.float32)
        self._edges, self._fit, self._threads = edges, fit, threads

    def to(
        self, width: int, height: int, photo: npt.NDArray[np.floating] | None = None, blur: float | None = None
    ) -> npt.NDArray[np.float32]:
        """The samples (height, width) of `reduce`; width, height, photo, blur: as there."""
        if photo is None:
            seen, blur, fine = self._values, 0.0, POINT  # clean samples are sharp
        else:
            seen, fine = np.ascontiguousarray(photo, np.float32), AREA
            blur = camera_blur(seen, self._edges) if blur is None else blur
        shrink = min(seen.shape[1] / width, seen.shape[0] / height) / _ENOUGH
        if shrink > 1:
            seen, blur, fine = shrunk(seen, shrink), blur / shrink, AREA
        start = fit_plain(seen, width, height, blur, fine)
        if len(self._edges.edges):
            self._take_near_edges(start)
            if self._fit == "lsq":
                start = fit_samples(seen, self._edges, start, blur, fine, threads=self._threads)
        return np.clip(start, 0, 1).astype(np.float32)

    @cached_property
    def _ground(self) -> tuple[_clean.Ground, _clean.Edges]:
        """The steps between old samples that cross no edge, and which edges are near each."""
        height, width = self._values.shape
        lines = np.column_stack(walls.segments(self._edges, width, height))
        index = edge_index.grid(lines, _CELL, width, height)
        return walkable(self._edges, width, height), _clean.Edges(index)

    def _take_near_edges(self, out: Floats) -> None:
        """Replace the samples that an edge is near by planes fitted to what each can reach."""
        height, width = out.shape
        old_height, old_width = self._values.shape
        near = walls.distances(self._edges, width, height, _NEAR)
        ground, near_by = self._ground
        factor = min(_clean.MAX_REACH - 1, max(old_width / width, old_height / height))

        def rows(first: int, last: int) -> None:
            spread, stiffness = _SPREAD * factor, (_STIFFNESS * factor) ** 2
            _clean.resample(self._values, ground, near_by, first, last, round(factor), spread, stiffness, near, out)

        threading.share(threading.ranges(rows, height, _BAND_ROWS), threading.count(self._threads))
