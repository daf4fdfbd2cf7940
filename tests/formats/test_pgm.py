"""PGM by the Netpbm definition: what is read, what is refused, what is kept exactly."""

from __future__ import annotations

import io

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from penink_cli.formats import pgm
from penink_cli.ground.errors import FormatError, LimitError
from penink_cli.ground.model import GreyImage
from tests.formats.readers import written


def read(data: bytes, max_pixels: int = 10_000) -> GreyImage:
    return pgm.read(io.BytesIO(data), "x.pgm", max_pixels)


ACCEPTED = {
    "raw": (b"P5 2 1 255\n\x00\xff", [[0, 255]], 255),
    "plain": (b"P2\n2 1\n255\n0 255\n", [[0, 255]], 255),
    "plain without a last newline": (b"P2 2 1 255 0 255", [[0, 255]], 255),
    "plain on one line a value": (b"P2 2 2 9\n0\n1\n2\n3", [[0, 1], [2, 3]], 9),
    "plain with trailing white space": (b"P2 1 1 9 7 \t\r\n\n", [[7]], 9),
    "plain with leading zeros": (b"P2 1 1 0009 00000000000000000000000007", [[7]], 9),
    "plain with a comment in the raster": (b"P2 2 1 9 1 # one\n 2 # two", [[1, 2]], 9),
    "maxval 1": (b"P5 2 1 1\n\x00\x01", [[0, 1]], 1),
    "maxval 100": (b"P5 2 1 100\n\x00\x64", [[0, 100]], 100),
    "maxval 256 takes two bytes": (b"P5 2 1 256\n\x00\x01\x01\x00", [[1, 256]], 256),
    "maxval 65535": (b"P5 2 1 65535\n\xff\xff\x01\x02", [[65535, 258]], 65535),
    "comments between the words": (b"P5#c\n 2 #c\n1 #c\r#d\n255\n\x01\x02", [[1, 2]], 255),
    "a comment within a number is as if it were not there": (b"P5 1#c\n0 1 255\n0123456789", [[*b"0123456789"]], 255),
    "a comment before the raster does not replace its white space": (b"P5 2 1 255#c\n\n\x01\x02", [[1, 2]], 255),
    "a raster that begins like a comment": (b"P5 2 1 255\n#\n", [[35, 10]], 255),
    "a raster that begins with white space": (b"P5 3 1 255\n\n \t", [[10, 32, 9]], 255),
    "carriage return before the raster": (b"P5 2 1 255\r\n\x01", [[10, 1]], 255),
    "white space of all kinds": (b"P5\t\r\n 2\r\n1\t255 \x01\x02", [[1, 2]], 255),
    "bytes after the raster": (b"P5 1 1 255\n\x07P5 9 9", [[7]], 255),
    "a second image": (b"P5 1 1 255\n\x07P5 1 1 255\n\x08", [[7]], 255),
}

REFUSED = {
    "nothing": (b"", "empty"),
    "half a magic number": (b"P", "not a PGM"),
    "a bitmap": (b"P4 8 1\n\x00", "not a PGM"),
    "a pixmap": (b"P6 1 1 255\n\x00\x00\x00", "not a PGM"),
    "lower case": (b"p5 1 1 255\n\x00", "not a PGM"),
    "white space first": (b" P5 1 1 255\n\x00", "not a PGM"),
    "a byte order mark first": (b"\xef\xbb\xbfP2 1 1 255 0", "not a PGM"),
    "magic alone": (b"P5", "before its width"),
    "no height": (b"P5 2", "before its width"),
    "a header alone": (b"P5 2 1 255", "before its maxval"),
    "no white space after the magic": (b"P52 1 255\n\x00\x00", "width"),
    "a comment is no white space": (b"P5#c\n2 1 255\n\x00\x00", "width"),
    "width 0": (b"P5 0 1 255\n", "width is 0"),
    "height 0": (b"P5 1 0 255\n", "height is 0"),
    "maxval 0": (b"P5 1 1 0\n\x00", "maxval is 0"),
    "maxval 65536": (b"P5 1 1 65536\n\x00\x00", "maxval is 65536"),
    "a negative width": (b"P5 -2 1 255\n\x00\x00", "width"),
    "a plus sign": (b"P5 +2 1 255\n\x00\x00", "width"),
    "a fraction": (b"P5 2.0 1 255\n\x00\x00", "width"),
    "hexadecimal": (b"P5 0x2 1 255\n\x00\x00", "width"),
    "a letter in maxval": (b"P5 1 1 25S\n\x00", "maxval"),
    "digits of another script": ("P2 1 1 ٩ 0".encode(), "maxval"),
    "form feed is no white space": (b"P5 1\x0c1 255\n\x00", "width"),
    "null in the header": (b"P5 1\x001 255\n\x00", "width"),
    "no raster": (b"P5 2 2 255\n", "truncated: 0 of 4 raster bytes"),
    "one byte short": (b"P5 2 2 255\n\x00\x00\x00", "truncated: 3 of 4 raster bytes"),
    "half a value short": (b"P5 2 1 65535\n\x00\x00\x00", "truncated: 3 of 4 raster bytes"),
    "a value above maxval": (b"P5 2 2 100\n\x00\x00\x00\x65", "row 2, value 2 is 101; maxval is 100"),
    "a 16-bit value above maxval": (b"P5 1 1 256\n\x01\x01", "is 257; maxval is 256"),
    "plain, one value short": (b"P2 2 2 9 1 2 3", "truncated: 3 of 4"),
    "plain, one value more": (b"P2 2 2 9 1 2 3 4 5", "more than 4"),
    "plain, a second image": (b"P2 1 1 9 1 P2 1 1 9 1", "found 'P'"),
    "plain, a value above maxval": (b"P2 2 1 9 1 10", "row 1, value 2 is 10; maxval is 9"),
    "plain, a value beyond 64 bits": (b"P2 1 1 9 99999999999999999999999999", "maxval is 9"),
    "plain, a negative value": (b"P2 2 1 9 1 -1", "found '-'"),
    "plain, a fraction": (b"P2 2 1 9 1 1.5", "found '.'"),
    "plain, an exponent": (b"P2 2 1 9 1 1e0", "found 'e'"),
    "plain, a letter": (b"P2 2 1 9 1 x", "found 'x'"),
    "plain, a null": (b"P2 2 1 9 1 2\x00", r"found '\x00'"),
    "text": (b"hello world\n", "not a PGM"),
    "a PNG": (b"\x89PNG\r\n\x1a\n", "not a PGM"),
    "gzip": (b"\x1f\x8b\x08\x00", "not a PGM"),
}


@pytest.mark.parametrize("name", ACCEPTED)
def test_is_read(name):
    data, values, maxval = ACCEPTED[name]
    image = read(data)
    assert image.values.tolist() == values and image.maxval == maxval
    assert image.values.dtype == (np.uint8 if maxval < 256 else np.uint16)
    assert image.values.dtype.isnative and image.values.flags.c_contiguous


@pytest.mark.parametrize("name", REFUSED)
def test_is_refused(name):
    data, complaint = REFUSED[name]
    with pytest.raises(FormatError) as caught:
        read(data)
    assert complaint in str(caught.value) and str(caught.value).startswith("x.pgm: ")


@pytest.mark.parametrize("size", [b"1000000000 1000000000", b"10001 1", b"1 10001", b"999999999999999 1"])
@pytest.mark.parametrize("magic", [b"P2", b"P5"])
def test_declared_size_is_checked_before_anything_is_taken(magic, size):
    with pytest.raises(LimitError, match=r"at most 10000 are allowed \(--max-pixels\)"):
        read(magic + b" " + size + b" 255\n")


@pytest.mark.parametrize("start", [b"P5 #", b"P5 ", b"P5 1 1 255 #"[:-2] + b"#", b"P5 000"])
def test_a_header_without_end_ends(start):
    endless = start + (b"#" if start.endswith(b"#") else start[-1:]) * (pgm.MAX_HEADER + 10)
    with pytest.raises(FormatError, match="header is longer"):
        read(endless)


def test_a_number_without_end_ends():
    with pytest.raises(FormatError, match="more than"):
        read(b"P5 " + b"1" * 5000 + b" 1 255\n")
    with pytest.raises(FormatError, match="digits"):
        read(b"P2 1 1 255 " + b"0" * (3 * pgm.BAND))


sizes = st.integers(1, 9)


@st.composite
def images(draw):
    maxval = draw(st.sampled_from([1, 2, 100, 254, 255, 256, 257, 1000, 65534, 65535]) | st.integers(1, 65535))
    width, height = draw(sizes), draw(sizes)
    values = draw(st.lists(st.integers(0, maxval), min_size=width * height, max_size=width * height))
    return GreyImage(np.array(values, np.uint8 if maxval < 256 else np.uint16).reshape(height, width), maxval)


def same(a: GreyImage, b: GreyImage) -> bool:
    return a.maxval == b.maxval and a.values.dtype == b.values.dtype and np.array_equal(a.values, b.values)


@given(images())
def test_what_is_written_is_read_as_it_was(image):
    data = written(pgm.write, image)
    assert same(read(data), image)
    assert data == pgm.header(*image.values.shape[::-1], image.maxval) + bytes(pgm.rows(image.values, image.maxval))


@given(
    images(), st.lists(st.sampled_from([b" ", b"\n", b"\t", b"\r\n", b" # c 9\n", b"\n#\r\n"]), min_size=4), st.data()
)
def test_plain_and_raw_say_the_same_whatever_separates_their_words(image, blanks, data):
    height, width = image.values.shape
    gap = lambda: data.draw(st.sampled_from([*blanks]))  # noqa: E731
    white = lambda: gap().replace(b"#", b"#x") + b" "  # noqa: E731
    header = b"%s%d%s%d%s%d" % (white(), width, white(), height, white(), image.maxval)
    raster = b"".join(b"%d%s" % (v, gap()) for v in image.values.ravel())
    assert same(read(b"P2" + header + b" " + raster), image)
    assert same(read(b"P5" + header + b" " + bytes(pgm.rows(image.values, image.maxval))), image)


@settings(max_examples=20)
@given(images(), st.integers(1, 40))
def test_bands_of_any_size_read_alike(image, band):
    """Numbers and comments that a band's end cuts in two are whole again."""
    plain = b"P2 %d %d %d #x 1\n" % (*image.values.shape[::-1], image.maxval)
    plain += b"".join(b"%d # 12 \n" % v for v in image.values.ravel())
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pgm, "BAND", band)
        assert same(read(plain), image)
        assert same(read(written(pgm.write, image)), image)


@given(images(), st.integers(0, 200))
def test_every_prefix_is_refused(image, cut):
    data = written(pgm.write, image)
    with pytest.raises(FormatError):
        read(data[: min(cut, len(data) - 1)])


@pytest.mark.parametrize("maxval", [255, 1000])
@pytest.mark.parametrize(("width", "height"), [(7, 5), (8, 4), (1, 90), (90, 1), (30, 3)])
def test_a_large_image_is_read_as_means(width, height, maxval):
    values = np.random.default_rng(5).integers(0, maxval + 1, (height, width))
    data = b"P5 %d %d %d\n" % (width, height, maxval) + values.astype(">u2" if maxval > 255 else np.uint8).tobytes()
    found = pgm.read_at_most(io.BytesIO(data), "x", 1000, 12).values
    k = next(k for k in range(1, 99) if width * height <= 12 * k * k)
    assert found.shape == (-(-height // k), -(-width // k)) and k > 1
    for (i, j), value in np.ndenumerate(found):
        part = values[i * k : (i + 1) * k, j * k : (j + 1) * k]
        assert value == int(np.floor(part.mean() + 0.5 + 1e-9))
    assert np.array_equal(pgm.read_at_most(io.BytesIO(data), "x", 1000, 1000).values, values)
    with pytest.raises(LimitError, match="at most 11 are allowed"):
        pgm.read_at_most(io.BytesIO(data), "x", 11, 5)
    with pytest.raises(FormatError, match="truncated"):
        pgm.read_at_most(io.BytesIO(data[:-1]), "x", 1000, 12)
    plain = b"P2 1 2 9\n1 2\n"
    assert pgm.read_at_most(io.BytesIO(plain), "x", 1000, 12).values.tolist() == [[1], [2]]
