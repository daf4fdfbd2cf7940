"""What a file is by its first bytes, for the error line of a command that was given the wrong one.

A reader asks only when it has failed: a file that is right is not looked at here.
"""

from __future__ import annotations

import re

from penink_cli.formats.signatures import NAMES, kind_of
from penink_cli.ground.errors import FormatError, PeninkError

ENOUGH = 4096  # bytes to tell one kind from another

_FORMAT = re.compile(rb'"format"\s*:\s*"penink-([a-z]+)"')
_NETPBM = re.compile(rb"P([1-7])[\s#]")
_NETPBM_NAMES = dict(zip((b"1", b"2", b"3", b"4", b"5", b"6", b"7"), ("PBM", "PGM", "PPM") * 2 + ("PAM",), strict=True))
_NAMES = {
    "pgm": "a PGM image",
    "photo": "a photograph",
    "strokes": "strokes",
    "edges": "an edge list",
    "lines": "telling lines",
    "directions": "a direction field",
    "texture": "a texture",
    "style": "a style",
    "pens": "a list of pens",
    "illustration": "an illustration",
    "svg": "an SVG drawing",
    "page": "a finished drawing",
    "foreign": "a picture of a kind that is not read",
}
# Pictures of other kinds: where their mark is, the mark, what they are.
_FOREIGN = (
    (0, b"8BPS", "a Photoshop picture"),
    (0, b"\0\0\0\x0cjP  ", "a JPEG 2000 picture"),
    (0, b"\xff\x4f\xff\x51", "a JPEG 2000 picture"),
    (0, b"\0\0\0\x0cJXL ", "a JPEG XL picture"),
    (0, b"\xff\x0a", "a JPEG XL picture"),
    (0, b"II\xbc", "a JPEG XR picture"),
    (8, b"crx ", "a camera raw (CR3)"),
    (0, b"FUJIFILMCCD-RAW", "a camera raw (RAF)"),
    (0, b"IIRO", "a camera raw (ORF)"),
    (0, b"IIRS", "a camera raw (ORF)"),
    (0, b"MMOR", "a camera raw (ORF)"),
    (0, b"IIU\0", "a camera raw (RW2)"),
    (0, b"FOVb", "a camera raw (X3F)"),
    (0, b"\0MRM", "a camera raw (MRW)"),
    (0, b"gimp xcf", "a GIMP picture"),
    (0, b"v/1\x01", "an OpenEXR picture"),
    (0, b"#?RADIANCE", "a Radiance HDR picture"),
    (0, b"#?RGBE", "a Radiance HDR picture"),
    (0, b"PF\n", "a PFM picture"),
    (0, b"Pf\n", "a PFM picture"),
    (0, b"DDS ", "a DDS picture"),
    (0, b"qoif", "a QOI picture"),
    (0, b"farbfeld", "a farbfeld picture"),
    (0, b"\x0a\x05\x01", "a PCX picture"),
    (0, b"\0\0\1\0", "an icon (ICO)"),
    (0, b"icns", "an icon (ICNS)"),
    (0, b"\x8aMNG", "an MNG animation"),
    (0, b"\x8bJNG", "a JNG picture"),
    (0, b"SIMPLE  =", "a FITS picture"),
    (128, b"DICM", "a DICOM picture"),
    (0, b"AT&TFORM", "a DjVu document"),
    (0, b"\x01\xda", "an SGI picture"),
    (0, b"\x59\xa6\x6a\x95", "a Sun raster picture"),
    (0, b"FLIF", "a FLIF picture"),
    (0, b"BPG\xfb", "a BPG picture"),
    (0, b"/* XPM */", "an XPM picture"),
    (4, b"ftyp", "a film, or a picture in a container of films, of a kind that is not read"),
    (0, b"\xc5\xd0\xd3\xc6", "an EPS with a preview"),
    (0, b"BM", "a BMP picture of a kind that is not read"),
)  # fmt: skip

# By the kind wanted and the kind found: what the user may do. "*" stands for every kind wanted that has no line.
_WAYS = {
    ("strokes", "pgm"): "`penink blast` makes strokes of it",
    ("strokes", "photo"): "`penink draw` makes a drawing of it",
    ("strokes", "illustration"): "`penink render` makes strokes of it",
    ("strokes", "edges"): "`penink outline` makes strokes of it",
    ("strokes", "lines"): "`penink lines` makes strokes of them",
    ("lines", "pgm"): "`penink detect-lines` finds the lines of a picture",
    ("lines", "photo"): "`penink detect-lines` finds the lines of a picture",
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
    ("*", "style"): "`penink draw --style` draws in it",
    ("*", "pens"): "`penink to-svg --pens` takes it",
    ("*", "texture"): "`penink blast --texture` draws with it",
    ("*", "illustration"): "`penink render` draws it",
    ("*", "page"): "penink writes such files, and reads none",
    ("*", "foreign"): "save it as PNG or JPEG",
}  # fmt: skip


def kind(start: bytes) -> tuple[str, str] | None:
    """The key in _NAMES of a file's kind, by its first bytes, and its name in a sentence; None for an unknown kind.

    >>> kind(b"P5 640 480 255 ")
    ('pgm', 'a PGM image')
    """
    if (photo := kind_of(start)) is not None:
        shown = NAMES.get(photo, photo)
        return "photo", f"{'an' if shown == 'AVIF' else 'a'} {shown} photograph"
    if found := _NETPBM.match(start):
        name = _NETPBM_NAMES[found[1]]
        return ("pgm", _NAMES["pgm"]) if name == "PGM" else ("photo", f"a {name} photograph")
    if start.startswith((b"PK\x03\x04", b"PIs", b"PIe", b"PId", b"PIl", b"PIt", b"PIp")):
        return "illustration", "a packed illustration" if start.startswith(b"PK") else "a part of a packed illustration"
    if start.startswith((b"%!PS", b"%PDF-")):
        return "page", "PostScript" if start.startswith(b"%!") else "PDF"
    for place, signature, name in _FOREIGN:
        if start[place : place + len(signature)] == signature:
            return "foreign", name
    head = start[:ENOUGH]
    if head.lstrip().startswith(b"{") and (found := _FORMAT.search(head)) and (name := found[1].decode()) in _NAMES:
        return name, _NAMES[name]
    if head.lstrip().startswith(b"<") and b"<svg" in head:
        return "svg", _NAMES["svg"]
    return None


def explained(error: PeninkError, start: bytes, wanted: str) -> PeninkError:
    """The error as it is, or one that names the file's kind where that is known and not the kind wanted.

    start: the file's first bytes, ENOUGH of them. wanted: a key of _NAMES.
    """
    found = kind(start)
    if found is None or found[0] == wanted:
        return error
    way = _WAYS.get((wanted, found[0]), _WAYS.get(("*", found[0]), ""))
    return FormatError(f"not {_NAMES[wanted]} but {found[1]}{': ' if way else ''}{way}", error.source)
