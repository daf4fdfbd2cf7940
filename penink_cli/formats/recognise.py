"""What a file is by its first bytes, for whoever has given a command the wrong one.

Readers come here when they fail, and not before: it costs nothing where all is well.
"""

from __future__ import annotations

import re

from penink_cli.formats.signatures import SIGNATURES
from penink_cli.ground.errors import FormatError, PeninkError

ENOUGH = 4096  # bytes to tell one kind from another

_FORMAT = re.compile(rb'"format"\s*:\s*"penink-([a-z]+)"')
_NETPBM = re.compile(rb"P([2356])[\s#]")
_NAMES = {
    "pgm": "a PGM image",
    "photo": "a photograph",
    "strokes": "strokes",
    "edges": "an edge list",
    "lines": "telling lines",
    "directions": "a direction field",
    "texture": "a texture",
    "illustration": "an illustration",
    "svg": "an SVG drawing",
    "page": "a finished drawing",
    "foreign": "a picture of a kind that is not read",
}

# By what was wanted and what was found: the way out. "*" is for all that is wanted and not named.
_WAYS = {
    ("strokes", "pgm"): "`penink blast` makes strokes of it",
    ("strokes", "photo"): "`penink draw` makes a drawing of it",
    ("strokes", "illustration"): "`penink render` makes strokes of it",
    ("strokes", "edges"): "`penink outline` makes strokes of it",
    ("strokes", "texture"): "`penink blast --texture` draws with it",
    ("edges", "pgm"): "`penink detect-edges` finds the edges of a picture",
    ("edges", "photo"): "`penink detect-edges` finds the edges of a picture",
    ("directions", "photo"): "`penink detect-directions` finds the directions of a picture",
    ("illustration", "pgm"): "`penink draw -o NAME.penink` makes an illustration of a picture",
    ("illustration", "photo"): "`penink draw -o NAME.penink` makes an illustration of a picture",
    ("illustration", "strokes"): "drawn already, for to-svg, to-pdf and to-ps without --self",
    ("pgm", "photo"): "`penink extract-samples` makes one of it, `penink draw` a whole drawing",
    ("pgm", "strokes"): "`penink to-pgm` makes one of them",
    ("photo", "strokes"): "`penink to-png` makes a picture of them",
    ("texture", "svg"): "`penink texture import` makes one of it",
    ("*", "edges"): "--edges takes it",
    ("*", "texture"): "`penink blast --texture` draws with it",
    ("*", "illustration"): "`penink render` draws it",
    ("*", "page"): "penink writes such files, and reads none",
    ("*", "foreign"): "save it as PNG or JPEG",
}  # fmt: skip


def kind(start: bytes) -> tuple[str, str] | None:
    """A key of _NAMES for the file that begins so, and its name in a sentence; None where it is none of those.

    >>> kind(b"P5 640 480 255 ")
    ('pgm', 'a PGM image')
    """
    for signature, name in SIGNATURES:
        if start.startswith(signature) and (name != "WEBP" or start[8:12] == b"WEBP"):
            return "photo", f"a {name if name != 'WEBP' else 'WebP'} photograph"
    if found := _NETPBM.match(start):
        return ("pgm", _NAMES["pgm"]) if found[1] in b"25" else ("photo", "a PPM photograph")
    if start.startswith((b"PK\x03\x04", b"PIs1", b"PIe1", b"PIt1")):
        return "illustration", "a packed illustration" if start.startswith(b"PK") else "a part of a packed illustration"
    if start.startswith((b"%!PS", b"%PDF-")):
        return "page", "PostScript" if start.startswith(b"%!") else "PDF"
    if start[4:8] == b"ftyp" or start.startswith((b"GIF8", b"BM")):
        return "foreign", _NAMES["foreign"]
    head = start[:ENOUGH]
    if head.lstrip().startswith(b"{") and (found := _FORMAT.search(head)) and (name := found[1].decode()) in _NAMES:
        return name, _NAMES[name]
    if head.lstrip().startswith(b"<") and b"<svg" in head:
        return "svg", _NAMES["svg"]
    return None


def explained(error: PeninkError, start: bytes, wanted: str) -> PeninkError:
    """The error; but where the file that begins so is not of the kind wanted, one that says what it is instead."""
    found = kind(start)
    if found is None or found[0] == wanted:
        return error
    way = _WAYS.get((wanted, found[0]), _WAYS.get(("*", found[0]), ""))
    return FormatError(f"not {_NAMES[wanted]} but {found[1]}{': ' if way else ''}{way}", error.source)
