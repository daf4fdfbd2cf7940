# cython: boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: embedsignature=True
"""The codes of a JPEG scan (ITU-T T.81, F.2 and G.2) read without making pixels of them, to find damage.

A JPEG has no checksum. But damaged codes fall out of step: they run out early, leave bytes over, or are no codes.
"""

from libc.stdint cimport uint16_t, uint64_t

WHOLE, CUT, NO_CODE, LEFT_OVER, NO_RESTART = range(5)

cdef enum:
    _WHOLE, _CUT, _NO_CODE, _LEFT_OVER, _NO_RESTART

cdef struct Bits:
    const unsigned char* data
    Py_ssize_t at, end      # the place of the byte that is read next, and of the end of the data
    uint64_t held           # its lowest `count` bits are to come
    int count
    int made                # the last of these bits: zeros in the place of data that are missing


cdef void fill(Bits* bits) noexcept nogil:
    """Hold more than 48 bits; where the data end, or a marker comes, zeros are made."""
    cdef unsigned char byte
    cdef Py_ssize_t ahead
    while bits.count <= 48:
        byte = 0
        if bits.at < bits.end and bits.data[bits.at] != 0xFF:
            byte = bits.data[bits.at]
            bits.at += 1
        else:
            ahead = bits.at
            while ahead < bits.end and bits.data[ahead] == 0xFF:
                ahead += 1
            if bits.at < bits.end and ahead < bits.end and bits.data[ahead] == 0:  # a stuffed byte, no marker
                byte = 0xFF
                bits.at = ahead + 1
            else:
                bits.made += 8
        bits.held = (bits.held << 8) | byte
        bits.count += 8


cdef inline int code(Bits* bits, const uint16_t* lookup) noexcept nogil:
    """The symbol of the next Huffman code, -1 for no code. At least 32 bits are held afterwards."""
    cdef uint16_t found
    if bits.count < 48:
        fill(bits)
    found = lookup[(bits.held >> (bits.count - 16)) & 0xFFFF]
    if found == 0:
        return -1
    bits.count -= found >> 8
    return found & 255


cdef inline int plain(Bits* bits, int count) noexcept nogil:
    """The next ``count`` bits, at most 16."""
    if bits.count < 16:
        fill(bits)
    bits.count -= count
    return <int>((bits.held >> bits.count) & ((<uint64_t>1 << count) - 1))


cdef int baseline(Bits* bits, const uint16_t* dc, const uint16_t* ac) noexcept nogil:
    """Read a block of a sequential scan; one of the results below, as of all passes."""
    cdef int k = 1, found = code(bits, dc)
    if found < 0 or found > 16:
        return _NO_CODE
    plain(bits, found)
    while k < 64:
        found = code(bits, ac)
        if found < 0:
            return _NO_CODE
        if found & 15:
            k += found >> 4
            if k > 63:
                return _NO_CODE
            bits.count -= found & 15
            k += 1
        elif found == 0xF0:
            k += 16
        else:
            return _WHOLE
    return _WHOLE


cdef int first_pass(Bits* bits, const uint16_t* ac, int k, int last, int* run, uint64_t* known) noexcept nogil:
    """Read a block of a progressive scan that brings coefficients k … last for the first time.

    run: blocks to come without codes of their own. known: bits of the block's coefficients that are not zero.
    """
    cdef int found
    if run[0]:
        run[0] -= 1
        return _WHOLE
    while k <= last:
        found = code(bits, ac)
        if found < 0:
            return _NO_CODE
        if found & 15:
            k += found >> 4
            if k > last:
                return _NO_CODE
            bits.count -= found & 15
            known[0] |= <uint64_t>1 << k
            k += 1
        elif found == 0xF0:
            k += 16
        else:
            run[0] = (1 << (found >> 4)) - 1 + plain(bits, found >> 4)
            return _WHOLE
    return _WHOLE


cdef int finer_pass(Bits* bits, const uint16_t* ac, int k, int last, int* run, uint64_t* known) noexcept nogil:
    """Read a block of a progressive scan that brings one more bit of coefficients k … last; as `first_pass`."""
    cdef int found, zeros
    if run[0] == 0:
        while k <= last:
            found = code(bits, ac)
            if found < 0 or (found & 15) > 1:
                return _NO_CODE
            if found & 15:
                plain(bits, 1)
            elif found != 0xF0:
                run[0] = (1 << (found >> 4)) + plain(bits, found >> 4)
                break
            zeros = found >> 4
            while k <= last:
                if known[0] >> k & 1:
                    plain(bits, 1)
                elif zeros == 0:
                    break
                else:
                    zeros -= 1
                k += 1
            if found & 15:
                if k > last:
                    return _NO_CODE
                known[0] |= <uint64_t>1 << k
            k += 1
    if run[0]:
        while k <= last:
            if known[0] >> k & 1:
                plain(bits, 1)
            k += 1
        run[0] -= 1
    return _WHOLE


cdef int left_over(Bits* bits) noexcept nogil:
    """Go on to the next marker; _LEFT_OVER for bytes before it, save those that cameras fill up with.

    These are two at the most, or any number that are all the same.
    """
    cdef int count = 0, same = 1, byte, value = -1
    cdef int whole = (bits.count - bits.made) // 8
    while True:
        if whole > 0:
            whole -= 1
            byte = <int>((bits.held >> (bits.made + 8 * whole)) & 255)
        else:
            while bits.at + 1 < bits.end and bits.data[bits.at] == 0xFF and bits.data[bits.at + 1] == 0xFF:
                bits.at += 1
            if bits.at + 1 >= bits.end or (bits.data[bits.at] == 0xFF and bits.data[bits.at + 1] != 0):
                break
            byte = bits.data[bits.at]
            bits.at += 2 if byte == 0xFF else 1
        count += 1
        if value >= 0 and byte != value:
            same = 0
        value = byte
    bits.held = 0
    bits.count = bits.made = 0
    return _WHOLE if count <= 2 or same else _LEFT_OVER


def scan(
    const unsigned char[::1] data, Py_ssize_t start, const uint16_t[:, ::1] lookups, const int[:, ::1] parts,
    uint64_t[::1] known, units, band,
):
    """Read one scan: (WHOLE or what is wrong with it, the place of the marker behind it).

    lookups: (8, 65536) by table (0-3 DC, 4-7 AC) and the next 16 bits: 256 · a code's length + its symbol, 0 for none.
    parts: a row a component of the scan: DC table, AC table, blocks across and down in a unit, where its blocks
        begin in `known` and how many a row has there.
    known: of a progressive picture, for each block bits of the coefficients that are not zero.
    units: of the picture across and down, and from one restart marker to the next, 0 for no markers.
    band: None for a sequential scan; of a progressive one the first and the last coefficient that it brings, and 0 if
        it brings them for the first time.
    """
    cdef Bits bits
    cdef int result = _WHOLE, run = 0, c, x, y, i, j, number = 0
    cdef int across = units[0], down = units[1], restart = units[2]
    cdef bint progressive = band is not None
    cdef int first = band[0] if progressive else 0, last = band[1] if progressive else 63
    cdef int high = band[2] if progressive else 0
    cdef Py_ssize_t unit, count = <Py_ssize_t>across * down
    cdef uint64_t* block
    bits.data, bits.at, bits.end = &data[0], start, data.shape[0]
    bits.held = 0
    bits.count = bits.made = 0
    with nogil:
        for unit in range(count):
            if restart and unit and unit % restart == 0:
                result = left_over(&bits)
                if result != _WHOLE:
                    break
                if bits.at + 1 >= bits.end or bits.data[bits.at + 1] != 0xD0 + number:
                    result = _CUT if bits.at + 1 >= bits.end else _NO_RESTART
                    break
                bits.at += 2
                number = (number + 1) & 7
                run = 0
            y, x = <int>(unit // across), <int>(unit % across)
            for c in range(parts.shape[0]):
                for i in range(parts[c, 3]):
                    for j in range(parts[c, 2]):
                        if not progressive:
                            result = baseline(&bits, &lookups[parts[c, 0], 0], &lookups[parts[c, 1], 0])
                        elif first == 0:
                            if high:
                                plain(&bits, 1)
                            else:
                                result = code(&bits, &lookups[parts[c, 0], 0])
                                if 0 <= result <= 16:
                                    plain(&bits, result)
                                    result = _WHOLE
                                else:
                                    result = _NO_CODE
                        else:
                            block = &known[
                                parts[c, 4] + <Py_ssize_t>(y * parts[c, 3] + i) * parts[c, 5] + x * parts[c, 2] + j
                            ]
                            if high:
                                result = finer_pass(&bits, &lookups[parts[c, 1], 0], first, last, &run, block)
                            else:
                                result = first_pass(&bits, &lookups[parts[c, 1], 0], first, last, &run, block)
                        if result != _WHOLE:
                            break
                    if result != _WHOLE:
                        break
                if result != _WHOLE:
                    break
            if bits.count < bits.made:  # zeros that were made have been read as codes
                result = _CUT
            if result != _WHOLE:
                break
        if result == _WHOLE:
            result = left_over(&bits)
    return result, bits.at
