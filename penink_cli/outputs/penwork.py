"""Strokes shared out among the pens of a plotter, and the names of layers that an AxiDraw obeys."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from penink_cli.formats.pens import Pen
from penink_cli.ground.codes import of_code
from penink_cli.ground.colour import lab_of_light, linear
from penink_cli.ground.model import Strokes
from penink_cli.ground.units import POINT_MM
from penink_cli.travel import clock

#: An AxiDraw's top speed, mm/s, and the number that stands for it in a layer's name.
TOP_SPEED = 8.6979 * 25.4
SPEED_PARTS = 110


@dataclass(frozen=True, eq=False)
class Load:
    """Strokes that are drawn without a pause.

    pen: that draws them, None where no pens are named. waits: the plotter waits for a hand before. part: the load's
    number among the loads of its pen, from 1, and how many these are.
    """

    strokes: Strokes
    pen: Pen | None = None
    waits: bool = False
    part: tuple[int, int] = (1, 1)

    def label(self, number: int, fallback: str | None) -> str:
        """The name of the load's layer: for an AxiDraw ``!``, a pause before it; the number, for vpype and an AxiDraw;
        for an AxiDraw ``+S`` and the speed of the pen when it is down; the pen's name, or else the fallback.
        """
        name = fallback if self.pen is None else self.pen.name
        if self.part[1] > 1:
            name = f"{name or 'pen'} {self.part[0]}/{self.part[1]}"
        speed = ""
        if self.pen is not None and self.pen.speed is not None:
            parts = round(self.pen.speed * POINT_MM / TOP_SPEED * SPEED_PARTS)
            speed = f"+S{min(max(parts, 1), SPEED_PARTS)}"
        return "!" * self.waits + str(number) + speed + (f" {name}" if name else "")


def by_pen(layers: Sequence[Strokes], pens: Sequence[Pen]) -> list[tuple[Strokes, Pen]]:
    """All strokes, each with the pen of the nearest colour and, of those, the nearest width; pen after pen.

    The strokes of a pen keep their order, and become as wide as the pen. layers, pens: at least one.
    """
    shades = lab_of_light(linear(np.array([of_code(pen.color) for pen in pens])))
    widths = np.array([pen.width for pen in pens])
    parts: list[list[Strokes]] = [[] for _ in pens]
    for layer in layers:
        own = lab_of_light(linear(np.array(of_code(layer.color or "#000000"))))
        off = shades - own
        far = off[:, 0] * off[:, 0] + off[:, 1] * off[:, 1] + off[:, 2] * off[:, 2]
        alike = np.flatnonzero(far <= far.min() + 1e-9)
        ratio = layer.widths[:, None] / widths[alike]
        chosen = alike[np.argmin(np.maximum(ratio, 1 / ratio), axis=1)]
        for k in np.unique(chosen).tolist():
            parts[k].append(clock.with_one_pen(layer.taken(chosen == k), pens[k].width))
    result = []
    for pen, found in zip(pens, parts, strict=True):
        if found:
            whole = replace(Strokes.joined(found), layer=pen.name, color=pen.color)
            result.append((whole, pen))
    return result


def loads(strokes: Strokes, pen: Pen | None, most: float | None, first: bool) -> list[Load]:
    """The strokes in loads no longer than `most`, or else than the pen's ink lasts, points; None for no limit.

    first: nothing has been drawn before, so that the first load need not wait.
    """
    length = most if most is not None else pen.refill if pen is not None else None
    groups = [strokes] if length is None else clock.split(strokes, length)
    waits = pen is not None or len(groups) > 1
    return [
        Load(group, pen, waits and not (first and i == 0), (i + 1, len(groups))) for i, group in enumerate(groups)
    ]


def merged(strokes: Strokes) -> Strokes:
    """The strokes ordered by width, the finest first; those of one width keep their order."""
    return strokes.taken(np.argsort(strokes.widths, kind="stable"))
