# cython: boundscheck=False, wraparound=False, cdivision=True
# distutils: extra_compile_args = -mavx512f -mavx512bw -mavx512dq -mavx512vl
include "sums.pyx"
