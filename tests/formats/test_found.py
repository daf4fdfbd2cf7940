"""Whatever the fuzzer, or a user, has found a reader to stumble over: tests/data/found/READER/*."""

from __future__ import annotations

import functools
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.conftest import ROOT
from tests.formats.readers import READERS, judge
from tests.fuzz.seeds import seeds

PIECES = st.binary(max_size=3) | st.sampled_from([b"true", b"1e999", b"-1", b"[", b'"'])


def test_what_was_found_once():
    for path in sorted((ROOT / "tests/data/found").glob("*/*")):
        judge(path.parent.name, path.read_bytes())


@pytest.mark.parametrize("reader", READERS)
def test_a_valid_file_is_read(reader):
    for data in seeds(reader):
        READERS[reader](data)


@functools.cache
def kept_seeds(reader: str) -> tuple[bytes, ...]:
    """The same ones in every example: some are made of random numbers that go on from call to call."""
    return tuple(seeds(reader))


@pytest.mark.parametrize("reader", READERS)
@given(st.data())
def test_any_bytes_are_a_value_or_one_clean_error(reader, data):
    """Bytes from nowhere, and valid files with a few bytes changed, put in or left out."""
    if data.draw(st.booleans()):
        judge(reader, data.draw(st.binary(max_size=60)))
        return
    text = bytearray(data.draw(st.sampled_from(kept_seeds(reader))))
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(text)))
        text[at : at + data.draw(st.integers(0, 3))] = data.draw(
            st.binary(max_size=3) | st.sampled_from([b"true", b"1e999", b"-1", b"[", b'"'])
        )
    judge(reader, bytes(text))


@pytest.mark.parametrize("order", "<>")
@pytest.mark.parametrize("big", [False, True])
def test_a_tiff_cut_anywhere_or_with_any_place_out_of_reach(big, order):
    """The directory comes last, and in it a profile's entry: what is cut off is that first."""
    whole = directory_last(big, order)
    if not big or order == "<":  # Pillow reads no big-endian BigTIFF
        READERS["photo"](whole)
    for length in range(len(whole)):
        judge("photo", whole[:length])
    for at in range(4, len(whole) - 7):
        for place in (1 << 62, (1 << 63) - 1, 1 << 63, (1 << 64) - 64, (1 << 64) - 1):
            judge("photo", whole[:at] + struct.pack(f"{order}Q", place) + whole[at + 8 :])


def directory_last(big: bool, order: str) -> bytes:
    """A TIFF (or a BigTIFF) of 4 x 4 pixels whose directory stands behind them."""
    word, kind, head = ("Q", 16, 16) if big else ("I", 4, 8)
    tags = {256: 4, 257: 4, 258: 8, 259: 1, 262: 1, 273: head, 277: 1, 278: 4, 279: 16}
    entries = [struct.pack(f"{order}HH2{word}", tag, kind, 1, value) for tag, value in tags.items()]
    entries.append(struct.pack(f"{order}HH2{word}", 34675, 7, 100, 10))
    start = struct.pack(f"{order}HHHQ", 43, 8, 0, head + 16) if big else struct.pack(f"{order}HI", 42, head + 16)
    count = struct.pack(f"{order}{'Q' if big else 'H'}", len(entries))
    pixels = bytes(range(16))
    return (b"II" if order == "<" else b"MM") + start + pixels + count + b"".join(entries) + bytes(8 if big else 4)
