"""Telling lines and marks measured: ``python -m tests.benchmarks.lines`` (about a minute).

Or only some parts: ``python -m tests.benchmarks.lines pictures time sizes tone``.

What is found in the sample photographs and what it takes to keep; processor time beside `skimage.feature.canny`; how
many lines are drawn from a stamp to a poster; tone with the lines drawn. (Small things: tests.benchmarks.discs.)
"""

from __future__ import annotations

import sys
import time

import numpy as np
import skimage.data
from PIL import Image
from skimage.feature import canny

from penink_cli.blasting.blast import blast, left_over
from penink_cli.formats import compact_lines
from penink_cli.ground.model import LineChoice, Strokes
from penink_cli.lines.detection import detect_lines
from penink_cli.lines.strokes import line_strokes
from penink_cli.options.textures import find_texture

PHOTOS = ("astronaut", "camera", "chelsea", "coffee", "coins", "moon", "rocket", "page", "grass")


def grey(name: str) -> np.ndarray:
    """A sample photograph, 0 … 1."""
    picture = Image.fromarray(np.asarray(getattr(skimage.data, name)()))
    return np.asarray(picture.convert("L"), np.float32) / 255


def pictures() -> None:
    """Lines of each picture, and the bytes they are kept in."""
    print("\n| picture | lines | rank ≥ .8 | light | spots | points | bytes packed |\n|" + " --- |" * 7)
    for name in PHOTOS:
        found = detect_lines(grey(name))
        packed = len(compact_lines.lines_bytes(found))
        strong = int((found.rank >= 0.8).sum())
        counts = f"{len(found)} | {strong} | {int(found.white.sum())} | {int((found.breadth > 0).sum())}"
        print(f"| {name} | {counts} | {len(found.points)} | {packed} |")


def processor_time() -> None:
    """Seconds of processor, one thread, beside Canny's detector on the same photo."""
    photo = np.asarray(Image.fromarray((grey("astronaut") * 255).astype(np.uint8)).resize((816, 612)), np.float32) / 255
    for side, picture in ((0.5, photo), (12, np.kron(photo, np.ones((5, 5), np.float32)))):
        spent = []
        for work in (lambda p: detect_lines(p, threads=1), lambda p: canny(p, 2.0)):
            start = time.process_time()
            work(picture)
            spent.append(time.process_time() - start)
        print(f"\n{side} megapixels: lines {spent[0]:.2f} s, canny {spent[1]:.2f} s")


def sizes() -> None:
    """Strokes drawn, and inches of line a square inch, from a stamp to a poster."""
    print("\n| picture | " + " | ".join(f"{w} in" for w in (1, 2, 4, 6, 12, 24)) + " |\n|" + " --- |" * 7)
    for name in ("astronaut", "chelsea", "rocket", "coins"):
        found, row = detect_lines(grey(name), white=False), []
        for inches in (1, 2, 4, 6, 12, 24):
            width, height = 72.0 * inches, 72.0 * inches * found.height / found.width
            drawn = line_strokes(found, width, height, LineChoice())
            knots = drawn.points[1:] - drawn.points[:-1]
            whose = np.repeat(np.arange(len(drawn)), np.diff(drawn.first))
            length = float(np.sqrt((knots[whose[1:] == whose[:-1]] ** 2).sum(axis=1)).sum())
            row.append(f"{len(drawn)}, {72 * length / (width * height):.1f}")
        print(f"| {name} | " + " | ".join(row) + " |")


def tone() -> None:
    """Tone at 4 in: the hatching alone, and with its lines."""
    print("\n| picture | hatching RMS, bias % | with lines RMS, bias % |\n| --- | --- | --- |")
    for name in ("camera", "coins", "chelsea", "astronaut"):
        photo = grey(name)
        found = detect_lines(photo)
        height = 288.0 * photo.shape[0] / photo.shape[1]
        picture = Image.fromarray((photo * 255).astype(np.uint8))
        wanted = 1 - np.asarray(picture.resize((576, round(2 * height)), Image.Resampling.LANCZOS), np.float64) / 255
        row = []
        for lines in (None, found):
            ink = line_strokes(found, 288.0, height, LineChoice()) if lines else None
            drawn = blast(wanted, 288.0, height, None, find_texture("crosshatch"), outlines=ink, lines=lines)
            error = left_over(wanted, 288.0, height, Strokes.joined([ink, drawn]) if ink else drawn, 600.0, 1)
            row.append(f"{100 * float(np.sqrt((error * error).mean())):.2f}, {-100 * float(error.mean()):.2f}")
        print(f"| {name} | " + " | ".join(row) + " |")


PARTS = {"pictures": pictures, "time": processor_time, "sizes": sizes, "tone": tone}


def main() -> None:
    """Print the tables."""
    for name in [word for word in sys.argv[1:] if word in PARTS] or PARTS:
        PARTS[name]()


if __name__ == "__main__":
    main()
