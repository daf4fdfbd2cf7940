"""The reconstruction kernels (appendix A) as tables of taps, one row for each output column or row."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from penink_cli.ground.errors import ParameterError
from penink_cli.ground.model import Floats
from penink_cli.reconstruction._compiled import kernels as _kernels

KERNELS = ("cubic", "bspline")
#: Of the weights that edges leave (equation 5's denominator): the sum of the cubic's below which the B-spline is
#: blended in, and the sum of the B-spline's below which plain convolution is.
T1, T2 = 0.5, 1e-4


@dataclass(frozen=True, eq=False)
class Taps:
    """The taps of n positions along one axis.

    where: (n,) the positions, in sample units.
    first: (n,) the first sample under the kernel, before clamping to the frame.
    cubic, bspline: (n, t) weights of the t samples from `first` on; each row sums to one.
    """

    where: Floats
    first: np.ndarray
    cubic: Floats
    bspline: Floats


def taps(where: Floats, widening: float = 1.0) -> Taps:
    """Tabulate both kernels at some positions.

    widening: 1 when enlarging; the inverse scale below scale 1, where the kernels are widened to band-limit.
    """
    where = np.ascontiguousarray(where, np.float64)
    count = math.ceil(4.0 * widening)
    first = np.empty(len(where), np.intc)
    cubic = np.empty((len(where), count))
    bspline = np.empty((len(where), count))
    _kernels.fill_taps(where, widening, first, cubic, bspline)
    return Taps(where, first, cubic, bspline)


def is_bspline(kernel: str) -> bool:
    """Whether the kernel of that name is the B-spline alone. Raises ParameterError, which names the known ones."""
    if kernel not in KERNELS:
        raise ParameterError(f"kernel {kernel!r} is not one of {', '.join(KERNELS)}")
    return kernel == "bspline"
