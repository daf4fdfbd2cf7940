"""Hatching along the form measured. ``python -m tests.benchmarks.form [TABLE]...``

Tables: fields constant tone pens lengths bytes speed poster; beside each figure stands what is held to be good enough.
Fields, constant and lengths look at the strokes alone; tone and pens need Ghostscript.
"""

from __future__ import annotations

import io
import subprocess
import sys
import time
from functools import cache

import numpy as np

from penink_cli.arrangement.detection import detect_edges
from penink_cli.blasting import hatching
from penink_cli.blasting.blast import blast
from penink_cli.blasting.solids import PEN_PT
from penink_cli.directions.detection import detect_directions
from penink_cli.formats import directions as directions_format
from penink_cli.ground.model import Directions, EdgeList, Floats, GreyImage, Strokes
from penink_cli.options.textures import find_texture
from penink_cli.outputs import postscript
from penink_cli.outputs.page import lay_out
from penink_cli.travel.order import ordered_each
from tests.benchmarks.blasting import picture
from tests.blasting import measures

PHOTOS = ("camera", "coins", "astronaut", "chelsea", "coffee", "rocket")
FIELD = 192  # samples of an analytic field


def analytic(kind: str) -> Directions:
    """A field over the frame, in radians by x and y from -1 to 1."""
    y, x = (np.mgrid[:FIELD, :FIELD] + 0.5) / FIELD * 2 - 1
    if kind == "random":
        from scipy.ndimage import gaussian_filter

        rng = np.random.default_rng(5)
        c, s = (gaussian_filter(rng.normal(size=x.shape), FIELD / 9.6, mode="wrap") for _ in range(2))
        angle = 0.5 * np.arctan2(s, c)
    else:
        angle = {
            "constant": np.full_like(x, -np.pi / 4),
            "circles": np.arctan2(y, x) + np.pi / 2,
            "saddle": -np.arctan2(y, x),
            "fan": np.arctan2(y + 1.5, x),
            "waves": 0.6 * np.sin(4.8 * x) + 0.4 * np.sin(3.6 * y),
        }[kind]
    return Directions(np.cos(2 * angle), np.sin(2 * angle), np.ones_like(angle))


@cache
def represented(name: str) -> tuple[Floats, EdgeList, Directions]:
    """Tone, edges and directions of a photograph."""
    tone = picture(name)
    edges = detect_edges(1 - tone)
    return tone, edges, detect_directions(GreyImage.from_grey(1 - tone), edges)


def draw(name: str, inches: float, texture: str, along: bool, **options) -> tuple[Floats, Strokes]:
    tone, edges, field = represented(name)
    size = inches * 72, inches * 72 * len(tone) / tone.shape[1]
    return tone, blast(tone, *size, edges, find_texture(texture), directions=field if along else None, **options)


def fields() -> None:
    print("flat, 8 × 8 in, parallel: tone   fine strokes     cv ≤ .17  doubled ≤ .004  gaping ≤ .03   length")
    for fine in (False, True):
        least = hatching.FINE_LEAST
        hatching.FINE_LEAST = least if fine else np.inf
        for kind in ("circles", "saddle", "fan", "waves", "random"):
            for tone in (0.1, 0.2, 0.35):
                strokes = blast(
                    np.full((64, 64), tone), 576, 576, None, find_texture("parallel"), directions=analytic(kind)
                )
                f = measures.ray_gaps(strokes)
                print(
                    f"  {kind:22} {tone:6}   {'yes' if fine else 'no':12}  {f['cv']:9.3f} {f['doubled']:15.4f}"
                    f" {f['gaping']:13.4f} {measures.lengths(strokes).mean():8.1f}",
                    flush=True,
                )
        hatching.FINE_LEAST = least


def constant() -> None:
    print("one direction, flat, 8 × 8 in: tone           cv ≤ .16  spread ≥ .04  aligned ≤ .16  doubled  length")
    for tone in (0.1, 0.2, 0.35):
        for name, field in (("straight sweep", None), ("along a field", analytic("constant"))):
            strokes = blast(np.full((64, 64), tone), 576, 576, None, find_texture("parallel"), directions=field)
            f = measures.evenness(strokes, -45.0)
            print(
                f"  {name:27} {tone:6} {f['cv']:17.3f} {f['spread']:13.3f} {f['aligned_ends']:14.3f}"
                f" {f['doubled']:8.4f} {measures.lengths(strokes).mean():7.1f}",
                flush=True,
            )


def tone() -> None:
    print("tone at 600 dpi, %:         inches  texture      RMS ≤ .9  bias ± .2  worst   long  strokes")
    for name in PHOTOS:
        for inches in (4, 8):
            for texture, along in (("crosshatch", False), ("crosshatch", True), ("form", True)):
                wanted, strokes = draw(name, inches, texture, along)
                rms, bias, worst = measures.tone_figures(strokes, wanted)
                print(
                    f"  {name + (' along' if along else ' straight'):25} {inches:6}  {texture:11} {rms:9.2f}"
                    f"  {bias:+9.2f}  {worst:5.1f}  {measures.long_share(strokes):5.2f}  {len(strokes):7}",
                    flush=True,
                )


def pens() -> None:
    print("one 0.3 mm pen along the form: inches    RMS   bias   (spread ≤ .5)")
    for texture in ("crosshatch", "form", "fur", "hair", "grass", "barb"):
        biases = []
        for inches in (3, 6, 12):
            wanted, strokes = draw("camera", inches, texture, True, pen_pt=0.3 / 25.4 * 72)
            rms, bias, _ = measures.tone_figures(strokes, wanted)
            biases.append(bias)
            print(f"  {texture:28} {inches:7}  {rms:5.2f}  {bias:+5.2f}", flush=True)
        print(f"  spread {max(biases) - min(biases):.2f}")


def lengths() -> None:
    """Mean lengths of the strokes of hatching, without those that fill black."""
    print("mean length, pt, 6 in: crosshatch straight  along  form straight  along  (within a tenth)")
    for name in PHOTOS:
        means = []
        for texture in ("crosshatch", "form"):
            for along in (False, True):
                strokes = draw(name, 6, texture, along)[1]
                means.append(measures.lengths(strokes.taken(strokes.widths != PEN_PT)).mean())
        print(f"  {name:29} {means[0]:10.1f} {means[1]:6.1f} {means[2]:14.1f} {means[3]:6.1f}", flush=True)


def bytes_() -> None:
    print("bytes of PostScript a stroke, 6 in (≤ 30):  straight   form")
    for name in PHOTOS[:4]:
        sizes = []
        for texture, along in (("crosshatch", False), ("form", True)):
            strokes = draw(name, 6, texture, along)[1]
            out = io.BytesIO()
            postscript.write(out, [strokes], lay_out([strokes]), order=ordered_each)
            sizes.append(len(out.getvalue()) / len(strokes))
        print(f"  {name:41} {sizes[0]:8.1f} {sizes[1]:6.1f}", flush=True)


SPEED = """
import io, sys, time, numpy as np
from penink_cli.blasting.blast import blast
from penink_cli.blasting.solids import PEN_PT
from penink_cli.formats import directions as directions_format
from penink_cli.options.textures import find_texture
texture, along, w, h, threads = sys.argv[1], sys.argv[2] == "along", *map(float, sys.argv[3:])
data = io.BytesIO(sys.stdin.buffer.read())
tone, field = np.load(data), directions_format.read(data, "field", 10**8)
c, t = time.process_time(), time.perf_counter()
s = blast(tone, w * 72, h * 72, None, find_texture(texture), threads=int(threads), directions=field if along else None)
c, t = time.process_time() - c, time.perf_counter() - t
peak = int(next(line for line in open("/proc/self/status") if line.startswith("VmHWM")).split()[1]) / 1024
print(f"{c:7.2f}  {t:7.2f}  {peak:7.0f}  {len(s):8}")
"""


def speed_table(rows: list[tuple[str, bool, float, float, int]]) -> None:
    print("camera:                   inches  threads    CPU s   wall s       MB   strokes")
    tone, _, field = represented("camera")
    data = io.BytesIO()
    np.save(data, tone)
    directions_format.write(data, field)
    for texture, along, w, h, threads in rows:
        way = "along" if along else "straight"
        arguments = [sys.executable, "-c", SPEED, texture, way, str(w), str(h), str(threads)]
        done = subprocess.run(arguments, input=data.getvalue(), capture_output=True, check=True)
        print(f"  {texture:11} {way:9} {w:4} × {h:<4} {threads:5}  {done.stdout.decode().strip()}", flush=True)


def speed() -> None:
    """Held to be good enough: 2.2 times the straight sweep's processor time, 280 MB."""
    speed_table([(texture, along, 8, 8, 1) for texture, along in
                 (("crosshatch", False), ("crosshatch", True), ("form", True))])  # fmt: skip


def poster() -> None:
    """Held to be good enough: 70 s, 1.2 GB."""
    speed_table([("crosshatch", False, 24, 36, 2), ("form", True, 24, 36, 2)])


TABLES = {
    "fields": fields, "constant": constant, "tone": tone, "pens": pens, "lengths": lengths, "bytes": bytes_,
    "speed": speed, "poster": poster,
}  # fmt: skip

if __name__ == "__main__":
    for table in sys.argv[1:] or TABLES:
        start = time.perf_counter()
        TABLES[table]()
        print(f"  ({time.perf_counter() - start:.0f} s)", flush=True)
