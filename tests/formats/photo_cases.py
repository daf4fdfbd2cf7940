"""Photographs with something the matter, each made here: what each is, and what reading it should give.

`python -m tests.benchmarks.photographs --cases` prints them as a table with what they give; test_photo_cases.py holds
them to it.
"""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from PIL import Image, ImageCms

from penink_cli.formats import photo
from penink_cli.formats.photo import Choices
from penink_cli.ground.errors import PeninkError
from tests.formats.photo_makers import (
    ADOBE,
    P3,
    PROPHOTO,
    SRGB,
    SRGB_CURVE,
    chunk,
    gamma_curve,
    icc,
    jpeg_parts,
    luma,
    managed,
    packed,
    page,
    parametric,
    png,
    saved,
    segment,
    table_curve,
    tiff,
)

RNG = np.random.default_rng(20)
HEIGHT, WIDTH = 24, 40
RAMP = np.add.outer(np.arange(HEIGHT) * 4, np.arange(WIDTH) * 4).astype(np.uint8)
GREY = np.clip(RAMP.astype(int) + RNG.integers(-20, 20, RAMP.shape), 0, 255).astype(np.uint8)
COLOUR = np.dstack([GREY, 255 - GREY[::-1], GREY[:, ::-1] // 2])


@dataclass(frozen=True)
class Case:
    """An input, and what it should give: an image's grey within some levels of 8 bits, or an error that says something.

    lines: what each line on the side says, in order.
    """

    group: str
    name: str
    data: bytes
    wanted: np.ndarray | str
    within: float = 0.51
    lines: tuple[str, ...] = ()
    choices: Choices = field(default_factory=Choices)


def given(case: Case) -> tuple[str, bool]:
    """What reading a case gives, in some words, and whether that is right."""
    lines: list[str] = []
    try:
        image = photo.read_grey(io.BytesIO(case.data), "p", 10**6, case.choices, lines.append)
    except PeninkError as error:
        found: Any = str(error).removeprefix("p: ")
        right = isinstance(case.wanted, str) and case.wanted in found
    else:
        grey = image.values * (255 / image.maxval)
        if isinstance(case.wanted, str) or grey.shape != case.wanted.shape:
            found, right = f"{image.values.shape[1]} x {image.values.shape[0]} pixels", False
        else:
            off = float(np.abs(grey - case.wanted).max())
            found, right = f"the picture, off by {off:.1f}", off <= case.within
    right &= len(lines) == len(case.lines) and all(part in line for part, line in zip(case.lines, lines, strict=False))
    return found + "".join(f"; says: {line.removeprefix('p: ')}" for line in lines), right


def wanted(case: Case) -> str:
    """What a case should give, in some words."""
    what = f"an error: {case.wanted}" if isinstance(case.wanted, str) else f"the picture, within {case.within:.1f}"
    return what + "".join(f"; says: …{line}…" for line in case.lines)


def cases() -> Iterator[Case]:
    """All of them."""
    yield from metadata()
    yield from jpegs()
    yield from transparency()
    yield from wrong_pictures()
    yield from curves()
    yield from depths()
    yield from kinds()


def metadata() -> Iterator[Case]:
    text = b"Comment\0" + RNG.integers(32, 127, 2 << 20, np.uint8).tobytes()
    squeezed = b"Comment\0\0" + zlib.compress(bytes(3 << 20))
    whole = png(GREY)
    names = {
        "text of 2 MiB": png(GREY, before=chunk(b"tEXt", text)),
        "compressed text of 3 MiB": png(GREY, before=chunk(b"zTXt", squeezed)),
        "international text of 3 MiB": png(GREY, after=chunk(b"iTXt", b"a\0\1\0\0\0" + zlib.compress(bytes(3 << 20)))),
        "a wrong checksum in a comment": png(GREY, before=chunk(b"tEXt", b"a\0b", wrong=1)),
        "a wrong checksum in a comment after the pixels": png(GREY, after=chunk(b"tIME", b"1234567", wrong=1)),
        "a comment whose end is missing": png(GREY, before=chunk(b"tEXt", b"a\0" + bytes(40))[:20]),
        "a comment that claims to be longer than the file": png(GREY, before=b"\x7f\xff\xff\xfftEXta\0b"),
        "a chunk of a private kind": png(GREY, before=chunk(b"prVt", bytes(99))),
        "an EXIF that makes no sense": png(GREY, before=chunk(b"eXIf", b"II*\0\xff\xff\xff\xff")),
        "physical sizes of length 0": png(GREY, before=chunk(b"pHYs", b"")),
        "a wrong checksum in its end": png(GREY, end=chunk(b"IEND", b"", wrong=1)),
    }
    for name, data in names.items():
        yield Case("metadata", f"PNG: {name}", data, GREY)
    yield Case(
        "metadata",
        "PNG: a profile of 3 MiB of zeros",
        png(GREY, before=chunk(b"iCCP", b"a\0\0" + zlib.compress(bytes(3 << 20)))),
        GREY,
        lines=("profile",),
    )
    yield Case("metadata", "PNG: no end", png(GREY, end=b""), GREY, lines=("no end",))
    yield Case(
        "metadata",
        "PNG: cut in a comment behind the pixels",
        png(GREY, after=chunk(b"tEXt", bytes(500))[:60], end=b""),
        GREY,
        lines=("all its rows are there",),
    )
    yield Case("metadata", "PNG: no end, --strict", png(GREY, end=b""), "no end", choices=Choices(damage="strict"))
    at = whole.index(b"IDAT") + 9
    yield Case(
        "metadata",
        "PNG: a wrong byte in its pixels",
        whole[:at] + bytes([whole[at] ^ 4]) + whole[at + 1 :],
        "checksum of its chunk IDAT",
    )
    jpeg = saved(GREY, "JPEG", quality=95)
    plain = np.asarray(Image.open(io.BytesIO(jpeg))).astype(float)
    head, *rest = jpeg_parts(jpeg)
    for name, extra in {
        "an EXIF that makes no sense": segment(0xE1, b"Exif\0\0II*\0\xff\xff\xff\x7f"),
        "an XMP cut short": segment(0xE1, b"http://ns.adobe.com/xap/1.0/\0<x:xmpmeta"),
        "pictures (MPF) that are not there": segment(0xE2, b"MPF\0II*\0\x08\0\0\0\1\0\xff"),
        "a comment that is no text": segment(0xFE, bytes(range(200, 256))),
        "a Photoshop block cut short": segment(0xED, b"Photoshop 3.0\x008BIM\4"),
    }.items():
        yield Case("metadata", f"JPEG: {name}", head + extra + b"".join(rest), plain)
    webp = saved(COLOUR, "WEBP", lossless=True, exif=b"Exif\0\0II*\0\xff\xff\xff\x7f", xmp=b"<x" * 200)
    yield Case("metadata", "WebP: an EXIF that makes no sense", webp, luma(COLOUR))
    yield Case("metadata", "WebP: cut in its XMP", webp[:-100], luma(COLOUR), lines=("cut behind its pixels",))
    yield Case(
        "metadata",
        "TIFF: text and EXIF elsewhere than in the file",
        tiff(page(GREY, t270=(2, 7), t34665=(4, 1 << 30), t700=(1, 99), t305=(77, 3))),
        GREY,
    )


def jpegs() -> Iterator[Case]:
    data = saved(COLOUR, "JPEG", quality=92, subsampling=2, restart_marker_blocks=2)
    plain = luma(np.asarray(Image.open(io.BytesIO(data))).astype(float))
    head, *middle, scan = jpeg_parts(data)
    profile = icc("RGB", [SRGB_CURVE] * 3, SRGB)
    twice = 2 * segment(0xE2, b"ICC_PROFILE\0\1\1" + profile)

    def built(before: bytes = b"", between: bytes = b"", pixels: bytes = scan) -> bytes:
        return head + before + between.join(middle) + between + pixels

    def padded(fill: bytes) -> bytes:
        out = bytearray()
        for i, byte in enumerate(scan):
            if byte == 0xFF and i + 1 < len(scan) and 0xD0 <= scan[i + 1] <= 0xD7:
                out += fill
            out.append(byte)
        return bytes(out)

    for name, made in {
        "the profile twice": built(twice),
        "a profile of which parts are missing": built(segment(0xE2, b"ICC_PROFILE\0\2\3" + profile)),
        "bytes between segments": built(between=b"\0\1\2\3"),
        "filling bytes between segments": built(between=b"\xff\xff\xff"),
        "zeros before restart markers": built(pixels=padded(bytes(7))),
        "filling bytes before restart markers": built(pixels=padded(b"\xff\xff")),
        "two bytes before restart markers": built(pixels=padded(b"\x12\x34")),
        "zeros before the end": data[:-2] + bytes(40) + data[-2:],
        "more behind the end": data + b"and more\xff\xd9",
    }.items():
        yield Case("jpeg", name, made, plain)
    progressive = saved(COLOUR, "JPEG", quality=92, progressive=True)
    grown = luma(np.asarray(Image.open(io.BytesIO(progressive))).astype(float))
    yield Case("jpeg", "no end marker", data[:-2], plain, lines=("no end marker",))
    yield Case("jpeg", "half of an end marker", data[:-1], plain, lines=("no end marker",))
    yield Case("jpeg", "no end marker, --strict", data[:-2], "no end marker", choices=Choices(damage="strict"))
    yield Case(
        "jpeg",
        "no end marker, --lenient",
        data[:-2],
        plain,
        lines=("no end marker",),
        choices=Choices(damage="lenient"),
    )
    yield Case("jpeg", "progressive, no end marker", progressive[:-2], grown, lines=("no end marker",))
    yield Case("jpeg", "progressive, cut in its last scan", progressive[:-20], "truncated")
    yield Case("jpeg", "cut in its scan", data[: -len(scan) // 2], "truncated")
    yield Case(
        "jpeg",
        "cut in its scan, --lenient",
        data[: -len(scan) // 3],
        plain,
        within=255,
        lines=("what is left",),
        choices=Choices(damage="lenient"),
    )
    swapped = scan.replace(b"\xff\xd1", b"\xff\xd3", 1)
    yield Case("jpeg", "a restart marker out of turn", built(pixels=swapped), "restart marker")
    yield Case(
        "jpeg",
        "arithmetic pixels of 12 bits",
        data.replace(b"\xff\xc0\0\x11\x08", b"\xff\xc0\0\x11\x0c"),
        "12 bits a value",
    )
    yield Case("jpeg", "lossless", data.replace(b"\xff\xc0\0\x11\x08", b"\xff\xc3\0\x11\x08"), "lossless JPEG")


def transparency() -> Iterator[Case]:
    two = (RAMP // 64).astype(np.uint8)
    seen = np.where(two == 1, 255, two * 85)
    one = chunk(b"tRNS", b"\0\1")
    yield Case("transparency", "one clear value of 2 bits", png(packed(two, 2), 2, before=one), seen)
    four = (RAMP // 16).astype(np.uint8)
    yield Case(
        "transparency",
        "one clear value of 4 bits",
        png(packed(four, 4), 4, before=chunk(b"tRNS", b"\0\7")),
        np.where(four == 7, 255, four * 17),
    )
    bit = (RAMP > 127).astype(np.uint8)
    yield Case(
        "transparency",
        "one clear value of 1 bit",
        png(packed(bit, 1), 1, before=chunk(b"tRNS", b"\0\0")),
        np.full(bit.shape, 255),
        lines=("white",),
    )
    deep = RAMP.astype(np.uint16) * 256 + 7
    alike = deep.copy()
    alike[0, 0] += 1  # differs in the low byte alone
    clear = np.where(alike == deep[0, 0], 255.0, alike / 257)
    yield Case(
        "transparency",
        "one clear value of 16 bits",
        png(alike.astype(">u2").view(np.uint8), 16, before=chunk(b"tRNS", struct.pack(">H", int(deep[0, 0])))),
        clear,
    )
    colours = np.stack([alike] * 3, axis=2)
    colours[0, 0] = (7, 7, 8)
    colours[0, 1] = (7, 7, 7)
    shown = luma(colours / 257.0)
    shown[0, 1] = 255
    yield Case(
        "transparency",
        "one clear color of 16 bits",
        png(
            colours.astype(">u2").view(np.uint8).reshape(HEIGHT, -1),
            16,
            2,
            before=chunk(b"tRNS", struct.pack(">3H", 7, 7, 7)),
        ),
        shown,
        within=0.6,
    )
    disc = np.hypot(*np.meshgrid(np.arange(WIDTH) - 20, np.arange(HEIGHT) - 12)) < 9
    alpha = np.where(disc, 255, 0).astype(np.uint8)
    white = np.dstack([np.full((HEIGHT, WIDTH, 3), 255, np.uint8), alpha])
    logo = saved(white, "PNG")
    yield Case("transparency", "white on nothing", logo, np.full(alpha.shape, 255), lines=("lost on white",))
    for kind, options in (("WEBP", {"lossless": True, "exact": True}), ("TIFF", {})):
        yield Case(
            "transparency",
            f"white on nothing, {kind}",
            saved(white, kind, **options),
            np.full(alpha.shape, 255),
            lines=("lost on white",),
        )
    yield Case(
        "transparency",
        "nearly white on nothing",
        saved(np.dstack([np.full((HEIGHT, WIDTH, 3), 244, np.uint8), alpha]), "PNG"),
        np.where(disc, 244, 255),
        lines=("lost on white",),
    )
    yield Case(
        "transparency", "white on nothing, --background black", logo, alpha, choices=Choices(background=(0, 0, 0))
    )
    yield Case(
        "transparency",
        "white on nothing, --background '#336699'",
        logo,
        np.where(disc, 255, luma(np.array([0x33, 0x66, 0x99]))),
        choices=Choices(background=(0x33, 0x66, 0x99)),
    )
    yield Case(
        "transparency", "white on nothing, --background alpha", logo, 255 - alpha, choices=Choices(background="alpha")
    )
    yield Case(
        "transparency",
        "grey, --background '#336699'",
        saved(np.dstack([GREY, alpha]), "PNG"),
        np.where(disc, GREY, luma(np.array([0x33, 0x66, 0x99]))),
        choices=Choices(background=(0x33, 0x66, 0x99)),
    )
    yield Case(
        "transparency",
        "nothing clear, --background alpha",
        saved(GREY, "PNG"),
        "nothing of it is transparent",
        choices=Choices(background="alpha"),
    )
    yield Case(
        "transparency",
        "dark on nothing",
        saved(np.dstack([COLOUR // 3, alpha]), "PNG"),
        np.where(disc, luma(COLOUR // 3), 255),
        within=1,
    )


def wrong_pictures() -> Iterator[Case]:
    small = np.ascontiguousarray(GREY[::4, ::4])
    full = page(GREY)
    reduced = page(small, t254=(4, 1))
    jpeg = saved(GREY, "JPEG", quality=95)
    decoded = np.asarray(Image.open(io.BytesIO(jpeg))).astype(float)
    preview = {"tags": {259: (3, 6)}, "raster": jpeg}
    mosaic = page(np.kron(GREY, np.ones((2, 2), np.uint8)), t262=(3, 32803))
    yield Case("which", "TIFF: a reduced image first", tiff(reduced, full), GREY)
    yield Case("which", "TIFF: a reduced image first, as of old", tiff(page(small, t255=(3, 2)), full), GREY)
    yield Case("which", "TIFF: the full one in the reduced one", tiff(page(small, (full,), t254=(4, 1))), GREY)
    yield Case(
        "which", "TIFF: a small one first that does not say so", tiff(page(small), full), GREY, lines=("largest of 2",)
    )
    yield Case("which", "TIFF: the full one first", tiff(full, reduced), GREY)
    yield Case("which", "TIFF: two pages", tiff(full, page(RAMP)), GREY, lines=("first of 2 pages",))
    yield Case("which", "TIFF: reduced images alone", tiff(reduced), small, lines=("reduced",))
    yield Case("which", "TIFF: a mask after it", tiff(full, page(GREY, t254=(4, 4), t262=(3, 4))), GREY)
    yield Case(
        "which",
        "a camera raw with a preview",
        tiff(page(small, (mosaic,), t254=(4, 1)), preview),
        decoded,
        lines=("camera raw of 80 x 48",),
    )
    yield Case(
        "which",
        "a camera raw with a preview, --strict",
        tiff(page(small, (mosaic,), t254=(4, 1)), preview),
        "camera raw",
        choices=Choices(damage="strict"),
    )
    yield Case("which", "a camera raw without a preview", tiff(mosaic), "camera raw")
    more = {"save_all": True, "append_images": [Image.fromarray(GREY[::-1])]}
    yield Case(
        "which", "GIF: an animation", saved(Image.fromarray(GREY), "GIF", **more), GREY, lines=("first of several",)
    )
    yield Case("which", "PNG: an animation", saved(Image.fromarray(GREY), "PNG", **more), GREY, lines=("animation",))
    yield Case(
        "which",
        "WebP: an animation",
        saved(
            Image.fromarray(COLOUR),
            "WEBP",
            lossless=True,
            save_all=True,
            append_images=[Image.fromarray(COLOUR[::-1].copy())],
        ),
        luma(COLOUR),
        lines=("animation",),
    )


def curves() -> Iterator[Case]:
    linear = icc("RGB", [gamma_curve(1.0)] * 3, SRGB)
    dark = icc("GRAY", [gamma_curve(1.0)])
    yield Case(
        "curve", "gAMA 1.0, grey", png(GREY, before=chunk(b"gAMA", struct.pack(">I", 100_000))), managed(GREY, dark), 1
    )
    yield Case(
        "curve",
        "gAMA 1.0, color",
        png(COLOUR.reshape(HEIGHT, -1), 8, 2, before=chunk(b"gAMA", struct.pack(">I", 100_000))),
        managed(COLOUR, linear),
        1,
    )
    yield Case(
        "curve",
        "gAMA .55, grey",
        png(GREY, before=chunk(b"gAMA", struct.pack(">I", 55_556))),
        managed(GREY, icc("GRAY", [table_curve(1.8, 4096)])),
        1,
    )
    yield Case(
        "curve", "gAMA 1/2.2, as sRGB's is written", png(GREY, before=chunk(b"gAMA", struct.pack(">I", 45_455))), GREY
    )
    yield Case(
        "curve",
        "gAMA 1.0 and sRGB: the latter counts",
        png(GREY, before=chunk(b"gAMA", struct.pack(">I", 100_000)) + chunk(b"sRGB", b"\0")),
        GREY,
    )
    p3 = struct.pack(">8I", 31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000)
    wide = icc("RGB", [SRGB_CURVE] * 3, P3)
    yield Case(
        "curve",
        "gAMA and primaries of P3",
        png(COLOUR.reshape(HEIGHT, -1), 8, 2, before=chunk(b"gAMA", struct.pack(">I", 45_455)) + chunk(b"cHRM", p3)),
        managed(COLOUR, wide),
        1,
    )
    profiles = {
        "linear": linear,
        "Display P3": wide,
        "Adobe RGB": icc("RGB", [gamma_curve(2.19921875)] * 3, ADOBE),
        "ProPhoto": icc("RGB", [gamma_curve(1.8)] * 3, PROPHOTO),
        "a table": icc("RGB", [table_curve(1.7, 33)] * 3, SRGB),
        "curves of three kinds": icc("RGB", [gamma_curve(1.5), table_curve(2.6, 1024), parametric(0, 2.0)], P3),
        "parametric 1": icc("RGB", [parametric(1, 2.2, 1.1, -0.1)] * 3, SRGB),
        "parametric 4": icc("RGB", [parametric(4, 2.2222, 0.9, 0.1, 0.2, 0.08, 0.0, 0.0)] * 3, SRGB),
    }
    for name, profile in profiles.items():
        yield Case("curve", f"PNG: {name}", saved(COLOUR, "PNG", icc_profile=profile), managed(COLOUR, profile), 1)
    for kind, options in (("TIFF", {}), ("WEBP", {"lossless": True})):
        yield Case(
            "curve", f"{kind}: Display P3", saved(COLOUR, kind, icc_profile=wide, **options), managed(COLOUR, wide), 1
        )
    jpeg = saved(COLOUR, "JPEG", quality=95, icc_profile=linear)
    yield Case("curve", "JPEG: linear", jpeg, managed(np.asarray(Image.open(io.BytesIO(jpeg))), linear), 1)
    yield Case(
        "curve",
        "PNG: linear, --profile ignore",
        saved(COLOUR, "PNG", icc_profile=linear),
        luma(COLOUR),
        choices=Choices(profile=False),
    )
    yield Case(
        "curve",
        "PNG: sRGB",
        saved(COLOUR, "PNG", icc_profile=ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()),
        luma(COLOUR),
    )
    yield Case(
        "curve",
        "PNG: grey, gamma 1.8",
        saved(GREY, "PNG", icc_profile=icc("GRAY", [gamma_curve(1.8)])),
        managed(GREY, icc("GRAY", [gamma_curve(1.8)])),
        1,
    )
    yield Case(
        "curve",
        "PNG: a profile that makes no sense",
        saved(COLOUR, "PNG", icc_profile=b"no profile" * 30),
        luma(COLOUR),
        lines=("profile makes no sense",),
    )
    for name, numbers in (
        ("b over a of 0", (1, 2.2, 0.0, 1.0)),
        ("b over a of 0, and c", (2, 2.2, 0.0, 1.0, 0.1)),
        ("a gamma below 0", (0, -2.0)),
        ("a gamma of 0", (0, 0.0)),
    ):
        yield Case(
            "curve",
            f"PNG: a curve that makes no sense: {name}",
            saved(COLOUR, "PNG", icc_profile=icc("RGB", [parametric(*numbers)] * 3, SRGB)),
            luma(COLOUR),
            lines=("makes no sense",),
        )
    yield Case(
        "curve",
        "PNG: a profile of inks",
        saved(COLOUR, "PNG", icc_profile=linear[:16] + b"CMYK" + linear[20:]),
        luma(COLOUR),
        lines=("not for its kind",),
    )


def depths() -> Iterator[Case]:
    deep = GREY.astype(np.uint16) * 257
    twelve = GREY.astype(np.uint16) * 16
    for kind in ("PNG", "TIFF"):
        yield Case("depth", f"{kind}: 16 bits", saved(deep, kind), GREY)
        yield Case("depth", f"{kind}: 12 bits in 16", saved(twelve, kind), twelve / 257, lines=("12 bits",))
    yield Case(
        "depth",
        "PGM: 10 bits in 16",
        b"P5 %d %d 65535\n" % (WIDTH, HEIGHT) + (GREY.astype(int) * 4).astype(">u2").tobytes(),
        GREY.astype(float) * 4 / 257,
        lines=("10 bits",),
    )
    yield Case("depth", "PNG: black in 16 bits", saved(deep * 0, "PNG"), GREY * 0)
    rows = (COLOUR.astype(">u2") * 257).view(np.uint8).reshape(HEIGHT, -1)
    yield Case("depth", "PNG: color of 16 bits", png(rows, 16, 2), luma(COLOUR))


def kinds() -> Iterator[Case]:
    yield Case("kind", "GIF", saved(Image.fromarray(GREY), "GIF"), GREY)
    palette = Image.fromarray(COLOUR).convert("P")
    yield Case("kind", "GIF: colors", saved(palette, "GIF"), luma(np.asarray(palette.convert("RGB")).astype(float)))
    for mode in ("1", "L", "P", "RGB"):
        image = Image.fromarray(COLOUR).convert(mode)
        yield Case("kind", f"BMP: {mode}", saved(image, "BMP"), luma(np.asarray(image.convert("RGB")).astype(float)))
    avif = saved(COLOUR, "AVIF", quality=100, subsampling="4:4:4")
    yield Case("kind", "AVIF", avif, luma(np.asarray(Image.open(io.BytesIO(avif)).convert("RGB")).astype(float)))
    yield Case("kind", "AVIF: cut short", avif[: len(avif) // 2], "AVIF")
    bits = (RAMP > 100).astype(np.uint8)
    yield Case("kind", "PBM", b"P4\n# bits\n%d %d\n" % (WIDTH, HEIGHT) + packed(bits, 1).tobytes(), 255 - 255 * bits)
    yield Case(
        "kind",
        "PBM: plain",
        b"P1 %d %d\n" % (WIDTH, HEIGHT) + b"".join(b"%d" % v for v in bits.ravel()),
        255 - 255 * bits,
    )
    yield Case(
        "kind",
        "PBM: plain, with comments",
        b"P1 # a 1\n%d %d # 0 and 1\n" % (WIDTH, HEIGHT) + b" # 1 1\n".join(b"%d" % v for v in bits.ravel()),
        255 - 255 * bits,
    )
    yield Case("kind", "PBM: cut short", b"P4 %d %d\n" % (WIDTH, HEIGHT) + packed(bits, 1).tobytes()[:-1], "truncated")
    alpha = np.full((HEIGHT, WIDTH), 128, np.uint8)
    for name, values, seen in (
        ("GRAYSCALE", GREY, GREY),
        ("RGB", COLOUR, luma(COLOUR)),
        ("GRAYSCALE_ALPHA", np.dstack([GREY, alpha]), GREY * (128 / 255) + 255 * (127 / 255)),
        ("RGB_ALPHA", np.dstack([COLOUR, alpha]), luma(COLOUR * (128 / 255) + 255 * (127 / 255))),
    ):
        depth = 1 if values.ndim == 2 else values.shape[2]
        head = f"P7\nWIDTH {WIDTH}\nHEIGHT {HEIGHT}\n# a comment\nDEPTH {depth}\nMAXVAL 255\n"
        head += f"TUPLTYPE {name}\nENDHDR\n"
        yield Case("kind", f"PAM: {name}", head.encode() + values.tobytes(), seen, within=1)
    head = f"P7\nWIDTH {WIDTH}\nHEIGHT {HEIGHT}\nDEPTH 1\nMAXVAL 1\nTUPLTYPE BLACKANDWHITE\nENDHDR\n".encode()
    yield Case("kind", "PAM: BLACKANDWHITE", head + bits.tobytes(), 255 * bits)
    yield Case("kind", "PAM: cut short", head + bits.tobytes()[:-1], "truncated")
    for name, start in {
        "Photoshop": b"8BPS\0\1",
        "JPEG 2000": b"\0\0\0\x0cjP  \r\n\x87\n",
        "JPEG XL": b"\xff\x0a\x10",
        "CR3": b"\0\0\0\x18ftypcrx \0\0\0\1crx isom",
        "RAF": b"FUJIFILMCCD-RAW 0201",
        "ORF": b"IIRO\x08\0",
        "OpenEXR": b"v/1\x01\2\0\0\0",
        "Radiance": b"#?RADIANCE\n",
        "PFM": b"Pf\n2 2\n-1\n",
        "QOI": b"qoif\0\0\0\1",
        "film": b"\0\0\0\x18ftypmp42\0\0\0\0",
    }.items():
        yield Case(
            "kind",
            f"not read: {name}",
            start + bytes(64),
            name,
        )
