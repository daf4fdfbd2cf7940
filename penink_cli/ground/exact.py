"""Lengths, angles, exponentials and logarithms that are the same to the last bit everywhere.

The functions of C libraries and of numpy differ between versions and between processors. These functions use nothing
but + - * /, the square root and exact scalings by powers of two, which IEEE 754 defines to the bit, in a fixed order.
They are within a few units in the last place. Kernels have the same functions in `_compiled/real.pxd`.

Arguments are floats or arrays of float64, results are arrays of the same shape.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from penink_cli.ground._compiled import exact as _exact

Floats = npt.NDArray[np.float64]


def hypot(x: npt.ArrayLike, y: npt.ArrayLike) -> Any:
    """Length of the hypotenuse, for lengths whose squares are finite.

    >>> float(hypot(3.0, 4.0))
    5.0
    """
    x, y = np.asarray(x, np.float64), np.asarray(y, np.float64)
    return np.sqrt(x * x + y * y)


def length(vectors: npt.ArrayLike) -> Any:
    """Lengths (…) of vectors (…, 2)."""
    vectors = np.asarray(vectors, np.float64)
    return hypot(vectors[..., 0], vectors[..., 1])


def exp(x: npt.ArrayLike) -> Any:
    """e to the power of x, for x up to 709; 0 for x below -700."""
    (x,), out = _flat(x)
    _exact.exponentials(x.ravel(), out.ravel())
    return out


def log(x: npt.ArrayLike) -> Any:
    """Natural logarithm of positive x."""
    (x,), out = _flat(x)
    _exact.logarithms(x.ravel(), out.ravel())
    return out


def power(x: npt.ArrayLike, y: npt.ArrayLike) -> Any:
    """x to the power of y for x ≥ 0, as e to the power of y ln x; 0 to the power of 0 is 1."""
    (x, y), out = _flat(x, y)
    _exact.powers(x.ravel(), y.ravel(), out.ravel())
    return out


def atan2(y: npt.ArrayLike, x: npt.ArrayLike) -> Any:
    """Angle of the vector (x, y), -π … π; 0 for the zero vector."""
    (x, y), out = _flat(x, y)
    _exact.angles(x.ravel(), y.ravel(), out.ravel())
    return out


def acos(x: npt.ArrayLike) -> Any:
    """Angle from 0 to π whose cosine is x, -1 … 1."""
    x = np.asarray(x, np.float64)
    return 2.0 * atan2(np.sqrt(1.0 - x), np.sqrt(1.0 + x))


def cos_sin(angle: npt.ArrayLike) -> tuple[Any, Any]:
    """Cosine and sine of angles of at most some 10 000 turns."""
    (angle,), cosine = _flat(angle)
    sine = np.empty(cosine.shape)
    _exact.waves(angle.ravel(), cosine.ravel(), sine.ravel())
    return cosine, sine


def _flat(*arguments: npt.ArrayLike) -> tuple[list[Floats], Floats]:
    """The arguments brought to one shape, their elements side by side in memory, and an array for the result."""
    arrays = np.broadcast_arrays(*(np.asarray(argument, np.float64) for argument in arguments))
    return [np.ascontiguousarray(array) for array in arrays], np.empty(arrays[0].shape)
