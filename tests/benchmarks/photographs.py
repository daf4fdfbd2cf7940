"""Photographs with a fault, and mutated ones: ``python -m tests.benchmarks.photographs [N | --cases]``.

``--cases`` prints a table: each input of tests/formats/photo_cases.py, what it should give, what it gives. A number
mutates that many photographs of every kind (10 000 unless told otherwise), a few bytes each, and reads them with each
choice in turn: wanted are no traceback, 2 s and 150 MB at the most for a file under 100 KB.
"""

from __future__ import annotations

import io
import multiprocessing
import sys
import time
import traceback
from collections.abc import Iterator

import numpy as np
from PIL import Image

from penink_cli.formats import photo
from penink_cli.formats.photo import Choices
from penink_cli.ground.errors import PeninkError
from tests.formats.photo_cases import COLOUR, cases, given, saved, wanted

MAX_PIXELS = 250_000_000
BATCH = 250
CHOICES = (Choices(), Choices(damage="lenient"), Choices(damage="strict", background=(9, 99, 199)))
Found = tuple[str, int, float, float, str]


def table() -> int:
    wrong = 0
    print(f"{'':5} {'kind':12} {'input':52} {'should give':52} gives")
    for case in cases():
        gives, right = given(case)
        wrong += not right
        print(f"{'' if right else 'WRONG':5} {case.group:12} {case.name:52} {wanted(case):52} {gives}")
    print(f"{wrong} wrong")
    return 1 if wrong else 0


def seeds() -> list[tuple[str, bytes]]:
    """A name and the bytes of small photographs of every kind."""
    noise = np.random.default_rng(1).integers(0, 256, (48, 64, 3), np.uint8)
    smooth = np.kron(COLOUR, np.ones((2, 2, 1), np.uint8))
    clear = np.dstack([smooth, smooth[..., 0]])
    found = [(f"{case.group}: {case.name}", case.data) for case in cases() if len(case.data) < 20_000]
    for name, kind, image, options in (
        ("JPEG", "JPEG", smooth, {"quality": 80}),
        ("JPEG noise", "JPEG", noise, {"quality": 80, "restart_marker_blocks": 3}),
        ("JPEG progressive", "JPEG", smooth, {"progressive": True}),
        ("PNG", "PNG", smooth, {}),
        ("PNG alpha", "PNG", clear, {}),
        ("WebP", "WEBP", smooth, {}),
        ("WebP alpha", "WEBP", clear, {}),
        ("WebP lossless", "WEBP", clear, {"lossless": True}),
        ("TIFF lzw", "TIFF", smooth, {"compression": "tiff_lzw"}),
        ("TIFF deflate", "TIFF", clear, {"compression": "tiff_adobe_deflate"}),
        ("TIFF jpeg", "TIFF", smooth, {"compression": "jpeg"}),
        ("TIFF fax", "TIFF", Image.fromarray(smooth[..., 0] > 99), {"compression": "group4"}),
        ("BMP", "BMP", smooth, {}),
        ("AVIF", "AVIF", clear, {}),
    ):
        found.append((name, saved(image, kind, **options)))
    try:
        import pillow_heif

        pillow_heif.register_heif_opener()
        found.append(("HEIC", saved(smooth, "HEIF")))
    except ImportError:
        print("no HEIC: its package is not there")
    return found


def mutated(data: bytes, rng: np.random.Generator) -> bytes:
    """A few bytes changed, repeated, left out or put in; the beginning, where headers are, most of all."""
    out = bytearray(data)
    for _ in range(int(rng.integers(1, 6))):
        at = int(rng.integers(0, min(len(out), 400 if rng.random() < 0.6 else len(out)) + 1))
        what = rng.random()
        if what < 0.5 and at < len(out):
            out[at] = int(rng.choice([0, 1, 0x7F, 0x80, 0xFF, int(rng.integers(0, 256))]))
        elif what < 0.65:
            out[at : at + int(rng.integers(1, 5))] = rng.integers(0, 256, int(rng.integers(1, 5)), np.uint8).tobytes()
        elif what < 0.75:
            del out[at : at + int(rng.integers(1, 60))]
        elif what < 0.85:
            out[at:at] = out[at : at + int(rng.integers(1, 200))]
        elif what < 0.95:
            out[at:at] = rng.integers(0, 256, int(rng.integers(1, 9)), np.uint8).tobytes()
        else:
            del out[max(at, 20) :]
    return bytes(out)


def peak_mb() -> float:
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmHWM")) / 1024


def batch(numbers: range, queue: multiprocessing.Queue) -> None:
    """Read some mutated photographs and tell of each: name, number, seconds, MB, what was wrong."""
    given_seeds = seeds()
    for number in numbers:
        name, data = given_seeds[number % len(given_seeds)]
        made = mutated(data, np.random.default_rng(number))
        queue.put(("", number, 0.0, 0.0, ""))  # begun: a crash is this one's
        with open("/proc/self/clear_refs", "w") as peak:
            peak.write("5")
        begun, fault = time.perf_counter(), ""
        try:
            photo.read_colours(io.BytesIO(made), "p", MAX_PIXELS, CHOICES[number % 3], lambda line: None)
        except PeninkError as error:
            if not str(error).startswith("p: ") or len(str(error)) > 300 or not str(error).isprintable():
                fault = f"says {error}"
        except Exception:
            fault = traceback.format_exc()
        queue.put((name, number, time.perf_counter() - begun, peak_mb(), fault))


def results(count: int) -> Iterator[Found]:
    for first in range(0, count, BATCH):
        queue: multiprocessing.Queue = multiprocessing.get_context("spawn").Queue()
        numbers = range(first, min(count, first + BATCH))
        worker = multiprocessing.get_context("spawn").Process(target=batch, args=(numbers, queue))
        worker.start()
        left, at = len(numbers), first
        while left:
            try:
                found = queue.get(timeout=20)
            except Exception:
                worker.kill()
                yield "?", at, 20.0, 0.0, f"died or hung, exit {worker.exitcode}"
                break
            at = found[1]
            if found[0]:
                left -= 1
                yield found
        worker.join()


def main() -> int:
    if "--cases" in sys.argv:
        return table()
    count = int(sys.argv[1]) if sys.argv[1:] else 10_000
    slow = large = 0.0
    bad = 0
    for done, (name, number, seconds, peak, fault) in enumerate(results(count), 1):
        slow, large = max(slow, seconds), max(large, peak)
        if fault or seconds > 2 or peak > 150:
            bad += 1
            print(f"{name} ({number}): {seconds:.2f} s, {peak:.0f} MB {fault}", flush=True)
        if done % 1000 == 0:
            print(f"{done} read, {bad} bad; at most {slow:.2f} s, {large:.0f} MB", flush=True)
    print(f"{count} mutated photographs: {bad} bad; at most {slow:.2f} s, {large:.0f} MB")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
