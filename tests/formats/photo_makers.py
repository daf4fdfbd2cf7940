"""Makers of photographs byte by byte, for what no library would write."""

from __future__ import annotations

import io
import struct
import zlib
from typing import Any

import numpy as np
from PIL import Image, ImageCms


def luma(colour: np.ndarray) -> np.ndarray:
    return colour[..., 0] * 0.299 + colour[..., 1] * 0.587 + colour[..., 2] * 0.114


def saved(image: Image.Image | np.ndarray, kind: str, **options: object) -> bytes:
    out = io.BytesIO()
    (image if isinstance(image, Image.Image) else Image.fromarray(image)).save(out, kind, **options)
    return out.getvalue()


def chunk(name: bytes, content: bytes, wrong: int = 0) -> bytes:
    return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content) ^ wrong)


def png(
    rows: np.ndarray,
    bits: int = 8,
    colour: int = 0,
    before: bytes = b"",
    after: bytes = b"",
    end: bytes | None = None,
    width: int | None = None,
) -> bytes:
    """A PNG of rows of packed bytes (h, s), with chunks before and after its pixels."""
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[colour]
    width = width or rows.shape[1] * 8 // (bits * channels)
    header = struct.pack(">IIBBBBB", width, rows.shape[0], bits, colour, 0, 0, 0)
    packed = zlib.compress(b"".join(b"\0" + row.tobytes() for row in rows))
    end = chunk(b"IEND", b"") if end is None else end
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + before + chunk(b"IDAT", packed) + after + end


def packed(values: np.ndarray, bits: int) -> np.ndarray:
    """Values of few bits as bytes of rows."""
    spread = (values[..., None] >> np.arange(bits - 1, -1, -1)) & 1
    return np.packbits(spread.reshape(len(values), -1).astype(np.uint8), axis=1)


def tiff(*pictures: dict[str, Any], first: int = 0) -> bytes:
    """A little-endian TIFF: of each picture its tags, a raster (bytes) and the pictures in it (sub)."""
    out = bytearray(b"II*\0\0\0\0\0")

    def put(picture: dict[str, Any]) -> tuple[int, int]:
        inner = [put(sub)[0] for sub in picture.get("sub", ())]
        raster, tags = picture["raster"], dict(picture["tags"])
        at = len(out)
        out.extend(raster + bytes(len(raster) % 2))
        if tags.get(259) != (3, 6):
            tags |= {273: (4, at), 279: (4, len(raster)), 278: tags[257]}
        else:
            tags |= {513: (4, at), 514: (4, len(raster))}
        if inner:
            tags[330] = (4, inner[0])
        place = len(out)
        extra: list[bytes] = []
        entries = b""
        for tag, (kind, value) in sorted(tags.items()):
            if isinstance(value, bytes):
                where = place + 2 + 12 * len(tags) + 4 + sum(map(len, extra))
                entries += struct.pack("<HHII", tag, kind, len(value), where)
                extra.append(value + bytes(len(value) % 2))
            else:
                entries += struct.pack("<HHII", tag, kind, 1, value)
        out.extend(struct.pack("<H", len(tags)) + entries + bytes(4) + b"".join(extra))
        return place, place + 2 + 12 * len(tags)

    link = 4
    for picture in pictures:
        place, following = put(picture)
        out[link : link + 4] = struct.pack("<I", place)
        link = following
    return bytes(out)


def page(values: np.ndarray, sub: tuple[dict[str, Any], ...] = (), **tags: tuple[int, Any]) -> dict[str, Any]:
    """A grey picture of a TIFF; tags as t254=(type, value)."""
    height, width = values.shape
    own = {256: (4, width), 257: (4, height), 258: (3, 8), 259: (3, 1), 262: (3, 1), 277: (3, 1)}
    own |= {int(name[1:]): value for name, value in tags.items()}
    return {"tags": own, "raster": values.tobytes(), "sub": sub}


def icc(space: str, curves: list[bytes], columns: tuple[tuple[float, float, float], ...] = ()) -> bytes:
    """A profile of curves (each a tag's content) and, for colours, the XYZ of red, green and blue."""
    names = ["kTRC"] if space == "GRAY" else ["rTRC", "gTRC", "bTRC", "rXYZ", "gXYZ", "bXYZ"]
    fixed = [b"XYZ \0\0\0\0" + struct.pack(">3i", *(round(v * 65536) for v in column)) for column in columns]
    contents = [*curves, *fixed]
    names.append("wtpt")
    contents.append(b"XYZ \0\0\0\0" + struct.pack(">3i", 63190, 65536, 54061))
    names += ["desc", "cprt"]
    contents += [b"desc\0\0\0\0\0\0\0\1\0" + bytes(78), b"text\0\0\0\0x\0"]
    table, body = struct.pack(">I", len(names)), b""
    at = 128 + 4 + 12 * len(names)
    for name, content in zip(names, contents, strict=True):
        content += bytes(-len(content) % 4)
        table += struct.pack(">4sII", name.encode(), at + len(body), len(content))
        body += content
    head = struct.pack(
        ">I4sI4s4s4s12s4s",
        at + len(body),
        b"lcms",
        0x02400000,
        b"mntr",
        space.encode().ljust(4),
        b"XYZ ",
        bytes(12),
        b"acsp",
    )
    head = head.ljust(68, b"\0") + struct.pack(">3i", 63190, 65536, 54061)
    return head.ljust(128, b"\0") + table + body


def gamma_curve(gamma: float) -> bytes:
    return b"curv\0\0\0\0" + struct.pack(">IH", 1, round(gamma * 256))


def table_curve(gamma: float, count: int = 256) -> bytes:
    return b"curv\0\0\0\0" + struct.pack(
        f">I{count}H", count, *np.round((np.arange(count) / (count - 1)) ** gamma * 65535).astype(int)
    )


def parametric(function: int, *values: float) -> bytes:
    return b"para\0\0\0\0" + struct.pack(f">HH{len(values)}i", function, 0, *(round(v * 65536) for v in values))


SRGB_CURVE = parametric(3, 2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045)
SRGB = ((0.4361, 0.2225, 0.0139), (0.3851, 0.7169, 0.0971), (0.1431, 0.0606, 0.7141))
P3 = ((0.5151, 0.2412, -0.0011), (0.2920, 0.6922, 0.0419), (0.1571, 0.0666, 0.7841))
ADOBE = ((0.6097, 0.3111, 0.0195), (0.2053, 0.6257, 0.0609), (0.1492, 0.0632, 0.7446))
PROPHOTO = ((0.7977, 0.2880, 0.0), (0.1352, 0.7119, 0.0), (0.0313, 0.0001, 0.8249))


def managed(values: np.ndarray, profile: bytes) -> np.ndarray:
    """Grey of what LittleCMS makes of values under a profile."""
    mode = "L" if values.ndim == 2 else "RGB"
    image = Image.fromarray(values)
    source = ImageCms.ImageCmsProfile(io.BytesIO(profile))
    seen = ImageCms.profileToProfile(
        image, source, ImageCms.createProfile("sRGB"), outputMode="RGB", flags=ImageCms.Flags.NOOPTIMIZE
    )
    assert mode and seen is not None
    return np.floor(luma(np.asarray(seen).astype(float)) + 0.5)


def jpeg_parts(data: bytes) -> list[bytes]:
    """The segments of a JPEG up to its first scan, and the rest."""
    parts, at = [data[:2]], 2
    while data[at + 1] != 0xDA:
        length = 2 + int.from_bytes(data[at + 2 : at + 4], "big")
        parts.append(data[at : at + length])
        at += length
    return [*parts, data[at:]]


def segment(marker: int, content: bytes) -> bytes:
    return bytes([0xFF, marker]) + struct.pack(">H", len(content) + 2) + content
