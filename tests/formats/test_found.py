"""Whatever the fuzzer, or a user, has found a reader to stumble over: tests/data/found/READER/*."""

from __future__ import annotations

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


@pytest.mark.parametrize("reader", READERS)
@given(st.data())
def test_any_bytes_are_a_value_or_one_clean_error(reader, data):
    """Bytes from nowhere, and valid files with a few bytes changed, put in or left out."""
    if data.draw(st.booleans()):
        judge(reader, data.draw(st.binary(max_size=60)))
        return
    text = bytearray(data.draw(st.sampled_from(list(seeds(reader)))))
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(text)))
        text[at : at + data.draw(st.integers(0, 3))] = data.draw(
            st.binary(max_size=3) | st.sampled_from([b"true", b"1e999", b"-1", b"[", b'"'])
        )
    judge(reader, bytes(text))
