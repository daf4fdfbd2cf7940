"""Engraving measured: ``python -m tests.benchmarks.engraving [TABLE]... [--quick]``.

Tables: steps spacing page renderings cost poster tones.

Tone as the eye sees it at 600 and 1200 dpi, on photographs and a ramp, straight and along the form; the largest step
of the ramp; how smoothly widths go; time and memory of a blast of 8 inches; bytes a knot; other programs' renderings.
"""

from __future__ import annotations

import argparse
import io
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from itertools import pairwise
from pathlib import Path

import numpy as np
import skimage.data

from penink_cli.blasting.blast import blast
from penink_cli.blasting.engraving import KNOT_PT
from penink_cli.ground.device import widened
from penink_cli.ground.model import ColourImage, Directions, Floats, GreyImage, Illustration, Layer, Strokes
from penink_cli.options.textures import find_texture
from penink_cli.outputs import pdf, postscript, svg
from penink_cli.outputs.page import lay_out
from penink_cli.outputs.raster import cover
from penink_cli.travel.order import ordered_each
from tests.benchmarks.form import analytic
from tests.blasting import measures
from tests.outputs.rendering import difference, ghostscript, pixels
from tests.selfdrawing.chromium import Page
from tests.selfdrawing.drawn import middles, page_svg

PHOTOGRAPHS = ("camera", "coins", "astronaut", "chelsea", "coffee", "rocket", "moon")


def photograph(name: str) -> Floats:
    """Tone (h, w) of a sample photograph, or a ramp."""
    if name == "ramp":
        return np.tile(np.linspace(0, 1, 512), (192, 1))
    values = np.asarray(getattr(skimage.data, name)(), float)
    grey = values[..., :3] @ np.array([0.299, 0.587, 0.114]) if values.ndim == 3 else values
    return 1.0 - grey / 255.0


def form(name: str) -> Directions | None:
    """The field of a photograph."""
    if name == "ramp":
        return None
    from penink_cli.directions.detection import detect_directions

    values = np.asarray(getattr(skimage.data, name)())
    photo = GreyImage(values) if values.ndim == 2 else ColourImage(np.ascontiguousarray(values[..., :3]))
    return detect_directions(photo)


def engraved(tone: Floats, inches: float, dpi: float, directions: Directions | None = None) -> Strokes:
    """The engraving of a tone."""
    width = 72.0 * inches
    texture = find_texture("engraving")
    height = width * tone.shape[0] / tone.shape[1]
    return blast(tone, width, height, None, texture, device_dpi=dpi, directions=directions).rounded()


def tones(names: tuple[str, ...], sizes: tuple[float, ...]) -> None:
    """RMS at most 1.0, bias within .25."""
    print("tone, %                    straight              along the form")
    for name in names:
        tone = photograph(name)
        for inches in sizes:
            for dpi in (600.0, 1200.0):
                figures = []
                for directions in (None, form(name)):
                    rms, bias, worst = measures.tone_figures(engraved(tone, inches, dpi, directions), tone, dpi)
                    figures.append(f"rms {rms:4.2f} bias {bias:5.2f} worst {worst:5.1f}")
                print(f"{name:10} {inches:g} in {dpi:4.0f} dpi  " + "   ".join(figures), flush=True)


def steps() -> None:
    """The ramp: its largest step and fall; widths: their second difference in parts of the distance of knots."""
    tone = photograph("ramp")
    strokes = engraved(tone, 4, 600)
    printed = 100 * np.linspace(0, 1, 400) - measures.tone_error(strokes, tone)[15:-15].mean(axis=0)
    change = np.diff(printed[8:-8:4])
    print(f"ramp: steps of a hundredth change the tone by {change.min():.2f} to {change.max():.2f} %")
    print(f"widths: second difference {second_difference(strokes):.3f} of the distance of knots (99 %)")


def second_difference(strokes: Strokes) -> float:
    """How far widths bend along a line, in parts of the distance of knots: what 99 % of them stay below."""
    knots, widths = strokes.knots, strokes.at_knots
    bends = [np.abs(np.diff(widths[a:b], 2))[3:-3] for a, b in pairwise(knots) if b - a > 10]
    return float(np.quantile(np.concatenate(bends), 0.99) / KNOT_PT)


def cost() -> None:
    """8 in with the field given: at most 2.5 s of processor, 250 MB."""
    tone, directions = photograph("astronaut"), form("astronaut")
    begun = time.process_time()
    strokes = engraved(tone, 8, 600, directions)
    spent, most = time.process_time() - begun, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"8 in: {len(strokes)} strokes, {len(strokes.at_knots)} knots, {spent:.2f} s, {most:.0f} MB in all")


def as_poppler(strokes: Strokes, shot: Floats) -> float:
    """How far a picture of 300 dpi is from what Poppler's own renderer does by its sources, in %.

    It inks each quarter of a pixel that a shape touches, strokes and fills alike, and darkens by the power 1.5 of that.
    So it is no measure of how true a drawing is; `pdftocairo`, of the same parser, covers areas.
    """
    h, w = shot.shape
    fine = 1 - np.concatenate(list(cover.bands([widened(strokes, 1200)], lay_out([strokes]), 1200, 255))) / 255
    fine = np.pad(fine, [(0, max(0, 4 * n - m)) for n, m in zip(shot.shape, fine.shape)])[: 4 * h, : 4 * w] > 0.5
    touched = fine.reshape(h, 4, w, 4).mean(axis=(1, 3))
    return difference(255 * (1 - touched**1.5), shot, 300)


def browser(path: Path, shape: tuple[int, ...]) -> Floats:
    """How Chromium draws an SVG so many pixels (h, w) large."""
    h, w = shape
    page = path.with_suffix(".html")
    page.write_text(
        "<!doctype html><style>body{margin:0}img{display:block}</style><body>"
        f"<img src={path.name} width={w} height={h} onload=\"document.body.dataset.ready='yes'\">"
    )
    with Page(page, w, h) as shown:
        return shown.screenshot().astype(float)


def sizes_and_renderings() -> None:
    """PostScript of at most 40 bytes a knot, 14 compressed; renderings within .5 %, pdftoppm's by its own rule."""
    strokes = engraved(photograph("chelsea"), 4, 600, form("chelsea"))
    page, near = lay_out([strokes]), ordered_each
    ours = np.concatenate(list(cover.bands([strokes], page, 300, 255))).astype(float)
    with tempfile.TemporaryDirectory() as folder:
        at = Path(folder)
        for compress in (False, True):
            out = io.BytesIO()
            postscript.write(out, [strokes], page, compress=compress, order=near)
            (at / "a.eps").write_bytes(out.getvalue())
            each = len(out.getvalue()) / len(strokes.at_knots)
            print(f"PostScript{', compressed' * compress}: {each:.1f} bytes a knot")
        for module, name in ((pdf, "a.pdf"), (svg, "a.svg")):
            out = io.BytesIO()
            module.write(out, [strokes], page)
            (at / name).write_bytes(out.getvalue())
        shots = {
            "Ghostscript, EPS": ghostscript(at / "a.eps", 300, True, f"-g{ours.shape[1]}x{ours.shape[0]}"),
            "Ghostscript, PDF": ghostscript(at / "a.pdf", 300),
        }
        for program, command in (
            ("pdftocairo", ["-gray", "-png", "-singlefile", "-r", "300", at / "a.pdf", "-"]),
            ("pdftoppm", ["-gray", "-r", "300", at / "a.pdf"]),
            ("mutool", ["draw", "-q", "-r", "300", "-c", "gray", "-F", "pgm", "-o", "-", at / "a.pdf"]),
            ("rsvg-convert", ["-d", "300", "-p", "300", "-b", "white", at / "a.svg"]),
        ):
            if shutil.which(program):
                shots[program] = pixels(subprocess.run([program, *command], capture_output=True, check=True).stdout)
        shots["Chromium, SVG"] = browser(at / "a.svg", ours.shape)
        if "pdftoppm" in shots:
            print(f"what pdftoppm is known to do, less pdftoppm: {as_poppler(strokes, shots['pdftoppm']):.2f} %")
        for name, shot in shots.items():
            h, w = (min(a, b) for a, b in zip(ours.shape, shot.shape))
            bias = (ours[:h, :w] - shot[:h, :w]).mean() / 2.55
            print(f"to-pgm less {name}: {difference(ours, shot, 300):.2f} % after a low-pass, {bias:+.2f} on the mean")


def spacing() -> None:
    """How even the lines lie: at most .05 in one direction, .12 where they curve; nor do widths bend (see `steps`)."""
    print("flat 35 %, 6 × 6 in: cv (≤ .05 constant, ≤ .12 curved)  doubled  gaping   widths' second difference (≤ .10)")
    for kind in ("constant", "circles", "saddle", "fan", "waves", "random"):
        strokes = blast(np.full((64, 64), 0.35), 432, 432, None, find_texture("engraving"), directions=analytic(kind))
        f = measures.ray_gaps(strokes)
        print(
            f"  {kind:20} {f['cv']:8.3f} {f['doubled']:32.4f} {f['gaping']:7.4f} {second_difference(strokes):12.3f}",
            flush=True,
        )


def page_spacing() -> None:
    """How even a page's lines lie, the middles of the shapes that it saves: at most .05, or .12 where they curve."""
    print("a page, flat 35 %, 6 × 6 in: cv (≤ .05 constant, ≤ .12 curved)  doubled  gaping")
    for kind in ("constant", "circles", "saddle", "fan", "waves", "random"):
        samples = GreyImage(np.full((24, 24), round(0.65 * 63), np.uint8), 63)
        layer = Layer(samples, None, find_texture("engraving"), levels=64, directions=analytic(kind))
        with tempfile.TemporaryDirectory() as folder:
            text = page_svg(Illustration(432, 432, (layer,)), Path(folder), 432)
        f = measures.ray_gaps(middles(text, 432, 432))
        print(f"  {kind:20} {f['cv']:8.3f} {f['doubled']:32.4f} {f['gaping']:7.4f}", flush=True)


POSTER = """
import resource, sys, time, numpy as np
from penink_cli.blasting.blast import blast
from penink_cli.options.textures import find_texture
from tests.benchmarks.engraving import form, photograph
tone, field = photograph("camera"), form("camera")
begun = time.process_time()
strokes = blast(tone, 24 * 72, 36 * 72, None, find_texture("engraving"), directions=field, threads=2)
most = int(next(line for line in open("/proc/self/status") if line.startswith("VmHWM")).split()[1]) / 1024
spent = time.process_time() - begun
print(f"24 × 36 in: {len(strokes)} strokes, {spent:.1f} s of processor (60), {most:.0f} MB (1200)")
"""


def poster() -> None:
    """24 × 36 in: at most 60 s of processor, 1.2 GB."""
    subprocess.run([sys.executable, "-c", POSTER], check=True)


TABLES = {
    "steps": steps,
    "spacing": spacing, "page": page_spacing,
    "renderings": sizes_and_renderings, "cost": cost, "poster": poster,
}  # fmt: skip


def main() -> None:
    """All of it, or the tables named."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("tables", nargs="*", metavar="TABLE")
    parser.add_argument("--quick", action="store_true", help="three pictures at 4 in")
    asked = parser.parse_args()
    for name in asked.tables or [*TABLES, "tones"]:
        if name == "tones":
            tones(("ramp", *PHOTOGRAPHS[: 3 if asked.quick else None]), (4.0,) if asked.quick else (4.0, 8.0))
        else:
            TABLES[name]()


if __name__ == "__main__":
    main()
