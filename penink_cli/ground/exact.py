"""Lengths, angles, exponentials and logarithms that are the same to the last bit everywhere.

The C library's and numpy's own differ between versions and between processors. These use nothing but
+ - * /, the square root and exact scalings by powers of two, which IEEE 754 defines to the bit, in a fixed order.
They are within a few units in the last place, and no faster than they need be.

Arguments are floats or arrays of float64, results arrays of the same shape.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

LN2_HIGH, LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10  # the first with 20 trailing zero bits
HALF_PI_HIGH, HALF_PI_MIDDLE = 1.57079632673412561417e00, 6.07710050630396597660e-11
HALF_PI_LOW = 2.02226624879595063154e-21
LOG2_E, TWO_OVER_PI = 1.44269504088896338700, 0.63661977236758134308
SQRT_HALF = 0.70710678118654752440
PI = 3.14159265358979323846


def hypot(x: npt.ArrayLike, y: npt.ArrayLike) -> Any:
    """Length of the hypotenuse, for lengths whose squares are numbers.

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
    """e to the power of x, for x from -700 to 700 (0 below): x = k ln 2 + r, and Taylor's series of r."""
    x = np.asarray(x, np.float64)
    k = np.floor(np.clip(x, -745.0, 710.0) * LOG2_E + 0.5)
    r = (x - k * LN2_HIGH) - k * LN2_LOW
    total = np.ones_like(r)
    for n in range(14, 0, -1):
        total = 1.0 + total * r / n
    return np.where(x < -745.0, 0.0, np.ldexp(total, k.astype(np.int32)))


def log(x: npt.ArrayLike) -> Any:
    """Natural logarithm of positive x: x = 2^k m, m about 1, and the series of artanh((m - 1) / (m + 1))."""
    m, k = np.frexp(np.asarray(x, np.float64))
    low = m < SQRT_HALF
    m, k = np.where(low, 2.0 * m, m), k - low
    f = (m - 1.0) / (m + 1.0)
    s, total = f * f, np.zeros_like(f)
    for n in range(23, 0, -2):
        total = total * s + 1.0 / n
    return k * LN2_HIGH + (2.0 * f * total + k * LN2_LOW)


def power(x: npt.ArrayLike, y: npt.ArrayLike) -> Any:
    """x to the power of y, x from 0 on: e to the power of y ln x."""
    x = np.asarray(x, np.float64)
    positive = x > 0
    raised = exp(np.asarray(y, np.float64) * log(np.where(positive, x, 1.0)))
    return np.where(positive, raised, np.where(np.asarray(y) == 0, 1.0, 0.0))


def atan2(y: npt.ArrayLike, x: npt.ArrayLike) -> Any:
    """Angle of the vector (x, y), -π … π; 0 of no vector.

    The smaller over the larger is at most the tangent of an eighth of a turn; halved three times, Taylor's series.
    """
    y, x = np.asarray(y, np.float64), np.asarray(x, np.float64)
    tall, wide = np.abs(y), np.abs(x)
    larger = np.maximum(tall, wide)
    t = np.minimum(tall, wide) / np.where(larger > 0, larger, 1.0)
    for _ in range(3):
        t = t / (1.0 + np.sqrt(1.0 + t * t))
    s, total = t * t, np.zeros_like(t)
    for n in range(17, 0, -2):
        total = (1.0 if n % 4 == 1 else -1.0) / n + total * s
    angle = 8.0 * t * total
    angle = np.where(tall > wide, PI / 2 - angle, angle)
    angle = np.where(x < 0, PI - angle, angle)
    return np.where(y < 0, -angle, angle)


def acos(x: npt.ArrayLike) -> Any:
    """Angle from 0 to π whose cosine is x, -1 … 1."""
    x = np.asarray(x, np.float64)
    return 2.0 * atan2(np.sqrt(1.0 - x), np.sqrt(1.0 + x))


def cos_sin(angle: npt.ArrayLike) -> tuple[Any, Any]:
    """Cosine and sine of angles of at most some 100 000 turns: the quarter turns taken off, and Taylor's series."""
    angle = np.asarray(angle, np.float64)
    quarter = np.floor(angle * TWO_OVER_PI + 0.5)
    r = ((angle - quarter * HALF_PI_HIGH) - quarter * HALF_PI_MIDDLE) - quarter * HALF_PI_LOW
    s = r * r
    sine, cosine = np.ones_like(r), np.ones_like(r)
    for n in range(18, 0, -2):
        cosine = 1.0 - cosine * s / (n * (n - 1))
        sine = 1.0 - sine * s / (n * (n + 1))
    sine = r * sine
    which = quarter.astype(np.int64) % 4
    swapped = which % 2 == 1
    c, d = np.where(swapped, sine, cosine), np.where(swapped, cosine, sine)
    return np.where((which == 1) | (which == 2), -c, c), np.where(which >= 2, -d, d)
