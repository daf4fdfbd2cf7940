"""Of EXIF, the orientation: nothing else in it concerns the pixels."""

from __future__ import annotations

import struct

ORIENTATION = 274


def orientation(exif: bytes | None) -> int:
    """The orientation, 1 … 8, of an EXIF block with or without its ``Exif``; 1 where it has none or is damaged."""
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
