"""Strokes as PostScript: an EPS file by the Document Structuring Conventions.

Coordinates are whole numbers of 1/20 pt, each relative to the point before it, and one
short procedure draws each kind of stroke.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from penink_cli.formats.strokes import Sink
from penink_cli.model import Strokes

UNITS = 20  # a point

PROLOG = b"""\
/penink 8 dict def
penink begin
/u {%d div} bind def
/w {setlinewidth} bind def
/m {rmoveto} bind def
/c {rcurveto} bind def
/l {rlineto} bind def
/s {currentpoint stroke moveto} bind def
/d {rmoveto 0 0 rlineto currentpoint stroke moveto} bind def
end
"""


def bounds(strokes: Sequence[Strokes]) -> tuple[float, float, float, float]:
    """x0, y0, x1, y1 (y down) of a box that holds the sheets and all ink."""
    x0, y0 = 0.0, 0.0
    x1, y1 = max(s.width for s in strokes), max(s.height for s in strokes)
    for s in strokes:
        if len(s):
            half = np.repeat(s.widths / 2, np.diff(s.first))[:, None]
            low, high = (s.points - half).min(axis=0), (s.points + half).max(axis=0)
            x0, y0 = min(x0, float(low[0])), min(y0, float(low[1]))
            x1, y1 = max(x1, float(high[0])), max(y1, float(high[1]))
    return x0, y0, x1, y1


def write(out: Sink, layers: Sequence[Strokes]) -> None:
    """Write one EPS with all layers, the first at the bottom."""
    height = max(s.height for s in layers)
    x0, y0, x1, y1 = bounds(layers)
    low_x, low_y, high_x, high_y = x0, height - y1, x1, height - y0
    box = (math.floor(low_x), math.floor(low_y), math.ceil(high_x), math.ceil(high_y))
    out.write(
        b"%%!PS-Adobe-3.0 EPSF-3.0\n%%%%BoundingBox: %d %d %d %d\n%%%%HiResBoundingBox: %.3f %.3f %.3f %.3f\n"
        % (*box, *(math.floor(v * 1000) / 1000 for v in (low_x, low_y)), *(math.ceil(v * 1000) / 1000 for v in (high_x, high_y)))
    )
    out.write(b"%%Creator: penink\n%%Pages: 1\n%%DocumentData: Clean7Bit\n%%EndComments\n%%BeginProlog\n")
    out.write(PROLOG % UNITS)
    out.write(b"%%EndProlog\n%%Page: 1 1\ngsave penink begin 1 u dup scale 1 setlinecap 1 setlinejoin 0 setgray\n")
    for s in layers:
        out.write(_body(s, height))
    out.write(b"end grestore\nshowpage\n%%Trailer\n%%EOF\n")


def _body(s: Strokes, height: float) -> bytes:
    lines = ["0 0 moveto"]
    whole = np.rint(s.points * (UNITS, -UNITS) + (0, height * UNITS)).astype(np.int64)
    widths = np.rint(s.widths * UNITS * 100) / 100
    at_x = at_y = 0
    width = None
    first = s.first.tolist()
    for i, w in enumerate(widths.tolist()):
        if w != width:
            lines.append(f"{w:g} w")
            width = w
        p = whole[first[i] : first[i + 1]].tolist()
        x, y = p[0]
        if len(p) == 1:
            lines.append(f"{x - at_x} {y - at_y} d")
        else:
            words = [f"{x - at_x} {y - at_y} m"]
            for k in range(1, len(p), 3):
                (a, b), (c, d), (e, f) = p[k : k + 3]
                words.append(f"{a - x} {b - y} {c - x} {d - y} {e - x} {f - y} c")
                x, y = e, f
            lines.append(" ".join(words) + " s")
        at_x, at_y = x, y
    return ("\n".join(lines) + "\n").encode("ascii")
