"""Blasting measured: tone, evenness, crispness, speed. ``python -m tests.benchmarks.blasting [TABLE]...``

Tables: tone strict textures light devices pens long evenness disc speed threads poster, each within two minutes or so,
textures within five. All need Ghostscript but the last three.
"""

from __future__ import annotations

import io
import subprocess
import sys
import time

import numpy as np

from penink_cli.blasting import curves, hatching, sweep, walls
from penink_cli.blasting.blast import blast
from penink_cli.blasting.shares import shares
from penink_cli.blasting.sheet import Sheet
from penink_cli.ground.model import EdgeList, Floats
from penink_cli.options.textures import find_texture
from tests.blasting import measures


def picture(name: str) -> Floats:
    """Tone of a photograph, or of a ramp."""
    if name == "ramp":
        return np.tile(np.linspace(0, 1, 600), (300, 1))
    from skimage import data

    values = getattr(data, name)().astype(float)
    if values.ndim == 3:
        values = values[..., :3] @ [0.299, 0.587, 0.114]
    return 1 - values / 255


def draw(name: str, inches: float, texture: str = "crosshatch", **options):
    tone = picture(name)
    start = time.process_time()
    strokes = blast(tone, inches * 72, inches * 72 * len(tone) / tone.shape[1], None, find_texture(texture), **options)
    return tone, strokes, time.process_time() - start


def tone_table(rows: list[tuple[str, float, str, str]]) -> None:
    print("tone at 600 dpi, %:        inches  texture      rule      RMS   bias  worst   long  strokes  CPU s")
    for name, inches, texture, rule in rows:
        wanted, strokes, seconds = draw(name, inches, texture, rule=rule)
        rms, bias, worst = measures.tone_figures(strokes, wanted)
        print(
            f"  {name:24} {inches:5}   {texture:11}  {rule:7} {rms:5.2f}  {bias:+5.2f}  {worst:5.1f}"
            f"  {measures.long_share(strokes):5.2f}  {len(strokes):7}  {seconds:5.2f}",
            flush=True,
        )


PHOTOS = ("ramp", "camera", "moon", "coins", "chelsea", "rocket")


def tone() -> None:
    tone_table([(n, w, "crosshatch", "best") for n in PHOTOS for w in (2, 4, 8)])


def strict() -> None:
    tone_table([(n, 4, "crosshatch", rule) for n in PHOTOS[:4] for rule in ("best", "strict")])
    print("strict, how much too light a flat field is:  " + "  ".join(f"{level:5.2f}" for level in LEVELS))
    for texture in ("crosshatch", "parallel", "stipple", "scribble"):
        biases = []
        for level in LEVELS:
            strokes = blast(np.full((16, 16), level), 288, 288, None, find_texture(texture), rule="strict")
            biases.append(measures.tone_figures(strokes, np.full((16, 16), level))[1])
        print(f"  {texture:41}  " + "  ".join(f"{bias:+5.1f}" for bias in biases), flush=True)
    print("the tones of the pictures, share of each:    " + "  ".join(f"{level:5.2f}" for level in LEVELS))
    for name in PHOTOS[:4]:
        nearest = np.abs(picture(name).reshape(-1, 1) - np.array(LEVELS)).argmin(axis=1)
        share = np.bincount(nearest, minlength=len(LEVELS)) / len(nearest)
        print(f"  {name:41}  " + "  ".join(f"{part:5.2f}" for part in share), flush=True)


LEVELS = (0.05, 0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.95)


def textures() -> None:
    names = ("parallel", "grain", "crosshatch4", "stipple", "scribble", "lawn", "brick")
    tone_table([(n, 4, t, "best") for t in names for n in PHOTOS[:4]])
    pairs = [(t, w) for t in ("parallel", "grain", "stipple", "scribble") for w in (2, 8)]
    tone_table([(n, w, t, "best") for t, w in pairs for n in PHOTOS[:4]])


def light() -> None:
    levels = (0.005, 0.01, 0.02, 0.03, 0.05, 0.08)
    print("light flats, 4 × 4 in, bias / RMS:  " + "  ".join(f"{level:11.1%}" for level in levels))
    for texture in ("crosshatch", "grain", "stipple", "scribble", "lawn"):
        cells = []
        for level in levels:
            wanted = np.full((32, 32), level)
            rms, bias, _ = measures.tone_figures(blast(wanted, 288, 288, None, find_texture(texture)), wanted)
            cells.append(f"{bias:+.2f} / {rms:.2f}")
        print(f"  {texture:32}  " + "  ".join(f"{cell:>11}" for cell in cells), flush=True)


def room(tone: Floats, width: float, edges: EdgeList, texture: str) -> float:
    """The share of a picture's ink for which there is room in strokes of over 20 pt that end at its strong edges.

    Lines in the directions of the layers, from frame to frame, are cut at the walls; each part weighs what its layer
    is to cover along it.
    """
    sheet = Sheet(tone, width, width * len(tone) / tone.shape[1], 0.12)
    layers = find_texture(texture).layers
    borders = walls.build(edges, sheet, 0.4)
    across = np.hypot(sheet.width, sheet.height)
    offsets = np.arange(-across / 2, across / 2, 1.5)
    ink, long = 0.0, 0.0
    for layer, cover in zip(layers, shares(sheet.tone.astype(float), sheet.tone.astype(float), layers)):
        c, s = sweep.heading(layer.angle)
        count = int(across)
        t = (np.arange(count + 1) / count - 0.5) * across
        points = np.array([sheet.width / 2, sheet.height / 2]) + t[None, :, None] * np.array([c, s])
        points = points + offsets[:, None, None] * np.array([-s, c])
        lines = curves.Polylines(points.reshape(-1, 2), np.arange(len(offsets) + 1) * (count + 1))
        none = np.zeros(len(offsets))
        parts = walls.cut(borders, lines, none, (none, none))
        at = np.clip(np.floor(lines.points * (sheet.scale / 8)).astype(int), 0, (sheet.columns - 1, sheet.rows - 1))
        run = np.concatenate([[0.0], np.cumsum(cover[at[:, 1], at[:, 0]])])
        base = lines.first[parts.curve]
        weight = run[base + parts.end.astype(int) + 1] - run[base + parts.start.astype(int)]
        ink += weight.sum()
        long += weight[(parts.end - parts.start) * across / count > 20].sum()
    return long / ink


def long() -> None:
    from penink_cli.arrangement.detection import detect_edges

    print("ink in runs over 20 pt, 4 in:  no edges  cut at strong edges  room for, at those edges     RMS  worst")
    for name in (*PHOTOS[1:], "astronaut", "coffee"):
        wanted = picture(name)
        edges = detect_edges(1 - wanted)
        free, cut = (draw_with(wanted, 4, e) for e in (None, edges))
        rms, _, worst = measures.tone_figures(cut, wanted)
        print(
            f"  {name:28} {measures.long_share(free):9.3f}  {measures.long_share(cut):19.3f}"
            f"  {room(wanted, 288, edges, 'crosshatch'):24.3f}  {rms:6.2f}  {worst:5.1f}",
            flush=True,
        )


def draw_with(tone: Floats, inches: float, edges: EdgeList | None):
    return blast(tone, inches * 72, inches * 72 * len(tone) / tone.shape[1], edges, find_texture("crosshatch"))


def devices() -> None:
    print("blasted anew for a device:     dpi    RMS   bias")
    for name in ("ramp", "camera"):
        for dpi in (300, 600, 1200):
            wanted, strokes, _ = draw(name, 4, device_dpi=dpi)
            rms, bias, _ = measures.tone_figures(strokes, wanted, dpi)
            print(f"  {name:24} {dpi:7}  {rms:5.2f}  {bias:+5.2f}", flush=True)


def pens() -> None:
    print("one 0.3 mm pen:            inches    RMS   bias")
    biases = []
    for inches in (3, 6, 12):
        wanted, strokes, _ = draw("camera", inches, pen_pt=0.3 / 25.4 * 72)
        rms, bias, _ = measures.tone_figures(strokes, wanted)
        biases.append(abs(bias))
        print(
            f"  camera {inches:23}    {rms:5.2f}  {bias:+5.2f}  {set(np.round(strokes.widths, 4).tolist())}", flush=True
        )
    print(f"  spread of |bias| {max(biases) - min(biases):.2f}")


def even() -> None:
    """Without fine strokes, which lie between the lines."""
    least, hatching.FINE_LEAST = hatching.FINE_LEAST, np.inf
    print(
        "evenness, flat, 8 × 8 in: tone  angle     cv spread doubled   long gaping aligned"
        "  tile dB  peak dB  repeat  over 20 pt  tone RMS"
    )
    for texture in ("parallel", "crosshatch"):
        for level in (0.1, 0.2, 0.35, 0.55):
            wanted = np.full((64, 64), level)
            strokes = blast(wanted, 576, 576, None, find_texture(texture))
            rms = measures.tone_figures(strokes, wanted)[0]
            for angle in (-45.0, 45.0) if level > 0.5 and texture == "crosshatch" else (-45.0,):
                f = measures.evenness(strokes, angle)
                print(
                    f"  {texture:22} {level:5}  {angle:5}  {f['cv']:5.3f} {f['spread']:6.3f} {f['doubled']:7.4f}"
                    f" {f['doubled_long']:6.4f} {f['gaping']:6.4f} {f['aligned_ends']:7.3f}"
                    f"  {f['tile_db']:+7.2f}  {f['tile_peak_db']:+7.2f}  {f['repeat_corr']:6.3f}"
                    f"  {measures.long_share(strokes):10.3f}  {rms:8.2f}",
                    flush=True,
                )
    hatching.FINE_LEAST = least


def disc() -> None:
    print("a disc of 0.8 on 0.15, ink: inches  edges   first point within, without")
    y, x = np.mgrid[:600, :600] - 299.5
    wanted = np.where(np.hypot(x, y) < 150, 0.8, 0.15)
    turn = np.arange(180) * np.pi / 90
    circle = 300 + 150 * np.column_stack([np.cos(turn), np.sin(turn)])
    ring = EdgeList(600, 600, circle, np.column_stack([np.arange(180), (np.arange(180) + 1) % 180]))
    for inches in (2, 4):
        for edges in (ring, None):
            strokes = blast(wanted, inches * 72, inches * 72, edges, find_texture("crosshatch"))
            ink = measures.rendered(strokes, 600)
            yy, xx = np.mgrid[: len(ink), : len(ink)] + 0.5 - len(ink) / 2
            r = np.hypot(xx, yy) * 72 / 600 - inches * 18
            within, without = ink[(r < 0) & (r > -1)].mean(), ink[(r > 0) & (r < 1)].mean()
            print(f"  {inches:31}  {'yes' if edges else 'no ':5}   {within:.2f}, {without:.2f}", flush=True)


SPEED = """
import sys, io, time, numpy as np
from penink_cli.blasting.blast import blast
from penink_cli.blasting.sheet import Sheet
from penink_cli.options.textures import find_texture
trials = [0, 0]
place = Sheet.place
def counting(self, lines, widths, batches, **options):
    found = place(self, lines, widths, batches, **options)
    trials[0] += sum(map(len, batches)) * len(options.get("shifts", (0.0,)))
    trials[1] += len(found[0])
    return found
Sheet.place = counting
w, h, threads, rule = float(sys.argv[1]) * 72, float(sys.argv[2]) * 72, int(sys.argv[3]), sys.argv[4]
tone, texture = np.load(io.BytesIO(sys.stdin.buffer.read())), find_texture("crosshatch")
c, t = time.process_time(), time.perf_counter()
s = blast(tone, w, h, None, texture, threads=threads, rule=rule)
c, t = time.process_time() - c, time.perf_counter() - t
import hashlib
digest = hashlib.sha256(s.points.tobytes() + s.widths.tobytes()).hexdigest()[:12]
# the kernel's other figure counts what the parent held
peak = int(next(line for line in open("/proc/self/status") if line.startswith("VmHWM")).split()[1]) / 1024
print(f"{c:7.2f}  {t:7.2f}  {peak:7.0f}  {trials[0]:8}  {trials[1]:8}  {len(s):8}  {digest}")
"""


def speed_table(sizes: list[tuple[float, float, int, str]]) -> None:
    print("crosshatch:   inches  threads  rule       CPU s   wall s       MB    trials  accepted   strokes  digest")
    file = io.BytesIO()
    np.save(file, picture("camera"))  # what reads photographs needs more memory than blasting
    for w, h, threads, rule in sizes:
        arguments = [sys.executable, "-c", SPEED, str(w), str(h), str(threads), rule]
        done = subprocess.run(arguments, input=file.getvalue(), capture_output=True, check=True)
        print(f"  {w:6} × {h:<10}  {threads:5}  {rule:7}  {done.stdout.decode().strip()}", flush=True)


def speed() -> None:
    speed_table([(w, w, 1, "best") for w in (2, 4, 8, 16)] + [(8, 8, 1, "strict")])


def threads() -> None:
    speed_table([(8, 8, n, "best") for n in (1, 2, 8)])


def poster() -> None:
    speed_table([(24, 36, 2, "best")])


TABLES = {
    "tone": tone, "strict": strict, "textures": textures, "light": light, "devices": devices, "pens": pens,
    "long": long, "evenness": even, "disc": disc, "speed": speed, "threads": threads, "poster": poster,
}  # fmt: skip

if __name__ == "__main__":
    for table in sys.argv[1:] or TABLES:
        TABLES[table]()
