"""Figures of the outputs: agreement of renderers, bytes, place and size, plotters, start-up.

Run as ``python -m tests.benchmarks.outputs [PART ...]``; parts are renderers, size, inclusion, plotters, startup.
Programs that are not installed are named and left out. vpype, which has many dependencies, is installed into a virtual
environment of its own in build/vpype, unless VPYPE names a Python that has it.
"""

import json
import os
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from penink_cli.formats import strokes as strokes_format
from penink_cli.main import SUBCOMMANDS
from penink_cli.outputs.page import lay_out
from penink_cli.outputs.raster import cover
from penink_cli.travel.order import ordered, travel_length
from tests.outputs.drawings import crosshatch, strokes_of
from tests.outputs.rendering import difference, ghostscript, pixels

ROOT = Path(__file__).parents[2]


def run(*command, **options):
    """Run, quietly; the standard output."""
    return subprocess.run([str(c) for c in command], capture_output=True, check=True, **options).stdout


def cpu(*command, **options):
    """CPU seconds of a command, the least of three, and its output."""
    best, out = np.inf, b""
    for _ in range(3):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        out = run(*command, **options)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        best = min(best, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return best, out


def penink(*arguments):
    return (sys.executable, "-m", "penink_cli", *arguments)


def outputs(folder, drawing, name="drawing"):
    """The strokes and their PS, SVG and PDF, as files."""
    with open(folder / f"{name}.strokes.jsonl", "wb") as out:
        strokes_format.write(out, drawing)
    for kind in ("ps", "svg", "pdf"):
        run(*penink(f"to-{kind}", folder / f"{name}.strokes.jsonl", "-o", folder / f"{name}.{kind}"))
    return folder / f"{name}.strokes.jsonl"


def renderers(folder):
    print("1. Agreement after a low-pass of 1/16 in, RMS %; crosshatch of 4000 strokes, 0.4 pt, 4 x 4 in")
    drawing = crosshatch(4000, 288)
    outputs(folder, drawing)
    dpi = 600
    size = f"-g{4 * dpi}x{4 * dpi}"
    exact = np.concatenate(list(cover.bands([drawing], lay_out([drawing]), dpi, 255))).astype(float)
    pictures = {"Ghostscript PS": ghostscript(folder / "drawing.ps", dpi, True, size)}
    pictures["Ghostscript PDF"] = ghostscript(folder / "drawing.pdf", dpi)
    if shutil.which("mutool"):
        run("mutool", "draw", "-q", "-r", dpi, "-c", "gray", "-o", folder / "m.png", folder / "drawing.pdf")
        pictures["MuPDF PDF"] = pixels((folder / "m.png").read_bytes())
    if shutil.which("rsvg-convert"):
        options = ("-d", dpi, "-p", dpi, "--background-color", "white")
        pictures["rsvg-convert SVG"] = pixels(run("rsvg-convert", *options, folder / "drawing.svg"))
    if shutil.which("inkscape"):
        options = (f"--export-dpi={dpi}", "--export-background=white", f"--export-filename={folder / 'i.png'}")
        run("inkscape", *options, folder / "drawing.svg")
        pictures["Inkscape SVG"] = pixels((folder / "i.png").read_bytes())
    for missing in {"mutool", "rsvg-convert", "inkscape", "pdftoppm"} - {p for p in map(_name, PROGRAMS) if p}:
        print(f"   {missing} is not installed: left out")
    for name, picture in pictures.items():
        print(f"   {name:18} against to-pgm, {dpi} dpi: {difference(picture, exact, dpi):.2f}")
    worst = max((difference(a, b, dpi), m, n) for m, a in pictures.items() for n, b in pictures.items() if m < n)
    print(f"   the two farthest apart: {worst[1]} and {worst[2]}: {worst[0]:.2f}")
    for low in (150, 300):
        coarse = np.concatenate(list(cover.bands([drawing], lay_out([drawing]), low, 255))).astype(float)
        theirs = ghostscript(folder / "drawing.ps", low, True, f"-g{4 * low}x{4 * low}")
        print(f"   to-pgm against Ghostscript, anti-aliased, {low} dpi: {difference(coarse, theirs, low):.2f}", end="")
        # Its 4 x 4 samples a pixel ink whatever a stroke touches; four times as many in either direction do so less.
        fine = ghostscript(folder / "drawing.ps", 4 * low, True, f"-g{16 * low}x{16 * low}")
        fine = fine.reshape(4 * low, 4, 4 * low, 4).mean(axis=(1, 3))
        print(f"; against the mean of its pixels at {4 * low} dpi: {difference(coarse, fine, low):.2f}")
    usual = ghostscript(folder / "drawing.ps", dpi, False, size)
    print("   Renderers that ink every pixel, or subpixel, that a stroke touches are darker by that:")
    print(f"   Ghostscript with its usual fill adjustment, {dpi} dpi: {difference(usual, exact, dpi):.2f}")
    if shutil.which("pdftoppm"):
        for fine in (dpi, 4 * dpi):
            # A quarter of the sheet is enough at 2400 dpi.
            part = ("-x", 0, "-y", 0, "-W", fine * 2, "-H", fine * 2)
            run("pdftoppm", "-r", fine, "-gray", "-png", "-singlefile", *part, folder / "drawing.pdf", folder / "p")
            shot = pixels((folder / "p.png").read_bytes())
            k = fine // dpi
            shot = shot.reshape(2 * dpi, k, 2 * dpi, k).mean(axis=(1, 3))
            print(f"   Poppler PDF against to-pgm, drawn at {fine} dpi: {difference(shot, exact, dpi):.2f}")


PROGRAMS = ("mutool", "rsvg-convert", "inkscape", "pdftoppm")


def _name(program):
    return program if shutil.which(program) else None


def size(folder):
    print("2. Bytes a stroke, tone, speed")
    for side in (288, 576):
        drawing = crosshatch(15000, side)
        file = outputs(folder, drawing)
        plain, packed = (folder / "drawing.ps").stat().st_size, len(run(*penink("to-ps", "--compress", file)))
        each = [(folder / f"drawing.{kind}").stat().st_size / 15000 for kind in ("svg", "pdf")]
        print(f"   crosshatch of 15000 strokes on {side / 72:g} in: PostScript {plain / 15000:.1f} plain,"
              f" {packed / 15000:.1f} compressed; SVG {each[0]:.0f}, PDF {each[1]:.0f}")  # fmt: skip
        naive = f"1 setlinecap 1 setlinejoin 1 -1 scale 0 -{side} translate\n" + "".join(
            "{} {} moveto {} {} {} {} {} {} curveto {} setlinewidth stroke\n".format(*drawing[i].ravel(), w)
            for i, w in enumerate(drawing.widths)
        )
        (folder / "naive.ps").write_text(f"%!\n{naive}showpage\n")
        options = (600, False, f"-g{side * 600 // 72}x{side * 600 // 72}")
        ours, plain_picture = ghostscript(folder / "drawing.ps", *options), ghostscript(folder / "naive.ps", *options)
        print(f"   tone against unrounded floats, 600 dpi: {(ours - plain_picture).mean() / -2.55:+.3f} points, RMS"
              f" {difference(ours, plain_picture, 600):.2f}")  # fmt: skip
    places = np.random.default_rng(0).random((300000, 1, 2)) * 1440
    with open(folder / "dots.jsonl", "wb") as out:
        strokes_format.write(out, strokes_of(places, 0.8, 1440, 1440))
    for kind in ("ps", "svg", "pdf", "pgm"):
        seconds, _ = cpu(*penink(f"to-{kind}", folder / "dots.jsonl", "-o", folder / f"dots.{kind}"))
        each = (folder / f"dots.{kind}").stat().st_size / 3e5
        print(f"   300000 dots, to-{kind}: {seconds:.2f} s of CPU, {each:.1f} bytes each")


def _ink_box(picture, dpi):
    """x0, y0, x1, y1 of the ink in points from the top-left corner."""
    y, x = np.nonzero(picture < 128)
    return np.array([x.min(), y.min(), x.max() + 1, y.max() + 1]) * 72 / dpi


def inclusion(folder):
    print("3. EPS in other people's documents; a frame of 4 x 3 in, place and size in points")
    corners = [(10, 10), (278, 10), (278, 206), (10, 206)]
    sides = [[a, a, b, b] for a, b in zip(corners, corners[1:] + corners[:1])]
    outputs(folder, strokes_of(sides, 2, 288, 216), "frame")
    shutil.copy(folder / "frame.ps", folder / "frame.eps")
    if shutil.which("latex") and shutil.which("dvips"):
        (folder / "t.tex").write_text(
            r"\documentclass{article}\usepackage[dvips]{graphicx}\textwidth480bp\textheight380bp\oddsidemargin-1in"
            r"\topmargin-1in\headheight0pt\headsep0pt\topskip0pt\parindent0pt\pagestyle{empty}"
            r"\begin{document}\special{papersize=500bp,400bp}\vbox to 0pt{\hbox{\hskip 50bp\includegraphics{frame.eps}"
            r"\hskip 20bp\includegraphics[width=72bp]{frame.eps}}\vss}\end{document}"
        )
        run("latex", "-interaction=nonstopmode", "t.tex", cwd=folder)
        run("dvips", "-q", "-o", "t.ps", "t.dvi", cwd=folder)
        run("ps2pdf", "t.ps", "t.pdf", cwd=folder)
        picture = ghostscript(folder / "t.pdf", 288)
        box = _ink_box(picture[:, : 345 * 4], 288)
        small = _ink_box(np.where(np.arange(picture.shape[1]) < 345 * 4, 255, picture), 288)
        print(f"   LaTeX: {box[2] - box[0]:.2f} x {box[3] - box[1]:.2f} wide and high (270 x 198 drawn), {box[0]:.2f}"
              f" from the left (59 drawn); at a quarter {small[2] - small[0]:.2f} x {small[3] - small[1]:.2f}"
              " (67.5 x 49.5)")  # fmt: skip
    else:
        print("   latex is not installed: left out")
    if shutil.which("inkscape"):
        # Without a display Inkscape cannot open EPS; with one it does so by this conversion.
        run("ps2pdf", "-dEPSCrop", "frame.eps", "frame-eps.pdf", cwd=folder)
        for kind, source in (("eps", "frame-eps.pdf"), ("pdf", "frame.pdf"), ("svg", "frame.svg")):
            target = folder / f"imported-{kind}.png"
            run("inkscape", "--export-dpi=288", "--export-background=white", "--export-area-page",
                f"--export-filename={target}", folder / source)  # fmt: skip
            picture = pixels(target.read_bytes())
            box = _ink_box(picture, 288)
            print(f"   Inkscape imports {kind}: page {picture.shape[1] / 4:.2f} x {picture.shape[0] / 4:.2f} (288x216)"
                  f", ink {' '.join(f'{v:.2f}' for v in box)} (9 9 279 207)")  # fmt: skip
    else:
        print("   inkscape is not installed: left out")


def vpype_python():
    """A Python that has vpype, made if need be."""
    if "VPYPE" in os.environ:
        return os.environ["VPYPE"]
    home = ROOT / "build" / "vpype"
    if not (home / "bin" / "vpype").exists():
        print("   installing vpype in", home.relative_to(ROOT), flush=True)
        run(sys.executable, "-m", "venv", home)
        run(home / "bin" / "python", "-m", "pip", "install", "--quiet", "vpype")
    return str(home / "bin" / "python")


READ = """
import json, sys, time, vpype, vpype_cli
d = vpype.read_multilayer_svg(sys.argv[1], quantization=0.05)
got = {"layers": [[i, l.property("vp_name"), len(l), l.length() * 0.75] for i, l in sorted(d.layers.items())]}
for name, options in (("linesort", ""), ("two-opt", " --two-opt")):
    if name in sys.argv[2:]:
        before = time.process_time()
        sorted_ = vpype_cli.execute("linesort" + options, d)
        got[name] = [time.process_time() - before, sum(l.pen_up_length()[0] for l in sorted_.layers.values()) * 0.75]
print(json.dumps(got))
"""


def plotters(folder):
    print("4. Pen plotters")
    python = vpype_python()
    vpype = str(Path(python).with_name("vpype"))
    few = strokes_of([[[9, 9]], [[20, 20], [30, 30], [40, 20], [50, 60]]], 1, 288, 288)
    several = [crosshatch(500, 288, seed=1), few]
    files = []
    for i, layer in enumerate(several):
        files.append(folder / f"{i}.strokes.jsonl")
        with open(files[-1], "wb") as out:
            strokes_format.write(out, layer)
    run(*penink("to-svg", *files, "-o", folder / "layers.svg"))
    got = json.loads(run(python, "-c", READ, folder / "layers.svg"))
    from penink_cli.travel.order import drawn_length

    for (number, name, count, length), layer in zip(got["layers"], several):
        whole = f"{count} paths of {len(layer)}, {length:.1f} pt long of {drawn_length(layer):.1f}"
        print(f"   vpype reads layer {number} ({name}): {whole}")
    outputs(folder, crosshatch(15000, 576))
    shutil.copy(folder / "drawing.strokes.jsonl", folder / "photo.strokes.jsonl")
    pipe = f"'{sys.executable}' -m penink_cli to-svg photo.strokes.jsonl | '{vpype}' read - linesort"
    pipe += " write --device hp7475a --page-size a4 plot.hpgl"
    run("bash", "-e", "-o", "pipefail", "-c", pipe, cwd=folder, env={**os.environ, "PYTHONPATH": str(ROOT)})
    size = (folder / "plot.hpgl").stat().st_size
    print(f"   penink to-svg | vpype read - linesort write plot.hpgl: {size} bytes of HPGL")
    # vpype's 2-opt is quadratic: it takes more than a quarter of an hour for 15000 strokes, so 3000 compare the ways.
    for count, optimiser in ((15000, "linesort"), (3000, "two-opt")):
        drawing = crosshatch(count, 576 * (count / 15000) ** 0.5)
        outputs(folder, drawing)
        before = time.process_time()
        travel = travel_length(ordered(drawing))
        ours = time.process_time() - before
        seconds, far = json.loads(run(python, "-c", READ, folder / "drawing.svg", optimiser))[optimiser]
        print(f"   {count} strokes, {travel_length(drawing):.0f} pt travelled unordered: --order {travel:.0f} pt in"
              f" {ours:.2f} s of CPU, vpype's {optimiser} {far:.0f} pt in {seconds:.1f} s: {travel / far:.2f} of its"
              f" way in {ours / seconds:.3f} of its time", flush=True)  # fmt: skip


def startup(folder):
    print("5. CPU of start-up, beyond the interpreter's own")
    bare, _ = cpu(sys.executable, "-c", "pass")
    times = {name: cpu(*penink(name, "--help"))[0] - bare for name in SUBCOMMANDS}
    slowest = max(times, key=times.__getitem__)
    print(f"   the interpreter alone {bare:.3f} s; --help of {len(times)} subcommands {min(times.values()):.3f} to"
          f" {times[slowest]:.3f} s ({slowest})")  # fmt: skip
    from PIL import Image

    y, x = np.mgrid[:24, :32]
    Image.fromarray(np.where((x - 16) ** 2 + (y - 12) ** 2 < 50, 60, 200).astype(np.uint8)).save(folder / "photo.png")
    script = """p() { "$PYTHON" -m penink_cli "$@"; }
    p detect-edges photo.png -o e.json
    p extract-samples -e e.json photo.png | p reduce -e e.json --factor 2 | p enlarge -e e.json --scale 4 |
    p blast -e e.json --width 0.5in | p to-ps > photo.ps"""
    # with compiled bytecode at hand, as a program that is installed has it
    environment = {**os.environ, "PYTHON": sys.executable, "PYTHONPATH": str(ROOT)}
    environment |= {"PYTHONPYCACHEPREFIX": str(folder / "bytecode"), "PYTHONDONTWRITEBYTECODE": ""}
    seconds = [cpu("bash", "-e", "-o", "pipefail", "-c", script, cwd=folder, env=environment)[0] for _ in range(6)]
    print(
        "   a chain of six filters on 32 x 24 pixels, all its work and six interpreters included: "
        f"{statistics.median(seconds[1:]):.2f} s"
    )


def main():
    parts = sys.argv[1:] or ["renderers", "size", "inclusion", "plotters", "startup"]
    for part in parts:
        with tempfile.TemporaryDirectory() as folder:
            globals()[part](Path(folder))


if __name__ == "__main__":
    main()
