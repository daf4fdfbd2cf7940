"""How fast and how true enlargement is: `python -m tests.benchmarks.reconstruction [PART …]`.

Parts: calls, limits, photos, process, large, preprocess, accuracy, growth, table1. Times are given as ratios to
Pillow's BICUBIC of the same 8-bit picture, measured in turns with it in the same run, the best of several. Two threads
can be no faster than the machine lets any two be: `calls` first prints how much that is in this run.
"""

from __future__ import annotations

import hashlib
import os
import resource
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path
from unittest import mock

import numpy as np
import skimage.data
from PIL import Image

from penink_cli.arrangement.detection import detect_edges
from penink_cli.formats import edge_list
from penink_cli.geometry.validity import check
from penink_cli.ground.model import EdgeList, GreyImage
from penink_cli.reconstruction import enlarge as enlarging
from penink_cli.reconstruction import lanes
from penink_cli.reconstruction._compiled import render as _render
from penink_cli.reconstruction.enlarge import enlarge, reconstruct
from penink_cli.reconstruction.paths import Paths
from tests.reconstruction.scenes import SCENES, psnr, tones

ROOT = Path(__file__).resolve().parents[2]
THREADS = 2


def arcs(width: int, height: int, count: int, seed: int = 0) -> EdgeList:
    """Some `count` edges in open chains of twelve, each an arc in a block of its own: the make of a photo's edges."""
    rng = np.random.default_rng(seed)
    block = np.sqrt(width * height * 12 / count)
    across, down = max(1, int(width / block)), max(1, round(height / block))
    vertices, edges = [], []
    for k in range(across * down):
        steps = min(12, count - len(edges))
        if steps < 1:
            break
        centre = (np.array([k % across, k // across]) + 0.5) * (width / across, height / down)
        radius = 0.46 * min(width / across, height / down)
        angle = rng.uniform(0, 2 * np.pi) + np.linspace(0, rng.uniform(1.5, 5.0), steps + 1)
        edges += [(len(vertices) + i, len(vertices) + i + 1) for i in range(steps)]
        vertices += (centre + radius * np.c_[np.cos(angle), np.sin(angle)] * (1, rng.uniform(0.3, 1))).tolist()
    found = EdgeList(width, height, np.array(vertices), np.array(edges, np.int64))
    check(found)
    return found


def scattered(width: int, height: int, count: int, seed: int = 0) -> EdgeList:
    """As many edges, none joined to another: every vertex an open end, the hardest case."""
    rng = np.random.default_rng(seed)
    across = int(np.ceil(np.sqrt(count * width / height)))
    down = -(-count // across)
    place = rng.permutation(across * down)[:count]
    centre = (np.c_[place % across, place // across] + 0.5) * (width / across, height / down)
    angle = rng.uniform(0, np.pi, count)
    half = np.c_[np.cos(angle), np.sin(angle)] * 0.49 * min(width / across, height / down, 2.6)
    vertices = np.stack([centre - half, centre + half], axis=1).reshape(-1, 2)
    return EdgeList(width, height, vertices, np.arange(2 * count).reshape(-1, 2))


def noise(width: int, height: int) -> GreyImage:
    return GreyImage(np.random.default_rng(1).integers(0, 256, (height, width)).astype(np.uint8))


def in_turns(tasks, rounds):
    """Best time of each task, all of them run once a round."""
    best = [np.inf] * len(tasks)
    for _ in range(rounds):
        for k, task in enumerate(tasks):
            start = time.perf_counter()
            task()
            best[k] = min(best[k], time.perf_counter() - start)
    return best


def pillow(image: GreyImage, width: int, height: int):
    source = Image.fromarray(image.values)
    return lambda: source.resize((width, height), Image.Resampling.BICUBIC)


def row(*cells):
    print("  " + "  ".join(f"{c:>14}" if not isinstance(c, float) else f"{c:>14.3g}" for c in cells), flush=True)


def parallel() -> float:
    """How much faster two threads compute something that needs neither memory nor the interpreter than one does."""
    block = b"penink" * (1 << 20)

    def work() -> None:  # lets go of the interpreter
        hashlib.sha256(block).digest()

    def both() -> None:
        other = threading.Thread(target=work)
        other.start()
        work()
        other.join()

    one, two = in_turns([work, both], 15)
    return 2 * one / two


def calls():
    print("Whole call on arrays, preprocessing included, two threads (must: 1.5, 1.0, no edges 0.15)")
    print(f"  in this run two threads do {parallel():.2f} × the work of one")
    row("samples", "edges", "make", "ms", "/ Pillow", "/ Pillow, CPU")
    for n, count, rounds in ((128, 500, 40), (1024, 20000, 5)):
        image = noise(n, n)
        makes = [("none", None), ("arcs", arcs(n, n, count)), ("scattered", scattered(n, n, count))]
        tasks = [pillow(image, 8 * n, 8 * n)]
        tasks += [lambda e=e: enlarge(image, e, 8 * n, 8 * n, threads=THREADS) for _, e in makes]
        base, *times = in_turns(tasks, rounds)
        single = [lambda e=e: enlarge(image, e, 8 * n, 8 * n, threads=1) for _, e in makes]
        cpu_base, *cpu = processor_time([tasks[0], *single], rounds)
        for (make, edges), t, c in zip(makes, times, cpu):
            row(
                f"{n}²→{8 * n}²",
                0 if edges is None else len(edges.edges),
                make,
                1e3 * t,
                t / base,
                c / cpu_base / THREADS,
            )
    print("  (the last column: processor time of one thread, shared by two, to Pillow's processor time)")


def processor_time(tasks, rounds):
    best = [np.inf] * len(tasks)
    for _ in range(rounds):
        for k, task in enumerate(tasks):
            start = time.process_time()
            task()
            best[k] = min(best[k], time.process_time() - start)
    return best


def limits():
    """What the parts of a call cost: none of them can be left out, and two threads at best halve their sum."""
    print("Where a call's time goes, processor time of one thread in ms and, halved, to Pillow's")
    row("samples", "make", "bare write", "one thread", *STAGES, "sum / 2 / Pillow")
    for n, count, rounds in ((128, 500, 30), (1024, 20000, 3)):
        image = noise(n, n)
        base = processor_time([pillow(image, 8 * n, 8 * n)], rounds)[0]
        write = processor_time([lambda: np.empty((8 * n, 8 * n), np.uint8).fill(1)], rounds)[0]
        start = in_turns([one_thread], 100)[0]
        for make, edges in (("none", None), ("arcs", arcs(n, n, count)), ("scattered", scattered(n, n, count))):
            spent = dict.fromkeys(STAGES, np.inf)
            for _ in range(rounds):
                for name, seconds in stages(image, edges, 8 * n).items():
                    spent[name] = min(spent[name], seconds)
            spent["sums"] -= spent["paths"]
            whole = sum(spent.values()) / base / THREADS
            row(f"{n}²→{8 * n}²", make, 1e3 * write, 1e3 * start, *(1e3 * spent[name] for name in STAGES), whole)
    print("  (bends: what each sample sees; paths: what each pixel sees, and by which bends; sums: equations 4 and 5)")


def one_thread():
    other = threading.Thread(target=lambda: None)
    other.start()
    other.join()


STAGES = ("preprocessing", "plain pass", "bends", "paths", "sums")


def stages(image, edges, size) -> dict[str, float]:
    """Processor time of the stages of one call on one thread; that of the paths is within that of the sums."""
    spent = dict.fromkeys(STAGES, 0.0)
    separable = lanes.kernel("separable")
    worker = enlarging._Enlargement._worker
    at_rest = False

    def timed(stage, whole):
        def run(*arguments, **options):
            start = time.process_time()
            result = whole(*arguments, **options)
            spent[stage] += time.process_time() - start
            return result

        return run

    def given(work):
        finder, tile, scratch = worker(work)
        if at_rest:
            scratch.rest()
        return mock.Mock(move=timed("bends", finder.move)), tile, scratch

    with (
        mock.patch.object(enlarging, "Paths", timed("preprocessing", Paths)),
        mock.patch.object(separable, "expand", timed("plain pass", separable.expand)),
        mock.patch.object(separable, "combine", timed("plain pass", separable.combine)),
        mock.patch.object(enlarging._Enlargement, "_worker", given),
        mock.patch.object(_render, "retouch", timed("sums", _render.retouch)),
    ):
        enlarge(image, edges, size, size, threads=1)
        found = dict(spent)
        if edges is not None:  # once more without any arithmetic: what then takes time is finding paths
            at_rest = True
            spent["sums"] = 0.0
            enlarge(image, edges, size, size, threads=1)
            found["paths"] = spent["sums"]
    return found


def photos():
    print("Photographs at 4 × as many pixels as samples, their edges detected, 8 × enlarged, two threads")
    row("photo", "samples", "edges", "ms", "/ Pillow", "/ Pillow, CPU")
    for name in ("camera", "coffee"):
        picture = Image.fromarray(getattr(skimage.data, name)()).convert("L")
        w, h = picture.width // 4, picture.height // 4
        grey = np.asarray(picture)[: 4 * h, : 4 * w] / 255.0
        edges = detect_edges(grey)
        image = GreyImage(np.round(255 * grey.reshape(h, 4, w, 4).mean(axis=(1, 3))).astype(np.uint8))
        tasks = [pillow(image, 8 * w, 8 * h), lambda: enlarge(image, edges, 8 * w, 8 * h, threads=THREADS)]
        base, mine = in_turns(tasks, 10)
        cpu_base, cpu = processor_time([tasks[0], lambda: enlarge(image, edges, 8 * w, 8 * h, threads=1)], 10)
        row(name, f"{w}x{h}", len(edges.edges), 1e3 * mine, mine / base, cpu / cpu_base / THREADS)


PILLOW_SCRIPT = """
import sys
import numpy
from PIL import Image
picture = Image.open(sys.argv[1]).resize((1024, 1024), Image.Resampling.BICUBIC)
values = numpy.asarray(picture)
with open(sys.argv[2], "wb") as out:
    out.write(b"P5\\n1024 1024\\n255\\n" + values.tobytes())
"""


def process():
    print("The process as a user runs it, 128² → 1024², 500 edges (must: 1.3)")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_inputs(folder, 128, 500)
        ours = command(folder, "--scale", "8", "-o", folder / "out.pgm")
        theirs = [sys.executable, "-c", PILLOW_SCRIPT, str(folder / "in.pgm"), str(folder / "pillow.pgm")]
        # Installed modules are compiled once; so must these be, whatever the environment says.
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONPYCACHEPREFIX": str(folder / "bytecode")}
        environment.pop("PYTHONDONTWRITEBYTECODE", None)

        def run(arguments):
            subprocess.run(arguments, check=True, env=environment)

        base, mine = in_turns([lambda: run(theirs), lambda: run(ours)], 12)
        row("penink ms", "Pillow ms", "ratio")
        row(1e3 * mine, 1e3 * base, mine / base)


def write_inputs(folder: Path, n: int, count: int) -> None:
    (folder / "in.pgm").write_bytes(b"P5\n%d %d\n255\n" % (n, n) + noise(n, n).values.tobytes())
    with (folder / "in.edges.json").open("wb") as out:
        edge_list.write(out, arcs(n, n, count))


def command(folder: Path, *arguments):
    return [
        sys.executable, "-m", "penink_cli", "enlarge", "-q", "-e", str(folder / "in.edges.json"),
        *map(str, arguments), "--threads", str(THREADS), str(folder / "in.pgm"),
    ]  # fmt: skip


def large():
    print("1024² → 32768², 20 000 edges, to a pipe that is read and dropped (must: 400 MB, 1.5)")
    image = noise(1024, 1024)
    base = in_turns([pillow(image, 8192, 8192)], 2)[0] / 8192**2
    with tempfile.TemporaryDirectory() as name:
        write_inputs(Path(name), 1024, 20000)
        start = time.perf_counter()
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        with subprocess.Popen(command(Path(name), "--scale", "32"), stdout=subprocess.PIPE, env=environment) as child:
            assert child.stdout is not None
            first = None
            while child.stdout.read(1 << 22):
                first = first or time.perf_counter() - start
        elapsed = time.perf_counter() - start
        assert child.returncode == 0
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    row("s", "first byte s", "peak MB", "ns/pixel", "/ Pillow")
    row(elapsed, float(first or 0), peak, 1e9 * elapsed / 32768**2, elapsed / 32768**2 / base)


def preprocess():
    print("Preprocessing alone (must: 20 000 edges within 50 × 500)")
    small, big = arcs(128, 128, 500), arcs(1024, 1024, 20000)
    few, many = in_turns([lambda: Paths(small, 128, 128), lambda: Paths(big, 1024, 1024)], 15)
    row("500, ms", "20 000, ms", "ratio")
    row(1e3 * few, 1e3 * many, many / few)
    search = in_turns([lambda: check(big)], 5)[0]
    print(f"  finding no crossing among 20 000 edges: {1e3 * search:.0f} ms")


def accuracy():
    print("8 × from 32² exact samples and edges, PSNR in dB (must: the second column)")
    row("scene", "dB", "must", "bicubic dB")
    for name, (make, least) in SCENES.items():
        tone, edges = make()
        truth = tones(tone, 256)
        plain = reconstruct(truth.reshape(32, 8, 32, 8).mean(axis=(1, 3)), None, 256, 256)
        row(name, psnr(reconstruct(tones(tone, 32), edges, 256, 256), truth), least, psnr(plain, truth))


def growth():
    print("Growth over edges, 1024² samples → 4096²")
    image = noise(1024, 1024)
    row("edges", "ms", "/ Pillow", "paths ms")
    for count in (100, 500, 2000, 5000, 20000):
        edges = arcs(1024, 1024, count)
        tasks = [pillow(image, 4096, 4096), lambda: enlarge(image, edges, 4096, 4096, threads=THREADS)]
        base, mine, before = in_turns([*tasks, lambda: Paths(edges, 1024, 1024)], 3)
        row(len(edges.edges), 1e3 * mine, mine / base, 1e3 * before)
    print("Growth over output, 128² samples, 500 edges")
    image, edges = noise(128, 128), arcs(128, 128, 500)
    row("output", "ms", "/ Pillow")
    for size in (256, 512, 1024, 2048, 4096, 8192):
        tasks = [pillow(image, size, size), lambda: enlarge(image, edges, size, size, threads=THREADS)]
        base, mine = in_turns(tasks, 3)
        row(f"{size}²", 1e3 * mine, mine / base)


TABLE_1 = [  # figure, samples, edges, output, the paper's seconds for preprocessing and enlarging
    ("3a pepper", (102, 128), 270, (204, 256), 39, 3),
    ("3b pepper", (102, 128), 270, (408, 512), 39, 35),
    ("3c pepper", (102, 128), 270, (816, 1024), 39, 108),
    ("4a worker", (64, 64), 0, (1024, 1024), 0, 3),
    ("4a egg", (128, 128), 0, (1024, 1024), 0, 4),
    ("4b worker", (64, 64), 237, (1024, 1024), 19, 130),
    ("4b egg", (128, 128), 143, (1024, 1024), 8, 41),
    ("5 keys", (128, 128), 504, (1024, 1024), 220, 142),
    ("5 shadow", (64, 64), 111, (1024, 1024), 3, 100),
    ("7a key", (27, 22), 0, (864, 704), 0, 2),
    ("7b key", (27, 22), 107, (864, 704), 8, 195),
    ("7b shadow", (27, 22), 6, (864, 704), 1, 30),
    ("8 billiard", (71, 61), 326, (568, 488), 47, 81),
]


def table1():
    print("The paper's table 1: seconds in 1997, and here")
    row("figure", "samples", "edges", "output", "paper pre", "here pre", "paper enlarge", "here enlarge")
    for name, (w, h), count, (width, height), pre, seconds in TABLE_1:
        image = noise(w, h)
        edges = arcs(w, h, count) if count else None
        before, whole = in_turns(
            [lambda: Paths(edges, w, h), lambda: enlarge(image, edges, width, height, threads=THREADS)], 5
        )
        row(name, f"{w}x{h}", count, f"{width}x{height}", float(pre), before, float(seconds), whole - before)


PARTS = (calls, limits, photos, process, large, preprocess, accuracy, growth, table1)


def main() -> None:
    """Print the parts asked for, all by default."""
    chosen = sys.argv[1:] or [part.__name__ for part in PARTS]
    for part in PARTS:
        if part.__name__ in chosen:
            part()
            print()


if __name__ == "__main__":
    main()
