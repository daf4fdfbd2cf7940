"""Powers that are the same on every machine: made of additions, multiplications and divisions, in one order.

The C library's may differ in the last bit from one system to the next.
"""

from __future__ import annotations

import numpy as np

from penink_cli.ground.model import Floats

LN2 = 0.6931471805599453
_ODD = [1.0 / k for k in range(25, 0, -2)]  # of the series of atanh
_EXP = [1.0]
for _k in range(1, 18):
    _EXP.insert(0, _EXP[0] / _k)


def power(base: Floats, exponent: float) -> Floats:
    """``base ** exponent``, to some 14 digits, of numbers from 0 up; 0 where the base is 0 (and the exponent above)."""
    mantissa, twos = np.frexp(np.maximum(base, 1e-300))  # exact
    small = mantissa < 0.7071067811865476
    mantissa = np.where(small, 2.0 * mantissa, mantissa)
    s = (mantissa - 1.0) / (mantissa + 1.0)
    square = s * s
    series = np.zeros_like(s)
    for term in _ODD:
        series = series * square + term
    logarithm = 2.0 * s * series + (twos - small) * LN2
    wanted = np.clip(exponent * logarithm, -700.0, 700.0)
    whole = np.floor(wanted / LN2 + 0.5)
    rest = wanted - whole * LN2
    result = np.zeros_like(rest)
    for term in _EXP:
        result = result * rest + term
    return np.where(base <= 0.0, 0.0, np.ldexp(result, whole.astype(np.int32)))
