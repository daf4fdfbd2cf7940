"""JSON as its definition has it: what Python's own reader would let pass is refused, with its place."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from penink_cli.formats import strict_json
from penink_cli.ground.errors import FormatError

REFUSED = {
    "nothing": (b"", "empty"),
    "white space": (b" \n\t", "empty"),
    "a byte order mark": (b"\xef\xbb\xbf{}", "byte order mark"),
    "UTF-16": ("{}".encode("utf-16-le"), "not JSON"),
    "UTF-16 with its mark": ("{}".encode("utf-16"), "not UTF-8"),
    "UTF-32": ("{}".encode("utf-32-le"), "not JSON"),
    "Latin-1": ('{"name": "Grün"}'.encode("latin-1"), "byte 12: not UTF-8"),
    "an overlong encoding": (b'"\xc0\x80"', "not UTF-8"),
    "an encoded surrogate": (b'"\xed\xa0\x80"', "not UTF-8"),
    "NaN": (b'{"a": NaN}', "NaN is not JSON"),
    "Infinity": (b"[Infinity]", "Infinity is not JSON"),
    "-Infinity": (b"[-Infinity]", "-Infinity is not JSON"),
    "infinity without a token": (b"[1e999]", "1e999 is out of range"),
    "minus infinity without a token": (b"[-1e999]", "-1e999 is out of range"),
    "an integer beyond a double": (b"[-" + b"9" * 309 + b"]", "is out of range"),
    "5000 digits": (b"[" + b"9" * 5000 + b"]", "too many digits"),
    "5000 digits and a fraction": (b"[" + b"9" * 5000 + b".5]", "out of range"),
    "a member twice": (b'{"a": 1, "b": 2, "a": 1}', 'member "a" appears twice'),
    "a member twice, once escaped": (b'{"a": 1, "\\u0061": 1}', 'member "a" appears twice'),
    "a member twice, deep within": (b'[[{"x": {"a": 1, "a": 2}}]]', 'member "a" appears twice'),
    "half a surrogate pair": (b'["\\ud800"]', "half of a surrogate pair"),
    "the other half": (b'{"a": "\\uDFFF"}', "half of a surrogate pair"),
    "half a surrogate pair in a name": (b'{"\\ud800": 1}', "half of a surrogate pair"),
    "arrays without end": (b"[" * 100_000, "nested too deeply"),
    "objects without end": (b'{"a":' * 100_000, "nested too deeply"),
    "deep and closed": (b"[" * 100_000 + b"]" * 100_000, "nested too deeply"),
    "two values": (b"{} {}", "column 4: not JSON"),
    "a trailing comma": (b"[1,]", "not JSON"),
    "single quotes": (b"{'a': 1}", "not JSON"),
    "a comment": (b"[1] // one", "not JSON"),
    "a plus sign": (b"[+1]", "not JSON"),
    "a leading zero": (b"[01]", "not JSON"),
    "a bare point": (b"[.5]", "not JSON"),
    "hexadecimal": (b"[0x10]", "not JSON"),
    "digits of another script": ("[٣]".encode(), "not JSON"),
    "a raw newline in text": (b'"a\nb"', "not JSON"),
    "a null in text": (b'"a\x00b"', "not JSON"),
    "non-breaking space": (b"\xc2\xa0[]", "not JSON"),
    "form feed": (b"\x0c[]", "not JSON"),
    "cut short": (b'{"a": [1, 2', "line 1, column 12: not JSON"),
    "cut short in text": (b'{"a', "not JSON"),
    "on the third line": (b"{\n\n  x}", "line 3, column 3: not JSON"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_is_refused(name):
    data, complaint = REFUSED[name]
    with pytest.raises(FormatError) as caught:
        strict_json.loads(data, "x.json")
    assert complaint in str(caught.value) and str(caught.value).startswith("x.json: ")
    assert str(caught.value).isprintable() and len(str(caught.value)) < 200


def test_the_place_is_named():
    with pytest.raises(FormatError, match=r"^x: line 7: column 1: not JSON"):
        strict_json.loads(b"?", "x", "line 7")
    with pytest.raises(FormatError, match=r'^x: line 7: member "a" appears twice'):
        strict_json.loads(b'{"a":1,"a":1}', "x", "line 7")


@pytest.mark.parametrize(
    "text",
    [
        b'"\\ud83d\\ude00"', '"😀"'.encode(), b"1e308", b"1e-999", b"-0.0", b" [ ] \r\n",
        b"1" + b"0" * 308, b"0." + b"3" * 400,
    ],
)  # fmt: skip
def test_is_read(text):
    assert strict_json.loads(text) == json.loads(text)


values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=20,
)


@given(values, st.booleans())
def test_reads_what_json_writes(value, ascii_only):
    text = json.dumps(value, ensure_ascii=ascii_only).encode("utf-8", "surrogatepass")
    assert strict_json.loads(text) == value


@given(st.binary() | st.text('0123456789.eE+-[]{}",:truefalsn \\ud8', max_size=30).map(str.encode))
def test_any_bytes_are_read_as_json_reads_them_or_refused(data):
    try:
        value = strict_json.loads(data, "x")
    except FormatError as error:
        assert str(error).startswith("x: ") and str(error).isprintable()
    else:
        assert json.loads(data.decode("utf-8")) == value


HUGE = int("9" * 400)
NOT_NUMBERS = [True, False, None, "1", [1], {"a": 1}, HUGE, -HUGE]


@pytest.mark.parametrize("value", [*NOT_NUMBERS, 1.5, -1, 11, 1.0, int("9" * 4000)], ids=lambda v: str(v)[:9])
def test_whole(value):
    with pytest.raises(FormatError, match=r"^n is .*a whole number from 0 to 10 is needed"):
        strict_json.whole(value, "n", 0, 10)
    assert strict_json.whole(10, "n", 0, 10) == 10


@pytest.mark.parametrize("value", [*NOT_NUMBERS, -0.5, 1.01], ids=lambda v: str(v)[:9])
def test_number(value):
    with pytest.raises(FormatError, match=r"^n is .*a number from 0 to 1 is needed"):
        strict_json.number(value, "n", 0, 1)
    assert strict_json.number(1, "n", 0, 1) == 1.0


@pytest.mark.parametrize("value", NOT_NUMBERS, ids=lambda v: str(v)[:9])
def test_arrays_of_numbers_name_the_first_that_is_none(value):
    with pytest.raises(FormatError, match=r"^thing 2 holds "):
        strict_json.numbers([0, 1.5, value, True], "things", "thing")
    with pytest.raises(FormatError, match=r"^thing 1 holds "):
        strict_json.pairs([[0, 1], [1, value], [value, 2]], "things", "thing")
    with pytest.raises(FormatError, match=r"^thing 1 holds .*whole numbers are needed"):
        strict_json.whole_pairs([[0, 1], [1, value], [0.5, 2]], "things", "thing")


@pytest.mark.parametrize("pair", [None, True, 1, [], [1], [1, 2, 3], "ab", {"a": 1, "b": 2}])
def test_pairs_name_the_first_that_is_none(pair):
    with pytest.raises(FormatError, match=r"^thing 1 is "):
        strict_json.pairs([[0, 1], pair, None], "things", "thing")


@given(
    st.lists(
        st.tuples(st.integers(-(2**62), 2**62) | st.floats(allow_nan=False, allow_infinity=False), st.integers(0, 9))
    )
)
def test_pairs_are_the_array_that_they_say(rows):
    found = strict_json.pairs([list(row) for row in rows], "things", "thing")
    assert found.shape == (len(rows), 2) and found.dtype == np.float64
    assert found.tolist() == [[float(a), float(b)] for a, b in rows]


@pytest.mark.parametrize("version", [True, 1.0, "1", 0, 2, None, [1], HUGE], ids=lambda v: str(v)[:9])
def test_versions_that_only_equal_1_are_not_1(version):
    with pytest.raises(FormatError, match=r"^version is .*; 1 is the only one known"):
        strict_json.header({"format": "f", "version": version}, "f")


@pytest.mark.parametrize("document", [None, [], "f", 1, True])
def test_a_document_is_an_object(document):
    with pytest.raises(FormatError, match="an object is expected, found"):
        strict_json.header(document, "f")


def test_quoted_values_are_short_and_printable():
    for value in ["x" * 1000, "\x1b[31m\n", 10**4000, [1] * 1000, {"a": 1}, math.pi, None, [10**200] * 4, "\ud800"]:
        shown = strict_json.quoted(value)
        assert shown.isprintable() and len(shown) <= 64
