"""Direction fields measured: ``python -m tests.benchmarks.directions [TABLE]...`` (two minutes).

Tables: rings beside_an_edge sizes photographs megapixel sets one_pen.

How far a field is from the rings of a ringed picture, and from stripes beside an edge; whether a stamp and a poster
find the same directions; what a field costs to find and to keep, and how many knots it has in photographs; how
true in tone sets of strokes are.
"""

from __future__ import annotations

import sys
import time

import numpy as np
import skimage.data
from scipy.ndimage import gaussian_filter

from penink_cli.arrangement.detection import detect_edges
from penink_cli.blasting.blast import blast
from penink_cli.directions.detection import detect_directions
from penink_cli.directions.evidence import links
from penink_cli.directions.reading import at_size
from penink_cli.directions.solving import singular
from penink_cli.formats import compact
from penink_cli.ground.model import ColourImage, Directions, EdgeList, GreyImage
from penink_cli.options.textures import find_texture
from tests.blasting import measures

PHOTOGRAPHS = (
    "astronaut", "chelsea", "coffee", "camera", "coins", "rocket", "motorcycle", "moon", "brick", "grass", "page",
)  # fmt: skip
NODE_PT = 0.9  # between places that a hatch reads a field at


def photograph(name: str) -> GreyImage | ColourImage:
    """A bundled photograph as it is stored."""
    pixels = skimage.data.stereo_motorcycle()[0] if name == "motorcycle" else getattr(skimage.data, name)()
    return ColourImage(np.ascontiguousarray(pixels[..., :3])) if pixels.ndim == 3 else GreyImage(pixels)


def edges_of(photo: GreyImage | ColourImage) -> EdgeList:
    """The edges of a photograph's luma."""
    values = photo.values / photo.maxval
    return detect_edges((values @ [0.299, 0.587, 0.114] if values.ndim == 3 else values).astype(np.float32))


def degrees(field: Directions) -> np.ndarray:
    """Angles of a field."""
    return np.degrees(np.arctan2(field.sin2, field.cos2)) / 2


def apart(a: np.ndarray, b: np.ndarray | float) -> np.ndarray:
    """Angles between directions."""
    return np.abs((a - b + 90) % 180 - 90)


def picture(height: int, width: int, grey: np.ndarray, noise: float) -> GreyImage:
    """Grey as a camera sees it."""
    seen = gaussian_filter(grey, 0.7) + np.random.default_rng(1).normal(0, noise, (height, width))
    return GreyImage(np.rint(255 * np.clip(seen, 0, 1)).astype(np.uint8))


def places(height: int, width: int, rows: int, columns: int) -> tuple[np.ndarray, np.ndarray]:
    """x and y in pixels from the middle of a picture, of the centres of rows × columns."""
    y, x = (np.mgrid[:rows, :columns] + 0.5) * [[[height / rows]], [[width / columns]]]
    return x - width / 2, y - height / 2


def rings() -> None:
    """The mean angle between a field and rings, at the nodes of a drawing of 6 inches."""
    print("angle between the field and rings, degrees, at nodes of a drawing of 6 in: mean, 95 %")
    height, width = 600, 800
    x, y = places(height, width, height, width)
    for period, noise in ((12, 0.0), (12, 0.02), (24, 0.02), (48, 0.02), (24, 0.05)):
        r = np.hypot(x, y)
        photo = picture(height, width, 0.5 + 0.25 * np.cos(2 * np.pi * r / period), noise)
        edges = detect_edges(photo.grey)
        rows, columns = round(432 * 0.75 / NODE_PT), round(432 / NODE_PT)
        u, v = places(height, width, rows, columns)
        found = degrees(at_size(detect_directions(photo, edges), edges, rows, columns))
        off = apart(found, np.degrees(np.arctan2(u, -v)))[np.hypot(u, v) > 40]
        print(f"  every {period} px, noise {noise:.2f}: {off.mean():5.2f} {np.quantile(off, 0.95):6.2f}")


def beside_an_edge() -> None:
    """Two fields beside a discontinuity edge, up to one sample from it."""
    height, width = 480, 640
    x, y = places(height, width, height, width)
    light, dark = 0.75 + 0.1 * np.sin(y / 5), 0.25 + 0.1 * np.sin((x + y) / 7)
    photo = picture(height, width, np.where(x > 0.2 * y, light, dark), 0.01)
    edge = EdgeList(width, height, np.array([[272.0, 0], [368.0, 480]]), np.array([[0, 1]]), np.array([0.5]))
    field = detect_directions(photo, edge)
    print("stripes of two angles beside an edge, degrees off: mean, most")
    for inches in (1, 4, 24):
        columns = round(72 * inches / NODE_PT)
        rows = columns * 3 // 4
        u, v = places(height, width, rows, columns)
        far = (u - 0.2 * v) / np.hypot(1, 0.2) / (width / 96)
        inner = np.maximum(abs(u) - 280, abs(v) - 200) < 0
        off = apart(degrees(at_size(field, edge, rows, columns)), np.where(far > 0, 0.0, -45.0))
        for where, chosen in (("from a sample on", inner & (abs(far) > 1)), ("up to the edge", inner)):
            print(f"  {inches:2d} in, {where:16}: {off[chosen].mean():5.2f} {off[chosen].max():6.2f}")


def sizes() -> None:
    """One field at 1, 4 and 24 inches: the angles between what is read at the same places."""
    photo = photograph("chelsea")
    edges = edges_of(photo)
    field = detect_directions(photo, edges)
    columns = 81  # nodes of a drawing of 1 inch, odd multiples of which have nodes at the same places
    rows = columns * 2 // 3
    stamp = degrees(at_size(field, edges, rows, columns))
    print("chelsea at 1 in and larger, degrees between directions read at the same places: most")
    for inches in (3, 5, 23):
        larger = degrees(at_size(field, edges, rows * inches, columns * inches))
        print(f"  {inches:2d} in: {apart(stamp, larger[inches // 2 :: inches, inches // 2 :: inches]).max():.4f}")


def photographs() -> None:
    """Cost, knots and bytes, and how much of a field the form says."""
    print("photograph      field   find, s  knots  confidence  in an archive: bytes, degrees off (RMS, most)")
    for name in PHOTOGRAPHS:
        photo = photograph(name)
        edges = edges_of(photo)
        begin = time.process_time()
        field = detect_directions(photo, edges)
        cost = time.process_time() - begin
        rows, columns = field.cos2.shape
        knots = singular(np.dstack([field.cos2, field.sin2]), links(edges, rows, columns)).sum()
        packed = compact.directions_bytes(field)
        off = apart(degrees(compact.directions_from(packed)), degrees(field))
        print(
            f"{name:12} {columns:4} x {rows:3} {cost:8.2f} {knots:6d} {field.confidence.mean():10.2f}"
            f" {len(packed):22d} {np.sqrt((off**2).mean()):6.2f} {off.max():5.2f}"
        )


def megapixel() -> None:
    """A photograph of one megapixel, and of twelve."""
    small = photograph("astronaut").values
    for side in (1000, 3464):
        at = np.arange(side) * len(small) // side
        photo = ColourImage(np.ascontiguousarray(small[at][:, at]))
        edges = edges_of(photograph("astronaut"))
        begin = time.process_time()
        detect_directions(photo, edges)
        print(f"{side * side / 1e6:.0f} megapixels, in colour: {time.process_time() - begin:.2f} s of processor")


def sets() -> None:
    """Tone of photographs in sets of oriented strokes, printed at 600 dpi, and what they cost."""
    print("set            photograph  inches   RMS %   bias   strokes  blast, s")
    for name, inches, texture in (
        ("camera", 4, "fur"), ("camera", 8, "grass"), ("coins", 4, "hair"), ("coins", 8, "barb"),
        ("astronaut", 4, "hair"), ("astronaut", 8, "fur"), ("chelsea", 4, "fur"), ("chelsea", 8, "hair"),
    ):  # fmt: skip
        photo = photograph(name)
        values = photo.values / photo.maxval
        tone = 1 - (values @ [0.299, 0.587, 0.114] if values.ndim == 3 else values)
        edges = edges_of(photo)
        field = detect_directions(photo, edges)
        begin = time.process_time()
        strokes = blast(
            tone, 72 * inches, 72 * inches * tone.shape[0] / tone.shape[1], edges, find_texture(texture),
            directions=field, threads=1,
        )  # fmt: skip
        cost = time.process_time() - begin
        rms, bias, _ = measures.tone_figures(strokes, tone)
        print(f"{texture:14} {name:12} {inches:4d} {rms:9.2f} {bias:6.2f} {len(strokes):9d} {cost:8.1f}")


def one_pen() -> None:
    """Flat tones in one pen of .3 mm: what no pressure of the hand evens out."""
    print("set, one pen of .3 mm, flat, 4 in     tone   RMS %   bias   strokes")
    for texture in ("fur", "hair", "barb", "grass"):
        for value in (0.2, 0.4, 0.7):
            tone = np.full((64, 64), value)
            strokes = blast(tone, 288, 288, None, find_texture(texture), pen_pt=0.3 / 25.4 * 72)
            rms, bias, _ = measures.tone_figures(strokes, tone)
            print(f"  {texture:33} {value:6} {rms:7.2f} {bias:+6.2f} {len(strokes):9d}", flush=True)


TABLES = (rings, beside_an_edge, sizes, photographs, megapixel, sets, one_pen)


def main() -> None:
    """Print the tables, or those named."""
    for table in TABLES:
        if len(sys.argv) < 2 or table.__name__ in sys.argv[1:]:
            table()


if __name__ == "__main__":
    main()
