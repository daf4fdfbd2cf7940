"""The prologues of the renderers: numbers that they share with Python, by one name in both languages.

These are the numbers of `blasting.constants`, those of other modules in `OTHERS`, and for pages those in `FOLLOWING`.
"""

from __future__ import annotations

import math
from typing import Any

from penink_cli.blasting import (
    constants,
    engraving,
    form,
    joining,
    pen_lines,
    phase,
    screens,
    shares,
    taking_turns,
    tracks,
)
from penink_cli.blasting import telling as beside
from penink_cli.ground import pens
from penink_cli.ground.device import FILLED, MEAN
from penink_cli.lines import strokes as pressed
from penink_cli.reconstruction.kernels import T1
from penink_cli.selfdrawing import telling
from penink_cli.selfdrawing.data import ANGLES

#: Numbers of other modules, and of the renderers alone, by their names in the renderers.
OTHERS: dict[str, Any] = {
    "PRINT_FULL": pens.FULL, "PRINT_LEAST": pens.LEAST, "PRINT_DOTS": pens.DOTS, "MEAN": MEAN, "FILLED": FILLED,
    "SPAN_PARTS": screens.SPAN_PARTS, "EVER": screens.EVER, "T1": T1, "ANGLES": ANGLES,
    "LADDER": telling.LADDER, "LINE_STEP": 1.5, "LINE_FINEST": pressed.FINEST, "LINE_TAPER": pressed.TIP_PT,
    "LINE_TIP": pressed.TIP, "WHITE_PEN": beside.WHITE.pen_pt, "WHITE_FROM": beside.DARK, "WHITE_FULL": beside.FULL,
    "MOST_TONE": engraving.MOST, "CLOSED": tracks.CLOSED,
    "LEAST_TONE": engraving.LEAST_TONE, "TAPER_PT": engraving.TAPER_PT, "TAPER_SHARE": engraving.TAPER_SHARE,
    "TIP_PT": engraving.TIP_PT, "BLUNT": engraving.BLUNT, "WAVER_PT": tracks.WAVER_PT,
    "CROSS_ANGLE": engraving.CROSS_ANGLE,
    # dashes: least length, and the shortest and the longest stretch of line that holds one; the shortest is not that of
    # `engraving`, which keeps a least gap as well
    "DASH_PT": engraving.DASH_PT, "SHORTEST_PERIOD_PT": 11.0, "LONGEST_PERIOD_PT": engraving.LONGEST_PERIOD_PT,
    # every second line leaves off between these tones, in parts of the tone of the finest lines
    "LEAVES_OFF": (0.8, 1.6),
    # a run shorter than so many DASH_PT is a dash
    "DASHES": 4.0,
    # a dash is tapered over this part of its length at both ends; waver goes to and fro over so many points
    "DASH_TAPER": 0.25, "GRAIN": 4 * tracks.WAVER_LENGTH_PT,
    # lines end at an edge over which tone steps by more 255ths than this
    "WALL": 26,
}  # fmt: skip
#: Numbers for lines along a field, which the page alone draws.
FOLLOWING: dict[str, Any] = {
    "LINK_LEAK": phase.LEAK, "LINK_LEAST": phase.LEAST, "LINK_ALONG": phase.ALONG,
    "COARSE_SWEEPS": phase.COARSE_SWEEPS, "SWEEPS": phase.SWEEPS, "LINE_SMOOTHING": pen_lines.SMOOTHING,
    "GIVES_WAY": shares.GIVES_WAY, "BACK_AFTER": shares.BACK_AFTER,
    "FAINT": form.FAINT, "SPARSEST": form.SPARSEST, "RAGGED": form.RAGGED, "STROKE_PT": form.STROKE_PT,
    "EVENINGS": tracks.EVENINGS, "EVENED": tracks.EVENED,
    "PROLONGED": tracks.PROLONGED, "ROOM": tracks.ROOM,
    "JOIN_BACK": joining.BACK, "JOIN_ASIDE": joining.ASIDE, "JOIN_APART": joining.APART,
    "JOIN_OVERLAP": joining.OVERLAP, "JOIN_STRAIGHT": joining.STRAIGHT, "JOIN_SLANT": joining.SLANT,
    "JOIN_WORSE": joining.WORSE,
    # of two lines that end in one place one ends so many samples sooner
    "SOONER": 10,
    "CELL_PART": taking_turns.CELL, **taking_turns.SEARCH,
    # cells of tone between the places at which a field is looked up
    "FIELD_CELLS": 3,
    # the part of a black place that lines cover; the pen's pressure closes the rest
    "CLOSE": 0.95,
    # strokes of fewer points are left out
    "STROKE_LEAST": 4,
    # the pen is pressed at least and at most so much, 1 being usual, and so much in black
    "PRESSED": (0.75, 1.3, 1.8),
}  # fmt: skip


def shared() -> dict[str, Any]:
    """Every number, and every row of numbers, that both renderers share with Python, by name."""
    return {name: value for name, value in vars(constants).items() if name.isupper()} | OTHERS


def javascript() -> str:
    """The prologue of the page: one `const` of all numbers."""
    listed = ", ".join(f"{name} = {_number(value, '[%s]', ', ')}" for name, value in (shared() | FOLLOWING).items())
    return f"// The numbers of penink_cli/selfdrawing/constants.py.\nconst {listed};\n"


def postscript() -> str:
    """The prologue of the EPS: a definition a number.

    The numbers of waves are WAVER0, WAVER1 … and WAVE0 …, for hot procedures take them one by one; angles are in
    degrees.
    """
    numbers = shared()
    waver, wave = numbers.pop("WAVER"), numbers.pop("WAVE")
    degrees = [value if i % 3 == 0 else round(math.degrees(value), 4) for i, value in enumerate(waver)]
    numbers |= {f"WAVER{i}": value for i, value in enumerate(degrees)}
    numbers |= {f"WAVE{i}": value for i, value in enumerate(wave)}
    lines = [f"/{name} {_number(value, '[ %s ]', ' ')} def" for name, value in numbers.items()]
    return "% The numbers of penink_cli/selfdrawing/constants.py.\n" + "\n".join(lines) + "\n"


def _number(value: Any, row: str, between: str) -> str:
    if isinstance(value, tuple):
        return row % between.join(_number(v, row, between) for v in value)
    return f"{value:.9g}"
