"""WebP (RIFF): only the chunks that carry pixels are given to the decoder."""

from __future__ import annotations

import struct

from penink_cli.formats.photo.choices import Verdict
from penink_cli.formats.photo.decoded import Decoded
from penink_cli.formats.photo.exif import orientation
from penink_cli.formats.photo.icc import MOST, profile_of
from penink_cli.formats.photo.pillow import decoded, with_meaning
from penink_cli.ground.errors import FormatError

PIXELS = (b"VP8 ", b"VP8L", b"ALPH", b"VP8X", b"ANIM", b"ANMF")
ALPHA = 0x10  # a flag of VP8X


def read(encoded: bytes, max_pixels: int, verdict: Verdict) -> Decoded:
    """The first picture of a WebP. Raises FormatError where its pixels are damaged or missing."""
    found: dict[bytes, list[bytes]] = {}
    scar = len(encoded) < 8 + int.from_bytes(encoded[4:8], "little")
    at, size = 12, len(encoded)
    end = min(size, 8 + int.from_bytes(encoded[4:8], "little"))
    while at + 8 <= max(end, 12):
        name, length = struct.unpack_from("<4sI", encoded, at)
        content = encoded[at + 8 : at + 8 + length]
        if len(content) < length:
            if name in PIXELS:
                verdict.damage(FormatError(f"truncated: {size} of at least {at + 8 + length} WebP bytes"))
            else:
                scar = True
        found.setdefault(name, []).append(content)
        at += 8 + length + length % 2
        if name in (b"VP8 ", b"VP8L"):
            end = size  # chunks behind the length that the header declares may be metadata, and are read too
    if not any(name in found for name in (b"VP8 ", b"VP8L", b"ANMF")):
        raise FormatError("damaged WebP photograph, or one cut short: it has no pixels")
    if scar and (b"ALPH" not in found or b"VP8 " in found):
        verdict.scar("the WebP is cut behind its pixels; all of them are there")
    if b"ANMF" in found:
        if len(found[b"ANMF"]) > 1:
            verdict.say("an animation: its first picture is read")
        clean = encoded
    else:
        clean = _clean(found)
    picture = decoded(clean, "WEBP", max_pixels, verdict)
    icc = found.get(b"ICCP", [b""])[0][:MOST]
    return with_meaning(picture, profile_of(icc, False, verdict), orientation(found.get(b"EXIF", [b""])[0]))


def _clean(found: dict[bytes, list[bytes]]) -> bytes:
    """A file of the pixels alone. found: the content of all chunks by their names."""
    pixels = b"VP8L" if b"VP8L" in found else b"VP8 "
    chunks = [(pixels, found[pixels][0])]
    extended = found.get(b"VP8X", [b""])[0]
    if pixels == b"VP8 " and b"ALPH" in found and len(extended) == 10:
        chunks.insert(0, (b"ALPH", found[b"ALPH"][0]))
        chunks.insert(0, (b"VP8X", bytes([ALPHA, *extended[1:]])))
    body = b"".join(
        name + struct.pack("<I", len(content)) + content + bytes(len(content) % 2) for name, content in chunks
    )
    return b"RIFF" + struct.pack("<I", 4 + len(body)) + b"WEBP" + body
