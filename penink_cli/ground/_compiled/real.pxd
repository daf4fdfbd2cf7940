"""Sine, exponential, logarithm and angle of doubles from +, -, *, / and square roots: on all machines the same bits.

C libraries differ from one another in the last bit, and one bit can decide where a stroke ends. These functions are
within 2 units in the last place of the true values: sine and cosine for |x| < 10^5, the exponential for |x| < 700, the
logarithm for normal positive numbers. They are not for arguments beyond.
"""

from libc.math cimport floor, frexp, ldexp, sqrt


cdef inline double sine_of(double x) noexcept nogil:
    return _wave(x, 0)


cdef inline double cosine_of(double x) noexcept nogil:
    return _wave(x, 1)


cdef inline double _wave(double x, int ahead) noexcept nogil:
    """sin(x + ahead · π / 2): x less the nearest multiple of π / 2, taken off in three parts, then a series."""
    cdef double n = floor(x * 0.63661977236758134308 + 0.5)
    cdef double r = ((x - n * 1.5707963267341256) - n * 6.077100506303966e-11) - n * 2.0222662487959506e-21
    cdef double z = r * r
    cdef int quarter = <int>(n - 4.0 * floor(n * 0.25)) + ahead
    cdef double value
    if quarter & 1:
        value = 1.0 - z * (0.5 - z * (1.0 / 24.0 - z * (1.0 / 720.0 - z * (1.0 / 40320.0 - z * (
            1.0 / 3628800.0 - z * (1.0 / 479001600.0 - z * (1.0 / 87178291200.0 - z / 20922789888000.0)))))))
    else:
        value = r - r * z * (1.0 / 6.0 - z * (1.0 / 120.0 - z * (1.0 / 5040.0 - z * (1.0 / 362880.0 - z * (
            1.0 / 39916800.0 - z * (1.0 / 6227020800.0 - z / 1307674368000.0))))))
    return -value if quarter & 2 else value


cdef inline double exponential(double x) noexcept nogil:
    """e^x: x less the nearest multiple of ln 2, taken off in two parts, then the series; 0 below -700."""
    cdef double n, r, total
    if x < -700.0:
        return 0.0
    n = floor(x * 1.44269504088896340736 + 0.5)
    r = (x - n * 0.693147180369123816490) - n * 1.90821492927058770002e-10
    total = 1.0 + r * (1.0 + r * (0.5 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * (1.0 / 120.0 + r * (1.0 / 720.0 + r * (
        1.0 / 5040.0 + r * (1.0 / 40320.0 + r * (1.0 / 362880.0 + r * (1.0 / 3628800.0 + r * (1.0 / 39916800.0 + r * (
            1.0 / 479001600.0 + r / 6227020800.0))))))))))))
    return ldexp(total, <int>n)


cdef inline double logarithm(double x) noexcept nogil:
    """ln x of a positive number: its exponent times ln 2, and twice the series of artanh of what is left."""
    cdef int exponent
    cdef double m = frexp(x, &exponent), s, z, total
    cdef int k
    if m < 0.70710678118654752440:
        m *= 2.0
        exponent -= 1
    s = (m - 1.0) / (m + 1.0)
    z = s * s
    total = 1.0 / 21.0
    for k in range(19, 0, -2):
        total = total * z + 1.0 / k
    return exponent * 0.693147180369123816490 + (2.0 * s * total + exponent * 1.90821492927058770002e-10)


cdef inline double angle_of(double x, double y) noexcept nogil:
    """The angle of the direction (x, y) from the x axis towards y, -π … π; 0 for none.

    The lesser over the greater is at most the tangent of an eighth of a turn; that halved three times, and the series.
    """
    cdef double wide = x if x >= 0.0 else -x
    cdef double tall = y if y >= 0.0 else -y
    cdef double t, s, total, angle
    cdef int n, _
    if wide == 0.0 and tall == 0.0:
        return 0.0
    t = tall / wide if tall <= wide else wide / tall
    for _ in range(3):
        t = t / (1.0 + sqrt(1.0 + t * t))
    s = t * t
    total = 0.0
    for n in range(17, 0, -2):
        total = (1.0 if n % 4 == 1 else -1.0) / n + total * s
    angle = 8.0 * t * total
    if tall > wide:
        angle = 1.57079632679489661923 - angle
    if x < 0.0:
        angle = 3.14159265358979323846 - angle
    return -angle if y < 0.0 else angle
