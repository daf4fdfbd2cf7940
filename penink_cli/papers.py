"""Papers by their names, and by their sizes."""

from __future__ import annotations

from penink_cli.errors import ParameterError, in_quotes
from penink_cli.units import parse_length

_MM = 72 / 25.4
PAPERS = {
    **{f"a{n}": (w * _MM, h * _MM) for n, (w, h) in enumerate(
        [(841, 1189), (594, 841), (420, 594), (297, 420), (210, 297), (148, 210), (105, 148)])},
    **{f"b{n}": (w * _MM, h * _MM) for n, (w, h) in enumerate(
        [(1000, 1414), (707, 1000), (500, 707), (353, 500), (250, 353), (176, 250)])},
    "letter": (612.0, 792.0), "legal": (612.0, 1008.0), "tabloid": (792.0, 1224.0), "executive": (522.0, 756.0),
}  # fmt: skip
SMALL_PT = 18.0  # a quarter of an inch: who asks for less has most likely forgotten the unit
LIMIT = 1e6  # points; more than the biggest sheet of any of the formats


def paper_size(name: str) -> tuple[float, float]:
    """Width and height in points of a paper's name, or of WIDTHxHEIGHT as ``210mmx297mm``."""
    if name.lower() in PAPERS:
        return PAPERS[name.lower()]
    sides = name.lower().split("x")
    if len(sides) == 2:
        try:
            width, height = map(parse_length, sides)
        except ParameterError:
            width = height = 0.0
        if 0 < width <= LIMIT and 0 < height <= LIMIT:
            return width, height
    import difflib

    near = difflib.get_close_matches(name.lower(), PAPERS, n=1, cutoff=0.6)
    hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(PAPERS)} and sizes such as 210mmx297mm"
    raise ParameterError(f"no paper {in_quotes(name)}; {hint}")


def check_sheet(width_pt: float, height_pt: float) -> None:
    """Refuse sheets of no size, and those that no memory holds; warn of one that is smaller than a stamp."""
    if not (0.01 <= width_pt <= 144_000 and 0.01 <= height_pt <= 144_000):
        raise ParameterError(f"{width_pt:g} × {height_pt:g} pt on paper; from 0.01 to 144000 is allowed each way")
    if width_pt * height_pt > 60 * 40 * 5184 * 4:
        raise ParameterError(f"{width_pt:g} × {height_pt:g} pt on paper; 9600 square inches are allowed")
    if max(width_pt, height_pt) < SMALL_PT:
        from penink_cli.options import warn

        size = f"{width_pt:.3g} × {height_pt:.3g} pt ({width_pt / _MM:.2g} × {height_pt / _MM:.2g} mm)"
        warn(f"the drawing is {size} on paper, which shows little; a bare number is points, 72 to the inch")
