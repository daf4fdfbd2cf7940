"""Telling lines and marks measured: ``python -m tests.benchmarks.lines`` (about a minute).

Or only some parts: ``python -m tests.benchmarks.lines pictures time sizes discs tone``.

What is found in the sample photographs and what it takes to keep; processor time beside `skimage.feature.canny`; how
many lines are drawn from a stamp to a poster; small discs and lettering under the textures; tone with the lines drawn.
"""

from __future__ import annotations

import sys
import time
from dataclasses import replace

import numpy as np
import skimage.data
from PIL import Image, ImageDraw, ImageFont
from skimage.feature import canny

from penink_cli.blasting.blast import blast, left_over
from penink_cli.blasting.sheet import coverage
from penink_cli.formats import compact_lines
from penink_cli.ground.device import MEAN
from penink_cli.ground.model import Floats, LineChoice, Strokes
from penink_cli.lines.detection import detect_lines
from penink_cli.lines.strokes import line_strokes
from penink_cli.options.textures import find_texture

PHOTOS = ("astronaut", "camera", "chelsea", "coffee", "coins", "moon", "rocket", "page", "grass")
FINE = 8  # pixels a point, of what discs are measured in


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


def _painted(strokes: Strokes, device_dpi: float | None) -> Strokes:
    if device_dpi is None:
        return strokes
    return replace(strokes.by_segments(), widths=strokes.by_segments().widths + MEAN * 72 / device_dpi)


def discs() -> None:
    """Black discs on white: tone inside, ink beyond a point in parts of the disc; white ones in black: paper inside."""
    print("\n| texture | printer | | " + " | ".join(f"{d} pt" for d in (2, 3, 4, 6, 8, 12)) + " |\n|" + " --- |" * 9)
    n = 72 * 8
    y, x = np.mgrid[:n, :n] + 0.5
    r = np.hypot(x - n / 2, y - n / 2) / FINE
    for texture in ("crosshatch", "parallel", "form", "engraving", "stipple"):
        for dpi in (600.0, None):
            for white in (False, True):
                row = []
                for d in (2, 3, 4, 6, 8, 12):
                    tone = np.where((r < d / 2) != white, 1.0, 0.0).reshape(144, 4, 144, 4).mean(axis=(1, 3))
                    drawn = _painted(blast(tone, 72, 72, None, find_texture(texture), device_dpi=dpi), dpi)
                    ink = coverage(drawn, n, n)
                    inside = float(ink[r < d / 2].mean())
                    stray = float(ink[r > d / 2 + 1].sum()) / float((r < d / 2).sum())
                    row.append(f"{1 - inside:.2f}" if white else f"{inside:.2f}, {stray:.2f}")
                kind = "white" if white else "black"
                print(f"| {texture} | {f'{dpi:g} dpi' if dpi else 'none'} | {kind} | " + " | ".join(row) + " |")
    for points in (9, 7):
        tone = lettering(points)
        drawn = blast(tone, 288, 72, None, find_texture("crosshatch"), device_dpi=None)
        ink = coverage(drawn, 72 * FINE, 288 * FINE)
        wanted = np.repeat(np.repeat(tone, 2, axis=0), 2, axis=1)[: ink.shape[0], : ink.shape[1]]
        near = coverage_of(wanted > 0.3, FINE)
        print(f"\nlettering of {points} pt at 4 in: {float(ink[wanted > 0.7].mean()):.2f} inside, "
              f"{float(ink[~near].sum() / ink.sum()):.3f} of the ink beyond a point")  # fmt: skip


def coverage_of(mask: np.ndarray, margin: int) -> np.ndarray:
    """What is no further than so many pixels from the mask."""
    from scipy.ndimage import distance_transform_edt

    return np.asarray(distance_transform_edt(~mask) <= margin)


def lettering(points: float) -> Floats:
    """Tone of two lines of type on a sheet of 288 × 72 points, 4 pixels a point."""
    picture = Image.new("L", (288 * 8, 72 * 8), 255)
    font = ImageFont.load_default(size=8 * points)
    for k, line in enumerate(("Hamburgefonts 0123456789", "sphinx of black quartz, judge")):
        ImageDraw.Draw(picture).text((80, 80 + 200 * k), line, 0, font)
    return 1 - np.asarray(picture.resize((288 * 4, 72 * 4), Image.Resampling.BOX), np.float64) / 255


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


PARTS = {"pictures": pictures, "time": processor_time, "sizes": sizes, "discs": discs, "tone": tone}


def main() -> None:
    """Print the tables."""
    for name in [word for word in sys.argv[1:] if word in PARTS] or PARTS:
        PARTS[name]()


if __name__ == "__main__":
    main()
