# cython: boundscheck=False, wraparound=False, cdivision=True
"""The exact orientation predicate that every geometric decision of the project rests on.

    a ────────→ b          x is to the right, y is DOWN:
         ·                 orient(a, b, c) = sign of (b − a) × (c − a)
           ·               is +1 where c lies as drawn here, to the right of one who goes from a to b,
             c             −1 to the left, and 0 on the line.

A double evaluation with an error bound settles nearly every call. The rest is summed exactly: six products, each split
into its rounded value and its rounding error, added up as a non-overlapping expansion whose last non-zero term has the
sign of the sum. Bound and expansions: Shewchuk, Adaptive Precision Floating-Point Arithmetic, 1997.

The tie rule: a query (a sample, a pixel's centre, a point) on the line through a and b stands for itself shifted by (ε,
ε²), ε above 0 and arbitrarily small. Its side is then the sign of a.y − b.y or, where these are equal, of b.x − a.x.
Kernels, Python, JavaScript and PostScript all break ties so.
"""

cdef double SPLITTER = 134217729.0  # 2²⁷ + 1


cdef int exactly(double ax, double ay, double bx, double by, double cx, double cy) noexcept nogil:
    """Sign of bx·cy − bx·ay − ax·cy − by·cx + by·ax + ay·cx, without rounding."""
    cdef double[12] terms
    cdef int n = 0
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


cdef int _add_product(double* terms, int n, double a, double b) noexcept nogil:
    """Add a·b exactly to an expansion of n terms in increasing magnitude; its new length, n + 2."""
    cdef double product = a * b
    cdef double c = SPLITTER * a
    cdef double a_high = c - (c - a)
    cdef double a_low = a - a_high
    c = SPLITTER * b
    cdef double b_high = c - (c - b)
    cdef double b_low = b - b_high
    cdef double error = a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low)
    n = _grow(terms, n, error)
    return _grow(terms, n, product)


cdef int _grow(double* terms, int n, double b) noexcept nogil:
    """Add one number to an expansion of n terms; its new length, n + 1."""
    cdef int i
    cdef double total, virtual, rest
    for i in range(n):
        total = b + terms[i]
        virtual = total - b
        rest = (b - (total - virtual)) + (terms[i] - virtual)
        terms[i] = rest
        b = total
    terms[n] = b
    return n + 1
