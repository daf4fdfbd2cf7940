# cython: boundscheck=False, wraparound=False, cdivision=True
# distutils: extra_compile_args = -mavx2
include "fades.pyx"
