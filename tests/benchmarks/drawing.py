"""How much drawings show of the sample photographs, style by style; how true their tone is; one drawing at many sizes.

Run as ``python -m tests.benchmarks.drawing [detail] [tone] [sizes] [swelling] [STYLE …]``: all parts and styles, or
those named. `detail`: a row a style, means and each picture. Drawing and photograph are both seen in a band between
0.96 and 3.84 points (differences of Gaussians) and correlated, so that a drawing may be lighter, darker or of more
contrast:

    detail   over the whole picture, where strong contrasts count most: 1 shows all of it, 0 none
    telling  divided by the photograph's own contrast around each place, so that every place counts alike
    paper    share of the drawing that the eye, which takes in a 32nd of an inch, sees lighter than 0.95
    black    and darker than 0.05
"""

import io
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_filter

from penink_cli.blasting.blast import left_over
from penink_cli.blasting.reserved import LEAST
from penink_cli.blasting.sheet import coverage, resample
from penink_cli.blasting.telling import told
from penink_cli.formats import lines, strokes
from penink_cli.ground.device import MEAN, widened
from penink_cli.ground.model import GreyImage
from penink_cli.measuring.tone import figures, printed
from penink_cli.measuring.tone import wanted as as_wanted
from penink_cli.options.styles import shipped
from penink_cli.outputs import pdf, postscript, svg
from penink_cli.outputs.page import lay_out
from penink_cli.travel.order import ordered_each
from samples.photographs import NAMES
from tests.blasting.measures import solids

INCHES, DPI = 6, 150
FINE, COARSE, AROUND, EYE = 2.0, 8.0, 16.0, DPI / 32  # pixels
MARGIN, FLOOR = 12, 0.004
PRINTER_DPI = 600.0
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


def penink(*words):
    """Run a filter."""
    subprocess.run([sys.executable, "-m", "penink_cli", *map(str, words)], check=True, stderr=subprocess.DEVNULL)


def table(folder, styles):
    print("| style | " + " | ".join(WANTED) + " | " + " | ".join(NAMES) + " (detail / telling) |")
    print("| --- |" + " --- |" * (len(WANTED) + len(NAMES)))
    for style in styles:
        rows = []
        for name in NAMES:
            photo = folder / f"{name}.png"
            penink("draw", photo, "--style", style, "--width", f"{INCHES}in", "-o", folder / "d.png")
            rows.append(seen(folder / "d.png", photo))
        means = [f"{np.mean([row[k] for row in rows]):.3f}" for k in WANTED]
        each = [f"{row['detail']:.2f} / {row['telling']:.2f}" for row in rows]
        print(f"| {style} | " + " | ".join([*means, *each]) + " |", flush=True)
    print("wanted of house: " + ", ".join(f"{k} >= {v}" for k, v in WANTED.items()))


def tone(folder, names=NAMES):
    """RMS and bias of tone against the composed grey, as the eye sees both: the hatching alone, and all there is.

    The eye is a Gaussian of 1/16 inch, as `penink measure` has it; RMS again of an eye that does not see across strong
    steps of tone, which forgives nothing beside an edge. Of the hatching alone no white is asked for where black has
    no white lines.
    """
    print("\n| picture | house, hatching alone: RMS, bias % (RMS on its side of edges) | house, all | true, all |")
    print("| --- | --- | --- | --- |")
    for name in names:
        photo, found, row = folder / f"{name}.png", folder / "l.json", []
        penink("detect-lines", photo, "-o", found)
        for style, options, strength in (
            ("house", ("--no-lines",), ()), ("house", (), ()), ("true", ("--no-outlines",), ("--strength", "0"))
        ):  # fmt: skip
            penink("compose", "--width", f"{INCHES}in", *strength, photo, "-o", folder / "g.pgm")
            penink("draw", photo, "--style", style, "--width", f"{INCHES}in", *options, "-o", folder / "d.jsonl")
            with open(folder / "d.jsonl", "rb") as stream:
                drawn = strokes.read(stream, "d.jsonl")
            wanted = 1 - np.asarray(Image.open(folder / "g.pgm"), float) / 255
            if style == "house" and not options:
                with open(found, "rb") as stream:
                    wanted, _ = told(wanted, drawn.width, drawn.height, lines.read(stream, "l.json"), None, 1)
            if style == "house" and options:
                nothing, gain = np.zeros((1, 1), np.float32), MEAN * 72 / PRINTER_DPI
                black = solids(wanted, drawn.width, drawn.height, None, gain, nothing, 1 - LEAST)
                filled = coverage(black, round(4 * drawn.height), round(4 * drawn.width)).astype(float)
                wanted = np.maximum(wanted, resample(filled, *wanted.shape))
            have = printed([widened(drawn, PRINTER_DPI)], 10**9, 1)
            grey = GreyImage.from_grey(1 - wanted, 65535)
            seen_by_all = figures(as_wanted(grey, have.shape[1], have.shape[0]), have)
            error = left_over(wanted, drawn.width, drawn.height, drawn, PRINTER_DPI, 1)
            row.append(f"{seen_by_all.rms:.2f}, {-seen_by_all.bias:+.2f} ({100 * np.sqrt((error**2).mean()):.2f})")
        print(f"| {name} | " + " | ".join(row) + " |", flush=True)
    print("wanted: <= 0.9, 0.2; <= 2.0, 0.6; <= 0.75, 0.2")


def sizes(folder):
    """One illustration from a stamp to a poster: bytes, strokes, and the share of the sheet that is inked."""
    photo, kept = folder / f"{NAMES[0]}.png", folder / "d.penink"
    penink("draw", photo, "-o", kept)
    row = [f"{kept.stat().st_size} bytes"]
    for inches in (1, 4, 24):
        penink("render", "--width", f"{inches}in", "--device-dpi", "none", kept, "-o", folder / "d.jsonl")
        with open(folder / "d.jsonl", "rb") as stream:
            drawn = strokes.read(stream, "d.jsonl")
        ink = coverage(drawn, round(drawn.height), round(drawn.width))
        count = f"{len(drawn)} strokes, {len(drawn) / inches**2:.0f} a square inch"
        row.append(f"{inches} in: {count}, ink {ink.mean():.3f}")
    print("\n" + "; ".join(row) + " (wanted: <= 14 KB, as much ink at each size)", flush=True)


def swelling(folder):
    """Bytes of a drawing whose strokes swell, by what it would take if they did not, and a knot of those that do."""
    photo, style = folder / f"{NAMES[0]}.png", folder / "even.style.json"
    style.write_bytes(subprocess.run(
        [sys.executable, "-m", "penink_cli", "style", "show", "house"], check=True, capture_output=True
    ).stdout.replace(b'"swell": 1', b'"swell": 0'))  # fmt: skip
    row, knots = [], 0
    for chosen in ("house", style):
        penink("draw", photo, "--style", chosen, "--no-lines", "--width", f"{INCHES}in", "-o", folder / "d.jsonl")
        with open(folder / "d.jsonl", "rb") as stream:
            drawn = strokes.read(stream, "d.jsonl")
        wide = drawn.taken(drawn.swells)
        for part in (drawn, wide):
            for module, options in ((postscript, {}), (postscript, {"compress": True}), (svg, {}), (pdf, {})):
                out = io.BytesIO()
                near = {"order": ordered_each} if module is postscript else {}
                module.write(out, [part], lay_out([part]), **options, **near)
                row.append(len(out.getvalue()))
        knots = len(wide.at_knots) or knots
    whole, some, even = row[:4], row[4:8], row[8:12]
    told = (
        f"{name} {a / c:.2f} times, {b / knots:.1f} bytes a knot"
        for name, a, b, c in zip(("PostScript", "compressed", "SVG", "PDF"), whole, some, even)
    )
    print("\nswelling: " + "; ".join(told) + " (wanted: 2, SVG and PDF too; PostScript 40 bytes a knot, 14 compressed)")


PARTS = {"detail": None, "tone": tone, "sizes": sizes, "swelling": swelling}


def main():
    parts = [word for word in sys.argv[1:] if word in PARTS] or list(PARTS)
    styles = [word for word in sys.argv[1:] if word not in PARTS] or shipped()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        subprocess.run([sys.executable, "-m", "samples.photographs", folder, *NAMES], check=True)
        for part in parts:
            if part == "detail":
                table(folder, styles)
            else:
                PARTS[part](folder)


if __name__ == "__main__":
    main()
