"""Photographs: every format and depth to the grey that its pixels say, and no damaged one taken for whole."""

from __future__ import annotations

import io
import os
import struct
import zlib

import numpy as np
import pytest
import skimage.data
from PIL import Image

from penink_cli.formats import pgm, photo
from penink_cli.formats.photo import png as png_reader
from penink_cli.ground.errors import FormatError, LimitError, PeninkError
from penink_cli.ground.model import ColourImage, GreyImage
from tests.formats.readers import written

WIDTH, HEIGHT = 7, 5
RNG = np.random.default_rng(8)
GREY = RNG.integers(0, 256, (HEIGHT, WIDTH), np.uint8)
DEEP = RNG.integers(0, 65536, (HEIGHT, WIDTH), np.uint16)
COLOUR = RNG.integers(0, 256, (HEIGHT, WIDTH, 3), np.uint8)
ALPHA = RNG.integers(0, 256, (HEIGHT, WIDTH), np.uint8)
FORMATS = ("PNG", "TIFF", "WEBP", "JPEG")


def read(data: bytes, max_pixels: int = 10_000) -> GreyImage:
    """The grey; every test that asks for it asks the same of the colours."""
    grey = photo.read_grey(io.BytesIO(data), "p.img", max_pixels)
    found = photo.read_colours(io.BytesIO(data), "p.img", max_pixels)
    again = photo.grey_of(found) if isinstance(found, ColourImage) else found
    assert again.maxval == grey.maxval and np.array_equal(again.values, grey.values)
    return grey


def saved(image: Image.Image, kind: str, **options: object) -> bytes:
    out = io.BytesIO()
    lossless = {"WEBP": {"lossless": True, "exact": True}, "JPEG": {"quality": 100, "subsampling": 0}}.get(kind, {})
    image.save(out, kind, **{**lossless, **options})
    return out.getvalue()


def luma(colour: np.ndarray) -> np.ndarray:
    """Rec. 601, slowly: 0.299 R + 0.587 G + 0.114 B to the nearest whole number."""
    return np.array([[0.299 * r + 0.587 * g + 0.114 * b for r, g, b in row] for row in colour.tolist()])


def on_white(values: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    a = alpha[..., None] / 255.0 if values.ndim == 3 else alpha / 255.0
    return values * a + 255 * (1 - a)


def close(image: GreyImage, expected: np.ndarray, within: float = 0.501) -> bool:
    return image.values.shape == expected.shape and float(np.abs(image.values - expected).max()) <= within


@pytest.mark.parametrize("kind", ("PNG", "TIFF", "PPM"))
def test_8_bit_grey_is_kept(kind):
    image = read(saved(Image.fromarray(GREY), kind))
    assert image.maxval == 255 and np.array_equal(image.values, GREY)


@pytest.mark.parametrize("kind", ("PNG", "TIFF"))
def test_16_bit_grey_is_kept(kind):
    image = read(saved(Image.fromarray(DEEP), kind))
    assert image.maxval == 65535 and image.values.dtype == np.uint16 and np.array_equal(image.values, DEEP)


@pytest.mark.parametrize("maxval", [1, 100, 255, 1000, 65535])
def test_pgm_keeps_its_maxval(maxval):
    given = GreyImage((DEEP.astype(int) % (maxval + 1)).astype(np.uint8 if maxval < 256 else np.uint16), maxval)
    image = read(written(pgm.write, given))
    assert image.maxval == maxval and np.array_equal(image.values, given.values)


@pytest.mark.parametrize("kind", (*FORMATS, "PPM"))
def test_colour_becomes_luma(kind):
    image = read(saved(Image.fromarray(COLOUR), kind))
    assert image.maxval == 255 and close(image, luma(COLOUR), 3 if kind == "JPEG" else 0.501)


@pytest.mark.parametrize("kind", ("PNG", "TIFF", "WEBP", "PPM"))
def test_colours_are_kept(kind):
    found = photo.read_colours(io.BytesIO(saved(Image.fromarray(COLOUR), kind)), "p.img", 10_000)
    assert isinstance(found, ColourImage) and found.maxval == 255 and np.array_equal(found.values, COLOUR)


@pytest.mark.parametrize("maxval", [1, 100, 255, 1000, 65535])
@pytest.mark.parametrize("magic", ["P3", "P6"])
def test_a_pixmap_of_any_maxval_becomes_luma_of_that_maxval(magic, maxval):
    colour = np.stack([DEEP, DEEP[::-1], DEEP[:, ::-1]], axis=2).astype(int) % (maxval + 1)
    stored = colour.astype(">u2" if maxval > 255 else np.uint8).tobytes()
    raster = stored if magic == "P6" else " ".join(map(str, colour.ravel().tolist())).encode()
    image = read(f"{magic} {WIDTH} {HEIGHT} {maxval}\n".encode() + raster)
    assert image.maxval == maxval and close(image, luma(colour))


@pytest.mark.parametrize("kind", ("PNG", "TIFF", "WEBP"))
def test_transparency_lies_on_white(kind):
    image = read(saved(Image.fromarray(np.dstack([COLOUR, ALPHA])), kind))
    assert close(image, luma(on_white(COLOUR, ALPHA)), 1.0)


def test_transparency_of_grey_lies_on_white():
    image = read(saved(Image.fromarray(np.dstack([GREY, ALPHA])), "PNG"))
    assert close(image, on_white(GREY, ALPHA), 1.0)


@pytest.mark.parametrize(
    ("image", "clear", "expected"),
    [
        (Image.fromarray(GREY), int(GREY[0, 0]), np.where(GREY[0, 0] == GREY, 255, GREY)),
        (Image.fromarray(DEEP), int(DEEP[0, 0]), np.where(DEEP[0, 0] == DEEP, 65535, DEEP)),
        (Image.fromarray(COLOUR), tuple(map(int, COLOUR[0, 0])), None),
    ],
    ids=["grey", "16-bit grey", "colour"],
)
def test_the_one_transparent_value_of_a_png_is_white(image, clear, expected):
    if expected is None:
        expected = luma(COLOUR)
        expected[0, 0] = 255
    assert close(read(saved(image, "PNG", transparency=clear)), expected)


def test_palettes_with_and_without_transparency():
    indices = (GREY % 4).astype(np.uint8)
    image = Image.frombytes("P", (WIDTH, HEIGHT), indices.tobytes())
    colours = np.array([[255, 0, 0], [0, 255, 0], [0, 0, 255], [9, 9, 9]], np.uint8)
    image.putpalette(colours.tobytes())
    assert close(read(saved(image, "PNG")), luma(colours[indices]))
    alphas = np.array([0, 255, 128, 255], np.uint8)
    transparent = read(saved(image, "PNG", transparency=bytes(alphas)))
    assert close(transparent, luma(on_white(colours[indices], alphas[indices])), 1.0)


@pytest.mark.parametrize("kind", ("PNG", "TIFF"))
def test_bilevel(kind):
    bits = GREY > 127
    assert np.array_equal(read(saved(Image.fromarray(bits), kind)).values, bits * 255)


@pytest.mark.parametrize("kind", ("TIFF", "JPEG"))
def test_inks(kind):
    """Neither format says what the inks look like: paper is white and the deepest black is black."""
    inks = np.zeros((16, 16, 4), np.uint8)
    inks[8:, :, 3] = 255
    grey = read(saved(Image.fromarray(inks, "CMYK"), kind)).values
    assert grey[:7].min() >= 253 and grey[9:].max() <= 2


@pytest.mark.parametrize("orientation", range(1, 9))
@pytest.mark.parametrize("kind", FORMATS)
def test_the_orientation_is_applied(kind, orientation):
    """The picture as it should be seen, stored as each orientation stores it."""
    scene = np.full((16, 24), 255, np.uint8)
    scene[:8, :8] = 0  # dark top left
    scene[8:, 16:] = 128
    undo = {
        1: lambda a: a,
        2: lambda a: a[:, ::-1],
        3: lambda a: a[::-1, ::-1],
        4: lambda a: a[::-1],
        5: lambda a: a.T,
        6: lambda a: np.rot90(a, 1),
        7: lambda a: a[::-1, ::-1].T,
        8: lambda a: np.rot90(a, -1),
    }
    exif = Image.Exif()
    exif[0x0112] = orientation
    stored = Image.fromarray(np.ascontiguousarray(undo[orientation](scene)))
    assert close(read(saved(stored.convert("RGB"), kind, exif=exif)), scene.astype(float), 3)


@pytest.mark.parametrize("compression", [None, "tiff_lzw", "tiff_adobe_deflate", "packbits"])
def test_compressed_tiff(compression):
    assert close(read(saved(Image.fromarray(COLOUR), "TIFF", compression=compression)), luma(COLOUR))
    deep = read(saved(Image.fromarray(DEEP), "TIFF", compression=compression))
    assert deep.maxval == 65535 and np.array_equal(deep.values, DEEP)


@pytest.mark.parametrize("kind", ("TIFF", "WEBP", "PNG"))
def test_the_first_of_several_pictures(kind):
    more = {"save_all": True, "append_images": [Image.fromarray(COLOUR[::-1])]}
    assert close(read(saved(Image.fromarray(COLOUR), kind, **more)), luma(COLOUR))


def tiff(tags: dict[int, tuple[int, int]], raster: bytes) -> bytes:
    """A little-endian TIFF of one strip; tags are tag: (type, value)."""
    tags = {
        256: (4, WIDTH),
        257: (4, HEIGHT),
        259: (3, 1),
        277: (3, 1),
        278: (4, HEIGHT),
        279: (4, len(raster)),
        **tags,
    }
    tags[273] = (4, 8 + 2 + 12 * (len(tags) + 1) + 4)
    entries = b"".join(struct.pack("<HHII", tag, kind, 1, value) for tag, (kind, value) in sorted(tags.items()))
    return b"II*\x00" + struct.pack("<IH", 8, len(tags)) + entries + bytes(4) + raster


@pytest.mark.parametrize("bits", [8, 16])
def test_tiff_in_which_zero_is_white(bits):
    given, top = (GREY, 255) if bits == 8 else (DEEP, 65535)
    for photometric, expected in ((1, given), (0, top - given)):
        image = read(tiff({258: (3, bits), 262: (3, photometric)}, given.astype(f"<u{bits // 8}").tobytes()))
        assert image.maxval == top and np.array_equal(image.values, expected)


# ------------------------------------------------------------------------ refusals


def png(width: int, height: int, rows: bytes, bits: int = 8, colour: int = 0, interlace: int = 0) -> bytes:
    def chunk(name: bytes, content: bytes) -> bytes:
        return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))

    header = struct.pack(">IIBBBBB", width, height, bits, colour, 0, 0, interlace)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def test_what_libtiff_says_is_not_said_twice(capfd):
    data = bytearray(saved(Image.fromarray(COLOUR), "TIFF", compression="tiff_adobe_deflate"))
    data[20:40] = bytes(20)
    with pytest.raises(FormatError, match="damaged TIFF"):
        read(bytes(data))
    assert capfd.readouterr().err == ""


def test_a_tiff_whose_planes_pillow_would_mix_up():
    tags = {258: (3, 16), 262: (3, 2), 277: (3, 3), 284: (3, 2)}
    with pytest.raises(FormatError, match="separate planes"):
        read(tiff(tags, DEEP.astype("<u2").tobytes() * 3))


def test_a_png_one_row_short():
    row = b"\x00" + b"\x80" * 4
    assert read(png(4, 3, row * 3)).values.tolist() == [[128] * 4] * 3
    with pytest.raises(FormatError, match=r"p.img: truncated: 10 of 15 bytes of PNG rows"):
        read(png(4, 3, row * 2))


@pytest.mark.parametrize(
    ("bits", "colour"), [(1, 0), (2, 0), (4, 0), (8, 2), (16, 2), (8, 4), (16, 4), (16, 6), (16, 0)]
)
@pytest.mark.parametrize("interlace", [0, 1])
def test_the_rows_of_a_png_of_any_kind_are_counted(bits, colour, interlace):
    """The rows that each pass has by the definition, and not a byte less."""
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[colour]
    width, height = 5, 6
    passes = png_reader.PASSES if interlace else ((0, 0, 1, 1),)
    whole = 0
    for x, y, step_x, step_y in passes:
        columns, lines = len(range(x, width, step_x)), len(range(y, height, step_y))
        whole += lines * (1 + (columns * channels * bits + 7) // 8) if columns else 0
    assert read(png(width, height, bytes(whole), bits, colour, interlace)).values.shape == (height, width)
    with pytest.raises(FormatError, match="truncated"):
        read(png(width, height, bytes(whole - 1), bits, colour, interlace))


@pytest.mark.parametrize("kind", (*FORMATS, "PPM"))
@pytest.mark.parametrize("part", [0.02, 0.1, 0.5, 0.9])
def test_a_photograph_cut_short(kind, part):
    smooth = Image.fromarray(np.add.outer(np.arange(64), np.arange(96)).astype(np.uint8)).convert("RGB")
    data = saved(smooth, kind)
    with pytest.raises(FormatError):
        read(data[: int(part * len(data))])


@pytest.mark.parametrize("kind", ("TIFF", "PPM"))
def test_a_photograph_one_byte_short(kind):
    data = saved(Image.fromarray(COLOUR), kind)
    with pytest.raises(FormatError):
        read(data[:-1])


@pytest.mark.parametrize("kind", ("PNG", "JPEG", "WEBP"))
def test_a_photograph_without_its_end_is_whole_as_long_as_its_pixels_are(kind):
    """The last byte of these carries no pixel: a line is said, and --strict refuses."""
    data = saved(Image.fromarray(COLOUR), kind)
    lines = []
    cut = photo.read_grey(io.BytesIO(data[:-1]), "p.img", 10_000, say=lines.append)
    assert np.array_equal(cut.values, read(data).values)
    assert len(lines) == 1 and lines[0].startswith("p.img: ")
    with pytest.raises(FormatError):
        photo.read_grey(io.BytesIO(data[:-1]), "p.img", 10_000, photo.Choices(damage="strict"))


@pytest.mark.parametrize(
    ("options", "found"), [({}, 0.9), ({"restart_marker_rows": 1}, 0.9), ({"progressive": True}, 0.65)], ids=str
)
def test_damage_within_a_jpeg(options, found):
    """There is no checksum, but a piece cut out puts the codes out of step, and an end moved up leaves blocks over."""
    data = saved(Image.fromarray(skimage.data.chelsea()), "JPEG", quality=85, subsampling=2, **options)
    assert read(data, 10**6).values.shape == (300, 451)
    places = np.linspace(len(data) / 5, len(data) - 200, 60).astype(int)
    refused = 0
    for at in places:
        if "progressive" not in options:  # there an early end is a coarser picture, and allowed
            with pytest.raises(FormatError, match=r"p.img: (damaged JPEG|truncated)"):
                read(data[:at] + b"\xff\xd9", 10**6)
        try:
            read(data[:at] + data[at + 100 :], 10**6)
        except FormatError:
            refused += 1
    assert refused >= found * len(places)


@pytest.mark.parametrize("fill", [b"\0" * 40, b"\xff" * 9, b"\x12\x34"])
def test_a_jpeg_filled_up_by_its_camera_is_read(fill):
    data = saved(Image.fromarray(COLOUR), "JPEG")
    assert np.array_equal(read(data[:-2] + fill + data[-2:]).values, read(data).values)
    assert np.array_equal(read(data + fill + b"\xff\xd9 a trailer").values, read(data).values)


def test_any_damage_to_a_png_is_found():
    data = saved(Image.fromarray(COLOUR), "PNG")
    for at in range(len(data)):
        damaged = bytearray(data)
        damaged[at] ^= 0x10
        if at >= len(data) - 12:  # the end, which has no pixels
            assert close(read(bytes(damaged)), luma(COLOUR))
            continue
        with pytest.raises(PeninkError):
            read(bytes(damaged))
    assert close(read(data + b"and more"), luma(COLOUR))


@pytest.mark.parametrize("kind", FORMATS)
def test_more_pixels_than_allowed(kind):
    data = saved(Image.new("L", (200, 60)), kind)
    assert read(data, 12_000).values.shape == (60, 200)
    with pytest.raises(
        LimitError, match=r"p.img: declares 200 x 60 pixels; at most 11999 are allowed \(--max-pixels\)"
    ):
        read(data, 11_999)


def test_a_small_file_that_declares_a_huge_picture():
    for width, height in ((2**31 - 1, 2**31 - 1), (10**9, 10**9), (100_001, 1000)):
        with pytest.raises(PeninkError):
            read(png(width, height, b""), 10**8)


@pytest.mark.parametrize(
    "start", [b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff", b"II*\x00\x08\x00\x00\x00", b"RIFF\x00\x00\x00\x00WEBP"]
)
def test_a_stream_of_nothing_that_only_begins_like_a_photograph_is_not_read_to_its_end(start):
    class Endless(io.BytesIO):
        def read(self, size: int = -1) -> bytes:
            return super().read(size) or bytes(size)

    stream = Endless(start)
    with pytest.raises(FormatError, match="its header makes no sense"):
        photo.read_grey(stream, "p.img", 10**9)


def test_a_long_photograph_is_read():
    """Longer than what is looked at in advance: many pages, or much metadata."""
    pages = {"save_all": True, "append_images": [Image.new("RGB", (900, 900))] * 8}
    data = saved(Image.fromarray(COLOUR), "TIFF", **pages)
    assert len(data) > photo.METADATA and close(read(data, 10**6), luma(COLOUR))
    first = saved(Image.new("RGB", (3000, 2000), (9, 99, 199)), "TIFF")
    assert len(first) > photo.METADATA and read(first, 10**7).values.shape == (2000, 3000)


def test_a_bomb_of_compressed_rows_is_not_blown_up():
    assert read(png(10, 10, bytes(10**8))).values.shape == (10, 10)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\x89",
        b"P",
        b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 10 10\n",
        b"\xc5\xd0\xd3\xc6" + bytes(40),
        b"%PDF-1.7\n",
        b"BM" + bytes(60),
        b"RIFF\x10\x00\x00\x00WAVEfmt ",
        b"<svg xmlns='http://www.w3.org/2000/svg'/>",
        b"\x00\x00\x00\x0cjP  \r\n\x87\n",
        b'{"format": "penink-edges"}',
        b"hello\n",
    ],
    ids=lambda data: repr(data[:8]),
)
def test_no_other_format_is_a_photograph(data, monkeypatch):
    monkeypatch.setattr(os, "system", lambda *_: pytest.fail("a program was started"))
    monkeypatch.setattr("subprocess.Popen", lambda *_, **__: pytest.fail("a program was started"))
    with pytest.raises(FormatError, match=r"p.img: (not )?a "):
        read(data)


@pytest.mark.parametrize("mode", ["F", "I", "LAB"])
def test_values_that_are_no_grey_of_8_or_16_bits(mode):
    with pytest.raises(FormatError, match="grey or colour of 8 or 16 bits is needed"):
        read(saved(Image.new(mode, (4, 4)), "TIFF"))


@pytest.mark.parametrize("kind", FORMATS)
def test_damaged_bytes_are_an_error_or_a_picture(kind):
    data = saved(Image.fromarray(np.add.outer(np.arange(32), np.arange(48)).astype(np.uint8)).convert("RGB"), kind)
    for seed in range(150):
        rng = np.random.default_rng(seed)
        damaged = bytearray(data)
        for at in rng.integers(0, len(data), 1 + seed % 8):
            damaged[at] = rng.integers(0, 256)
        try:
            image = read(bytes(damaged))
        except PeninkError as error:
            assert str(error).startswith("p.img: ") and len(str(error)) < 200
        else:
            assert image.values.max() <= image.maxval
