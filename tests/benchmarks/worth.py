"""What each piece of machinery gains: ``python -m tests.benchmarks.worth [vectors junctions tours coder codes]``.

Each piece says at its top what this command prints; one that gains nothing is to go. All times are of the processor.
"""

from __future__ import annotations

import io
import lzma
import sys
import time
import zlib
from collections.abc import Callable
from functools import partial
from unittest import mock

import numpy as np

from penink_cli.arrangement import detection
from penink_cli.formats import compact, compact_edges
from penink_cli.geometry.trails import trails
from penink_cli.ground.model import GreyImage
from penink_cli.reconstruction import lanes
from penink_cli.reconstruction.enlarge import enlarge
from penink_cli.reconstruction.extraction import extract_samples
from penink_cli.reconstruction.reduction import reduce
from penink_cli.travel.order import ordered, travel_length
from tests.benchmarks import edges as of_edges
from tests.benchmarks.reconstruction import arcs, noise, scattered


def spent(task: Callable[[], object]) -> tuple[float, object]:
    """Seconds of the processor that a task takes, and its result."""
    start = time.process_time()
    result = task()
    return time.process_time() - start, result


def vectors() -> None:
    """Enlarging by 4 on one thread with the vectors of each make, as parts of the time of the narrowest."""
    print("vectors: time by bytes of a vector, 16 is 1")
    scenes = {"4096 edges in chains": arcs(256, 256, 4096), "4096 apart": scattered(256, 256, 4096), "none": None}
    makes = sorted(width for width in lanes.MAKES["sums"] if width <= lanes.VECTOR_BYTES)
    for name, edges in scenes.items():
        for maxval in (255, 65535):
            best = dict.fromkeys(makes, np.inf)
            for _ in range(7):
                for width in makes:
                    with mock.patch.object(lanes, "VECTOR_BYTES", width):
                        took, _ = spent(lambda: enlarge(noise(256, 256), edges, 1024, 1024, maxval=maxval, threads=1))
                    best[width] = min(best[width], took)
            print(f"  {name}, maxval {maxval}: " + ", ".join(f"{w}: {best[w] / best[16]:.2f}" for w in makes))


def junctions() -> None:
    """Edges of rendered scenes and round trips of photographs, with the settling of junctions and without."""
    for what, settle in (("with", detection.settle_junctions), ("without", lambda *_: None)):
        print(f"junctions: {what} settling")
        with mock.patch.object(detection, "settle_junctions", settle):
            of_edges.position_rows(range(4))
            for name in ("camera", "coffee", "chelsea"):
                took, (edges, _, _, gains) = spent(lambda name=name: of_edges.round_trip(name))
                print(f"  {name}: {edges} edges, {took:.1f} s, lsq gains {gains[2]:.2f} dB near edges")


def tours() -> None:
    """The way between strokes by the nearest next, and shortened."""
    from penink_cli.ground.model import Strokes

    for name, n in (("short strokes anywhere", 20000), ("few", 1000)):
        rng = np.random.default_rng(3)
        start = rng.uniform(0, 500, (n, 1, 2))
        along = rng.normal(0, 8, (n, 1, 2))
        points = (start + along * np.arange(4)[None, :, None] / 3).reshape(-1, 2)
        strokes = Strokes(500, 500, points, np.arange(n + 1) * 4, np.full(n, 0.5))
        nearest, first = spent(lambda s=strokes: ordered(s, improve=False))
        whole, better = spent(lambda s=strokes: ordered(s))
        print(f"tours: {n} {name}: {travel_length(better) / travel_length(first):.3f} of the way, {nearest:.2f} s "
              f"without, {whole:.2f} s with")  # fmt: skip


def coder() -> None:
    """Samples and edges by the coder, as parts of what general compressors make of the same numbers."""
    from PIL import Image

    for name in ("camera", "coffee", "chelsea"):
        photo = of_edges.photograph(name)
        height, width = (n - n % 4 for n in photo.shape)
        photo = photo[:height, :width]
        edges = detection.detect_edges(photo)
        samples = reduce(extract_samples(photo, edges), edges, width // 4, height // 4)
        grey = np.round(np.clip(samples, 0, 1) * 255).astype(np.uint8)
        png = io.BytesIO()
        Image.fromarray(grey).save(png, "PNG", optimize=True)
        took, data = spent(lambda g=grey: compact.samples_bytes(GreyImage(g)))
        print(f"coder: {name}: samples {len(data)} bytes, {took:.2f} s: {len(data) / len(png.getvalue()):.2f} of PNG,"
              f" {len(data) / len(lzma.compress(grey.tobytes(), preset=9)):.2f} of xz")  # fmt: skip
        columns, rows = 16 * (width // 4), 16 * (height // 4)
        took, data = spent(partial(compact_edges.edges_bytes, edges, columns, rows))
        grid = np.rint(edges.vertices / (edges.width, edges.height) * (columns, rows)).astype(np.int16)
        chains = [np.diff(grid[along], axis=0, prepend=0) for along, _ in trails(grid, edges.edges)]
        plain = np.concatenate(chains).astype("<i2").tobytes()
        print(f"coder: {name}: edges {len(data)} bytes, {took:.2f} s: {len(data) / len(zlib.compress(plain, 9)):.2f} of"
              f" steps deflated, {len(data) / len(lzma.compress(plain, preset=9)):.2f} of steps by xz")  # fmt: skip


def codes() -> None:
    """The check of a JPEG's codes: its time beside decoding, and what of 2000 struck or cut files only it refuses."""
    from PIL import Image, UnidentifiedImageError

    from penink_cli.formats.photo import jpeg
    from penink_cli.formats.photo.choices import Choices, Verdict
    from penink_cli.formats.photo.pillow import decoded
    from penink_cli.ground.errors import PeninkError

    verdict = Verdict(Choices(), lambda line: None)
    picture = Image.fromarray(np.uint8(255 * of_edges.photograph("camera"))).resize((2048, 2048))
    for how, progressive in (("baseline", False), ("progressive", True)):
        out = io.BytesIO()
        picture.convert("RGB").save(out, "JPEG", quality=90, progressive=progressive)
        large = out.getvalue()
        both = min(spent(partial(jpeg.read, large, 10**8, verdict))[0] for _ in range(5))
        alone = min(spent(partial(decoded, large, "JPEG", 10**8, verdict))[0] for _ in range(5))
        small = io.BytesIO()
        picture.resize((160, 160)).save(small, "JPEG", quality=90, progressive=progressive)
        whole = small.getvalue()
        before = np.asarray(Image.open(small))
        begin = whole.index(b"\xff\xda") + 16
        random = np.random.default_rng(1)
        wrong = told = same = 0
        for k in range(2000):
            struck = bytearray(whole)
            at = int(random.integers(begin, len(whole) - 2))
            if k % 4:
                struck[at] ^= 1 << int(random.integers(8))
            else:
                struck = struck[:at]
            try:
                differ = not np.array_equal(np.asarray(Image.open(io.BytesIO(struck))), before)
            except (OSError, ValueError, UnidentifiedImageError):
                continue  # decoding alone sees it
            try:
                jpeg.read(bytes(struck), 10**8, verdict)
                refused = False
            except PeninkError:
                refused = True
            wrong += differ
            told += differ and refused
            same += refused and not differ
        print(f"codes: {how}: {both / alone:.2f} of decoding's time, {both - alone:.3f} s for 4 megapixels; without"
              f" a word decoding alone gives other pixels for {wrong} of 2000 struck or cut files, {told} of which the"
              f" check refuses, and {same} whose pixels are the same")  # fmt: skip


def main() -> None:
    """Print the parts asked for, or all."""
    parts = {"vectors": vectors, "junctions": junctions, "tours": tours, "coder": coder, "codes": codes}
    for part in sys.argv[1:] or parts:
        parts[part]()


if __name__ == "__main__":
    main()
