"""Samples, directions and texts in few bytes: members of a packed illustration.

Each begins as `members` says: four bytes, whole numbers (seven bits a byte, low ones first, the eighth set on all but
the last). One stretch of the adaptive code of `_compiled/coder` follows:

=========  =========================================  ==========================================
``PIs1``   width, height, maxval                      samples, row by row, by their neighbours
``PIs2``   width, height, maxval                      the same, by neighbours that no edge hides
``PIs3``   width, height, maxval, 1 beside edges      the same, by weights fitted to the samples around
``PId2``   columns, rows                              directions: angles row by row, then confidence
``PIt1``   number of bytes                            a text, byte by byte
=========  =========================================  ==========================================

`compact_edges` and `compact_lines` have edges and telling lines; `parts` is how an archive holds all of them. Samples
beside edges must be read with the edges that they were written with: these say which neighbours tell of a sample.

Directions are kept as one of ANGLES angles of a half turn, 5.625° apart, and as confidence in sevenths, one for 4 × 4
samples. ``PId1``, which is read and no longer written, has ANGLES_1 angles.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from penink_cli.formats._compiled import cuts as _cuts
from penink_cli.formats._compiled import samples as _samples
from penink_cli.formats._compiled.coder import Coder
from penink_cli.formats._compiled.samples import FITTED_LEVELS, FITTED_SAMPLES
from penink_cli.formats.members import check_end, finished, header, size_class, within, written_numbers
from penink_cli.ground.errors import FormatError, LimitError
from penink_cli.ground.model import Directions, EdgeList, Floats, GreyImage, Ints

SAMPLES, SAMPLES_BESIDE, SAMPLES_FITTED, TEXT = b"PIs1", b"PIs2", b"PIs3", b"PIt1"
ALL_SAMPLES = SAMPLES, SAMPLES_BESIDE, SAMPLES_FITTED
DIRECTIONS, DIRECTIONS_1 = b"PId2", b"PId1"

ANGLES, ANGLES_1 = 32, 48  # of a half turn: 0°, 45° and 90° are among them
SURE = 7  # the highest level of confidence
BLOCK = 4  # samples along each side of a square that share one confidence
MAX_FIELD = 1 << 20  # samples of a direction field
# Decoding takes .04 µs a sample where all is paper, up to 2 µs a fitted sample, .3 µs a byte of text and up to 3 µs a
# byte of code. With these limits, FITTED_SAMPLES and `members.MAX_CODE` that is 3 seconds a member at the most.
MAX_SAMPLES = 1 << 24
MAX_TEXT = 1 << 20

_SPACING = 16  # of samples, in the whole numbers of `cuts`
# Edges that pass more than _PASSED cells a sample, and _SOME besides, are taken to hide nothing: finding what they hide
# would take too long.
_PASSED, _SOME = 4, 1 << 16

_TURN = 8  # the kind of number (see `Coder.number`) that a turn is


def requantised(image: GreyImage, levels: int) -> GreyImage:
    """The image at no more than ``levels`` grey levels; one that has no more is returned as it is."""
    if image.maxval < levels:
        return image
    most = levels - 1
    values = (image.values.astype(np.int64) * (2 * most) + image.maxval) // (2 * image.maxval)
    return _grey(values, most)


def _grey(values: npt.NDArray[Any], maxval: int) -> GreyImage:
    return GreyImage(values.astype(np.uint8) if maxval < 256 else values.astype(np.uint16), maxval)


# ------------------------------------------------------------------------------ samples


def samples_bytes(image: GreyImage, edges: EdgeList | None = None) -> bytes:
    """Samples without loss, beside edges in the same frame if there are any. Raises LimitError."""
    h, w = image.values.shape
    coder = Coder()
    beside = edges is not None and len(edges.edges) > 0
    values = np.ascontiguousarray(image.values, np.int32)
    if w * h <= FITTED_SAMPLES and image.maxval < FITTED_LEVELS:
        _samples.fitted(coder, values, image.maxval, _hidden(edges, w, h))
        return SAMPLES_FITTED + written_numbers(w, h, image.maxval, int(beside)) + finished(coder)
    _samples.by_neighbours(coder, values, image.maxval, _hidden(edges, w, h) if beside else None)
    return (SAMPLES_BESIDE if beside else SAMPLES) + written_numbers(w, h, image.maxval) + finished(coder)


def samples_from(data: bytes, max_pixels: int, edges: EdgeList | None = None) -> GreyImage:
    """What `samples_bytes` wrote, given the same edges.

    Raises FormatError, and LimitError before anything large is allocated.
    """
    magic = data[:4] if data[:4] in ALL_SAMPLES else SAMPLES
    fitted = magic == SAMPLES_FITTED
    (width, height, maxval, *known), rest = header(data, magic, 4 if fitted else 3)
    beside = bool(known[0]) if fitted else magic == SAMPLES_BESIDE
    if not (width and height and 1 <= maxval < (FITTED_LEVELS if fitted else 65536)) or max(known, default=0) > 1:
        raise FormatError(f"samples of {width} x {height} with maxval {maxval}")
    limit = min(max_pixels, FITTED_SAMPLES if fitted else MAX_SAMPLES)
    if width * height > limit:
        raise LimitError(f"{width} x {height} samples; {limit} are allowed in all")
    if beside and edges is None:
        raise FormatError("samples beside edges, and the layer has none")
    values = np.zeros((height, width), np.int32)
    coder = Coder(rest)
    if fitted:
        _samples.fitted(coder, values, maxval, _hidden(edges if beside else None, width, height))
    else:
        _samples.by_neighbours(coder, values, maxval, _hidden(edges, width, height) if beside else None)
    check_end(coder)
    return _grey(values, maxval)


def _hidden(edges: EdgeList | None, width: int, height: int) -> npt.NDArray[np.uint8]:
    """(height, width) bits of the neighbours that edges hide from each sample, as `cuts.mark` has them."""
    cuts = np.zeros((height, width), np.uint8)
    if edges is not None and len(edges.edges):
        scale = (_SPACING * width / edges.width, _SPACING * height / edges.height)
        points = np.rint(edges.vertices * scale).astype(np.int64)
        a, b = points[edges.edges[:, 0]], points[edges.edges[:, 1]]
        passed = int((np.abs(b - a) // _SPACING + 4).sum())
        if passed <= _PASSED * width * height + _SOME:
            _cuts.mark(np.column_stack([a, b]), cuts)
    return cuts


# -------------------------------------------------------------------------------- texts


def text_bytes(text: bytes) -> bytes:
    """A text as a compact member; any bytes are taken. Raises LimitError."""
    if len(text) > MAX_TEXT:
        raise LimitError(f"a text of {len(text)} bytes; {MAX_TEXT} are allowed")
    coder = Coder()
    coder.text(np.frombuffer(bytearray(text), np.uint8))
    return TEXT + written_numbers(len(text)) + finished(coder)


def text_from(data: bytes) -> bytes:
    """What `text_bytes` wrote. Raises FormatError and LimitError."""
    (size,), rest = header(data, TEXT, 1)
    if size > MAX_TEXT:
        raise LimitError(f"a text of {size} bytes; {MAX_TEXT} are allowed")
    values = np.zeros(size, np.uint8)
    coder = Coder(rest)
    coder.text(values)
    check_end(coder)
    return values.tobytes()


# --------------------------------------------------------------------------- directions


def _angles(count: int) -> Floats:
    """(count, 2) cos 2θ and sin 2θ of the angles that are kept."""
    double = [2 * math.pi * k / count for k in range(count)]
    return np.array([(round(math.cos(a), 12), round(math.sin(a), 12)) for a in double])


def directions_bytes(field: Directions) -> bytes:
    """A direction field, its angles and its confidence rounded to those that are kept. Raises LimitError."""
    rows, columns = field.cos2.shape
    _check_field(columns, rows)
    angles = _angles(ANGLES)
    nearest = np.empty((rows, columns), np.int64)
    for i in range(rows):  # where cos 2θ and sin 2θ are both 0 it is the first angle
        nearest[i] = np.argmax(field.cos2[i, :, None] * angles[:, 0] + field.sin2[i, :, None] * angles[:, 1], axis=1)
    coder = Coder()
    _code_angles(coder, nearest, ANGLES)
    _samples.by_neighbours(coder, _by_blocks(field.confidence), SURE)
    return DIRECTIONS + written_numbers(columns, rows) + finished(coder)


def directions_from(data: bytes) -> Directions:
    """What `directions_bytes` wrote. Raises FormatError and LimitError."""
    first = data[:4] == DIRECTIONS_1
    count = ANGLES_1 if first else ANGLES
    (columns, rows), rest = header(data, DIRECTIONS_1 if first else DIRECTIONS, 2)
    if not (columns and rows):
        raise FormatError(f"directions of {columns} x {rows} samples")
    _check_field(columns, rows)
    coder = Coder(rest)
    nearest = np.zeros((rows, columns), np.int64)
    _code_angles(coder, nearest, count)
    levels = np.zeros((-(-rows // BLOCK), -(-columns // BLOCK)), np.int32)
    _samples.by_neighbours(coder, levels, SURE)
    check_end(coder)
    if not levels.any():
        raise FormatError("confidence is 0 everywhere")
    cos2, sin2 = np.moveaxis(_angles(count)[nearest], 2, 0)
    confidence = levels.repeat(BLOCK, axis=0).repeat(BLOCK, axis=1)[:rows, :columns] / SURE
    return Directions(np.ascontiguousarray(cos2), np.ascontiguousarray(sin2), confidence)


def _check_field(columns: int, rows: int) -> None:
    if columns * rows > MAX_FIELD:
        raise LimitError(f"{columns} x {rows} samples of a direction field; {MAX_FIELD} are allowed")


def _by_blocks(confidence: npt.NDArray[np.floating]) -> npt.NDArray[np.int32]:
    """(rows, columns) levels of confidence, 0 … SURE, the mean of each block; at least one is above 0."""
    h, w = confidence.shape
    whole = np.pad(confidence.astype(np.float64), ((0, -h % BLOCK), (0, -w % BLOCK)), mode="edge")
    mean = np.zeros((len(whole) // BLOCK, whole.shape[1] // BLOCK))
    for i in range(BLOCK):
        for j in range(BLOCK):
            mean += whole[i::BLOCK, j::BLOCK] / BLOCK**2
    levels = np.floor(np.clip(mean, 0, 1) * SURE + 0.5).astype(np.int32)
    if not levels.any():
        levels[np.unravel_index(np.argmax(mean), mean.shape)] = 1
    return levels


def _code_angles(coder: Coder, nearest: Ints, count: int) -> None:
    """Code angles (h, w), 0 … count − 1, row by row, each as its turn from the one that its neighbours let expect.

    The angles are written, or read in place.
    """
    h, w = nearest.shape
    turns = np.zeros((2, w + 2), np.int64).tolist()  # the sizes of the turns of this row and the last
    above: list[int] = [0] * (w + 2)
    for i in range(h):
        given, row = nearest[i].tolist(), [0] * (w + 2)
        ahead = above[1]
        last, before = turns[(i + 1) & 1], turns[i & 1]
        for j in range(w):
            if coder.overrun:
                return
            # The other neighbours are taken by their turns from the west one, so that the half turn is no seam.
            west = row[j] if j else ahead
            north = west + _turn(above[j + 1] - west, count) if i else west
            north_west = west + _turn(above[j] - west, count) if i and j else north
            north_east = north + _turn(above[j + 2] - north, count) if i and j + 1 < w else north
            guess = (2 * (west + north) + north_east - north_west + 2) >> 2
            rough = abs(west - north_west) + abs(north - north_west) + abs(north - north_east)
            near = last[j + 1] + last[j + 2] + before[j]
            aside = 7 * within(west - guess, 3) + within(north - guess, 3)
            turn = coder.number(_turn(given[j] - guess, count), _TURN, 12 * size_class(near) + size_class(rough), aside)
            row[j + 1] = (guess + turn) % count
            before[j + 1] = min(count, abs(turn))
        above = row
        nearest[i] = row[1:-1]


def _turn(steps: int, count: int) -> int:
    """A turn of so many steps, brought between −count / 2 and count / 2."""
    return (steps + count // 2) % count - count // 2
