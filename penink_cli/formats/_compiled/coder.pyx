# cython: boundscheck=False, wraparound=False, cdivision=True
"""The adaptive binary coder behind all that a packed illustration holds: numbers and texts; samples by `samples.pyx`.

A range coder (Martin 1979, with carries and 32 bits of range) driven by probabilities that several contexts estimate
and a small network mixes in the logistic domain (Mahoney's "lightweight PAQ"). All of it is integer arithmetic: the
same numbers give the same bytes on any machine. The library of a general compressor does not promise that from one
version to the next.

What it is worth (`python -m tests.benchmarks.worth coder`, three photographs reduced 4 times, 8 bits): samples take .88
to .93 of PNG and .86 to .89 of xz, edges .69 to .72 of their steps deflated and .73 to .80 of xz, strengths included.

One `Coder` both writes and reads. Each method takes the value to write and returns it, or
takes anything and returns the value read, so that writer and reader cannot disagree on the model.
"""

import numpy as np

cdef enum:
    TABLE = 1 << 18  # estimates for each input
    MIXERS = 4  # sets of mixing weights for each decision
    SLOPE = 20  # mixing weights learn at this rate
    TOLD_SLOPE = 60  # the rate where two probabilities are told (see `told`)
    FIRST = 19660  # 0.3 of 65536: each mixing weight at first
    FIRST_TOLD = 19661  # where probabilities are told, the first weight of each of them
    FIRST_BESIDE = 9830  # and 0.15, the first weight of a context beside them
    LIMIT = 90  # an estimate moves by at least 1 / (LIMIT + 1.6) of its error
    END = 0b01010101  # the end mark
    OVERRUN = 4  # bytes that may be read beyond the end: `finish` leaves out zeros there

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


cdef class Coder:
    """Writes numbers into bytes, or reads them back.

    data: None to write (then `finish` gives the bytes), or the bytes to read.
    """

    def __init__(self, data: bytes | None = None):
        self._p = np.full((INPUTS, TABLE), 32768, np.int32)
        self._n = np.zeros((INPUTS, TABLE), np.uint8)
        self._weights = np.full((MIXERS * NODES, INPUTS), FIRST, np.int32)
        self._squash, self._stretch, self._rate = _SQUASH.copy(), _STRETCH.copy(), _RATE.copy()
        self.context = np.zeros(INPUTS, np.int32)
        self._index = np.zeros(INPUTS, np.int32)
        self._input = np.zeros(INPUTS, np.int32)
        self._bytes = bytearray()
        self.reading = data is not None
        self._data = np.frombuffer(bytearray(data) if data else bytearray(1), np.uint8)
        self._size = len(data) if data else 0
        self._at = 0
        self._low, self._range, self._code = 0, 0xFFFFFFFF, 0
        self._cache, self._pending = -1, 0
        if self.reading:
            for _ in range(4):
                self._code = (self._code << 8) | self._next()

    @property
    def overrun(self) -> bool:
        """Whether more bytes were asked for than there are: the data is truncated."""
        return self.exhausted()

    @property
    def rest(self) -> int:
        """How many bytes come after all that was read."""
        return max(0, self._size - self._at)

    def end(self) -> bool:
        """Write the end mark, or say whether it comes next. Data that was cut short reads as ones for ever."""
        cdef int k
        cdef int found = 0
        for k in range(8):
            found = found * 2 + self._code_bit((END >> (7 - k)) & 1, 2048)
        return found == END

    cdef bint exhausted(self):
        return self._at > self._size + OVERRUN

    cdef unsigned int _next(self):
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
        """Code one bit that is 1 with probability p / 4096."""
        cdef unsigned int bound = (self._range >> 12) * <unsigned int>p
        if self.reading:
            bit = 1 if self._code < bound else 0
            if not bit:
                self._code -= bound
        elif not bit:
            self._low += bound
        self._range = bound if bit else self._range - bound
        while self._range < 0x01000000:
            self._range <<= 8
            if self.reading:
                self._code = (self._code << 8) | self._next()
            else:
                self._shift()
        return bit

    cdef int _bit(self, int node, int mixer, int bit):
        """Code one decision of a number, mixed from the estimates of all contexts."""
        return self._decision((mixer * NODES + node) % (MIXERS * NODES), node, INPUTS, SLOPE, bit)

    cdef void expect_told(self):
        """Begin with less weight on contexts: probabilities will be told beside them."""
        cdef int k, row
        for row in range(MIXERS * NODES):
            for k in range(INPUTS):
                self._weights[row, k] = FIRST_BESIDE if k < TOLD else FIRST_TOLD

    cdef int told(self, int node, int mixer, int bit, double one, double other):
        """Code one decision from the estimates of TOLD contexts and two probabilities, one and other, that it is 1."""
        self._input[TOLD] = self._stretch[max(4, min(4091, <int>(4096 * one)))]
        self._input[TOLD + 1] = self._stretch[max(4, min(4091, <int>(4096 * other)))]
        return self._decision(mixer * NODES + node, node, TOLD, TOLD_SLOPE, bit)

    cdef int _decision(self, int row, int node, int contexts, int slope, int bit):
        """Code one decision by the mixing weights of that row. The caller has set the inputs beyond the contexts'."""
        cdef int k, index, p, error
        cdef long long step, dot = 0
        for k in range(contexts):
            index = (self.context[k] * NODES + node) & (TABLE - 1)
            self._index[k] = index
            self._input[k] = self._stretch[self._p[k, index] >> 4]
        for k in range(INPUTS):
            dot += <long long>self._weights[row, k] * self._input[k]
        dot >>= 16
        dot = max(-2047, min(2047, dot))
        p = self._squash[dot + 2047]
        bit = self._code_bit(bit, p)
        error = ((bit << 12) - p) * slope
        for k in range(INPUTS):
            self._weights[row, k] += (self._input[k] * error + 0x8000) >> 16
        for k in range(contexts):
            index = self._index[k]
            p = self._p[k, index]
            # A signed product of 16 and 16 bits needs 33.
            step = (65535 if bit else 0) - p
            self._p[k, index] = p + <int>((step * self._rate[self._n[k, index]]) >> 16)
            if self._n[k, index] < LIMIT:
                self._n[k, index] += 1
        return bit

    cdef long long whole(self, int mixer, long long value):
        """Code a signed number in the contexts that are set: zero, sign, size in unary up to 12, then Elias gamma."""
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
        """Code one whole number of up to 40 bits.

        kind: 0 … 15; each kind has statistics of its own. a, b: contexts, 0 … 255, that the number may depend on.
        """
        cdef int c = (kind & 15) << 8
        self.context[0] = c
        self.context[1] = c | (a & 255)
        self.context[2] = c | (b & 255)
        self.context[3] = c | ((a * 7 + b * 31 + 11) & 255)
        self.context[4] = c
        self.context[5] = c | (a & 255)
        return self.whole(kind & 3, value)

    def number_in(self, long long value, int kind, int a, int b, int c) -> int:
        """Code one whole number as `number` does, in three contexts, 0 … 255, and pairs of them."""
        cdef int base = (kind & 15) << 8
        self.context[0] = base
        self.context[1] = base | (a & 255)
        self.context[2] = base | (b & 255)
        self.context[3] = base | (c & 255)
        self.context[4] = (base + (a & 255) * 521 + (b & 255) * 37 + 1) & 4095
        self.context[5] = (base + (a & 255) * 521 + (c & 255) * 61 + 2) & 4095
        return self.whole(kind & 3, value)

    def text(self, unsigned char[::1] values) -> None:
        """Code the bytes (n,) of a text, each predicted from the three before it: they are written, or read in place.

        Reading stops where the bytes overrun.
        """
        cdef Py_ssize_t i
        cdef int half, k, node, byte, bits
        cdef Py_ssize_t n = values.shape[0]
        cdef int one = 0, two = 0, three = 0
        for i in range(n):
            if self.exhausted():
                return
            byte = values[i]
            bits = 0
            for half in range(2):  # 15 decisions for each half of a byte, so that NODES suffice
                self.context[0] = bits + half * 16
                self.context[1] = one * 32 + bits + half * 16
                self.context[2] = (one * 1031 + two * 337 + bits * 7 + half) & 4095
                self.context[3] = (one * 1031 + two * 337 + three * 2131 + bits * 7 + half) & 4095
                self.context[4] = (two * 337 + three * 2131 + bits * 7 + half) & 4095
                self.context[5] = (one * 523 + three * 2131 + bits * 7 + half) & 4095
                node = 1
                for k in range(4):
                    node = node * 2 + self._bit(node, half, (byte >> (7 - 4 * half - k)) & 1)
                bits = node & 15 if half == 0 else bits * 16 + (node & 15)
            values[i] = bits
            three = two
            two = one
            one = bits

    def finish(self) -> bytes:
        """The bytes written, with the end mark: of the numbers within the last range the one with most trailing zeros.

        Up to four trailing zero bytes are left out: the reader supplies them.
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
