"""The data that a renderer is sent of an illustration, as `renderer/data.ps` and `renderer/data.js` read them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from penink_cli.blasting import screens
from penink_cli.blasting.outlines import Run, runs
from penink_cli.formats.compact import ANGLES
from penink_cli.geometry.trails import trails
from penink_cli.ground.angles import direction
from penink_cli.ground.errors import LimitError
from penink_cli.ground.model import (
    EdgeList,
    Engraving,
    Floats,
    GreyImage,
    Illustration,
    Ints,
    Layer,
    LineChoice,
)
from penink_cli.selfdrawing import telling
from penink_cli.selfdrawing.lattice import PARTS, on_lattice

#: Samples a side. Arrays of a Level 2 interpreter hold 65535 entries: one for each of 254 × 254 samples and their
#: border.
MOST_SAMPLES = 254
MOST_EDGES = 20000
#: Levels of grey at which eased samples are sent at the most: more levels are more bytes and show no difference.
EASED = 64
#: Points of all telling lines of a layer together.
MOST_POINTS = 40000


@dataclass(frozen=True)
class FieldData:
    """A field of directions.

    width, height: samples. angles: a byte a sample, coded as `samples_bytes` codes grey: numbers of the ANGLES that
    archives divide a half turn into.
    """

    width: int
    height: int
    angles: bytes


@dataclass(frozen=True)
class LineData:
    """Telling lines, and how they are drawn.

    dark, white: how many there are of each, the dark ones first. across, down: places of the grid that the points lie
    on.
    lines: as of `telling.line_bytes`.
    """

    choice: LineChoice
    dark: int = 0
    white: int = 0
    across: int = 0
    down: int = 0
    lines: bytes = b""


@dataclass(frozen=True, eq=False)
class LayerData:
    """One layer.

    width, height: samples. levels: of grey. samples: a byte a sample, as of `samples_bytes`. edges: bytes of the
    chains.
    chains: how many chains there are. outlined: how many of these, the first ones, are outlined. vertices, ends: how
    many vertices and edges there are. outline_pt: pen of the outlines. gamma: of the tone curve. table: of the texture.
    family: see `family`. form: of each of the texture's layers of hatching the degrees from a field, and the tones
    where it begins and ends. field: the directions, None where strokes follow none. engraving: lines that swell, in
    place of the table's screens, or None. told: the telling lines. color: of the ink, #rrggbb.
    """

    width: int
    height: int
    levels: int
    samples: bytes
    edges: bytes
    chains: int
    outlined: int
    vertices: int
    ends: int
    outline_pt: float
    gamma: float
    table: screens.ThresholdTable
    family: int
    form: tuple[tuple[float, float, float], ...]
    field: FieldData | None
    engraving: Engraving | None
    told: LineData
    color: str

    @property
    def black(self) -> float:
        """The tone beyond which all is solid: where the last of several layers begins, if it goes up to 1; else 1."""
        return self.form[-1][1] if len(self.form) > 1 and self.form[-1][2] >= 1 else 1.0


def layers(illustration: Illustration) -> list[LayerData]:
    """All layers, the first at the bottom. Raises LimitError where one is too large for a device."""
    out = []
    for number, layer in enumerate(illustration.layers, 1):
        h, w = layer.samples.values.shape
        if max(w, h) > MOST_SAMPLES:
            raise LimitError(
                f"layer {number}: {w} x {h} samples; an illustration that draws itself may have "
                f"{MOST_SAMPLES} x {MOST_SAMPLES} a layer (penink reduce makes them fewer)"
            )
        out.append(_layer(layer, w, h, number, family(illustration, number - 1)))
    return out


def family(illustration: Illustration, i: int) -> int:
    """The number of the first layer with layer i's texture, pen and turn, whose strokes lie in the same places."""
    mine = illustration.layers[i]

    def alike(layer: Layer) -> bool:
        named = layer.texture_name is not None and layer.texture_name == mine.texture_name
        return (named or layer.texture is mine.texture) and (layer.pen_pt, layer.turn) == (mine.pen_pt, mine.turn)

    return next(k for k, layer in enumerate(illustration.layers) if alike(layer))


def _layer(layer: Layer, w: int, h: int, number: int, family: int) -> LayerData:
    """The data of a layer of w × h samples. number: for error lines, from 1."""
    chains: list[bytes] = []
    outlined = 0
    vertices, ends = np.zeros((0, 2), np.int64), np.zeros((0, 2), np.int64)
    if layer.edges is not None and len(layer.edges.edges):
        vertices, ends, strength = on_lattice(layer.edges, w, h)
        if len(ends) > MOST_EDGES:
            raise LimitError(
                f"layer {number}: {len(ends)} edges; an illustration that draws itself may have {MOST_EDGES} a layer"
            )
        drawn = _outlined(layer, vertices, ends, strength, w, h)
        outlined = len(drawn)
        rest = np.setdiff1d(np.arange(len(ends)), [e for run in drawn for e in run.edges])
        chains = [_chain_bytes(vertices[run.trail], _pressure(run, layer)) for run in drawn]
        chains += [_chain_bytes(vertices[trail]) for trail, _ in trails(vertices, ends[rest])]
    ink, levels = ink_levels(layer)
    return LayerData(
        w, h, levels, samples_bytes(ink, levels), b"".join(chains),
        len(chains), outlined, len(np.unique(ends)), len(ends),
        layer.outline.pen_pt if layer.outline else 0.0, layer.gamma, screens.table(layer.texture, layer.pen_pt),
        family, _form(layer), _field(layer), layer.texture.engraving if layer.pen_pt is None else None, _told(layer),
        layer.color or "#000000",
    )  # fmt: skip


def follows(layer: Layer) -> bool:
    """Whether the layer has directions, and strokes that would follow them."""
    texture = layer.texture
    kind = texture.engraving if layer.pen_pt is None else None
    return layer.directions is not None and bool(kind.along if kind else texture.layers)


def _form(layer: Layer) -> tuple[tuple[float, float, float], ...]:
    """See `LayerData.form`."""
    hatch = layer.texture.layers
    return tuple((one.angle - hatch[0].angle if one.turn is None else one.turn, one.low, one.high) for one in hatch)


def _field(layer: Layer) -> FieldData | None:
    """The directions, None where the texture's strokes do not follow any."""
    field = layer.directions
    if field is None or not follows(layer):
        return None
    reach = -(-max(field.cos2.shape) // MOST_SAMPLES)
    cos2, sin2 = field.cos2[::reach, ::reach], field.sin2[::reach, ::reach]  # more samples would show no difference
    turn = np.array([direction(360.0 * k / ANGLES) for k in range(ANGLES)])
    h, w = cos2.shape
    angles = np.empty((h, w), np.int64)
    for i, (c, s) in enumerate(zip(cos2, sin2, strict=True)):
        angles[i] = np.argmax(np.outer(c, turn[:, 0]) + np.outer(s, turn[:, 1]), axis=1)
    return FieldData(w, h, samples_bytes(angles, ANGLES))


def _told(layer: Layer) -> LineData:
    """The telling lines. Raises LimitError for more than MOST_POINTS points."""
    if layer.lines is None or not len(layer.lines):
        return LineData(layer.line)
    which, steps = telling.told(layer.lines, layer.line)
    if int(np.diff(layer.lines.first)[which].sum()) > MOST_POINTS:
        raise LimitError(f"telling lines of more than {MOST_POINTS} points in an illustration that draws itself")
    white = int(np.count_nonzero(layer.lines.white[which]))
    across, down = telling.grid(layer.lines)
    drawn = telling.line_bytes(layer.lines, which, steps)
    return LineData(layer.line, len(which) - white, white, across, down, drawn)


def ink_levels(layer: Layer) -> tuple[Ints, int]:
    """Samples (h, w) as levels of ink, 0 for paper, and how many levels there are.

    A device has no time to ease few grey levels, so it is sent eased samples, in fractions of a level.
    """
    most = layer.levels - 1
    grey = np.floor(layer.samples.values * float(most) / layer.samples.maxval + 0.5).astype(np.int64)
    if (parts := EASED // layer.levels) > 1:
        from penink_cli.reconstruction.easing import eased

        fine = eased(GreyImage(grey.astype(np.uint16), most), layer.edges)
        most *= parts
        grey = np.floor(fine.values * float(most) / fine.maxval + 0.5).astype(np.int64)
    return most - grey, most + 1


def ink_bytes(levels: Ints, count: int) -> Ints:
    """Levels of ink (h, w), of which there are `count`, in 255ths, as devices compute them."""
    return np.floor(levels * (255.0 / (count - 1)) + 0.5).astype(np.int64)


def as_sent(layer: Layer) -> tuple[GreyImage, EdgeList | None]:
    """A layer's samples and edges as a device has them, the edges in 32nds of a sample."""
    h, w = layer.samples.values.shape
    ink = ink_bytes(*ink_levels(layer))
    samples = GreyImage((255 - ink).astype(np.uint8), 255)
    if layer.edges is None or not len(layer.edges.edges):
        return samples, None
    vertices, ends, strength = on_lattice(layer.edges, w, h)
    return samples, _within_the_frame(vertices, ends, strength, w, h)


def _within_the_frame(vertices: Ints, ends: Ints, strength: Floats | None, w: int, h: int) -> EdgeList:
    """Edges on the lattice as an edge list in 32nds of a sample."""
    across, down = 2 * PARTS * w, 2 * PARTS * h
    inside = np.clip(2 * vertices + 1, 0, (across, down)).astype(np.float64)
    return EdgeList(across, down, inside, ends, strength)


def _outlined(layer: Layer, vertices: Ints, ends: Ints, strength: Floats | None, w: int, h: int) -> list[Run]:
    """The runs of a layer's edges on the lattice that its outline choice outlines, the most telling first."""
    if layer.outline is None or layer.edges is None:
        return []
    around = None
    if layer.outline.regions:
        from penink_cli.geometry import regions

        edges = _within_the_frame(vertices, ends, None, w, h)
        points = np.array(layer.outline.regions, np.float64) / (layer.edges.width, layer.edges.height)
        around = regions.edges_around(edges, points * (edges.width, edges.height))
    # in the edge list's pixels, which the choice is in
    pixel = np.array([layer.edges.width / w, layer.edges.height / h]) / PARTS
    at = (vertices + 0.5) * pixel
    return runs(EdgeList(layer.edges.width, layer.edges.height, at, ends, strength), layer.outline, around)


def _pressure(run: Run, layer: Layer) -> int:
    """The pen's pressure along a run, in 255ths; 0 for a pen that does not swell."""
    even = layer.outline is not None and layer.outline.even
    return 0 if even else math.floor(255 * run.pressure + 0.5)


def samples_bytes(ink: Ints, levels: int) -> bytes:
    """Each level of ink (h, w) as its difference, modulo levels, from a median of its neighbours.

    The median is of left, upper and left + upper - upper left. In the first column left is the upper one, in the first
    row upper is the left one; the first sample of all is compared with 0. Of the usual predictors this one leaves the
    fewest bytes to Flate: 3.2 KB of 96 x 96 samples of the camera man.
    """
    left, upper, corner = np.empty_like(ink), np.empty_like(ink), np.empty_like(ink)
    left[:, 1:], upper[1:], corner[1:, 1:] = ink[:, :-1], ink[:-1], ink[:-1, :-1]
    left[1:, 0], left[0, 0] = ink[:-1, 0], 0
    upper[0], corner[0], corner[1:, 0] = left[0], left[0], ink[:-1, 0]
    median = np.clip(left + upper - corner, np.minimum(left, upper), np.maximum(left, upper))
    return ((ink - median) % levels).astype(np.uint8).tobytes()


def _chain_bytes(at: Ints, pressure: int | None = None) -> bytes:
    """A chain of vertices (n, 2) on the lattice: number of edges, of outlines the pressure, the first vertex, steps.

    A step that is too long for two bytes is two bytes of 128, and the vertex itself.
    """
    at = at + 1
    x, y = at[0].tolist()
    parts = [(len(at) - 1).to_bytes(2, "big"), b"" if pressure is None else bytes([pressure])]
    parts += [v.to_bytes(2, "big") for v in (x, y)]
    for (dx, dy), (x, y) in zip(np.diff(at, axis=0).tolist(), at[1:].tolist(), strict=True):
        if -128 <= dx <= 127 and -128 <= dy <= 127:
            parts.append(bytes([dx + 128, dy + 128]))
        else:
            parts.append(bytes([128, 128]) + x.to_bytes(2, "big") + y.to_bytes(2, "big"))
    return b"".join(parts)


def is_sent(screen: screens.Screen) -> bool:
    """Whether a screen's strokes are sent. A renderer makes those of hatching itself, and repeats those of a copy."""
    return screen.layer is None and screen.again is None


def tile_bytes(screen: screens.Screen) -> bytes:
    """The strokes of a tile: each a threshold in 255ths, its first point, and three steps from there.

    Points are in quarters of a point. Of a tile that grows a stroke begins with its span, two bytes, and its threshold
    has two bytes.
    """
    control = np.rint(screen.points.reshape(-1, 4, 2) / screens.GRID_PT).astype(np.int64)
    if screen.spans is None:
        heads = [bytes([limit]) for limit in np.rint(screen.enters * 255).astype(np.int64).tolist()]
    else:
        limits = screen.enters.astype(np.int64).tolist()
        heads = [bytes(span) + k.to_bytes(2, "big") for span, k in zip(screen.spans.tolist(), limits, strict=True)]
    parts = []
    for head, points in zip(heads, control.tolist(), strict=True):
        (x, y), *rest = points
        steps = [c - o + 128 for point in rest for c, o in zip(point, (x, y), strict=True)]
        parts.append(head + x.to_bytes(2, "big") + y.to_bytes(2, "big") + bytes(steps))
    return b"".join(parts)
