"""What drawings show of the sample photographs, style by style, and what `draw` costs.

Run as ``python -m tests.benchmarks.drawing [detail] [cost] [STYLE …]``: all parts and all styles, or those named.
`detail`: a row a style, means and each picture. Drawing and photograph are both seen in a band between 0.96 and
3.84 points (differences of Gaussians) and correlated, so that a drawing may be lighter, darker or of more contrast:

    detail   over the whole picture, where strong contrasts count most: 1 shows all of it, 0 none
    telling  divided by the photograph's own contrast around each place, so that every place counts alike
    paper    share of the drawing that the eye, which takes in a 32nd of an inch, sees lighter than 0.95
    black    and darker than 0.05
"""

import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import skimage.data
from PIL import Image
from scipy.ndimage import gaussian_filter
from skimage.feature import canny

from penink_cli.options.styles import shipped
from samples.photographs import NAMES

INCHES, DPI = 6, 150
FINE, COARSE, AROUND, EYE = 2.0, 8.0, 16.0, DPI / 32  # pixels
MARGIN, FLOOR = 12, 0.004
WANTED = {"detail": 0.72, "telling": 0.52, "paper": 0.10, "black": 0.03}


def seen(drawing, photo):
    """The four measures of a drawing and its photograph, PNG files."""
    ink = Image.open(drawing).convert("L")
    size = (INCHES * DPI, max(1, round(ink.height * INCHES * DPI / ink.width)))
    kind = Image.Resampling.BOX if ink.width > size[0] else Image.Resampling.BICUBIC
    a = np.asarray(ink.resize(size, kind), float) / 255
    b = np.asarray(Image.open(photo).convert("L").resize(size, Image.Resampling.LANCZOS), float) / 255
    inner = (slice(MARGIN, -MARGIN),) * 2
    drawn, there = ((gaussian_filter(p, FINE) - gaussian_filter(p, COARSE))[inner] for p in (a, b))
    contrast = np.sqrt(gaussian_filter(there * there, AROUND)) + FLOOR

    def correlation(weight):
        return (weight * drawn * there).sum() / np.sqrt((weight * drawn**2).sum() * (weight * there**2).sum())

    eye = gaussian_filter(a, EYE)
    return {
        "detail": correlation(1.0),
        "telling": correlation(1 / contrast**2),
        "paper": (eye > 0.95).mean(),
        "black": (eye < 0.05).mean(),
    }


def draw(photo, output, *options):
    """Draw, by the command itself; seconds of processor."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, "-m", "penink_cli", "draw", photo, *options, "-o", output], check=True,
                   stderr=subprocess.DEVNULL)  # fmt: skip
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def table(folder, styles):
    print("| style | " + " | ".join(WANTED) + " | " + " | ".join(NAMES) + " (detail / telling) |")
    print("| --- |" + " --- |" * (len(WANTED) + len(NAMES)))
    for style in styles:
        rows = []
        for name in NAMES:
            draw(folder / f"{name}.png", folder / "d.png", "--style", style, "--width", f"{INCHES}in")
            rows.append(seen(folder / "d.png", folder / f"{name}.png"))
        means = [f"{np.mean([row[k] for row in rows]):.3f}" for k in WANTED]
        each = [f"{row['detail']:.2f} / {row['telling']:.2f}" for row in rows]
        print(f"| {style} | " + " | ".join([*means, *each]) + " |", flush=True)
    print("wanted of house: " + ", ".join(f"{k} >= {v}" for k, v in WANTED.items()))


def cost(folder):
    """12 and half a megapixel of a portrait, with a camera's grain, beside Canny's detector on the former."""
    face = Image.fromarray(skimage.data.astronaut()[64:448])
    for width, height in ((4000, 3000), (816, 612)):
        values = np.asarray(face.resize((width, height), Image.Resampling.BICUBIC), float)
        values = np.clip(values + np.random.default_rng(0).normal(0, 3, values.shape), 0, 255).astype(np.uint8)
        Image.fromarray(values).save(folder / "p.jpg", quality=92)
        grey = np.asarray(Image.open(folder / "p.jpg").convert("L")) / 255
        start = time.process_time()
        canny(grey, 2)
        once = time.process_time() - start
        spent = draw(folder / "p.jpg", folder / "d.svg")
        peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024
        print(f"draw of {width * height / 1e6:.1f} megapixels: {spent:.1f} s of processor, {spent / once:.1f} x canny"
              f" on the same ({once:.2f} s); {peak} MB at the most")  # fmt: skip


def main():
    parts = [word for word in sys.argv[1:] if word in ("detail", "cost")] or ["detail", "cost"]
    styles = [word for word in sys.argv[1:] if word not in parts] or shipped()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        subprocess.run([sys.executable, "-m", "samples.photographs", folder, *NAMES], check=True)
        if "detail" in parts:
            table(folder, styles)
        if "cost" in parts:
            cost(folder)


if __name__ == "__main__":
    main()
