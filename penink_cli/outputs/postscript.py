"""Strokes as PostScript: EPS by the Document Structuring Conventions, or a page for a printer.

The structure of the page is here. The arrays of numbers that fill it, and the procedures that draw these, are in
`postscript_arrays`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from penink_cli.formats.strokes import Sink
from penink_cli.ground.model import Strokes
from penink_cli.outputs.page import Page, ink_box
from penink_cli.outputs.postscript_arrays import PROLOG, SWELLING, Order, number, units_of, written

FLATE = b"/z {/F currentfile /ASCII85Decode filter def F /FlateDecode filter cvx exec F flushfile} bind def\n"


def write(
    out: Sink,
    layers: Sequence[Strokes],
    page: Page,
    colours: Sequence[tuple[float, float, float]] = (),
    compress: bool = False,
    order: Order = lambda strokes, first: strokes,
    separations: bool = False,
    with_preview: bool = False,
) -> None:
    """Write one EPS, or, where the page is a paper, one page for a printer.

    layers: the first at the bottom. colours: red, green, blue (0 … 1) of each layer; black if there is none.
    compress: the arrays are deflated, which needs a Level 3 interpreter.
    order: brings each run first[g] … first[g + 1] - 1 of strokes into an order with short ways between them.
    separations: every layer is a page by itself, and black. The page must be a paper.
    with_preview: the EPS has a preview, for programs that run no PostScript.
    """
    head = _write_head(out, layers, page, compress, len(layers) if separations else 1)
    if with_preview:
        from penink_cli.outputs import preview

        for line in preview.comments(layers, page, head, colours):
            out.write(line)
    _write_prolog(out, layers, page, compress)
    units = units_of(layers)
    pages = [[i] for i in range(len(layers))] if separations else [list(range(len(layers)))]
    for place, shown in enumerate(pages, 1):
        label = _text(layers[shown[0]].layer or f"layer {place}") if separations else b"1"
        out.write(b"%%%%Page: %s %d\n" % (label, place))
        if separations:
            out.write(b"%%%%PlateColor: %s\n" % label)
        _write_page(out, [(i, layers[i]) for i in shown], page, units, () if separations else colours, compress, order)
    out.write(b"%%Trailer\n%%EOF\n")


def _write_page(
    out: Sink, layers: Sequence[tuple[int, Strokes]], page: Page, units: int,
    colours: Sequence[tuple[float, float, float]], compress: bool, order: Order,
) -> None:  # fmt: skip
    """One page: the layers on it, each with its number. units: whole numbers of the arrays to a point."""
    # The position starts at the sheet's top-left corner; y is turned up only here.
    out.write(b"gsave penink begin\n1 setlinecap 1 setlinejoin [] 0 setdash\n")
    if page.landscape:
        out.write(b"90 rotate 0 %s translate\n" % number(-page.height))
    out.write(b"%s %s translate 1 %d div dup scale\n" % (number(page.x), number(page.height - page.y), units))
    # A half, MIDDLE: whole numbers would lie on the edges of a printer's pixels too often.
    out.write(b".5 dup translate\n")
    out.write(b"/x 0 def /y 0 def\n" if layers[0][0] else b"")
    at = (0, 0)
    for i, layer in layers:
        name = layer.layer or f"layer {i + 1}"
        out.write(b"%%%%BeginObject: %s\n" % _text(name))
        colour = colours[i] if i < len(colours) else (0.0, 0.0, 0.0)
        out.write(b"0 setgray\n" if colour == (0, 0, 0) else b"%s %s %s setrgbcolor\n" % tuple(map(number, colour)))
        body, at = written(layer, units, at, order)
        if compress:
            out.write(b"z\n")
            out.write(_ascii85(b"".join(body)))
        else:
            for part in body:
                out.write(part)
        out.write(b"%%EndObject\n")
    out.write(b"end grestore\n%%PageTrailer\nshowpage\n")


def _write_head(
    out: Sink, layers: Sequence[Strokes], page: Page, compress: bool, pages: int
) -> tuple[int, int, int, int]:
    """Write the comments at the beginning; returns the bounding box in whole points, y up."""
    x0, y0, x1, y1 = 0.0, 0.0, page.width, page.height
    if page.paper:  # what is printed on the paper, not the paper
        x0, y0 = page.x, page.y
        x1, y1 = x0 + max(s.width for s in layers), y0 + max(s.height for s in layers)
    for box in filter(None, map(ink_box, layers)):
        slack = 1 / units_of(layers)  # by rounding
        x0, y0 = min(x0, page.x + box[0] - slack), min(y0, page.y + box[1] - slack)
        x1, y1 = max(x1, page.x + box[2] + slack), max(y1, page.y + box[3] + slack)
    bounds = (x0, page.height - y1, x1, page.height - y0)
    media = (page.width, page.height)
    if page.landscape:  # the paper goes through the printer upright
        bounds = (y0, x0, y1, x1)
        media = (page.height, page.width)
    exact = [*(math.floor(v * 1000) / 1000 for v in bounds[:2]), *(math.ceil(v * 1000) / 1000 for v in bounds[2:])]
    rough = math.floor(exact[0]), math.floor(exact[1]), math.ceil(exact[2]), math.ceil(exact[3])
    out.write(b"%!PS-Adobe-3.0\n" if page.paper else b"%!PS-Adobe-3.0 EPSF-3.0\n")
    out.write(b"%%%%BoundingBox: %d %d %d %d\n" % rough)
    out.write(b"%%%%HiResBoundingBox: %s %s %s %s\n" % tuple(map(number, exact)))
    out.write(b"%%%%Creator: penink\n%%%%Pages: %d\n%%%%DocumentData: Clean7Bit\n" % pages)
    if compress:
        out.write(b"%%LanguageLevel: 3\n")
    elif page.paper:
        out.write(b"%%LanguageLevel: 2\n")
    if page.paper:
        size = tuple(map(number, media))
        out.write(b"%%%%Orientation: %s\n" % (b"Landscape" if page.landscape else b"Portrait"))
        out.write(b"%%%%DocumentMedia: %s %s %s 0 () ()\n" % (page.paper.encode("ascii"), *size))
    out.write(b"%%EndComments\n")
    return rough


def _write_prolog(out: Sink, layers: Sequence[Strokes], page: Page, compress: bool) -> None:
    out.write(b"%%BeginProlog\n")
    out.write(PROLOG)
    if any(s.knot_widths is not None for s in layers):
        out.write(SWELLING)
    if compress:
        out.write(FLATE)
    out.write(b"end\n%%EndProlog\n")
    if page.paper:
        # the paper goes through the printer upright
        media = (page.height, page.width) if page.landscape else (page.width, page.height)
        size = tuple(map(number, media))
        out.write(b"%%%%BeginSetup\n%%%%BeginFeature: *PageSize %s\n" % page.paper.encode("ascii"))
        out.write(b"<< /PageSize [%s %s] >> setpagedevice\n%%%%EndFeature\n%%%%EndSetup\n" % size)


def _ascii85(text: bytes) -> bytes:
    """The text deflated, in printable characters, on lines of 240 of which none begins with %."""
    import base64
    import zlib

    # Z_FILTERED: in lists of numbers short repetitions cost more than they save; 3 % smaller than the default.
    deflate = zlib.compressobj(9, zlib.DEFLATED, 15, 8, zlib.Z_FILTERED)
    coded = base64.a85encode(deflate.compress(text) + deflate.flush())
    lines = [coded[i : i + 240] for i in range(0, len(coded), 240)]
    # A line that begins with %% would look like a comment of the structure; white space is ignored.
    return b"\n".join(b" " + line if line.startswith(b"%") else line for line in lines) + b"~>\n"


def _text(name: str) -> bytes:
    """At most 80 characters of a name as a string of the structuring conventions: 7 bits, one line."""
    coded = b""
    for byte in name[:80].encode("utf-8", "replace"):
        if byte in b"()\\" or not 32 <= byte < 127:
            coded += b"\\%03o" % byte
        else:
            coded += bytes([byte])
    return b"(%s)" % coded
