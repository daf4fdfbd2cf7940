# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The exact orientation predicate that every geometric decision of the project rests on.

A double evaluation with Shewchuk's error bound settles nearly every call. The rest is
summed exactly: six products, each split into its rounded value and its rounding error,
added up as a non-overlapping expansion whose last non-zero term has the sign of the sum.
"""

import cython
from cython.cimports.libc.math import fabs

COMPILED = cython.compiled

FILTER = cython.declare(cython.double, 3.3306690738754716e-16)  # (3 + 16 u) u with u = 2⁻⁵³
SPLITTER = cython.declare(cython.double, 134217729.0)  # 2²⁷ + 1


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def orient(
    ax: cython.double, ay: cython.double, bx: cython.double, by: cython.double, cx: cython.double, cy: cython.double
) -> cython.int:
    """Exact sign of (b − a) × (c − a)."""
    left: cython.double = (bx - ax) * (cy - ay)
    right: cython.double = (by - ay) * (cx - ax)
    area: cython.double = left - right
    bound: cython.double = FILTER * (fabs(left) + fabs(right))
    if area > bound:
        return 1
    if area < -bound:
        return -1
    return _exact(ax, ay, bx, by, cx, cy)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _exact(
    ax: cython.double, ay: cython.double, bx: cython.double, by: cython.double, cx: cython.double, cy: cython.double
) -> cython.int:
    """Sign of bx·cy − bx·ay − ax·cy − by·cx + by·ax + ay·cx, without rounding."""
    terms = cython.declare(cython.double[12])
    n: cython.int = 0
    n = _add_product(terms, n, bx, cy)
    n = _add_product(terms, n, -bx, ay)
    n = _add_product(terms, n, -ax, cy)
    n = _add_product(terms, n, -by, cx)
    n = _add_product(terms, n, by, ax)
    n = _add_product(terms, n, ay, cx)
    while n > 0:
        n -= 1
        if terms[n] > 0.0:
            return 1
        if terms[n] < 0.0:
            return -1
    return 0


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _add_product(terms: cython.p_double, n: cython.int, a: cython.double, b: cython.double) -> cython.int:
    """Add a·b exactly to an expansion of n terms in increasing magnitude; its new length, n + 2."""
    product: cython.double = a * b
    c: cython.double = SPLITTER * a
    a_high: cython.double = c - (c - a)
    a_low: cython.double = a - a_high
    c = SPLITTER * b
    b_high: cython.double = c - (c - b)
    b_low: cython.double = b - b_high
    error: cython.double = a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low)
    n = _grow(terms, n, error)
    return _grow(terms, n, product)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _grow(terms: cython.p_double, n: cython.int, b: cython.double) -> cython.int:
    """Add one number to an expansion of n terms; its new length, n + 1."""
    i: cython.int
    total: cython.double
    virtual: cython.double
    rest: cython.double
    for i in range(n):
        total = b + terms[i]
        virtual = total - b
        rest = (b - (total - virtual)) + (terms[i] - virtual)
        terms[i] = rest
        b = total
    terms[n] = b
    return n + 1
