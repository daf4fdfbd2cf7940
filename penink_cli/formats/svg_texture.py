"""SVG drawings as textures: their paths become strokes, in drawing order. The one module that imports svgelements."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any, BinaryIO
from xml.etree.ElementTree import ParseError

import numpy as np

from penink_cli.formats.strokes import LIMIT
from penink_cli.ground.errors import FormatError
from penink_cli.ground.model import Floats, Strokes, Texture

MAX_BYTES = 64 << 20
MAX_STROKES = 500_000
POINTS_PER_PIXEL = 0.75  # CSS: 96 pixels to the inch
USUAL_PEN_PT = 0.4
CLOSED = 1e-6  # pixels: arcs do not come round to the very digit, and a shape is closed all the same


def read(
    stream: BinaryIO,
    source: str,
    name: str,
    pen_pt: float | None = None,
    whole: bool = False,
    report: Callable[[str], None] = lambda line: None,
) -> Texture:
    """The texture that an SVG drawing makes.

    Everything that has an outline counts, filled or not: paths, lines, polygons, circles …, their transforms applied;
    a subpath is a stroke. The tile is the drawing's size. pen_pt: the width of all strokes; by default each
    one's stroke-width, or 0.4 pt where it has none. report: told what is left out, text and images. Raises FormatError.
    """
    text = stream.read(MAX_BYTES + 1)
    try:
        if len(text) > MAX_BYTES:
            raise FormatError(f"larger than {MAX_BYTES} bytes")
        return _texture(_parse(text), name, pen_pt, whole, report)
    except FormatError as error:
        from penink_cli.formats.recognise import explained

        raise explained(error, text, "svg").from_source(source) from None


def _parse(text: bytes) -> Any:
    import svgelements

    try:
        drawing = svgelements.SVG.parse(io.BytesIO(text), reify=True, ppi=96.0)
    except ParseError as error:
        raise FormatError(f"not SVG: {error}") from None
    except (ValueError, TypeError, AttributeError, IndexError, KeyError, ZeroDivisionError, RecursionError) as error:
        # the parser lets what its own conversions raise on broken values through
        raise FormatError(f"not SVG that can be read: {type(error).__name__}: {error}") from None
    if not isinstance(drawing, svgelements.SVG):
        raise FormatError("not SVG: the outermost element is not svg")
    return drawing


def _texture(drawing: Any, name: str, pen_pt: float | None, whole: bool, report: Callable[[str], None]) -> Texture:
    import svgelements

    size = [_number(getattr(drawing, side, None)) for side in ("width", "height")]
    if not all(0.01 <= s * POINTS_PER_PIXEL <= LIMIT for s in size):
        raise FormatError("the drawing has no size: width and height, or a viewBox, are needed")
    strokes: list[Floats] = []
    widths: list[float] = []
    left_out = {"text": 0, "image": 0}
    for element in drawing.elements():
        if isinstance(element, (svgelements.Text, svgelements.Image)):
            left_out["image" if isinstance(element, svgelements.Image) else "text"] += 1
        if not isinstance(element, svgelements.Shape) or element.values.get("visibility") == "hidden":
            continue
        width = _number(element.stroke_width) * POINTS_PER_PIXEL if element.stroke.value is not None else 0.0
        for control in _chains(svgelements.Path(element)):
            strokes.append(control * POINTS_PER_PIXEL)
            widths.append(pen_pt or (width if width >= 0.0001 else USUAL_PEN_PT))
            if len(strokes) > MAX_STROKES:
                raise FormatError(f"more than {MAX_STROKES} strokes")
    dropped = " and ".join(f"{count} {what}{'s' * (count > 1)}" for what, count in left_out.items() if count)
    if not strokes:
        raise FormatError(f"no path, line or shape in the drawing{', only ' * bool(dropped)}{dropped}")
    if dropped:
        report(f"{dropped} left out; turn text to paths to have it")
    points = np.concatenate(strokes)
    if not (np.abs(points) <= LIMIT).all():
        raise FormatError(f"a coordinate that is no number, or is beyond ±{LIMIT:.0f} pt")
    first = np.zeros(len(strokes) + 1, np.int64)
    np.cumsum([len(s) for s in strokes], out=first[1:])
    tile = Strokes(
        size[0] * POINTS_PER_PIXEL, size[1] * POINTS_PER_PIXEL, points, first, np.array(widths), texture=name
    )
    return Texture(name, tile, np.arange(len(strokes), dtype=np.float64), whole)


def _number(value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        return 0.0


def _chains(path: Any) -> list[Floats]:
    """Chains of cubics (3k + 1, 2) of a path, one for each subpath; a subpath of no length is a dot."""
    import svgelements

    chains: list[list[tuple[float, float]]] = []
    for segment in path:
        if isinstance(segment, svgelements.Move):
            continue
        start, end = segment.start, segment.end
        if start is None or end is None:
            continue
        here = (start.x, start.y)
        if not chains or chains[-1][-1] != here:
            chains.append([here])
        if isinstance(segment, svgelements.CubicBezier):
            chains[-1] += [(p.x, p.y) for p in (segment.control1, segment.control2, end)]
        elif isinstance(segment, svgelements.QuadraticBezier):
            c = segment.control
            chains[-1] += [((a.x + 2 * c.x) / 3, (a.y + 2 * c.y) / 3) for a in (start, end)] + [(end.x, end.y)]
        elif isinstance(segment, svgelements.Arc):
            for cubic in segment.as_cubic_curves():
                chains[-1] += [(p.x, p.y) for p in (cubic.control1, cubic.control2, cubic.end)]
        elif max(abs(start.x - end.x), abs(start.y - end.y)) > CLOSED:
            chains[-1] += [
                (start.x + (end.x - start.x) * t, start.y + (end.y - start.y) * t) for t in (1 / 3, 2 / 3)
            ] + [(end.x, end.y)]
    return [np.array(chain, np.float64) for chain in chains]
