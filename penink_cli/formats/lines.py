"""Telling lines (``*.lines.json``): what a pen would draw of a photograph besides its tone, in the photo's pixels.

    {"format": "penink-lines", "version": 1, "width": 640, "height": 480, "lines": [
      {"points": [[10, 20.5], [14, 22], [19, 22.5]], "weight": [0.2, 0.9, 0.4], "rank": 7.25},
      {"points": [[300, 90], [310, 80]], "weight": [0.5, 0.5], "rank": 2, "white": true},
      {"points": [[120.5, 85.25]], "weight": [1], "rank": 1.5, "breadth": 6.5}]}

See README.md beside this file and schemas/lines.schema.json.
"""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from penink_cli.formats import strict_json
from penink_cli.ground.errors import FormatError, LimitError
from penink_cli.ground.model import Floats, Lines

if TYPE_CHECKING:
    from penink_cli.ground.streams import Output

FORMAT = "penink-lines"
DECIMALS = 2  # of coordinates, breadths and ranks, as written
WEIGHTS = 3  # decimals of weights
MAX_SIDE = 2**31 - 1  # of a frame, pixels
MAX_RANK = 1e6
MAX_BYTES = 80_000_000  # the lines of an ordinary photograph take a few hundred thousand
MAX_LINES = 1_000_000


def read(stream: BinaryIO, source: str) -> Lines:
    """Telling lines, each of which `check` allows: within the frame, a weight for each point, no point twice in a row.

    Raises FormatError, which names the line, and LimitError for more than MAX_BYTES bytes or MAX_LINES lines.
    """
    text = stream.read(MAX_BYTES + 1)
    try:
        if len(text) > MAX_BYTES:
            raise LimitError(f"lines of more than {MAX_BYTES} bytes")
        found = _lines(strict_json.loads(text))
        check(found)
    except (FormatError, LimitError) as error:
        from penink_cli.formats.recognise import explained

        raise explained(error, text, "lines").from_source(source) from None
    return found


def _lines(document: object) -> Lines:
    members = strict_json.header(document, FORMAT)
    width = strict_json.whole(strict_json.member(members, "width"), "width", 1, MAX_SIDE)
    height = strict_json.whole(strict_json.member(members, "height"), "height", 1, MAX_SIDE)
    items = strict_json.array(strict_json.member(members, "lines"), "lines")
    if len(items) > MAX_LINES:
        raise LimitError(f"{len(items)} lines; {MAX_LINES} are allowed")
    points: list[list[Any]] = []
    weights: list[list[Any]] = []
    ranks, breadths = np.zeros(len(items)), np.zeros(len(items))
    whites = np.zeros(len(items), np.bool_)
    for i, item in enumerate(items):
        place = f"line {i}"
        item = strict_json.members(item, place)
        points.append(strict_json.array(strict_json.member(item, "points", place), f"{place}: points"))
        weights.append(strict_json.array(strict_json.member(item, "weight", place), f"{place}: weight"))
        if len(weights[-1]) != len(points[-1]):
            raise FormatError(f"{place}: {len(weights[-1])} weights for {len(points[-1])} points")
        ranks[i] = strict_json.number(strict_json.member(item, "rank", place), f"{place}: rank", 0, MAX_RANK)
        if "breadth" in item:
            breadths[i] = strict_json.number(item["breadth"], f"{place}: breadth", 0, MAX_SIDE)
        whites[i] = strict_json.flag(item.get("white", False), f"{place}: white")
    try:  # the points of all lines at once: line by line it takes three times as long
        at = strict_json.pairs(list(chain.from_iterable(points)), "points", "point")
        weight = strict_json.numbers(list(chain.from_iterable(weights)), "weight", "weight")
    except FormatError:
        for i, (some, weighing) in enumerate(zip(points, weights)):
            strict_json.pairs(some, "points", f"line {i}: point")
            strict_json.numbers(weighing, "weight", f"line {i}: weight")
        raise
    first = np.zeros(len(items) + 1, np.int64)
    np.cumsum(np.fromiter(map(len, points), np.int64, len(points)), out=first[1:])
    return Lines(width, height, at + 0.0, first, weight, ranks, whites, breadths)  # + 0.0: -0 is 0


def check(lines: Lines) -> None:
    """Raise FormatError for the first line that the format does not allow."""
    counts = np.diff(lines.first)
    wrong = np.flatnonzero(counts < np.where(lines.breadth > 0, 1, 2))
    if len(wrong):
        least = "1 of a thing with breadth" if lines.breadth[wrong[0]] > 0 else "2"
        raise FormatError(f"line {wrong[0]}: {counts[wrong[0]]} points; at least {least} are needed")
    whose = np.repeat(np.arange(len(lines)), counts)
    inside = (lines.points >= 0) & (lines.points <= (lines.width, lines.height))  # false for NaN
    wrong = np.flatnonzero(~inside.all(axis=1))
    if len(wrong):
        k = wrong[0] - lines.first[whose[wrong[0]]]
        x, y = lines.points[wrong[0]]
        frame = f"{lines.width} x {lines.height}"
        raise FormatError(f"line {whose[wrong[0]]}: point {k}: ({x:.10g}, {y:.10g}) is outside the frame {frame}")
    wrong = np.flatnonzero(~((lines.weight >= 0) & (lines.weight <= 1)))
    if len(wrong):
        k = wrong[0] - lines.first[whose[wrong[0]]]
        raise FormatError(f"line {whose[wrong[0]]}: weight {k}: {lines.weight[wrong[0]]:g} is not in 0..1")
    same = (lines.points[1:] == lines.points[:-1]).all(axis=1) & (whose[1:] == whose[:-1])
    wrong = np.flatnonzero(same)
    if len(wrong):
        k = wrong[0] - lines.first[whose[wrong[0]]]
        raise FormatError(f"line {whose[wrong[0]]}: points {k} and {k + 1} are the same")
    for name, values in (("rank", lines.rank), ("breadth", lines.breadth)):
        wrong = np.flatnonzero(~((values >= 0) & (values <= (MAX_RANK if name == "rank" else MAX_SIDE))))
        if len(wrong):
            raise FormatError(f"line {wrong[0]}: {name} {values[wrong[0]]:g} is out of range")


def rounded(lines: Lines) -> Lines:
    """The lines as `write` writes them: numbers rounded to their decimals, and no point twice in a row."""
    points = np.round(lines.points, DECIMALS) + 0.0
    whose = np.repeat(np.arange(len(lines)), np.diff(lines.first))
    keep = np.ones(len(points), np.bool_)
    keep[1:] = (points[1:] != points[:-1]).any(axis=1) | (whose[1:] != whose[:-1])
    first = np.zeros(len(lines) + 1, np.int64)
    np.cumsum(np.bincount(whose[keep], minlength=len(lines)), out=first[1:])
    return Lines(
        lines.width, lines.height, points[keep], first, np.round(lines.weight[keep], WEIGHTS) + 0.0,
        np.round(lines.rank, DECIMALS) + 0.0, lines.white, np.round(lines.breadth, DECIMALS) + 0.0,
    )  # fmt: skip


def write(out: Output, lines: Lines) -> None:
    """Write telling lines, one a line of text.

    Raises FormatError for lines that, rounded, could not be read again.
    """
    lines = rounded(lines)
    check(lines)
    head = f'{{"format": "{FORMAT}", "version": 1, "width": {lines.width}, "height": {lines.height}, "lines": ['
    out.write(head.encode("ascii"))
    rows = [_row(lines, i) for i in range(len(lines))]
    out.write((("\n  " if rows else "") + ",\n  ".join(rows) + "]}\n").encode("ascii"))


def _row(lines: Lines, i: int) -> str:
    points: Floats = lines[i]
    weight = lines.weight[lines.first[i] : lines.first[i + 1]]
    pattern = ", ".join([f"[%.{DECIMALS}f, %.{DECIMALS}f]"] * len(points)) % tuple(points.ravel().tolist())
    pressed = ", ".join([f"%.{WEIGHTS}f"] * len(points)) % tuple(weight.tolist())
    row = f'{{"points": [{pattern}], "weight": [{pressed}], "rank": {lines.rank[i]:.{DECIMALS}f}'
    if lines.breadth[i] > 0:
        row += f', "breadth": {lines.breadth[i]:.{DECIMALS}f}'
    return row + (', "white": true}' if lines.white[i] else "}")
