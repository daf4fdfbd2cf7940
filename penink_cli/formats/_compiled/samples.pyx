# cython: boundscheck=False, wraparound=False, cdivision=True
"""Samples in the code of `coder`: each by what the neighbours that come before it let expect.

Measured on photographs reduced to 128 × 128 samples of 6 bits: 2.6 to 4.3 bits a sample where PNG needs 3.5 to 5.3.
`coder.pyx` begins with what its code is worth.
"""

from libc.math cimport floor, sqrt

from penink_cli.formats._compiled.coder cimport Coder

import numpy as np

FITTED_SAMPLES = 1 << 20  # the most samples of an image that is fitted: each takes up to 2 µs
FITTED_LEVELS = 64  # and the most levels
cdef enum:
    REACH = 6  # samples from the one that is coded to the border of the window in which weights are fitted
    TAKEN = 6  # neighbours whose differences are weighed
    SCALES = 64  # classes of how wrong guesses are
cdef double STIFF = 4.0  # of the ridge that holds weights to those of the plain guess
cdef double SPREAD = 1.08  # of the distribution, in mean errors
cdef double[13] _FADES  # the weight in the fit of a sample so many steps away
for _k in range(13):
    _FADES[_k] = round(0.8**_k, 9)


cdef struct Near:
    int west, north, north_west, north_east, north_north, west_west
    int median  # of west, north and their plane
    int around  # 16 times the value expected by the neighbours and their slopes
    int rough  # how much the neighbours differ
    int parted  # 0: no neighbour is behind an edge, 1: some, 2: west and north, 3: all four next to the sample


cdef inline Near _near(int[:, ::1] values, Py_ssize_t i, Py_ssize_t j, int maxval, int hidden) noexcept nogil:
    """The neighbours of sample (i, j) that come before it; one beyond the frame, or hidden, is made of the others.

    hidden: bits of the neighbours that an edge parts from the sample, as `cuts.mark` has them.
    """
    cdef Near near
    cdef int around = 0
    cdef int weight = 0
    cdef int most, least
    near.west = values[i, j - 1] if j else (values[i - 1, j] if i else maxval)
    near.north = values[i - 1, j] if i else near.west
    near.north_west = values[i - 1, j - 1] if i and j else near.north
    near.north_east = values[i - 1, j + 1] if i and j + 1 < values.shape[1] else near.north
    near.north_north = values[i - 2, j] if i > 1 else near.north
    near.west_west = values[i, j - 2] if j > 1 else near.west
    near.parted = 0
    if i == 0 and hidden & 1:
        hidden |= 2 | 4 | 8 | 32
    elif j == 0 and hidden & 2:
        hidden |= 1 | 4 | 16
    if hidden:
        if not hidden & 1:
            around += 6 * near.west
            weight += 6
        if not hidden & 2:
            around += 6 * near.north
            weight += 6
        if not hidden & 4:
            around += 2 * near.north_west
            weight += 2
        if not hidden & 8:
            around += 3 * near.north_east
            weight += 3
        if weight:
            around = (2 * around + weight) // (2 * weight)
            near.west = around if hidden & 1 else near.west
            near.north = around if hidden & 2 else near.north
            near.north_west = around if hidden & 4 else near.north_west
            near.north_east = around if hidden & 8 else near.north_east
            near.west_west = around if hidden & 16 else near.west_west
            near.north_north = around if hidden & 32 else near.north_north
        near.parted = 3 if weight == 0 else 2 if hidden & 3 == 3 else 1
    most, least = max(near.west, near.north), min(near.west, near.north)
    if near.north_west >= most:
        near.median = least
    elif near.north_west <= least:
        near.median = most
    else:
        near.median = near.west + near.north - near.north_west
    near.around = 6 * (near.west + near.north) + 2 * (near.north_east - near.north_west) + 4 * near.median
    near.around += 2 * (near.west - near.west_west) + 2 * (near.north - near.north_north)
    near.rough = abs(near.west - near.north_west) + abs(near.north - near.north_west)
    near.rough += abs(near.north - near.north_east) + abs(near.west - near.west_west)
    near.rough += abs(near.north - near.north_north)
    return near


cdef inline int _magnitude(int value) noexcept nogil:
    """The class of a size, 0 … 11, finer for small sizes."""
    if value < 6:
        return value
    if value < 9:
        return 6
    if value < 13:
        return 7
    if value < 19:
        return 8
    if value < 28:
        return 9
    return 10 if value < 48 else 11


cdef inline int _sign(int value, int shift) noexcept nogil:
    """The class of a difference, 0 … 4: well below, below, the same, above, well above."""
    value >>= shift
    if value == 0:
        return 2
    if value < 0:
        return 0 if value < -3 else 1
    return 4 if value > 3 else 3


cdef inline int _around(Near near, int guess, int shift) noexcept nogil:
    """The class, 0 … 624, of how four neighbours compare with the guess."""
    cdef int found = _sign(near.west - guess, shift) * 125 + _sign(near.north - guess, shift) * 25
    return found + _sign(near.north_north - guess, shift) * 5 + _sign(near.west_west - guess, shift)


def by_neighbours(Coder coder, int[:, ::1] values, int maxval, unsigned char[:, ::1] cuts=None) -> None:
    """Write samples, or read them, row by row: each as its difference from what its neighbours let expect.

    values: (h, w), written, or read in place. cuts: (h, w) bits of the neighbours that an edge parts from a sample, as
    `cuts.mark` has them: their values tell nothing of it, and the mean of the other neighbours stands in.

    A value read that would leave 0 … maxval is wrapped into it, so that any bytes at all give samples. Reading stops
    where the bytes overrun: a few bytes may announce millions of samples.
    """
    cdef Py_ssize_t i, j
    cdef Py_ssize_t h = values.shape[0]
    cdef Py_ssize_t w = values.shape[1]
    cdef int guess, level, rough, before, value
    cdef Near near
    cdef int[:, ::1] errors = np.zeros((2, w + 2), np.int32)  # absolute, of this row and the last
    cdef int *context = &coder.context[0]
    cdef int shift = 0
    while (maxval >> shift) > 63:
        shift += 1
    for i in range(h):
        for j in range(w):
            if coder.exhausted():
                return
            near = _near(values, i, j, maxval, cuts[i, j] if cuts is not None else 0)
            guess = max(0, min(maxval, (near.around + 8) >> 4))
            rough = near.rough >> shift
            before = _magnitude((errors[(i + 1) & 1, j + 1] + errors[i & 1, j] + errors[(i + 1) & 1, j + 2]) >> shift)
            level = _magnitude(rough)
            context[0] = level * 12 + before + 144 * near.parted
            context[1] = ((near.west >> shift) * 64 + (near.north >> shift)) & 4095
            context[2] = (guess >> shift) * 12 + before
            context[3] = _sign(near.median - guess, shift) * 60 + _sign(near.north_east - guess, shift) * 12
            context[3] += level + 300 * near.parted
            context[4] = _around(near, guess, shift)
            context[5] = before + 12 * near.parted
            value = guess + <int>coder.whole(0 if rough else 1, values[i, j] - guess)
            if coder.reading:
                value = value % (maxval + 1)
                values[i, j] = value if value >= 0 else value + maxval + 1
            errors[i & 1, j + 1] = abs(values[i, j] - guess)
        errors[i & 1, 0] = errors[i & 1, 1]
        errors[i & 1, w + 1] = errors[i & 1, w]


cdef struct Guess:  # Student's distribution with four degrees of freedom
    double middle  # levels
    double spread  # levels


cdef inline double _below(double x, Guess guess) noexcept nogil:
    """The part of the distribution that lies below x."""
    cdef double t = (x - guess.middle) / guess.spread
    t = t / sqrt(1 + t * t / 4)
    return 0.5 + 0.375 * t * (1 - t * t / 12)


cdef inline double _between(int low, int high, Guess guess) noexcept nogil:
    """The probability of the levels from low to high; never 0."""
    return max(1e-6, _below(high + 0.5, guess) - _below(low - 0.5, guess))


cdef inline double _share(int a, int b, int low, int high, Guess guess) noexcept nogil:
    """The probability of the levels a … b, given that it is one of low … high."""
    return _between(a, b, guess) / _between(low, high, guess)


cdef inline double _share_of_two(int a, int b, int c, int d, Guess guess) noexcept nogil:
    """The probability of the levels a … b, given that it is one of these or of c … d."""
    cdef double one = _between(a, b, guess)
    return one / (one + _between(c, d, guess))


cdef inline double _stops(int guess, int off, int most, bint below, Guess by) noexcept nogil:
    """The probability that a level is ``off`` from the guess, given that it is at least so far off on that side."""
    if below:
        return _share(guess - off, guess - off, 0, guess - off, by)
    return _share(guess + off, guess + off, guess + off, guess + most, by)


cdef double _correction(
    double[:, :, ::1] around, Py_ssize_t i, Py_ssize_t j, Py_ssize_t rows, double[:, ::1] matrix
) noexcept nogil:
    """What is added to the plain guess of sample (i, j): its neighbours by the weights that fit best within REACH.

    around: (rows, w, TAKEN + 1) of each sample the differences of its neighbours, and the error of its plain guess;
    row i of the image is row i % rows. matrix: (TAKEN, TAKEN + 1) room for the normal equations.
    """
    cdef Py_ssize_t up, column, first, last, row
    cdef int a, b, c
    cdef double part, found
    cdef double *known
    for a in range(TAKEN):
        for b in range(a, TAKEN + 1):
            matrix[a, b] = STIFF if a == b else 0.0
    for up in range(min(i, REACH) + 1):
        row = (i - up) % rows
        first = max(0, j - REACH)
        last = min(around.shape[1] - 1, j + REACH) if up else j - 1
        for column in range(first, last + 1):
            known = &around[row, column, 0]
            part = _FADES[up + (column - j if column > j else j - column)]
            for a in range(TAKEN):
                found = part * known[a]
                for b in range(a, TAKEN + 1):
                    matrix[a, b] += found * known[b]
    for a in range(TAKEN):
        for b in range(a + 1, TAKEN):
            matrix[b, a] = matrix[a, b]
    for a in range(TAKEN):
        for b in range(a + 1, TAKEN):
            part = matrix[b, a] / matrix[a, a]
            for c in range(a, TAKEN + 1):
                matrix[b, c] -= part * matrix[a, c]
    known = &around[i % rows, j, 0]
    found = 0.0
    for a in range(TAKEN - 1, -1, -1):
        for b in range(a + 1, TAKEN):
            matrix[a, TAKEN] -= matrix[a, b] * matrix[b, TAKEN]
        matrix[a, TAKEN] /= matrix[a, a]
        found += matrix[a, TAKEN] * known[a]
    return found


cdef double _energy(double[:, ::1] wrong, Py_ssize_t i, Py_ssize_t j, Py_ssize_t rows, Py_ssize_t w) noexcept nogil:
    """How wrong the guesses were around sample (i, j), levels. wrong: (rows, w + 4), two columns of margin a side."""
    cdef Py_ssize_t up
    cdef double energy = wrong[i % rows, j + 1] + 0.4 * wrong[i % rows, j]
    cdef double seen = (1.0 if j else 0.0) + (0.4 if j > 1 else 0.0)
    if i:
        up = (i - 1) % rows
        energy += wrong[up, j + 2] + 0.6 * wrong[up, j + 1] + 0.7 * wrong[up, j + 3] + 0.3 * wrong[up, j + 4]
        energy += 0.3 * wrong[up, j]
        seen += 1.0 + (0.6 if j else 0.0) + (0.7 if j + 1 < w else 0.0) + (0.3 if j + 2 < w else 0.0)
        seen += 0.3 if j > 1 else 0.0
    if i > 1:
        energy += 0.4 * wrong[(i - 2) % rows, j + 2]
        seen += 0.4
    return energy / seen if seen > 0 else 1.5


cdef inline void _set_contexts(Coder coder, Near near, int guess, int maxval, int before):
    """Set the contexts of the decisions on one sample. before: the sum of its neighbours' errors."""
    cdef int *context = &coder.context[0]
    before = _magnitude(before)
    context[0] = _magnitude(near.rough) * 12 + before + 144 * near.parted
    context[1] = guess * 12 + before
    context[2] = _around(near, guess, 0)
    context[3] = 64 * (1 if guess == 0 else 2 if guess == maxval else 0)
    context[3] += (near.west == guess) + 2 * (near.north == guess) + 4 * (near.north_west == guess)
    context[3] += 8 * (near.north_east == guess) + 16 * (near.west_west == guess) + 32 * (near.north_north == guess)


cdef int _level(Coder coder, int value, int guess, int maxval, int mixer, Guess fit, Guess plain):
    """Write the level of one sample, or read and return it: whether it is the guess, on which side, how far off.

    fit, plain: the two distributions that say how likely each level is.
    """
    cdef bint below
    cdef int most
    cdef int off = value - guess
    if coder.told(0, mixer, off == 0, _share(guess, guess, 0, maxval, fit), _share(guess, guess, 0, maxval, plain)):
        return guess
    below = guess > 0
    if below and guess < maxval:
        below = coder.told(
            1, mixer, off < 0,
            _share_of_two(0, guess - 1, guess + 1, maxval, fit), _share_of_two(0, guess - 1, guess + 1, maxval, plain),
        )
    most = guess if below else maxval - guess
    off = abs(off)
    value = 1
    while value < most and not coder.told(
        1 + min(value, 40), mixer, off == value,
        _stops(guess, value, most, below, fit), _stops(guess, value, most, below, plain),
    ):
        value += 1
    return guess - value if below else guess + value


def fitted(Coder coder, int[:, ::1] values, int maxval, unsigned char[:, ::1] cuts) -> None:
    """Write samples of few levels, or read them, row by row: each by weights fitted to the samples around it.

    A sample is guessed from its neighbours by the weights that would have guessed the samples within REACH best, by
    least squares. How wrong the guesses nearby were says how likely each level is (Student's distribution with four
    degrees of freedom, which has a closed form). This guess, the plain one and four contexts are mixed. All of it is
    sums, products, quotients and square roots of doubles in a fixed order.

    values: (h, w), at most FITTED_SAMPLES of them, written, or read in place. maxval: below FITTED_LEVELS.
    cuts: as of `by_neighbours`. Reading stops where the bytes overrun.
    """
    cdef Py_ssize_t i, j, here
    cdef Near near
    cdef int k, level, guess, value, before
    cdef double middle, plain, fit, energy
    cdef Guess by_fit, by_plain
    cdef Py_ssize_t h = values.shape[0]
    cdef Py_ssize_t w = values.shape[1]
    cdef Py_ssize_t rows = min(h, REACH + 1)
    cdef double[:, :, ::1] around_all = np.zeros((rows, w, TAKEN + 1))  # see `_correction`
    cdef double[:, ::1] wrong = np.zeros((rows, w + 4))  # two columns of margin
    cdef int[:, ::1] errors = np.zeros((2, w + 2), np.int32)
    cdef double[:, ::1] matrix = np.zeros((TAKEN, TAKEN + 1))
    cdef double[:, ::1] scales = np.empty((2, SCALES))
    cdef double[::1] counts = np.full(SCALES, 2.0)
    for k in range(SCALES):
        scales[0, k] = scales[1, k] = 2 * (0.4 + 0.12 * k)
    coder.expect_told()
    for i in range(h):
        here = i % rows
        for j in range(w):
            if coder.exhausted():
                return
            near = _near(values, i, j, maxval, cuts[i, j])
            plain = near.around / 16.0
            middle = (near.west + near.north) / 2.0
            around_all[here, j, 0] = near.west - middle
            around_all[here, j, 1] = near.north_west - middle
            around_all[here, j, 2] = near.north_east - middle
            around_all[here, j, 3] = near.west_west - middle
            around_all[here, j, 4] = near.north_north - middle
            around_all[here, j, 5] = near.median - middle
            fit = plain
            if near.rough or near.median != near.west:  # neighbours that are all equal correct nothing
                fit += _correction(around_all, i, j, rows, matrix)
            plain = min(max(plain, 0.0), <double>maxval)
            fit = min(max(fit, 0.0), <double>maxval)
            energy = _energy(wrong, i, j, rows, w)
            level = min(SCALES - 1, <int>(6 * sqrt(energy + 0.12 * near.rough)))
            by_fit = Guess(fit, max(0.06, SPREAD * scales[0, level] / counts[level]))
            by_plain = Guess(plain, max(0.06, SPREAD * scales[1, level] / counts[level]))
            guess = <int>floor(fit + 0.5)
            before = errors[(i + 1) & 1, j + 1] + errors[i & 1, j] + errors[(i + 1) & 1, j + 2]
            _set_contexts(coder, near, guess, maxval, before)
            k = 0 if level < 8 else 1 if level < 14 else 2 if level < 20 else 3
            value = _level(coder, values[i, j], guess, maxval, k, by_fit, by_plain)
            values[i, j] = value
            around_all[here, j, TAKEN] = value - near.around / 16.0
            wrong[here, j + 2] = abs(value - fit)
            scales[0, level] += abs(value - fit)
            scales[1, level] += abs(value - plain)
            counts[level] += 1
            errors[i & 1, j + 1] = abs(value - guess)
        errors[i & 1, 0] = errors[i & 1, 1]
        errors[i & 1, w + 1] = errors[i & 1, w]
