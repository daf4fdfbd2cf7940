"""Strokes as PDF: one page of vector paths, layers as optional content that viewers can switch.

pydyf writes the objects and the cross-reference table. There is no date and no identifier, so equal
strokes give equal bytes.
"""

from __future__ import annotations

import io
import zlib
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from penink_cli.ground.decimals import plain
from penink_cli.outputs.registry import Option

if TYPE_CHECKING:  # the help text needs none of it
    import numpy as np

    from penink_cli.formats.strokes import Sink
    from penink_cli.ground.model import Strokes
    from penink_cli.outputs.page import Page

GUIDE = """
The page has the picture's size, or is the --paper. Several FILEs are layers, the first at the
bottom, which viewers can switch on and off; coloured ones are transparent inks over one another.

\b
penink to-pdf photo.strokes.jsonl -o photo.pdf
penink to-pdf --paper letter --margin 0.5in photo.strokes.jsonl -o photo.pdf
"""
OPTIONS = (
    Option("title", "Title of the document, for viewers and print shops.", ""),
    Option("author", "Author of the document.", ""),
    Option("trim", "Say that the sheet is cut to the picture: a trim box.", False),
)
DECIMALS = 3  # of a point
OUTLINE_DECIMALS = 2  # of a point: outlines are written in whole hundredths
MOST = 14400  # user-space units: viewers differ about longer sides of a page


def write(
    out: Sink, layers: Sequence[Strokes], page: Page, colours: Sequence[tuple[float, float, float]] = (),
    title: str = "", author: str = "", trim: bool = False,
) -> None:  # fmt: skip
    """Write a PDF 1.5 file; the first layer is at the bottom. Colours: red, green, blue (0 … 1) of each layer.

    Where there are several colours, a layer is a group that is multiplied with what lies below: its ink is transparent,
    but its own strokes do not darken one another where they cross. title, author: left out where empty. trim: with a
    trim box around the sheet.
    """
    import numpy as np
    import pydyf

    from penink_cli.outputs import inks

    document = pydyf.PDF()
    colours = [colours[i] if i < len(colours) else inks.BLACK for i in range(len(layers))]
    over = inks.overprint(colours)
    # Sides beyond Acrobat's limit are given in a larger unit.
    unit = max(1.0, max(page.width, page.height) / MOST)
    box = pydyf.Array([0, 0, *(round(side / unit, DECIMALS) for side in (page.width, page.height))])
    # where there are dots, polygons that are made of curves are as fine as they may be: `ground.device`
    begin = b"1 J 1 j .2 i\n" if any((np.diff(layer.first) == 1).any() for layer in layers) else b"1 J 1 j\n"
    if unit > 1:
        begin = b"%.9f 0 0 %.9f 0 0 cm\n" % (1 / unit, 1 / unit) + begin
    content = [b"/M gs\n" if over else begin]
    forms = pydyf.Dictionary()
    properties, groups = pydyf.Dictionary(), pydyf.Array()
    for i, layer in enumerate(layers):
        group = pydyf.Dictionary({"Type": "/OCG", "Name": pydyf.String(layer.layer or f"layer {i + 1}")})
        document.add_object(group)
        groups.append(group.reference)
        properties[f"L{i + 1}"] = group.reference
        colour = colours[i]
        drawn = [b"0 G\n" if colour == (0, 0, 0) else b"%.4f %.4f %.4f RG\n" % colour]
        swells = layer.swells
        if swells.any():
            layer, wide = layer.taken(~swells), layer.taken(swells)
            drawn += [drawn[0].lower(), _outlines(wide, page)]
        drawn += _paths(layer, page)
        if over:
            alone = {"S": "/Transparency", "CS": "/DeviceRGB", "I": "true"}
            kind = {"Type": "/XObject", "Subtype": "/Form", "BBox": box, "Group": pydyf.Dictionary(alone)}
            form = _stream([begin, *drawn], kind)
            document.add_object(form)
            forms[f"X{i + 1}"] = form.reference
            drawn = [b"/X%d Do\n" % (i + 1)]
        content += [b"/OC /L%d BDC\n" % (i + 1), *drawn, b"EMC\n"]
    stream = _stream(content, {})
    document.add_object(stream)
    resources = {"Properties": properties}
    if over:
        multiply = pydyf.Dictionary({"M": pydyf.Dictionary({"BM": "/Multiply"})})
        resources |= {"XObject": forms, "ExtGState": multiply}
    leaf = {
        "Type": "/Page",
        "Parent": document.pages.reference,
        "Contents": stream.reference,
        "MediaBox": box,
        "Resources": pydyf.Dictionary(resources),
    }
    if over:
        leaf["Group"] = pydyf.Dictionary({"S": "/Transparency", "CS": "/DeviceRGB"})
    if trim:
        sheet = (max(s.width for s in layers), max(s.height for s in layers))
        corners = (page.x, page.height - page.y - sheet[1], page.x + sheet[0], page.height - page.y)
        leaf["TrimBox"] = pydyf.Array([round(max(v, 0.0) / unit, DECIMALS) for v in corners])
    for name, text in (("Title", title), ("Author", author)):
        if text:
            document.info[name] = pydyf.String(text)
    if unit > 1:
        leaf["UserUnit"] = round(unit, 9)
    document.add_page(pydyf.Dictionary(leaf))
    document.catalog["OCProperties"] = pydyf.Dictionary(
        {"OCGs": groups, "D": pydyf.Dictionary({"Order": groups, "ON": groups})}
    )
    held = io.BytesIO()
    document.write(held, version=b"1.5" if unit == 1 else b"1.6")
    out.write(held.getvalue())


def _stream(content: list[bytes], entries: dict[str, object]) -> Any:
    import pydyf

    return pydyf.Stream([zlib.compress(b"".join(content), 6)], {**entries, "Filter": "/FlateDecode"})


def _paths(layer: Strokes, page: Page) -> list[bytes]:
    """The operators that draw a layer, each stroke by itself; the width of the pen is set where it changes."""
    import numpy as np

    from penink_cli.outputs import words

    if not len(layer):
        return []
    counts = np.diff(layer.first)
    exact = layer.points * (1, -1) + np.array((page.x, page.height - page.y))
    grid = words.whole(exact * 10**DECIMALS)
    last = layer.first[1:] - 1
    # A dot is a line to itself: its numbers stand twice.
    times = np.ones(len(grid), np.int64)
    times[last[counts == 1]] = 2
    numbers = np.repeat(grid, times, axis=0)
    inner = np.arange(len(grid)) - np.repeat(layer.first[:-1], counts)
    after = np.zeros((len(grid), 2), np.int32)
    after[inner == 0, 1] = 1
    after[(inner > 0) & (inner % 3 == 0), 1] = 2
    pens, pen = np.unique(words.whole(layer.widths * 10000), return_inverse=True)
    # The word that ends a stroke sets the pen of the next stroke, if that is another pen.
    follows = np.append(pen[1:], pen[-1])
    switch = np.where(follows == pen, 0, 1 + follows)
    table = [b" ", b" m\n", b" c\n", *(b" c S\n" + w for w in _pens(pens)), *(b" l S\n" + w for w in _pens(pens))]
    after[last[counts > 1], 1] = 3 + switch[counts > 1]
    after = np.repeat(after, times, axis=0)
    copies = np.cumsum(times) - 1  # the last copy of each point
    after[copies[last[counts == 1]], 1] = 3 + len(pens) + 1 + switch[counts == 1]
    return [_pens(pens)[1 + pen[0]], bytes(words.text(numbers.ravel(), after.ravel(), table, DECIMALS))]


def _outlines(strokes: Strokes, page: Page) -> bytes:
    """The operators that fill the outlines of strokes that swell, in coordinates relative to where each begins."""
    import numpy as np

    from penink_cli.outputs import swelling, words

    points, first = swelling.outlines(strokes)
    exact = points * (1, -1) + np.array((page.x, page.height - page.y))
    grid = words.whole(exact * 10**OUTLINE_DECIMALS)
    counts = np.diff(first)
    inner = np.arange(len(grid)) - np.repeat(first[:-1], counts)
    grid = np.where((inner > 0)[:, None], grid - np.repeat(grid[first[:-1]], counts, axis=0), grid)
    after = np.zeros((len(grid), 2), np.int32)
    after[inner == 0, 1] = 1
    after[(inner > 0) & (inner % 3 == 0), 1] = 2
    after[first[1:] - 1, 1] = 3
    begin = b"q 1 0 0 1 "
    table = [b" ", b" cm 0 0 m\n", b" c\n", b" c f Q\n" + begin]
    body = bytes(words.text(grid.ravel(), after.ravel(), table))
    unit = plain(1 / 10**OUTLINE_DECIMALS, OUTLINE_DECIMALS).encode()
    return b"q %s 0 0 %s 0 0 cm\n" % (unit, unit) + begin + body[: len(body) - len(begin)] + b"Q\n"


def _pens(pens: np.ndarray) -> list[bytes]:
    """The operators that set the pens (in ten-thousandths of a point); before them one that does nothing."""
    return [b"", *(plain(p / 10000, 4).encode() + b" w\n" for p in pens.tolist())]
