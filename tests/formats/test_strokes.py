"""The strokes file: what is written is read back, what is wrong is refused by its line."""

import io
import json
from dataclasses import replace
from importlib import resources

import jsonschema
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from penink_cli.formats import strokes
from penink_cli.ground.errors import FormatError, ParameterError
from penink_cli.ground.model import HEADER as HEADER_MEMBERS
from penink_cli.ground.model import Strokes

HEADER = b'{"format": "penink-strokes", "version": 1, "width": 100, "height": 50}\n'

FOUR = b"[[1, 1], [2, 2], [3, 3], [4, 4]]"

numbers = st.floats(-9e6, 9e6).map(lambda v: round(v, 3))
pens = st.floats(0.001, 1e4).map(lambda v: max(round(v, 4), 0.001))


@st.composite
def drawings(draw):
    segments = draw(st.lists(st.integers(0, 3), max_size=8))
    first = np.concatenate([[0], np.cumsum([3 * k + 1 for k in segments])]).astype(np.int64)
    points = np.array(draw(st.lists(st.tuples(numbers, numbers), min_size=int(first[-1]), max_size=int(first[-1]))))
    widths = np.array(draw(st.lists(pens, min_size=len(segments), max_size=len(segments))), float)
    even = Strokes(draw(pens), draw(pens), points.reshape(-1, 2), first, widths)
    knots = None
    if draw(st.booleans()):  # some strokes swell, to a point perhaps
        swings = [draw(st.lists(st.sampled_from([0.0, 1.0, 1.5]), min_size=k + 1, max_size=k + 1)) for k in segments]
        knots = even.at_knots * np.concatenate([[], *(s if any(s) else np.ones(len(s)) for s in swings)])
    return replace(
        even if knots is None else even.swelling(knots),
        layer=draw(st.none() | st.text()),
        texture=draw(st.none() | st.text()),
        seed=draw(st.none() | st.integers(-(1 << 62), 1 << 62)),
        color=draw(st.none() | st.from_regex("#[0-9a-fA-F]{6}", fullmatch=True)),
        device_dpi=draw(st.none() | st.integers(10, 4800).map(float)),
    )


def written(s):
    out = io.BytesIO()
    strokes.write(out, s)
    return out.getvalue()


def read(text):
    return strokes.read(io.BytesIO(text), "a.strokes.jsonl")


@settings(deadline=None)
@given(drawings())
def test_round_trip(s):
    back = read(written(s))
    assert [getattr(back, name) for name in HEADER_MEMBERS] == [getattr(s, name) for name in HEADER_MEMBERS]
    assert np.array_equal(back.first, s.first)
    assert np.allclose(back.points, s.points, rtol=0, atol=0.0006)
    assert np.allclose(back.widths, s.widths, rtol=0, atol=0.00006)
    assert np.allclose(back.at_knots, s.at_knots, rtol=0, atol=0.00011)
    assert written(back) == written(read(written(back)))


@settings(deadline=None)
@given(drawings())
def test_rounded_is_what_is_read_back(s):
    back, rounded = read(written(s)), s.rounded()
    assert (back.width, back.height) == (rounded.width, rounded.height)
    for name in ("points", "first", "widths", "at_knots"):
        assert np.array_equal(getattr(back, name), getattr(rounded, name))
    assert (back.knot_widths is None) == (rounded.knot_widths is None)


@settings(deadline=None)
@given(drawings())
def test_every_line_is_what_json_and_the_schema_say(s):
    schema = json.loads(resources.files("penink_cli.formats").joinpath("schemas/strokes.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    lines = written(s).decode("ascii").split("\n")
    assert lines.pop() == ""
    values = [json.loads(line) for line in lines]
    for value in values:
        validator.validate(value)
    back = read(written(s))
    for i, value in enumerate(values[1:]):
        assert value["width"] == back.widths[i]
        assert np.array_equal(np.array(value["points"], float), back[i])
        at_knots = back.at_knots[back.knots[i] : back.knots[i + 1]]
        assert np.array_equal(value.get("widths", [value["width"]] * len(at_knots)), at_knots)
        assert ("widths" in value) == bool(back.swells[i])


@pytest.mark.parametrize(
    "line",
    [
        b'{"points": [[1, 2]], "width": 3}',
        b'{"width": 3, "points": [[1, 2]], "colour": "red"}',
        b' { "width" :\t3.0,"points":[ [1,2] ] } ',
        b'{"width": 3e0, "points": [[0.1e1, 20E-1]]}',
        b'{"width": 3.00000000000000000000, "points": [[1, 2]]}',
        b'{"w\\u0069dth": 3, "points": [[1, 2]]}',
    ],
)
@pytest.mark.parametrize("ending", [b"\n", b"\r\n", b""])
def test_one_stroke_in_other_words(line, ending):
    s = read(HEADER + line + ending)
    assert s.widths.tolist() == [3.0]
    assert s.points.tolist() == [[1.0, 2.0]]


@pytest.mark.parametrize(
    "line",
    [
        b'{"width": 1.5, "points": [[1, 2], [2, 2], [3, 2], [4, 2]], "widths": [0, 3]}',
        b'{"widths": [0, 3], "width": 1.5, "points": [[1, 2], [2, 2], [3, 2], [4, 2]]}',
        b' { "width" : 1.5,"points":[ [1,2] ,[2,2],[3,2],[4,2]] ,"widths" : [ 0 ,3.0 ] } ',
        b'{"width": 1.51, "points": [[1, 2], [2, 2], [3, 2], [4, 2]], "widths": [0e0, 3]}',
        b'{"width": 1.51, "points": [[1, 2], [2, 2], [3, 2], [4, 2]], "widths": [0, 3]}',
    ],
)
def test_one_stroke_that_swells_in_other_words(line):
    even = b'{"width": 2, "points": [[1, 2]]}\n'
    s = read(HEADER + even + line + b"\n" + even)
    assert s.at_knots.tolist() == [2.0, 0.0, 3.0, 2.0]
    assert s.swells.tolist() == [False, True, False]
    assert s.widths[1] == pytest.approx(1.5, abs=0.011)


def test_a_header_tells_ink_and_printer():
    text = HEADER[:-2] + b', "color": "#A0b1c2", "device_dpi": 1200}\n'
    s = read(text)
    assert (s.color, s.device_dpi) == ("#A0b1c2", 1200.0)
    assert read(written(s)).device_dpi == 1200.0
    assert b'"device_dpi": null' in written(replace(s, device_dpi=None))
    assert read(written(replace(s, device_dpi=None))).device_dpi is None


@settings(deadline=None)
@given(st.decimals(-99999, 99999, places=5).map(str))
def test_numbers_are_the_doubles_that_python_reads(text):
    assert read(HEADER + b'{"width": 1, "points": [[%s, 0]]}' % text.encode()).points[0, 0] == float(text)


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        (b"", "empty"),
        (b"\n", "line 1"),
        (b"[]\n", "line 1: an object is expected"),
        (b'{"format": "penink-edges", "version": 1, "width": 1, "height": 1}\n', "not strokes but an edge list"),
        (b'{"format": "penink-strokes", "version": 2, "width": 1, "height": 1}\n', "line 1: version is 2"),
        (b'{"format": "penink-strokes", "version": true, "width": 1, "height": 1}\n', "line 1: version is true"),
        (b'{"format": "penink-strokes", "version": 1.0, "width": 1, "height": 1}\n', "line 1: version is 1.0"),
        (b'{"format": "penink-strokes", "version": 1, "height": 1}\n', 'line 1: member "width" is missing'),
        (b'{"format": "penink-strokes", "version": 1, "width": 0, "height": 1}\n', "line 1: width is 0;"),
        (b'{"format": "penink-strokes", "version": 1, "width": 1, "height": true}\n', "line 1: height is true"),
        (b'{"format": "penink-strokes", "version": 1, "width": 1, "height": 1, "layer": 7}\n', "layer is 7; text"),
        (b'{"format": "penink-strokes", "version": 1, "width": 1, "height": 1, "seed": 0.5}\n', "seed is 0.5; a whole"),
        (b'{"format": "penink-strokes", "version": 1, "width": 1, "height": 1, "layer": null}\n', "layer is null;"),
        (b'{"format": "penink-strokes", "version": 1, "width": 1, "height": 1, "seed": null}\n', "seed is null;"),
        (HEADER[:-2] + b', "color": "red"}\n', 'line 1: color "red" is not #rrggbb'),
        (HEADER[:-2] + b', "color": null}\n', "line 1: color null is not #rrggbb"),
        (HEADER[:-2] + b', "device_dpi": 0}\n', "line 1: device_dpi is 0"),
        (HEADER[:-2] + b', "device_dpi": "600"}\n', 'line 1: device_dpi is "600"'),
        (HEADER[:-2] + b', "device_dpi": true}\n', "line 1: device_dpi is true"),
        (HEADER + b'{"width": 1, "points": %s, "widths": [1]}\n' % FOUR, "line 2: 1 widths; a stroke of 1"),
        (HEADER + b'{"width": 1, "points": %s, "widths": [1, 1, 1]}\n' % FOUR, "line 2: 3 widths; a stroke of 1"),
        (HEADER + b'{"width": 1, "points": %s, "widths": 1}\n' % FOUR, "line 2: widths 1; a stroke of 1"),
        (HEADER + b'{"width": 1, "points": %s, "widths": null}\n' % FOUR, "line 2: widths null; a stroke of"),
        (HEADER + b'{"width": 1, "points": %s, "widths": [3, -1]}\n' % FOUR, "line 2: width 1 of widths is -1"),
        (HEADER + b'{"width": 1, "points": %s, "widths": [1, true]}\n' % FOUR, "line 2: width 1 of widths is true"),
        (HEADER + b'{"width": 1, "points": %s, "widths": [1, 1e8]}\n' % FOUR, "line 2: width 1 of widths is 1000"),
        (HEADER + b'{"width": 1, "points": %s, "widths": [1, 2]}\n' % FOUR, "line 2: width 1 is not the mean of its"),
        (HEADER + b'{"width": 1, "points": %s, "widths": [1, 1],}\n' % FOUR, "line 2"),
        (HEADER + b"\n", "line 2"),
        (HEADER + b"7\n", "line 2: 7 is not a stroke"),
        (HEADER + b'{"width": 1, "points": [[1, 2]]}\n{"width": 1, "points": [[1, 2]]\n', "line 3"),
        (HEADER + b'{"width": 1, "points": []}\n', "line 2: 0 points"),
        (HEADER + b'{"width": 1, "points": [[1, 2], [1, 2]]}\n', "line 2: 2 points"),
        (HEADER + b'{"width": 1}\n', 'line 2: member "points" is missing'),
        (HEADER + b'{"width": 1, "points": null}\n', "line 2: points null"),
        (HEADER + b'{"points": [[1, 2]]}\n', 'line 2: member "width" is missing'),
        (HEADER + b'{"width": null, "points": [[1, 2]]}\n', "line 2: width is null"),
        (b'{"format": "penink-strokes", "width": 1, "height": 1}\n', 'line 1: member "version" is missing'),
        (HEADER + b'{"width": 1, "points": {"0": 1}}\n', "line 2: points an object;"),
        (HEADER + b'{"width": 1, "points": [[1, 2, 3]]}\n', "line 2: point 0 is [1, 2, 3]"),
        (HEADER + b'{"width": 1, "points": [[1, false]]}\n', "line 2: point 0"),
        (HEADER + b'{"width": 1, "points": [[1, NaN]]}\n', "line 2"),
        (HEADER + b'{"width": 1, "points": [[1, 1e999]]}\n', "line 2"),
        (HEADER + b'{"width": 1, "points": [[1, 10000001]]}\n', "line 2: point 0"),
        (HEADER + b'{"width": 1, "points": [[01, 1]]}\n', "line 2"),
        (HEADER + b'{"width": 1, "points": [[1., 1]]}\n', "line 2"),
        (HEADER + b'{"width": 1, "points": [[.5, 1]]}\n', "line 2"),
        (HEADER + b'{"width": 1, "points": [[+5, 1]]}\n', "line 2"),
        (HEADER + b'{"width": 1, "points": [[--5, 1]]}\n', "line 2"),
        (HEADER + b'{"width": 1, "points": [[-, 1]]}\n', "line 2"),
        (HEADER + b'{"width": 1, "points": [[1 1]]}\n', "line 2"),
        (HEADER + b'{"width": 1, "points": [[1, 1],]}\n', "line 2"),
        (HEADER + b'{"width": -1, "points": [[1, 1]]}\n', "line 2: width is -1"),
        (HEADER + b'{"width": 0, "points": [[1, 1]]}\n', "line 2: width is 0"),
        (HEADER + b'{"width": "1", "points": [[1, 1]]}\n', 'line 2: width is "1"'),
        (HEADER + b'{"width": 1, "width": 1, "points": [[1, 1]]}\n', "line 2"),
        (HEADER + b'{"width": 1, "points": [[1, 1]]} {"width": 1, "points": [[1, 1]]}\n', "line 2"),
        (HEADER + b'{"width": 1, "points": [[1, 1]]}\r{"width": 1, "points": [[1, 1]]}\n', "line 2"),
        (HEADER + b'{"width": 1,\n"points": [[1, 1]]}\n', "line 2"),
        (b"\xef\xbb\xbf" + HEADER, "line 1"),
        (HEADER + b'{"width": 1, "points": [[1, 1]], "a": "\xff"}\n', "line 2"),
        (HEADER.decode().encode("utf-16"), "line 1"),
    ],
)
def test_refused(text, complaint):
    with pytest.raises(FormatError) as refused:
        read(text)
    assert complaint in str(refused.value)
    assert str(refused.value).startswith("a.strokes.jsonl: ")
    assert "\n" not in str(refused.value)


def test_a_line_separator_does_not_end_a_line():
    text = HEADER[:-2] + ', "layer": "a\u2028b"}\n'.encode()
    assert read(text + b'{"width": 1, "points": [[1, 2]], "note": "\xe2\x80\xa8"}\n').layer == "a\u2028b"


def test_line_numbers_hold_over_blocks(monkeypatch):
    monkeypatch.setattr(strokes, "BLOCK", 37)
    good = b'{"width": 1, "points": [[1, 1]]}\n'
    other = b'{"points": [[1, 1]], "width": 1}\n'
    assert len(read(HEADER + (good + other) * 50)) == 100
    with pytest.raises(FormatError, match="line 102: width is 0"):
        read(HEADER + (good + other) * 50 + b'{"width": 0, "points": [[1, 1]]}\n')


def test_a_line_without_end_is_refused_before_it_is_held():
    class Endless:
        asked = 0

        def read(self, size):
            self.asked += size
            return HEADER + b"[" * (size - len(HEADER)) if self.asked == size else b"[" * size

    stream = Endless()
    with pytest.raises(FormatError, match="line 2: longer than"):
        strokes.read(stream, "-")
    assert stream.asked < 3 * strokes.MAX_LINE


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf, 1.1e7])
def test_what_cannot_be_written_is_refused(wrong):
    good = Strokes(9, 9, np.zeros((2, 2)), np.array([0, 1, 2]), np.ones(2))
    bad = Strokes(9, 9, np.array([[0, 0], [wrong, 0]]), np.array([0, 1, 2]), np.ones(2))
    writer = strokes.Writer(io.BytesIO(), 9, 9)
    writer.add(good)
    with pytest.raises(ParameterError, match="stroke 3:"):
        writer.add(bad)
    with pytest.raises(ParameterError, match="points in width"):
        strokes.Writer(io.BytesIO(), wrong, 9)


def test_a_width_is_never_written_as_nothing():
    s = read(written(Strokes(9, 9, np.zeros((1, 2)), np.array([0, 1]), np.array([1e-9]))))
    assert s.widths[0] > 0


@pytest.mark.parametrize("name", ["layer", "texture"])
def test_a_text_that_is_not_utf8_is_not_written(name):
    out = io.BytesIO()
    with pytest.raises(ParameterError, match=f'{name} "a.*udcff" is not UTF-8'):
        strokes.write(out, Strokes(9, 9, **{name: "a\udcff"}))
    assert not out.getvalue()


@pytest.mark.parametrize("dpi", [1e-6, 0.0004, 0.001, 600.0, 1e7])
def test_any_printer_that_is_read_is_written_so_that_it_can_be_read(dpi):
    out = io.BytesIO()
    strokes.write(out, Strokes(9, 9, device_dpi=dpi))
    again = strokes.read(io.BytesIO(out.getvalue()), "x").device_dpi
    assert again == pytest.approx(dpi, abs=0.001)
