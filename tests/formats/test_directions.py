"""Direction fields: three PGM images in one stream, and what is refused of them."""

from __future__ import annotations

import io

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from penink_cli.formats import directions
from penink_cli.ground.errors import FormatError, LimitError
from penink_cli.ground.model import Directions
from penink_cli.options.inputs import read_directions
from tests.formats.readers import written

PLANE = b"P5 2 1 254\n"


def read(data: bytes, max_pixels: int = 1000) -> Directions:
    return directions.read(io.BytesIO(data), "d.pgm", max_pixels)


def test_the_example_of_the_documentation_is_read():
    field = read(PLANE + b"\xfe\x00" + b"P5 #two bytes\n2 1 1000\n\x01\xf4\x03\xe8" + b"P5 2 1 255\n\x00\xffrest")
    assert field.cos2.tolist() == [[1, -1]] and field.sin2.tolist() == [[0, 1]]
    assert field.confidence.tolist() == [[0, 1]]


REFUSED = {
    "nothing": (b"", "not a direction field: it is empty"),
    "text": (b"hello", "not a direction field: begins with 'he', not P5"),
    "plain": (b"P2 2 1 254 1 2", "cos 2θ: begins with 'P2', not P5; a field is three raw PGM images"),
    "a PNG": (b"\x89PNG\r\n\x1a\n", "not a direction field but a PNG photograph"),
    "one image": (PLANE + b"\x00\x00", "sin 2θ: is missing"),
    "two images": (2 * (PLANE + b"\x00\x00"), "confidence: is missing"),
    "something between": (PLANE + b"\x00\x00\n" + PLANE, r"sin 2θ: begins with '\nP', not P5"),
    "another size second": (PLANE + b"\x00\x00P5 1 2 254\n\x00\x00", "sin 2θ: 1 x 2 samples; cos 2θ has 2 x 1"),
    "another size third": (2 * (PLANE + b"\x00\x00") + b"P5 1 1 99\n1", "confidence: 1 x 1 samples; cos 2θ has 2 x 1"),
    "first cut short": (PLANE + b"\x00", "cos 2θ: truncated: 1 of 2 raster bytes"),
    "third cut short": (2 * (PLANE + b"\x00\x00") + PLANE + b"\x09", "confidence: truncated: 1 of 2 raster bytes"),
    "third without raster": (2 * (PLANE + b"\x00\x00") + b"P5 2 ", "confidence: truncated: ends before its height"),
    "a value above maxval": (PLANE + b"\x00\xff", "cos 2θ: row 1, value 2 is 255; maxval is 254"),
    "no confidence": (3 * (PLANE + b"\x00\x00"), "confidence: it is 0 everywhere"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_is_refused(name):
    data, complaint = REFUSED[name]
    with pytest.raises(FormatError) as caught:
        read(data)
    assert str(caught.value).startswith("d.pgm: ") and complaint in str(caught.value)


def test_size_is_checked_before_anything_is_taken():
    with pytest.raises(LimitError, match="cos 2θ: declares 1000 x 1000 pixels; at most 1000"):
        read(b"P5 1000 1000 255\n")


@given(st.lists(st.tuples(st.integers(-180, 180), st.integers(1, 9)), min_size=1, max_size=12))
def test_what_is_written_is_read_to_a_third_of_a_degree(samples):
    angle, confidence = (np.array([column], float) for column in zip(*samples, strict=True))
    angle = np.deg2rad(angle)
    field = Directions(np.cos(2 * angle), np.sin(2 * angle), confidence / 9)
    data = written(directions.write, field)
    back = read(data)
    apart = np.rad2deg(np.arctan2(back.sin2, back.cos2) - 2 * angle) / 2
    assert np.abs((apart + 90) % 180 - 90).max() < 0.33
    assert np.abs(back.confidence - field.confidence).max() <= 0.5 / 254
    assert written(directions.write, back) == data  # and what has been read is written as it was


def test_a_field_of_no_confidence_is_not_written():
    with pytest.raises(FormatError, match="0 everywhere"):
        written(directions.write, Directions(np.ones((1, 1)), np.zeros((1, 1)), np.full((1, 1), 0.001)))


@pytest.mark.parametrize(
    ("width", "height", "fits"),
    [(96, 64, True), (451, 300, True), (3, 2, True), (4000, 2667, True), (64, 96, False), (96, 70, False)],
)
def test_a_field_of_another_shape_is_refused(width, height, fits, tmp_path):
    plane = np.ones((64, 96))
    file = tmp_path / "d.pgm"
    file.write_bytes(written(directions.write, Directions(plane, plane * 0, plane)))
    if fits:
        assert read_directions(str(file), width, height, 10_000).cos2.shape == (64, 96)
    else:
        with pytest.raises(FormatError, match=f"of 96 x 64 samples; the picture has {width} x {height} pixels"):
            read_directions(str(file), width, height, 10_000)
