"""Making stroke textures: tiles of strokes of which every prefix is evenly spaced.

A tile is filled until it is as good as black, so that it serves every tone. Hatching textures also say
what they are an instance of (`HatchLayer`), which blasting prefers to their tile.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from penink_cli.ground import exact
from penink_cli.ground.angles import direction
from penink_cli.ground.device import DOT, MEAN
from penink_cli.ground.errors import ParameterError
from penink_cli.ground.model import Engraving, Floats, HatchLayer, Strokes, Texture
from penink_cli.textures.even import Torus
from penink_cli.textures.kinds import SETS
from penink_cli.textures.sets import make_set

TILE_PT = 144.0
#: What a full tile covers, at the least.
FULL = 0.978
#: Tones at which the layers of hatching end. The next one begins a little before.
LAYER_ENDS = {1: (0.99,), 2: (0.5, 0.99), 3: (0.42, 0.7, 0.99), 4: (0.42, 0.66, 0.83, 0.99)}
#: Angles of the layers, from that of the first.
LAYER_TURNS = (0.0, 90.0, 45.0, 135.0)
#: Lines along the form tell it best while they are alone; those over them lie neither square to them, which looks
#: woven, nor near them, which shimmers. Above the last tone it is black.
FORM_ENDS, FORM_TURN, FORM_BLACK = (0.65, 0.92), 50.0, 0.92
#: A stroke paints a little more than its pen is wide: what a device of 600 dpi adds.
GAIN_PT, DOT_GAIN_PT = MEAN * 72 / 600, DOT * 72 / 600

#: Lines that a brick is hatched with before all is crossed by others, of 64 for which there is room.
HATCHED = 56

Maker = Callable[[np.random.Generator, int], Floats]


def bowed_line(centre: Floats, angle: Floats, length: Floats, bow: Floats) -> Floats:
    """Cubics (n, 4, 2): straight strokes about centre (n, 2), their middle pushed sideways by bow."""
    along = np.array([direction(a) for a in angle.tolist()])
    half = along * length[:, None] / 2
    across = np.column_stack([-along[:, 1], along[:, 0]]) * bow[:, None]
    ends = np.stack([centre - half, centre - half / 3, centre + half / 3, centre + half], axis=1)
    return ends + np.stack([-across / 3, across, across, -across / 3], axis=1)


def fill(
    torus: Torus, candidates: Maker, pen: float, until: float, reached: float, choices: int, rng: np.random.Generator
) -> list[Floats]:
    """Strokes (each (3k + 1, 2)), the emptiest of so many choices each time, from coverage reached to until.

    Coverage is counted on the grid of the torus, a stroke leaving bare of each cell it runs through what is not its
    share of it: right for strokes that lie as they please, and a little pessimistic for these, which keep apart.
    """
    bare = np.full((torus.rows, torus.columns), 1.0 - reached)
    cell = float(1.0 / (torus.scale[0] * torus.scale[1]))
    mean = 1.0 - reached
    out = []
    while mean > 1.0 - until:
        strokes = candidates(rng, choices)
        samples = along_curve(strokes)
        best = torus.emptiest(samples)
        length = max(polygon_length(strokes[best]), pen * 0.8)
        torus.add(samples[best], length)
        rows, columns = torus.cells(samples[best])
        keep = exact.exp(-length / len(rows) * pen / cell)
        for r, c in zip(rows.tolist(), columns.tolist(), strict=True):
            was = bare[r, c]
            bare[r, c] = was * keep
            mean -= float(was - was * keep) / bare.size
        out.append(strokes[best])
    return out


def along_curve(strokes: Floats) -> Floats:
    """Samples (n, p, 2) of chains (n, 3k + 1, 2), about one a point of length; a dot is its own sample."""
    k = (strokes.shape[1] - 1) // 3
    if k == 0:
        return strokes
    per = max(2, round(polygon_length(strokes[0]) / k))
    t = (np.arange(per) / per)[:, None]
    u = 1 - t
    parts = []
    for j in range(k):
        p = strokes[:, 3 * j : 3 * j + 4, None]
        parts.append(u * u * u * p[:, 0] + 3 * u * u * t * p[:, 1] + 3 * u * t * t * p[:, 2] + t * t * t * p[:, 3])
    return np.concatenate(parts, axis=1)


def polygon_length(stroke: Floats) -> float:
    """Length of a control polygon (p, 2)."""
    legs = np.diff(stroke, axis=0)
    return float(np.sqrt((legs * legs).sum(axis=1)).sum())


def tile(
    name: str, strokes: list[Floats], widths: list[float], width: float, height: float, seed: int, whole: bool = False,
    layers: tuple[HatchLayer, ...] = (),
) -> Texture:  # fmt: skip
    """A texture of strokes in order of priority, in hundredths of a point."""
    first = np.zeros(len(strokes) + 1, np.int64)
    np.cumsum([len(s) for s in strokes], out=first[1:])
    points: Floats = np.round(np.concatenate(strokes), 2).astype(np.float64)
    laid = Strokes(width, height, points, first, np.array(widths), texture=name, seed=seed)
    return Texture(name, laid, np.arange(len(strokes), dtype=np.float64), whole, layers)


def hatching(
    name: str,
    angle: float,
    count: int,
    pen: float,
    spacing: float,
    seed: int,
    wave: float = 0.0,
    wave_length: float = 0.0,
    turns: tuple[float, ...] = LAYER_TURNS,
    ends: tuple[float, ...] = (),
) -> Texture:
    """Straight or wavy strokes in one to four directions, one layer after the other."""
    rng = np.random.default_rng(seed)
    ends = ends or LAYER_ENDS[count]
    layers = []
    strokes: list[Floats] = []
    reached = 0.0
    for i, until in enumerate(ends):
        turned = angle + turns[i]
        if spacing > 0:
            until = min(until, 1 - (1 - reached) * (1 - min(0.97, (pen + GAIN_PT) / spacing)))
        low = max(0.0, reached - (0.05 if ends == FORM_ENDS else 0.04))
        if until <= low:
            break
        layers.append(HatchLayer(turned, low, until, pen, spacing, wave, wave_length))
        torus = Torus(TILE_PT, TILE_PT, 0.7)

        def lines(rng: np.random.Generator, n: int, turned: float = turned) -> Floats:
            turn = turned + rng.uniform(-1.5, 1.5, n)
            length, bow = rng.uniform(34, 68, n), rng.normal(0, 0.3, n)
            return bowed_line(rng.uniform(0, TILE_PT, (n, 2)), turn, length, bow)

        strokes += fill(
            torus, lines, pen + GAIN_PT, until if spacing or i + 1 < count else FULL + 0.012, reached, 40, rng
        )
        reached = until
    if wave > 0:
        strokes = [wavy(s, angle, wave, wave_length) for s in strokes]
    return tile(name, strokes, [pen] * len(strokes), TILE_PT, TILE_PT, seed, layers=tuple(layers))


def wavy(stroke: Floats, angle: float, wave: float, wave_length: float) -> Floats:
    """A chain pushed sideways by a wave along its direction, which repeats with the tile."""
    c, s = direction(angle)
    across = np.array([-s, c])
    p = along_curve(stroke[None])[0]
    p = np.concatenate([p[:: max(1, round(wave_length / 4))], stroke[-1:]])
    turns = max(1, round(TILE_PT / wave_length))
    phase = 2 * math.pi * ((turns * p)[:, 0] + (turns * p)[:, 1]) / TILE_PT
    p = p + exact.cos_sin(phase)[1][:, None] * wave * across
    slope = np.gradient(p, axis=0) / 3
    inner = np.stack([p[:-1] + slope[:-1], p[1:] - slope[1:], p[1:]], axis=1).reshape(-1, 2)
    return np.concatenate([p[:1], inner])


def parallel(angle: float, pen: float, spacing: float, layers: int, seed: int) -> Texture:
    """Lines in one direction, denser as it gets darker."""
    return hatching("parallel", angle, layers, pen, spacing, seed)


def crosshatch(angle: float, pen: float, spacing: float, layers: int, seed: int) -> Texture:
    """Lines in one direction, and others across them where it is dark."""
    return hatching("crosshatch" if layers <= 2 else f"crosshatch{layers}", angle, layers, pen, spacing, seed)


def grain(angle: float, pen: float, spacing: float, layers: int, seed: int) -> Texture:
    """Wandering lines side by side, like the grain of wood."""
    return hatching("grain", angle, layers, pen, spacing, seed, wave=5.0, wave_length=72.0)


def form(angle: float, pen: float, spacing: float, layers: int, seed: int) -> Texture:
    """Lines along the form, others at a slant over them where it is dark, and black where it is darkest."""
    slanted = hatching("form", angle, 2, pen, spacing, seed, turns=(0.0, FORM_TURN), ends=FORM_ENDS)
    first, second = slanted.layers
    black = replace(first, low=FORM_BLACK, high=1.0, turn=0.0)
    return replace(slanted, layers=(replace(first, turn=0.0), replace(second, turn=FORM_TURN), black))


def stipple(angle: float, pen: float, spacing: float, layers: int, seed: int) -> Texture:
    """Dots."""
    size = 72.0
    torus = Torus(size, size, 0.5, grid=0.75)
    rng = np.random.default_rng(seed)

    def dots(rng: np.random.Generator, n: int) -> Floats:
        return rng.uniform(0, size, (n, 1, 2))

    # the area of a dot as the length of line it stands for
    area = math.pi / 4 * (pen + DOT_GAIN_PT) ** 2
    strokes = fill(torus, dots, area / (pen * 0.8), FULL, 0.0, 60, rng)
    return tile("stipple", strokes, [pen] * len(strokes), size, size, seed, whole=True)


def scribble(angle: float, pen: float, spacing: float, layers: int, seed: int) -> Texture:
    """Loops that a restless pen makes."""
    size = 96.0
    torus = Torus(size, size, 0.7)

    def loops(rng: np.random.Generator, n: int) -> Floats:
        knots = 9
        heading = np.cumsum(
            np.column_stack([rng.uniform(0, 2 * math.pi, n), rng.normal(1.05, 0.55, (n, knots - 1))]), 1
        )
        step = rng.uniform(3.0, 6.0, (n, knots))[..., None] * np.stack(exact.cos_sin(heading), axis=2)
        p = np.cumsum(step, axis=1)
        p = p - p.mean(axis=1, keepdims=True) + rng.uniform(0, size, (n, 1, 2))
        slope = np.gradient(p, axis=1) / 3
        inner = np.stack([p[:, :-1] + slope[:, :-1], p[:, 1:] - slope[:, 1:], p[:, 1:]], axis=2).reshape(n, -1, 2)
        return np.concatenate([p[:, :1], inner], axis=1)

    strokes = fill(torus, loops, pen + GAIN_PT, FULL + 0.01, 0.0, 24, np.random.default_rng(seed))
    return tile("scribble", strokes, [pen] * len(strokes), size, size, seed)


def grass(angle: float, pen: float, spacing: float, layers: int, seed: int) -> Texture:
    """Blades that grow upwards and bend."""
    size = 96.0
    torus = Torus(size, size, 0.7)

    def blades(rng: np.random.Generator, n: int) -> Floats:
        lean = np.radians(-90.0 + angle + rng.normal(0, 16, n))
        bend = rng.normal(0, 0.5, n)
        length = rng.uniform(10, 26, n)
        foot = rng.uniform(0, size, (n, 2))
        out = np.empty((n, 4, 2))
        for j, (reach, turn) in enumerate(((0.0, 0.0), (0.34, 0.1), (0.7, 0.45), (1.0, 1.0))):
            a = lean + bend * turn
            out[:, j] = foot + (reach * length)[:, None] * np.column_stack(exact.cos_sin(a))
        return out

    strokes = fill(torus, blades, pen + GAIN_PT, FULL + 0.01, 0.0, 32, np.random.default_rng(seed))
    return tile("grass", strokes, [pen] * len(strokes), size, size, seed)


def brick(angle: float, pen: float, spacing: float, layers: int, seed: int) -> Texture:
    """A wall: the joints first, then all bricks hatched, then everything."""
    rng = np.random.default_rng(seed)
    # no whole number of a printer's dots, in which all joints would lie alike: ink would be off by a twentieth
    course, stretcher = 11.75, 35.75
    rows, columns = 8, 3
    width, height = columns * stretcher, rows * course
    gap = 1.3
    joints: list[Floats] = []
    spans = []
    for r in range(rows):
        for c in range(columns):
            x, y = c * stretcher + (stretcher / 2 if r % 2 else 0.0), r * course
            box = np.array([x + gap, y + gap, x + stretcher - gap, y + course - gap]) + rng.normal(0, 0.25, 4)
            spans.append(box)
            # the shaded sides, below and at the right, then the lit ones
            for a, b in (((0, 3), (2, 3)), ((2, 1), (2, 3)), ((0, 1), (2, 1)), ((0, 1), (0, 3))):
                p, q = box[list(a)], box[list(b)]
                t = np.array([0.02, 0.34, 0.66, 0.98])[:, None]
                line = p * (1 - t) + q * t
                line[1:3] += rng.normal(0, 0.25, 2)
                joints.append(line)
    sides = [joints[k::4] for k in range(4)]
    order = [group[i] for group in sides for i in rng.permutation(len(group))]
    # a line more in every brick, each time half way between two that are there, of 64 in the end
    for k in range(HATCHED):
        across = (int(f"{k:06b}"[::-1], 2) + rng.uniform(0.2, 0.8, len(spans))) / 64
        for i in rng.permutation(len(spans)):
            left, top, right, bottom = spans[i] + np.array([0.7, rng.uniform(0.3, 1.2), -0.7, -rng.uniform(0.3, 1.2)])
            foot = left - 5.0 + float(across[i]) * (right - left + 5.0)
            # slanting, and within the brick
            t = np.clip((np.array([left, right]) - foot) / 5.0, 0.0, 1.0)
            if (t[1] - t[0]) * (bottom - top) < 1.5:
                continue
            at = t[0] + np.array([0.0, 1 / 3, 2 / 3, 1.0]) * (t[1] - t[0])
            line = np.column_stack([foot + 5.0 * at, bottom + (top - bottom) * at])
            line[1:3, 0] += rng.normal(0, 0.15)
            order.append(line)

    def course_lines(rng: np.random.Generator, n: int) -> Floats:
        centre = rng.uniform(0, 1, (n, 2)) * (width, height)
        return bowed_line(centre, angle + rng.normal(0, 1.2, n), rng.uniform(14, 30, n), rng.normal(0, 0.2, n))

    strokes = order + fill(Torus(width, height, 0.7), course_lines, pen + GAIN_PT, FULL + 0.012, 0.6, 32, rng)
    return tile("brick", strokes, [pen] * len(strokes), width, height, seed, whole=True)


def engraved(
    name: str, kind: Engraving, angle: float, pen: float, spacing: float, layers: int, seed: int
) -> Texture:
    """Lines that swell; the tile holds lines of one width in their direction, which stand for them."""
    stands = hatching(name, angle, layers, pen, 0.0, seed)
    return replace(stands, engraving=replace(kind, angle=angle, spacing_pt=spacing or kind.spacing_pt))


#: Kind -> what its lines are like.
ENGRAVINGS = {
    "engraving": Engraving(),
    "engraving-straight": Engraving(along=False),
    "contour-rings": Engraving(along=False, centre=(0.5, 0.5)),
    "wood": Engraving(along=False, spacing_pt=1.78, finest_pt=0.25, waver=1.0, blunt=True),
}

#: Kind -> (maker, its usual angle, pen and number of layers).
MAKERS: dict[str, tuple[Callable[[float, float, float, int, int], Texture], float, float, int]] = {
    "parallel": (parallel, -45.0, 0.4, 1),
    "crosshatch": (crosshatch, -45.0, 0.4, 2),
    "crosshatch4": (crosshatch, -45.0, 0.4, 4),
    "form": (form, -45.0, 0.4, 2),
    "stipple": (stipple, 0.0, 1.0, 1),
    "scribble": (scribble, 0.0, 0.4, 1),
    "grain": (grain, -8.0, 0.4, 1),
    "brick": (brick, 0.0, 0.4, 1),
    "grass": (grass, 0.0, 0.4, 1),
    **{name: (partial(engraved, name, kind), -30.0, 0.4, 1) for name, kind in ENGRAVINGS.items()},
}


def make(
    kind: str, *, angle: float | None = None, pen: float | None = None, spacing: float = 0.0, layers: int | None = None,
    seed: int = 0, finest: float | None = None, lines: int | None = None, centre: tuple[float, float] | None = None,
) -> Texture:  # fmt: skip
    """A texture of a kind, by default as it is shipped.

    angle: of the first layer, degrees, clockwise from the right. pen: stroke width, points. spacing: hatching lines
    of one layer are nowhere closer, points; 0 for no limit. layers: 1 … 4 directions of hatching.
    Of engravings only: spacing is the lines' distance, finest the least width of a line, points; lines: so many to the
    sheet's width; centre: of rings, parts of the sheet. Raises ParameterError where these do not fit the kind.
    A set of strokes has its pen alone.
    """
    if kind in SETS:
        return make_set(kind, pen)
    maker, usual_angle, usual_pen, usual_layers = MAKERS[kind]
    made = maker(usual_angle if angle is None else angle, pen or usual_pen, spacing, layers or usual_layers, seed)
    if made.engraving is None:
        if (finest, lines, centre) != (None, None, None):
            raise ParameterError(f"{kind} is no engraving: {', '.join(ENGRAVINGS)} are")
        return made
    engraving = replace(made.engraving, lines=lines, finest_pt=finest or made.engraving.finest_pt)
    if not engraving.finest_pt < engraving.spacing_pt:
        raise ParameterError(f"a finest line of {engraving.finest_pt:g} pt at a spacing of {engraving.spacing_pt:g}")
    if centre is not None:
        if engraving.centre is None:
            raise ParameterError(f"{kind} has no centre; contour-rings has")
        engraving = replace(engraving, centre=centre)
    return replace(made, engraving=engraving)
