# cython: boundscheck=False, wraparound=False, cdivision=True
"""The adaptive binary coder behind the compact samples, edges and texts of a packed illustration.

A range coder (Martin 1979, carry and all, with 32 bits of range) driven by probabilities that
several contexts estimate and a small network mixes in the logistic domain (Mahoney's "lightweight
PAQ"). All of it is integer arithmetic: the same numbers give the same bytes on any machine, which a
general compressor's library promises from no version to the next. Measured on photographs reduced to
128 × 128 samples of 6 bits: 2.6 to 4.3 bits a sample where PNG needs 3.5 to 5.3.

What it is worth (`python -m tests.benchmarks.worth coder`, three photographs reduced 4 times, 8 bits): samples take .88
to .93 of PNG and .86 to .89 of xz, edges .75 to .79 of their steps deflated and .80 to .87 of xz, strengths included.

One `Coder` both writes and reads. Each method takes the value to write and returns it, or
takes anything and returns the value read, so that writer and reader cannot disagree on the model.
"""

from libc.math cimport floor, sqrt

import numpy as np

INPUTS = 6  # contexts mixed for each binary decision
NODES = 64  # binary decisions that one number can take
TABLE = 1 << 18  # estimates for each input
SLOPE = 20  # mixing weights learn at this rate
LIMIT = 90  # an estimate moves by at least 1 / (LIMIT + 1.6) of its error
END = 0b01010101
OVERRUN = 4  # bytes that may be read beyond the end: zeros that `finish` leaves out

FITTED_SAMPLES = 1 << 20  # of an image that is fitted: each takes up to 3 µs
FITTED_LEVELS = 64
cdef enum:
    REACH = 6  # samples, of the window that weights are fitted in
    TAKEN = 6  # neighbours whose differences are weighed
    TOLD = 4  # contexts beside the probabilities that are told
    SCALES = 64  # classes of how wrong guesses are
    FIRST = 9830  # 0.15: the mixing weight of a context at first
    FIRST_TOLD = 19661  # 0.3: and of a probability
    TOLD_SLOPE = 60
cdef double STIFF = 4.0  # holds weights to those of the plain guess
cdef double SPREAD = 1.08  # of the distribution, in mean errors
cdef double[13] _FADES  # what a sample so many steps away counts for
for _k in range(13):
    _FADES[_k] = round(0.8**_k, 9)

_KNEES = (
    1, 2, 3, 6, 10, 16, 27, 45, 73, 120, 194, 310, 488, 747, 1101, 1546, 2047,
    2549, 2994, 3348, 3607, 3785, 3901, 3975, 4022, 4050, 4068, 4079, 4085, 4089, 4092, 4093, 4094,
)  # fmt: skip


def _squash_table() -> np.ndarray:
    """4096 / (1 + exp(-x / 256)) for x = -2047 … 2047, piecewise linear between whole numbers."""
    x = np.arange(-2047, 2048)
    knees = np.array([*_KNEES, 4095])
    at, part = (x >> 7) + 16, x & 127
    return ((knees[at] * (128 - part) + knees[at + 1] * part + 64) >> 7).astype(np.int32)


def _stretch_table(squash: np.ndarray) -> np.ndarray:
    """The inverse: the least x whose squash reaches p, for p = 0 … 4095."""
    return (np.searchsorted(squash, np.arange(4096)).clip(0, 4094) - 2047).astype(np.int32)


_SQUASH = _squash_table()
_STRETCH = _stretch_table(_SQUASH)
_RATE = (65536 * 10 // (np.arange(256) * 10 + 16)).astype(np.int32)


cdef inline double _below(double x, double middle, double spread) noexcept nogil:
    """The part of a Student's distribution with four degrees of freedom that lies below x."""
    cdef double t = (x - middle) / spread
    t = t / sqrt(1 + t * t / 4)
    return 0.5 + 0.375 * t * (1 - t * t / 12)


cdef inline double _between(int low, int high, double middle, double spread) noexcept nogil:
    """The part that falls to whole numbers from low to high."""
    return max(1e-6, _below(high + 0.5, middle, spread) - _below(low - 0.5, middle, spread))


cdef inline double _share(int a, int b, int c, int d, double middle, double spread) noexcept nogil:
    """What falls to a … b of what falls to that and to c … d."""
    cdef double one = _between(a, b, middle, spread)
    return one / (one + _between(c, d, middle, spread))


cdef inline double _stops(int guess, int off, int most, bint below, double middle, double spread) noexcept nogil:
    """How likely a number that is at least so far off on that side is just that."""
    if below:
        return _between(guess - off, guess - off, middle, spread) / _between(0, guess - off, middle, spread)
    return _between(guess + off, guess + off, middle, spread) / _between(guess + off, guess + most, middle, spread)


cdef struct Near:
    int west, north, north_west, north_east, north_north, west_west
    int median  # of west, north and their plane
    int parted  # 0: no neighbour is behind an edge, 1: some, 2: west and north, 3: all that count


cdef inline Near _near(int[:, ::1] values, Py_ssize_t i, Py_ssize_t j, int maxval, int hidden) noexcept nogil:
    """The neighbours of sample (i, j) that come before it; those that are not there, or hidden, as the others have it.

    hidden: bits of those that an edge parts it from, as `cuts.mark` has them.
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
    return near


cdef class Coder:
    """Writes numbers into bytes, or reads them back.

    data: None to write (then `finish` gives the bytes), or the bytes to read.
    """

    cdef int[:, ::1] _p
    cdef unsigned char[:, ::1] _n
    cdef int[:, ::1] _weights
    cdef int[::1] _squash
    cdef int[::1] _stretch
    cdef int[::1] _rate
    cdef int[::1] _context
    cdef int[::1] _index
    cdef int[::1] _input
    cdef bytearray _bytes
    cdef unsigned char[::1] _data
    cdef bint _reading
    cdef Py_ssize_t _at
    cdef Py_ssize_t _size
    cdef unsigned long long _low
    cdef unsigned int _range
    cdef unsigned int _code
    cdef int _cache
    cdef Py_ssize_t _pending

    def __init__(self, data: bytes | None = None):
        self._p = np.full((INPUTS, TABLE), 32768, np.int32)
        self._n = np.zeros((INPUTS, TABLE), np.uint8)
        self._weights = np.full((4 * NODES, INPUTS), 65536 * 3 // 10, np.int32)
        self._squash, self._stretch, self._rate = _SQUASH.copy(), _STRETCH.copy(), _RATE.copy()
        self._context = np.zeros(INPUTS, np.int32)
        self._index = np.zeros(INPUTS, np.int32)
        self._input = np.zeros(INPUTS, np.int32)
        self._bytes = bytearray()
        self._reading = data is not None
        self._data = np.frombuffer(bytearray(data) if data else bytearray(1), np.uint8)
        self._size = len(data) if data else 0
        self._at = 0
        self._low, self._range, self._code = 0, 0xFFFFFFFF, 0
        self._cache, self._pending = -1, 0
        if self._reading:
            for _ in range(4):
                self._code = (self._code << 8) | self._next()

    @property
    def overrun(self) -> bool:
        """Whether more bytes were asked for than there are: the data is truncated."""
        return self._exhausted()

    @property
    def rest(self) -> int:
        """Bytes that were not needed: the data goes on after its end."""
        return max(0, self._size - self._at)

    def end(self) -> bool:
        """Write a mark after the last number, or say whether it is there: data cut short reads as ones for ever."""
        cdef int k
        cdef int found = 0
        for k in range(8):
            found = found * 2 + self._code_bit((END >> (7 - k)) & 1, 2048)
        return found == END

    cdef inline bint _exhausted(self):
        return self._at > self._size + OVERRUN

    cdef inline unsigned int _next(self):
        cdef unsigned int byte = 0
        if self._at < self._size:
            byte = self._data[self._at]
        self._at += 1
        return byte

    cdef void _shift(self):
        """Hand on the top byte of low; a run of 255s waits until it is known whether a carry comes."""
        cdef int carry = <int>(self._low >> 32)
        if self._low < 0xFF000000 or carry:
            if self._cache >= 0:
                self._bytes.append((self._cache + carry) & 255)
            while self._pending:
                self._bytes.append((255 + carry) & 255)
                self._pending -= 1
            self._cache = <int>((self._low >> 24) & 255)
        else:
            self._pending += 1
        self._low = (self._low & 0x00FFFFFF) << 8

    cdef int _code_bit(self, int bit, int p):
        """One bit that is 1 with probability p / 4096."""
        cdef unsigned int bound = (self._range >> 12) * <unsigned int>p
        if self._reading:
            bit = 1 if self._code < bound else 0
            if not bit:
                self._code -= bound
        elif not bit:
            self._low += bound
        self._range = bound if bit else self._range - bound
        while self._range < 0x01000000:
            self._range <<= 8
            if self._reading:
                self._code = (self._code << 8) | self._next()
            else:
                self._shift()
        return bit

    cdef int _bit(self, int node, int mixer, int bit):
        """One decision of a number, mixed from the estimates of every context."""
        cdef int k, index, p, error
        cdef long long step, dot = 0
        cdef int row = (mixer * NODES + node) % (4 * NODES)
        for k in range(INPUTS):
            index = (self._context[k] * NODES + node) & (TABLE - 1)
            self._index[k] = index
            self._input[k] = self._stretch[self._p[k, index] >> 4]
            dot += <long long>self._weights[row, k] * self._input[k]
        dot >>= 16
        dot = max(-2047, min(2047, dot))
        p = self._squash[dot + 2047]
        bit = self._code_bit(bit, p)
        error = ((bit << 12) - p) * SLOPE
        for k in range(INPUTS):
            self._weights[row, k] += (self._input[k] * error + 0x8000) >> 16
            index = self._index[k]
            p = self._p[k, index]
            # A product of 16 and 16 bits, signed: it needs 33.
            step = (65535 if bit else 0) - p
            self._p[k, index] = p + <int>((step * self._rate[self._n[k, index]]) >> 16)
            if self._n[k, index] < LIMIT:
                self._n[k, index] += 1
        return bit

    cdef long long _number(self, int mixer, long long value):
        """A signed number in the contexts set: zero, sign, size in unary up to 12, then Elias gamma."""
        cdef long long size, rest
        cdef int negative, k, length
        if self._bit(0, mixer, value == 0):
            return 0
        negative = self._bit(1, mixer, value < 0)
        size = (-value if negative else value) - 1
        for k in range(12):
            if self._bit(2 + k, mixer, size == k):
                return -(k + 1) if negative else k + 1
        rest = size - 11
        length = 0
        while length < 40 and not self._bit(14 + min(length, 15), mixer, (rest >> (length + 1)) == 0):
            length += 1
        value = 1
        for k in range(length - 1, -1, -1):
            if k >= length - 2:
                value = value * 2 + self._bit(30 + 2 * min(length, 15) + (length - 1 - k), mixer, (rest >> k) & 1)
            else:
                value = value * 2 + self._code_bit((rest >> k) & 1, 2048)
        size = value + 11
        return -(size + 1) if negative else size + 1

    def number(self, long long value, int kind, int a=0, int b=0) -> int:
        """One whole number of up to 40 bits.

        kind: what it is (0 … 15), so that each kind has its own statistics; a, b: contexts of
        0 … 255 that it is likely to depend on.
        """
        cdef int c = (kind & 15) << 8
        self._context[0] = c
        self._context[1] = c | (a & 255)
        self._context[2] = c | (b & 255)
        self._context[3] = c | ((a * 7 + b * 31 + 11) & 255)
        self._context[4] = c
        self._context[5] = c | (a & 255)
        return self._number(kind & 3, value)

    def number_in(self, long long value, int kind, int a, int b, int c) -> int:
        """One whole number of up to 40 bits, in three contexts of 0 … 255 and pairs of them; else as `number`."""
        cdef int base = (kind & 15) << 8
        self._context[0] = base
        self._context[1] = base | (a & 255)
        self._context[2] = base | (b & 255)
        self._context[3] = base | (c & 255)
        self._context[4] = (base + (a & 255) * 521 + (b & 255) * 37 + 1) & 4095
        self._context[5] = (base + (a & 255) * 521 + (c & 255) * 61 + 2) & 4095
        return self._number(kind & 3, value)

    def samples(self, int[:, ::1] values, int maxval, unsigned char[:, ::1] cuts=None) -> None:
        """Samples row by row, each as its difference from what its neighbours let expect.

        cuts: (h, w) bits of the neighbours that an edge parts a sample from, as `cuts.mark` has them: their
        values tell nothing, and are taken to be what those that are left have on the whole.
        values: (h, w), written from or read into. A number read that would leave 0 … maxval is
        wrapped into it, so that any bytes at all give samples. Reading stops where the bytes
        overrun: a few of them may announce millions of samples.
        """
        cdef Py_ssize_t i, j
        cdef Py_ssize_t h = values.shape[0]
        cdef Py_ssize_t w = values.shape[1]
        cdef int shift = 0
        while (maxval >> shift) > 63:
            shift += 1
        cdef int north, west, north_west, north_east, north_north, west_west, guess, median, level, rough, before, value
        cdef int around, count
        cdef Near near
        cdef int[:, ::1] errors = np.zeros((2, w + 2), np.int32)  # absolute, of this row and the last
        for i in range(h):
            for j in range(w):
                if self._exhausted():
                    return
                near = _near(values, i, j, maxval, cuts[i, j] if cuts is not None else 0)
                west, north, north_west = near.west, near.north, near.north_west
                north_east, north_north, west_west = near.north_east, near.north_north, near.west_west
                median, count = near.median, near.parted
                # The mean of what slopes and neighbours say.
                around = 6 * (west + north) + 2 * (north_east - north_west)
                around += 2 * (west - west_west) + 2 * (north - north_north)
                guess = (around + 4 * median + 8) >> 4
                guess = max(0, min(maxval, guess))
                rough = abs(west - north_west) + abs(north - north_west) + abs(north - north_east)
                rough = (rough + abs(west - west_west) + abs(north - north_north)) >> shift
                before = (errors[(i + 1) & 1, j + 1] + errors[i & 1, j] + errors[(i + 1) & 1, j + 2]) >> shift
                level = self._magnitude(rough)
                self._context[0] = level * 12 + self._magnitude(before)
                self._context[1] = ((west >> shift) * 64 + (north >> shift)) & 4095
                self._context[2] = (guess >> shift) * 12 + self._magnitude(before)
                self._context[3] = self._sign(median - guess, shift) * 60 + self._sign(north_east - guess, shift) * 12
                self._context[3] += level
                self._context[4] = self._sign(west - guess, shift) * 125 + self._sign(north - guess, shift) * 25
                self._context[4] += self._sign(north_north - guess, shift) * 5 + self._sign(west_west - guess, shift)
                self._context[5] = self._magnitude(before)
                if count:
                    self._context[0] += 144 * count
                    self._context[3] += 300 * count
                    self._context[5] += 12 * count
                value = guess + <int>self._number(0 if rough else 1, values[i, j] - guess)
                if self._reading:
                    value = value % (maxval + 1)
                    values[i, j] = value if value >= 0 else value + maxval + 1
                errors[i & 1, j + 1] = abs(values[i, j] - guess)
            errors[i & 1, 0] = errors[i & 1, 1]
            errors[i & 1, w + 1] = errors[i & 1, w]

    def fitted(self, int[:, ::1] values, int maxval, unsigned char[:, ::1] cuts) -> None:
        """Samples of few levels, row by row, by what fitted the samples around each.

        The neighbours of a sample are weighed as would have served those within REACH of it best, by least squares; how
        wrong that was nearby says how far the next is likely to be from it, and so how likely each level is (Student's
        distribution with four degrees of freedom, which has a closed form). Two such guesses and four contexts are
        mixed. All of it is sums, products, quotients and square roots of doubles in a fixed order.

        values: (h, w), at most FITTED_SAMPLES of them, written from or read into. maxval: below FITTED_LEVELS.
        cuts: as of `samples`. Reading stops where the bytes overrun.
        """
        cdef Py_ssize_t i, j, here
        cdef Near near
        cdef int k, count, around, north, west, north_west, north_east, north_north, west_west
        cdef int median, rough, before, level, guess, value, off, most
        cdef bint below
        cdef double middle, plain, fit, energy, seen, one, other
        cdef Py_ssize_t h = values.shape[0]
        cdef Py_ssize_t w = values.shape[1]
        cdef Py_ssize_t rows = min(h, REACH + 1)
        cdef double[:, :, ::1] around_all = np.zeros((rows, w, TAKEN + 1))  # what was known of each, what it was
        cdef double[:, ::1] wrong = np.zeros((rows, w + 4))  # two columns of margin
        cdef int[:, ::1] errors = np.zeros((2, w + 2), np.int32)
        cdef double[:, ::1] matrix = np.zeros((TAKEN, TAKEN + 1))
        cdef double[:, ::1] scales = np.empty((2, SCALES))
        cdef double[::1] counts = np.full(SCALES, 2.0)
        for k in range(SCALES):
            scales[0, k] = scales[1, k] = 2 * (0.4 + 0.12 * k)
        for k in range(4 * NODES):
            for here in range(INPUTS):
                self._weights[k, here] = FIRST_TOLD if here >= TOLD else FIRST
        for i in range(h):
            here = i % rows
            for j in range(w):
                if self._exhausted():
                    return
                near = _near(values, i, j, maxval, cuts[i, j])
                west, north, north_west = near.west, near.north, near.north_west
                north_east, north_north, west_west = near.north_east, near.north_north, near.west_west
                median, count = near.median, near.parted
                around = 6 * (west + north) + 2 * (north_east - north_west)
                around += 2 * (west - west_west) + 2 * (north - north_north) + 4 * median
                plain = around / 16.0
                middle = (west + north) / 2.0
                around_all[here, j, 0] = west - middle
                around_all[here, j, 1] = north_west - middle
                around_all[here, j, 2] = north_east - middle
                around_all[here, j, 3] = west_west - middle
                around_all[here, j, 4] = north_north - middle
                around_all[here, j, 5] = median - middle
                rough = abs(west - north_west) + abs(north - north_west) + abs(north - north_east)
                rough += abs(west - west_west) + abs(north - north_north)
                fit = plain
                if rough or median != west:  # else whatever they weigh, they say the same
                    fit += self._correction(around_all, i, j, rows, matrix)
                plain = min(max(plain, 0.0), <double>maxval)
                fit = min(max(fit, 0.0), <double>maxval)
                energy = wrong[here, j + 1] + 0.4 * wrong[here, j]
                seen = (1.0 if j else 0.0) + (0.4 if j > 1 else 0.0)
                if i:
                    k = <int>((i - 1) % rows)
                    energy += wrong[k, j + 2] + 0.6 * wrong[k, j + 1] + 0.7 * wrong[k, j + 3] + 0.3 * wrong[k, j + 4]
                    energy += 0.3 * wrong[k, j]
                    seen += 1.0 + (0.6 if j else 0.0) + (0.7 if j + 1 < w else 0.0) + (0.3 if j + 2 < w else 0.0)
                    seen += 0.3 if j > 1 else 0.0
                if i > 1:
                    energy += 0.4 * wrong[(i - 2) % rows, j + 2]
                    seen += 0.4
                energy = energy / seen if seen > 0 else 1.5
                level = min(SCALES - 1, <int>(6 * sqrt(energy + 0.12 * rough)))
                one = max(0.06, SPREAD * scales[0, level] / counts[level])
                other = max(0.06, SPREAD * scales[1, level] / counts[level])
                guess = <int>floor(fit + 0.5)
                before = errors[(i + 1) & 1, j + 1] + errors[i & 1, j] + errors[(i + 1) & 1, j + 2]
                self._context[0] = self._magnitude(rough) * 12 + self._magnitude(before) + 144 * count
                self._context[1] = guess * 12 + self._magnitude(before)
                self._context[2] = self._sign(west - guess, 0) * 125 + self._sign(north - guess, 0) * 25
                self._context[2] += self._sign(north_north - guess, 0) * 5 + self._sign(west_west - guess, 0)
                self._context[3] = 64 * (1 if guess == 0 else 2 if guess == maxval else 0)
                self._context[3] += (west == guess) + 2 * (north == guess) + 4 * (north_west == guess)
                self._context[3] += 8 * (north_east == guess) + 16 * (west_west == guess) + 32 * (north_north == guess)
                k = 0 if level < 8 else 1 if level < 14 else 2 if level < 20 else 3
                off = values[i, j] - guess
                value = guess
                if not self._told(
                    0, k, off == 0,
                    _between(guess, guess, fit, one) / _between(0, maxval, fit, one),
                    _between(guess, guess, plain, other) / _between(0, maxval, plain, other),
                ):
                    below = guess > 0
                    if below and guess < maxval:
                        below = self._told(
                            1, k, off < 0,
                            _share(0, guess - 1, guess + 1, maxval, fit, one),
                            _share(0, guess - 1, guess + 1, maxval, plain, other),
                        )
                    most = guess if below else maxval - guess
                    off = abs(off)
                    value = 1
                    while value < most and not self._told(
                        1 + min(value, 40), k, off == value,
                        _stops(guess, value, most, below, fit, one), _stops(guess, value, most, below, plain, other),
                    ):
                        value += 1
                    value = guess - value if below else guess + value
                values[i, j] = value
                around_all[here, j, TAKEN] = value - (around / 16.0)
                wrong[here, j + 2] = abs(value - fit)
                scales[0, level] += abs(value - fit)
                scales[1, level] += abs(value - plain)
                counts[level] += 1
                errors[i & 1, j + 1] = abs(value - guess)
            errors[i & 1, 0] = errors[i & 1, 1]
            errors[i & 1, w + 1] = errors[i & 1, w]

    cdef double _correction(
        self, double[:, :, ::1] around, Py_ssize_t i, Py_ssize_t j, Py_ssize_t rows, double[:, ::1] matrix
    ):
        """What the weights that served the samples within REACH best add to the plain guess of the sample at i, j."""
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
                part = _FADES[up + abs(column - j)]
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

    cdef int _told(self, int node, int mixer, int bit, double one, double other):
        """One decision, mixed from the estimates of TOLD contexts and two probabilities that it is 1."""
        cdef int k, index, p, error
        cdef long long step, dot = 0
        cdef int row = mixer * NODES + node
        for k in range(TOLD):
            index = (self._context[k] * NODES + node) & (TABLE - 1)
            self._index[k] = index
            self._input[k] = self._stretch[self._p[k, index] >> 4]
        self._input[TOLD] = self._stretch[max(4, min(4091, <int>(4096 * one)))]
        self._input[TOLD + 1] = self._stretch[max(4, min(4091, <int>(4096 * other)))]
        for k in range(INPUTS):
            dot += <long long>self._weights[row, k] * self._input[k]
        dot >>= 16
        dot = max(-2047, min(2047, dot))
        p = self._squash[dot + 2047]
        bit = self._code_bit(bit, p)
        error = ((bit << 12) - p) * TOLD_SLOPE
        for k in range(INPUTS):
            self._weights[row, k] += (self._input[k] * error + 0x8000) >> 16
        for k in range(TOLD):
            index = self._index[k]
            p = self._p[k, index]
            step = (65535 if bit else 0) - p
            self._p[k, index] = p + <int>((step * self._rate[self._n[k, index]]) >> 16)
            if self._n[k, index] < LIMIT:
                self._n[k, index] += 1
        return bit

    cdef inline int _magnitude(self, int value):
        """0 … 11, finer for small numbers."""
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

    cdef inline int _sign(self, int value, int shift):
        """0 … 4: well below, below, the same, above, well above."""
        value >>= shift
        if value == 0:
            return 2
        if value < 0:
            return 0 if value < -3 else 1
        return 4 if value > 3 else 3

    def text(self, unsigned char[::1] values) -> None:
        """Bytes of text, each predicted from the three before it; written from or read into values (n,).

        Reading stops where the bytes overrun, as in `samples`.
        """
        cdef Py_ssize_t i
        cdef int half, k, node, byte, bits
        cdef Py_ssize_t n = values.shape[0]
        cdef int one = 0, two = 0, three = 0
        for i in range(n):
            if self._exhausted():
                return
            byte = values[i]
            bits = 0
            for half in range(2):  # 15 decisions for each half of a byte, so that NODES suffice
                self._context[0] = bits + half * 16
                self._context[1] = one * 32 + bits + half * 16
                self._context[2] = (one * 1031 + two * 337 + bits * 7 + half) & 4095
                self._context[3] = (one * 1031 + two * 337 + three * 2131 + bits * 7 + half) & 4095
                self._context[4] = (two * 337 + three * 2131 + bits * 7 + half) & 4095
                self._context[5] = (one * 523 + three * 2131 + bits * 7 + half) & 4095
                node = 1
                for k in range(4):
                    node = node * 2 + self._bit(node, half, (byte >> (7 - 4 * half - k)) & 1)
                bits = node & 15 if half == 0 else bits * 16 + (node & 15)
            values[i] = bits
            three = two
            two = one
            one = bits

    def finish(self) -> bytes:
        """The bytes written, end mark included: the roundest number within the last range.

        Trailing zeros are left out: the reader supplies them.
        """
        self.end()
        cdef unsigned long long last = self._low + self._range - 1
        cdef unsigned long long mask = 0xFFFFFFFF
        while (last & ~mask) < self._low:
            mask >>= 1
        self._low = last & ~mask
        for _ in range(4):
            self._shift()
        if self._cache >= 0:
            self._bytes.append(self._cache)
        self._bytes.extend([255] * self._pending)
        size = len(self._bytes)
        return bytes(self._bytes[: size - 4]) + bytes(self._bytes[size - 4 :]).rstrip(b"\0")
