"""SVG drawings as textures: their paths become strokes, in drawing order. No other module imports svgelements."""

from __future__ import annotations

import io
import math
import re
from collections.abc import Callable
from typing import Any, BinaryIO
from xml.etree import ElementTree
from xml.etree.ElementTree import ParseError

import numpy as np

from penink_cli.formats.strokes import LIMIT
from penink_cli.formats.texture import LEAST_WIDTH
from penink_cli.ground import exact
from penink_cli.ground.errors import FormatError, printable
from penink_cli.ground.model import Floats, Strokes, Texture

MAX_BYTES = 64 << 20
MAX_STROKES = 500_000
POINTS_PER_PIXEL = 0.75  # CSS: 96 pixels to the inch
USUAL_PEN_PT = 0.4
MAX_ELEMENTS = 1_000_000  # of a drawing, once each `use` is what it names
WHITE = 250  # of 255: a colour with at least so much of red, green and blue leaves no ink
CHORDS = 32  # chords by which the length of a segment is measured where it is cut into dashes
CLOSED = 1e-6  # pixels: a gap at the end of a closed shape that is no more is a rounding error of its arcs


def read(
    stream: BinaryIO,
    source: str,
    name: str,
    pen_pt: float | None = None,
    whole: bool = False,
    report: Callable[[str], None] = lambda line: None,
) -> Texture:
    """The texture that an SVG drawing makes.

    Every shape that leaves ink counts, its transforms applied. A stroked shape is followed, dash by dash if it is
    dashed, and one that is only filled is drawn around. Each subpath is a stroke. The tile has the drawing's size.

    pen_pt: the width of all strokes; None for each shape's stroke-width, or 0.4 pt where it has none. whole: as
    `Texture` has it. report: receives a line about what is left out, which is what is invisible or white, a background,
    text and images, and about clipped shapes, which are drawn whole.

    Raises FormatError, also for more than MAX_BYTES bytes, MAX_ELEMENTS elements or MAX_STROKES strokes.
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
    """The drawing as svgelements has it. Raises FormatError."""
    import svgelements

    try:
        _check_elements(text)
        drawing = svgelements.SVG.parse(io.BytesIO(_seen(text)), reify=True, ppi=96.0)
    except ParseError as error:
        raise FormatError(f"not SVG: {error}") from None
    except FormatError:
        raise
    except (ValueError, TypeError, AttributeError, LookupError, ArithmeticError, RecursionError) as error:
        # The parser does not catch what its own conversions raise on broken values.
        raise FormatError(f"not SVG that can be read: {printable(f'{type(error).__name__}: {error}', 120)}") from None
    if not isinstance(drawing, svgelements.SVG):
        raise FormatError("not SVG: the outermost element is not svg")
    return drawing


def _check_elements(text: bytes) -> None:
    """Raise FormatError for a drawing that a few `use` in one another make huge, and for one that uses itself."""
    if b"use" not in text:
        return
    tree = ElementTree.fromstring(text)
    named = {element.get("id"): element for element in tree.iter()}
    known: dict[ElementTree.Element, int] = {}

    def count(element: ElementTree.Element) -> int:
        if element not in known:
            known[element] = MAX_ELEMENTS  # while it is being counted: it is met again only in itself
            used = element.get("href", element.get("{http://www.w3.org/1999/xlink}href", "")).strip()
            parts = list(element)
            if str(element.tag).endswith("use") and used.startswith("#") and used[1:] in named:
                parts.append(named[used[1:]])
            known[element] = 1 + sum(map(count, parts))  # whole numbers
        return known[element]

    if count(tree) > MAX_ELEMENTS:
        raise FormatError(f"more than {MAX_ELEMENTS} elements, or one that uses itself")


def _seen(text: bytes) -> bytes:
    """The drawing without what its parser shows although it is hidden.

    That is what stands in a group of no opacity or display, and symbols outside of defs. No child can show again what
    its group hides, whatever is said of the child itself.
    """
    if not any(word in text for word in (b"opacity", b"display", b"symbol")):
        return text
    tree = ElementTree.fromstring(text)
    rules = _rules(tree)
    changed = False
    for parent in list(tree.iter()):
        for i, element in enumerate(parent):
            if not isinstance(element.tag, str):
                continue
            if len(element) and (_is_none(_said(element, rules, "opacity", "1"))
                                 or _said(element, rules, "display", "") == "none"):  # fmt: skip
                for hidden in element.iter():
                    if isinstance(hidden.tag, str):
                        hidden.set("style", "display:none")
                        hidden.set("display", "none")
                changed = True
            kind = element.tag.rpartition("}")
            if kind[2] == "symbol" and parent.tag != f"{kind[0]}{kind[1]}defs":
                defs = ElementTree.Element(f"{kind[0]}{kind[1]}defs")
                defs.append(element)
                parent[i] = defs
                changed = True
    if not changed:
        return text
    ElementTree.register_namespace("", "http://www.w3.org/2000/svg")
    ElementTree.register_namespace("xlink", "http://www.w3.org/1999/xlink")
    return ElementTree.tostring(tree)


def _is_none(opacity: str) -> bool:
    """Whether an opacity is 0 or less; what is no number is not."""
    return bool(re.fullmatch(r"[-+]?0*\.?0*%?|-.*", opacity) and re.search("[0-9]", opacity))


def _rules(tree: ElementTree.Element) -> list[tuple[str, dict[str, str]]]:
    """The rules of style sheets in the drawing, in their order: a selector (a tag, .class, #id or *), declarations."""
    rules = []
    for element in tree.iter():
        if isinstance(element.tag, str) and element.tag.rpartition("}")[2] == "style":
            sheet = re.sub(r"/\*.*?\*/", "", element.text or "", flags=re.DOTALL)
            for selectors, said in re.findall(r"([^{}]*)\{([^{}]*)\}", sheet):
                rules += [(selector.strip(), _declared(said)) for selector in selectors.split(",")]
    return rules


def _declared(text: str) -> dict[str, str]:
    """CSS declarations by their names."""
    pairs = (part.partition(":") for part in text.split(";"))
    return {name.strip(): value.replace("!important", "").strip() for name, _, value in pairs}


def _said(element: ElementTree.Element, rules: list[tuple[str, dict[str, str]]], name: str, usual: str) -> str:
    """The value of a property that an element itself is given.

    Its style comes first, then a style sheet by its id, class or tag, then its attribute, then ``usual``.
    """
    own = _declared(element.get("style", ""))
    if name in own:
        return own[name]
    classes = {f".{word}" for word in element.get("class", "").split()}
    for known in ({f"#{element.get('id')}"}, classes, {element.tag.rpartition("}")[2]}, {"*"}):
        found = [said[name] for selector, said in rules if selector in known and name in said]
        if found:
            return found[-1]
    return element.get(name, usual).strip()


def _texture(drawing: Any, name: str, pen_pt: float | None, whole: bool, report: Callable[[str], None]) -> Texture:
    """The texture of a parsed drawing. Raises FormatError."""
    import svgelements

    size = [_number(getattr(drawing, side, None)) for side in ("width", "height")]
    if not all(0.01 <= s * POINTS_PER_PIXEL <= LIMIT for s in size):
        raise FormatError("the drawing has no size: width and height, or a viewBox, are needed")
    strokes: list[Floats] = []
    widths: list[float] = []
    left_out = {"invisible shape": 0, "white shape": 0, "background": 0, "text": 0, "image": 0}
    clipped = 0
    for element in drawing.elements():
        if isinstance(element, (svgelements.Text, svgelements.Image)):
            left_out["image" if isinstance(element, svgelements.Image) else "text"] += 1
        if not isinstance(element, svgelements.Shape):
            continue
        chains = _chains(svgelements.Path(element))
        paint = _paint(element, chains, size)
        if paint in left_out:
            left_out[paint] += 1
            continue
        clipped += element.values.get("clip-path", "none") != "none"
        width = _number(element.stroke_width) * POINTS_PER_PIXEL if paint == "stroke" else 0.0
        if paint == "stroke" and (pattern := _dashes(element)):
            chains = [part for control in chains for part in _dashed(control, *pattern)]
        for control in chains:
            strokes.append(control * POINTS_PER_PIXEL)
            widths.append(pen_pt or (width if width >= LEAST_WIDTH else USUAL_PEN_PT))
            if len(strokes) > MAX_STROKES:
                raise FormatError(f"more than {MAX_STROKES} strokes")
    parts = [f"{count} {what}{'s' * (count > 1)}" for what, count in left_out.items() if count]
    dropped = " and ".join([", ".join(parts[:-1]), parts[-1]] if len(parts) > 1 else parts)
    if not strokes:
        raise FormatError(f"no path, line or shape that leaves ink in the drawing{', only ' * bool(dropped)}{dropped}")
    said = [f"{dropped} left out" + "; turn text to paths to have it" * bool(left_out["text"])] if dropped else []
    if said + [clipped] * bool(clipped):
        report("; ".join([*said, *[f"{clipped} clipped, and drawn whole"] * bool(clipped)]))
    points = np.concatenate(strokes)
    if not (np.abs(points) <= LIMIT).all() or not max(widths) <= LIMIT:
        raise FormatError(f"a coordinate or a stroke-width that is no number, or is beyond ±{LIMIT:.0f} pt")
    first = np.zeros(len(strokes) + 1, np.int64)
    np.cumsum([len(s) for s in strokes], out=first[1:])
    tile = Strokes(
        size[0] * POINTS_PER_PIXEL, size[1] * POINTS_PER_PIXEL, points, first, np.array(widths), texture=name
    )
    return Texture(name, tile, np.arange(len(strokes), dtype=np.float64), whole)


def _paint(element: Any, chains: list[Floats], size: list[float]) -> str:
    """The part of a shape that leaves ink, "stroke" or "fill"; or what a shape without ink is called in the report.

    chains: of the shape, in pixels. size: the drawing's width and height, pixels.
    """
    values = element.values
    if values.get("visibility") in ("hidden", "collapse") or _opacity(values.get("opacity")) <= 0 or not chains:
        return "invisible shape"
    stroke, fill = (_colour(paint) for paint in (element.stroke, element.fill))
    if stroke and _number(element.stroke_width) <= 0:
        stroke = ""
    if stroke == "ink":
        return "stroke"
    if fill == "ink":
        return "background" if _covers(chains, size) else "fill"
    return "white shape" if "white" in (stroke, fill) else "invisible shape"


def _colour(paint: Any) -> str:
    """What a paint leaves: "ink", "white", or "" for nothing."""
    if paint is None or paint.value is None or paint.opacity <= 0:
        return ""
    return "white" if min(paint.red, paint.green, paint.blue) >= WHITE else "ink"


def _opacity(text: Any) -> float:
    """An opacity, 1 where it is missing or no number."""
    try:
        text = str(text or 1).strip()
        return float(text[:-1]) / 100 if text.endswith("%") else float(text)
    except ValueError:
        return 1.0


def _covers(chains: list[Floats], size: list[float]) -> bool:
    """Whether a shape of no more than four sides covers the whole drawing, but for a hundredth of it."""
    if len(chains) != 1 or len(chains[0]) > 3 * 4 + 1:
        return False
    low, high = chains[0].min(axis=0), chains[0].max(axis=0)
    slack = 0.01 * np.array(size)
    return bool((low <= slack).all() and (high >= np.array(size) - slack).all())


def _dashes(element: Any) -> tuple[list[float], float] | None:
    """The lengths of dashes and gaps in turn, and the offset, in pixels; None for a solid line."""
    import svgelements

    words = re.split(r"[,\s]+", str(element.values.get("stroke-dasharray") or "none").strip())
    try:
        matrix = svgelements.Matrix(element.values.get("transform") or "")
        scale = math.sqrt(abs(matrix.a * matrix.d - matrix.b * matrix.c))
        lengths = [float(svgelements.Length(word).value(ppi=96.0)) * scale for word in words]
        offset = svgelements.Length(str(element.values.get("stroke-dashoffset") or 0)).value(ppi=96.0)
        offset = float(offset) * scale
    except (TypeError, ValueError, AttributeError):  # none, or percentages
        return None
    if min(lengths) < 0 or not 0 < math.fsum(lengths) < LIMIT or not abs(offset) < LIMIT:
        return None
    return lengths * (1 + len(lengths) % 2), offset


def _dashed(control: Floats, lengths: list[float], offset: float) -> list[Floats]:
    """The dashes of a chain of cubics (3k + 1, 2), each a chain too. Raises FormatError for more than MAX_STROKES."""
    t = np.arange(CHORDS + 1)[:, None] / CHORDS
    segments = [control[k : k + 4] for k in range(0, len(control) - 1, 3)]
    way: list[Floats] = []
    for a, b, c, d in segments:
        u = 1 - t
        curve = u * u * u * a + 3 * t * u * u * b + 3 * t * t * u * c + t * t * t * d
        way.append(np.cumsum(np.append(0.0, exact.length(np.diff(curve, axis=0)))))
    ends = np.cumsum([0.0, *(w[-1] for w in way)])
    period = math.fsum(lengths)
    if ends[-1] / period * len(lengths) > 2 * MAX_STROKES:
        raise FormatError(f"more than {MAX_STROKES} dashes")
    if not segments:
        return [control]
    pieces = []
    at, k = -(offset % period), 0
    while at < ends[-1]:
        begin, end = max(at, 0.0), min(at + lengths[k], float(ends[-1]))
        if k % 2 == 0 and end >= begin and at + lengths[k] >= 0:
            piece = _between(segments, way, ends, begin, end)
            if len(piece):
                pieces.append(piece)
        at, k = at + lengths[k], (k + 1) % len(lengths)
    return pieces


def _between(segments: list[Floats], way: list[Floats], ends: Floats, begin: float, end: float) -> Floats:
    """The part of a chain between two lengths along it; a dot where they are equal.

    segments: (4, 2) control points each. way: the length at the ends of each one's chords. ends: at each one's ends.
    """
    points: list[Floats] = []
    for i, segment in enumerate(segments):
        if end < ends[i] or begin > ends[i + 1] or (begin == ends[i + 1] and begin < end):
            continue
        places = np.arange(CHORDS + 1) / CHORDS
        u, v = (float(np.interp(x - ends[i], way[i], places)) for x in (begin, end))
        if v < u or (u == v and begin < end):
            continue

        def polar(*at: float, p: Floats = segment) -> Floats:
            for t in at:
                p = p[:-1] + (p[1:] - p[:-1]) * t
            return p[0]

        if not points:
            points.append(polar(u, u, u))
        if begin == end:
            break
        points += [polar(u, u, v), polar(u, v, v), polar(v, v, v)]
    return np.array(points).reshape(-1, 2)


def _number(value: Any) -> float:
    """A number, 0 for what is none."""
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
