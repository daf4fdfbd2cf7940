"""The one thing that EXIF says of a picture's pixels: which way up they are."""

from __future__ import annotations

import struct

ORIENTATION = 274


def orientation(exif: bytes | None) -> int:
    """1 … 8 of an EXIF block, with or without its ``Exif`` before it; 1 where it does not say, or makes no sense."""
    if not exif:
        return 1
    exif = exif.removeprefix(b"Exif\0\0")
    order = {b"II": "<", b"MM": ">"}.get(exif[:2])
    if order is None:
        return 1
    try:
        at = struct.unpack_from(f"{order}I", exif, 4)[0]
        for i in range(struct.unpack_from(f"{order}H", exif, at)[0]):
            tag, kind, count, value = struct.unpack_from(f"{order}HHIH", exif, at + 2 + 12 * i)
            if tag == ORIENTATION:
                return int(value) if kind == 3 and count == 1 and 1 <= value <= 8 else 1
    except struct.error:
        pass
    return 1
