"""Bytes of archives and what they show; walls: ``python -m tests.benchmarks.archives [PART …] [-- PHOTO …]``.

sizes        bytes of `draw -o x.penink` of half a megapixel, by members, encoding and decoding; without directions
             and lines in the style `true`
similarity   `render` at 6 in of that archive, and of one with all edges, a grid of RMS 8 and 64 levels, against the
             photograph (`detail` and `telling` of tests.benchmarks.drawing)
wall         brick from natural 4 in at 2, 4, 8, 16 in: courses, tone, time beside crosshatch
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_filter1d

from penink_cli.blasting.blast import blast
from penink_cli.formats import archive, illustration, parts
from penink_cli.ground.model import GreyImage, Illustration, Layer
from penink_cli.options.illustrations import read_illustration
from penink_cli.options.textures import find_texture
from penink_cli.selfdrawing import postscript
from tests.benchmarks.drawing import seen
from tests.blasting import measures

PIXELS = 500_000
NAMES = ("astronaut", "camera", "chelsea", "coffee", "coins", "moon", "rocket")


def penink(*words: object) -> None:
    subprocess.run([sys.executable, "-m", "penink_cli", *map(str, words)], check=True)


def photograph(name: str, folder: Path) -> Path:
    """A bundled picture of half a megapixel."""
    import skimage.data

    picture = Image.fromarray(np.asarray(getattr(skimage.data, name)()))
    part = (PIXELS / (picture.width * picture.height)) ** 0.5
    path = folder / f"{name}.png"
    picture.resize((round(picture.width * part), round(picture.height * part)), Image.Resampling.BICUBIC).save(path)
    return path


def drawn(name: str, folder: Path) -> Path:
    path = folder / f"{name}.penink"
    if not path.exists():
        penink("draw", photograph(name, folder), "-o", path)
    return path


def held(packed: bytes) -> dict[str, bytes]:
    """What the first layer of an archive is made of: samples, edges, directions, lines, by these names."""
    files = archive.read(packed, "")
    manifest = json.loads(files["illustration.json"])
    kept, layer = parts.parts_from(files[manifest["parts"]]), manifest["layers"][0]
    return {kind: data for kind in layer if (data := parts.chosen(kept, str(layer[kind]))) is not None}


def sizes(names: list[str], folder: Path) -> None:
    print(
        "bytes of draw -o x.penink, half a megapixel; plain: --style true, without directions and lines; s of processor"
    )
    print("| photograph | all | samples | edges | directions | lines | grid, edges | encode | decode | plain |")
    print("|" + " --- |" * 10)
    rows = []
    for name in names:
        path = drawn(name, folder)
        members = {kind: len(data) for kind, data in held(path.read_bytes()).items()}
        start = time.process_time()
        whole = read_illustration(str(path), 10**8)
        middle = time.process_time()
        archive.pack(illustration.members(whole))
        end = time.process_time()
        plain = folder / "plain.penink"
        penink("draw", photograph(name, folder), "--style", "true", "--no-lines", "-o", plain)
        rows.append([path.stat().st_size, *(members.get(k, 0) for k in ("samples", "edges", "directions", "lines"))])
        rows[-1].append(plain.stat().st_size)
        h, w = whole.layers[0].samples.values.shape
        count = len(whole.layers[0].edges.edges) if whole.layers[0].edges else 0
        cells = [*rows[-1][:5], f"{w}x{h}, {count}", f"{end - middle:.2f}", f"{middle - start:.2f}", rows[-1][5]]
        print(f"| {name} | " + " | ".join(map(str, cells)) + " |", flush=True)
    mean = [f"{v:.0f}" for v in np.mean(rows, axis=0)]
    print(f"| mean | {' | '.join(mean[:5])} | | | | {mean[5]} |")


def not_thinned(name: str, folder: Path) -> Path:
    """An archive of the same photograph that is not thinned: all edges and lines, RMS 8, 64 levels, 96 directions."""
    photo, f = (
        photograph(name, folder),
        {k: folder / k for k in ("g.pgm", "e.json", "l.json", "d.pgm", "s.pgm", "r.pgm")},
    )
    penink("compose", "--width", 432, "--dpi", 1152, photo, "-o", f["g.pgm"])
    penink("detect-edges", "--high", 0.15, f["g.pgm"], "-o", f["e.json"])
    penink("detect-lines", photo, "-o", f["l.json"])
    penink("detect-directions", "-e", f["e.json"], "--lines", f["l.json"], photo, "-o", f["d.pgm"])
    penink("extract-samples", "-e", f["e.json"], f["g.pgm"], "-o", f["s.pgm"])
    penink("reduce", "-e", f["e.json"], "--photo", f["g.pgm"], "--auto", f["s.pgm"], "-o", f["r.pgm"])
    now = json.loads(archive.read(drawn(name, folder).read_bytes(), "")["illustration.json"])
    del now["parts"]
    layer = now["layers"][0] | {
        "samples": "r.pgm",
        "edges": "e.json",
        "directions": "d.pgm",
        "lines": "l.json",
        "levels": 64,
    }
    path = folder / "all.illustration.json"
    path.write_text(json.dumps(now | {"layers": [layer]}))
    return path


def similarity(names: list[str], folder: Path) -> None:
    print("drawings at 6 in against the photograph: detail / telling of the archive, of one not thinned, difference")
    rows = []
    for name in names:
        measured = []
        for path in (drawn(name, folder), not_thinned(name, folder)):
            penink("render", path, "--width", "6in", "--device-dpi", "none", "-o", folder / "s.jsonl")
            penink("to-png", folder / "s.jsonl", "-o", folder / "s.png")
            found = seen(folder / "s.png", folder / f"{name}.png")
            measured.append((found["detail"], found["telling"]))
        (a, b), (c, d) = measured
        rows.append((a - c, b - d))
        print(f"{name:10s} {a:.3f} / {b:.3f}   {c:.3f} / {d:.3f}   {a - c:+.3f} / {b - d:+.3f}", flush=True)
    print("mean difference " + " / ".join(f"{v:+.3f}" for v in np.mean(rows, axis=0)))


def repeats(profile: np.ndarray) -> int:
    """The first lag at which a profile's correlation with itself peaks at more than half of its highest peak."""
    flat = gaussian_filter1d(profile, 2) - gaussian_filter1d(profile, 120)
    like = np.array([1.0, *(np.mean(flat[k:] * flat[:-k]) / np.mean(flat * flat) for k in range(1, len(flat) // 2))])
    peaks = [k for k in range(24, len(like) - 9) if like[k] == like[k - 8 : k + 9].max()]
    return next(k for k in peaks if like[k] > max(like[peaks]) / 2)


def counted(page: np.ndarray) -> str:
    """Courses in the height and bricks across, of ink (h, w) on a light flat wall."""
    course = repeats(page.mean(axis=1))
    # bricks of every second course, which lie below one another; of all places to begin, where they are plainest
    rows = np.arange(len(page))
    plain = [page[(rows + shift) % (2 * course) < course].mean(axis=0) for shift in range(0, 2 * course, 2)]
    return f"{len(page) / course:.1f}, {page.shape[1] / repeats(max(plain, key=np.var)):.1f}"


def on_a_printer(inches: float) -> np.ndarray:
    """The ink (960, 1440) of a light flat wall that an EPS of natural width 4 in draws by itself, 600 dpi."""
    from tests.selfdrawing.pictures import ghostscript

    samples = GreyImage(np.full((16, 24), 13, np.uint8), 15)
    picture = Illustration(288.0, 192.0, (Layer(samples, None, find_texture("brick"), "brick"),))
    size = f"<< /PageSize [{72 * inches} {48 * inches}] >> setpagedevice {inches / 4} dup scale\n"
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "page.pbm"
        program = b"%!\n" + size.encode() + postscript.write(picture)
        ghostscript(program, "-sDEVICE=pbmraw", "-r600", f"-sOutputFile={out}")
        page = Image.open(out).convert("L").resize((1440, 960), Image.Resampling.BOX)
    return 1 - np.asarray(page, float) / 255


def wall(names: list[str], folder: Path) -> None:
    print("brick, natural width 4 in, on a ramp with a shadow; courses in the height, bricks across of a light flat")
    print("| inches | courses, bricks | tone RMS, bias, worst % | s of processor | crosshatch | EPS: courses, bricks |")
    print("| --- | --- | --- | --- | --- | --- |")
    from tests.textures.test_textures import coverage

    brick, crosshatch = find_texture("brick"), find_texture("crosshatch")
    for inches in (2, 4, 8, 16):
        n = max(200, 144 * inches)
        y, x = np.mgrid[0 : 2 * n // 3, 0:n] / n
        tone = 0.08 + 0.55 * x + 0.3 * np.exp(-30 * ((x - 0.3) ** 2 + (y - 0.3) ** 2))
        size = 72.0 * inches, 48.0 * inches
        times = [time.process_time()]
        strokes = blast(tone, *size, None, brick, natural_pt=288, threads=1)
        times.append(time.process_time())
        blast(tone, *size, None, crosshatch, threads=1)
        times.append(time.process_time())
        rms, bias, worst = measures.tone_figures(strokes, tone)
        flat = blast(np.full((160, 240), 0.12), *size, None, brick, natural_pt=288, device_dpi=None)
        spent, other = np.diff(times)
        print(
            f"| {inches} | {counted(coverage(flat, 960, 1440))} | {rms:.2f}, {bias:+.2f}, {worst:.1f} "
            f"| {spent:.2f} | {other:.2f} | {counted(on_a_printer(inches))} |", flush=True,
        )  # fmt: skip


PARTS = {"sizes": sizes, "similarity": similarity, "wall": wall}


def main() -> None:
    words = sys.argv[1:]
    at = words.index("--") if "--" in words else len(words)
    with tempfile.TemporaryDirectory() as folder:
        for part in words[:at] or PARTS:
            PARTS[part](words[at + 1 :] or list(NAMES), Path(folder))


if __name__ == "__main__":
    main()
