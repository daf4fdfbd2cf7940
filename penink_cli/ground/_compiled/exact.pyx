# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: the functions of `real.pxd` over arrays. All arrays are flat, (n,), and of one length; see exact.py."""

from penink_cli.ground._compiled.real cimport angle_of, cosine_of, exponential, logarithm, sine_of


def exponentials(const double[::1] x, double[::1] out) -> None:
    """out = e^x."""
    cdef Py_ssize_t k
    with nogil:
        for k in range(x.shape[0]):
            out[k] = exponential(x[k])


def logarithms(const double[::1] x, double[::1] out) -> None:
    """out = ln x, x above 0."""
    cdef Py_ssize_t k
    with nogil:
        for k in range(x.shape[0]):
            out[k] = logarithm(x[k])


def powers(const double[::1] x, const double[::1] y, double[::1] out) -> None:
    """out = x^y, x from 0 on."""
    cdef Py_ssize_t k
    with nogil:
        for k in range(x.shape[0]):
            if x[k] > 0.0:
                out[k] = exponential(y[k] * logarithm(x[k]))
            else:
                out[k] = 1.0 if y[k] == 0.0 else 0.0


def angles(const double[::1] x, const double[::1] y, double[::1] out) -> None:
    """out = the angle of the vector (x, y), -π … π; 0 for the zero vector."""
    cdef Py_ssize_t k
    with nogil:
        for k in range(x.shape[0]):
            out[k] = angle_of(x[k], y[k])


def waves(const double[::1] x, double[::1] cosine, double[::1] sine) -> None:
    """Cosine and sine of x."""
    cdef Py_ssize_t k
    with nogil:
        for k in range(x.shape[0]):
            cosine[k] = cosine_of(x[k])
            sine[k] = sine_of(x[k])
