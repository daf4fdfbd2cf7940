"""Papers by their names, and by their sizes."""

from __future__ import annotations

from penink_cli.ground.errors import ParameterError, in_quotes
from penink_cli.ground.units import MM, parse_length

PAPERS = {
    **{f"a{n}": (w * MM, h * MM) for n, (w, h) in enumerate(
        [(841, 1189), (594, 841), (420, 594), (297, 420), (210, 297), (148, 210), (105, 148)])},
    **{f"b{n}": (w * MM, h * MM) for n, (w, h) in enumerate(
        [(1000, 1414), (707, 1000), (500, 707), (353, 500), (250, 353), (176, 250)])},
    "letter": (612.0, 792.0), "legal": (612.0, 1008.0), "tabloid": (792.0, 1224.0), "executive": (522.0, 756.0),
}  # fmt: skip
LIMIT = 1e6  # points; more than the biggest sheet of any of the formats
_NUMBER = "0123456789."


def plain_name(name: str) -> str:
    """A paper's name or size in small letters and without white space.

    >>> plain_name("30 × 21\\tcm")
    '30x21cm'
    """
    return "".join(name.lower().replace("×", "x").split())


def paper_size(name: str) -> tuple[float, float]:
    """Width and height in points of a paper's name, or of WIDTHxHEIGHT as ``210x297mm``: one unit serves both.

    Raises ParameterError.

    >>> paper_size("11x17in") == paper_size("11inx17in") == (792.0, 1224.0)
    True
    """
    if name.lower() in PAPERS:
        return PAPERS[name.lower()]
    sides = plain_name(name).split("x")
    if len(sides) == 2:
        try:
            if not sides[0].strip(_NUMBER):
                sides[0] += sides[1].lstrip(_NUMBER)
            width, height = map(parse_length, sides)
        except ParameterError:
            width = height = 0.0
        if 0 < width <= LIMIT and 0 < height <= LIMIT:
            return width, height
    import difflib

    near = difflib.get_close_matches(name.lower(), PAPERS, n=1, cutoff=0.6)
    hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(PAPERS)} and sizes such as 210x297mm"
    raise ParameterError(f"no paper {in_quotes(name)}; {hint}")
