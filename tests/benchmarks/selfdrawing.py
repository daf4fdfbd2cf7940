"""Illustrations that draw themselves: bytes, tone at many sizes and devices, seconds, memory.

Run as ``python -m tests.benchmarks.selfdrawing [PART]...``; parts are size, grid, tone, poster, textures, engraving,
places, latex, page, field, refusals. Bundled photographs at 96 samples across, 64 levels; tone by a low-pass of sigma
1/16 inch; Ghostscript's seconds are CPU time.
"""

from __future__ import annotations

import io
import shutil
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_filter, maximum_filter, minimum_filter
from skimage import data as pictures

from penink_cli.arrangement.detection import detect_edges
from penink_cli.formats.illustration import LEVELS
from penink_cli.ground.errors import LimitError
from penink_cli.ground.model import Directions, GreyImage, Illustration, Layer
from penink_cli.options.textures import find_texture
from penink_cli.reconstruction import extraction, reduction
from penink_cli.reconstruction.enlarge import enlarge
from penink_cli.selfdrawing import data, html, postscript
from tests.selfdrawing.chromium import Page
from tests.selfdrawing.crossings import crossings
from tests.selfdrawing.pictures import expected_tone, ghostscript, printed

Image.MAX_IMAGE_PIXELS = None


@cache
def picture(name: str, n: int = 96, texture: str = "crosshatch", **options: float) -> Illustration:
    """A bundled photograph at n samples across, 4 inches wide."""
    grey = getattr(pictures, name)() / 255.0
    few = {"sigma": 1.6, "high": 0.3, "low": 0.12, "tolerance": 1.0, "min_length": 18.0}
    edges = detect_edges(grey, **{**few, **options})
    h = round(n * grey.shape[0] / grey.shape[1])
    samples = reduction.reduce(extraction.extract_samples(grey, edges), edges, n, h)
    layer = Layer(GreyImage.from_grey(np.clip(samples, 0, 1), LEVELS - 1), edges, find_texture(texture), levels=LEVELS)
    return Illustration(288.0, 288.0 * h / n, (layer,))


def run(
    program: bytes, scale: float, dpi: int, folder: Path, width: float, height: float
) -> tuple[np.ndarray, float, float]:
    """The page (h, w) 0 … 1, CPU seconds and peak megabytes of Ghostscript."""
    source, out = folder / "a.ps", folder / "a.pbm"
    size = f"<< /PageSize [{width * scale} {height * scale}] >> setpagedevice {scale} dup scale\n"
    source.write_bytes(b"%!\n" + size.encode() + program)
    options = ["-q", "-dBATCH", "-dNOPAUSE", "-dSAFER", f"-r{dpi}", "-sDEVICE=pbmraw", f"-sOutputFile={out}"]
    # in a small process of its own: a child's peak counts what its parent held
    measure = (
        "import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True);"
        "u = resource.getrusage(resource.RUSAGE_CHILDREN); print(u.ru_utime + u.ru_stime, u.ru_maxrss / 1024)"
    )
    command = [sys.executable, "-S", "-c", measure, "gs", *options, str(source)]
    seconds, memory = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
    return np.asarray(Image.open(out).convert("L")) / 255.0, float(seconds), float(memory)


def tone(page: np.ndarray, layer: Layer, inches: float) -> tuple[float, float]:
    """RMS and bias in percent (+ is too light), low-passed by 1/16 inch."""
    n = round(inches * 100)
    m = round(n * page.shape[0] / page.shape[1])
    samples, edges = data.as_sent(layer)
    h, w = samples.values.shape
    target = enlarge(samples, edges, max(n, w), max(m, h)).values / 255.0
    small = [
        np.asarray(Image.fromarray(a.astype(np.float32)).resize((n, m), Image.Resampling.BOX), float)
        for a in (page, target)
    ]
    off = gaussian_filter(small[0], 6.25) - gaussian_filter(small[1], 6.25)
    return 100 * float(np.sqrt((off**2).mean())), 100 * float(off.mean())


def size(folder: Path) -> None:
    """Bytes."""
    print("samples, edges: bytes of EPS, Level 2, page (at most 20, 26 and 32 KB)")
    for n, options in ((96, {}), (128, {}), (128, {"min_length": 12.0, "high": 0.26, "tolerance": 0.5})):
        p = picture("camera", n, **options)
        sizes = [len(postscript.write(p)), len(postscript.write(p, "lzw")), len(html.write(p, "camera"))]
        print(f"  {n} x {n}, {len(data.as_sent(p.layers[0])[1].edges)}: {sizes}")
    for texture in ("parallel", "crosshatch4", "grain", "stipple", "scribble", "brick", "lawn"):
        p = picture("camera", texture=texture)
        print(f"  96 x 96, {texture}: {[len(postscript.write(p)), len(html.write(p, 'camera'))]}")


def grid(folder: Path) -> None:
    """The device's tone against enlarge's."""
    print("tone grid against enlarge: cells within 1.5 of 255, worst")
    for photo, n in (("camera", 96), ("coins", 96), ("moon", 96), ("camera", 128)):
        p = picture(photo, n)
        show = "Tone { (%stdout)(w) file exch writehexstring (\\n) print } forall\n"
        program = postscript.write(p, "readable").decode().replace("  Gamma 1 ne { Curve } if\n", show)
        got = ghostscript(program.encode(), "-sDEVICE=pbmraw", "-r600", "-sOutputFile=/dev/null").decode().split()
        cells = np.array([list(bytes.fromhex(line)) for line in got], float)
        off = np.abs(cells - expected_tone(p.layers[0], cells.shape[1], cells.shape[0]))
        print(f"  {photo} {n}: {100 * (off <= 1.5).mean():.3f} %, {off.max():.1f}", flush=True)


def row(photo: str, inches: float, dpi: int, folder: Path, texture: str = "crosshatch") -> float:
    """Print what one printout shows; its bias."""
    p = picture(photo, texture=texture)
    got, seconds, memory = run(postscript.write(p), inches / 4, dpi, folder, p.width, p.height)
    rms, bias = tone(got, p.layers[0], inches)
    cost = f"{seconds:7.2f} {seconds / (inches * inches * p.height / p.width):7.3f} {memory:6.0f}"
    print(f"  {texture:11} {photo:7} {inches:4g} {dpi:5} {rms:6.2f} {bias:+6.2f} {cost}", flush=True)
    return bias


HEAD = "  texture     photo   inches  dpi  RMS %  bias %  CPU s  s/sq in  MB"


def printouts(folder: Path) -> None:
    """Tone and speed at many sizes on many devices."""
    print(HEAD)
    for photo in ("camera", "coins", "moon"):
        biases = {at: row(photo, *at, folder) for at in ((1, 600), (2, 600), (4, 300), (4, 600), (4, 1200), (12, 300))}
        biases[12, 600] = row(photo, 12, 600, folder) if photo == "camera" else biases[12, 300]
        drift = abs(biases[2, 600] - biases[12, 600])
        print(f"  drift of bias, {photo}, 2 to 12 in: {drift:.2f} (at most 1)")


def poster(folder: Path) -> None:
    """24 inches: memory (at most 64 MB)."""
    print(HEAD)
    row("camera", 24, 300, folder)


def textures(folder: Path) -> None:
    """The other textures."""
    print(HEAD)
    for texture in ("parallel", "crosshatch4", "grain", "stipple", "scribble", "brick", "lawn"):
        for photo in ("camera", "coins", "moon"):
            row(photo, 4, 600, folder, texture)


def engraving(folder: Path) -> None:
    """Lines that swell, straight and in rings: tone, and CPU seconds a square inch (at most 0.12)."""
    print(HEAD)
    for texture in ("crosshatch", "engraving-straight", "contour-rings", "wood"):
        for photo in ("camera", "coins"):
            row(photo, 4, 600, folder, texture)
    row("camera", 4, 1200, folder, "engraving-straight")
    row("camera", 2, 300, folder, "engraving-straight")


def rings(n: int = 96) -> Directions:
    """A field of circles about the middle."""
    y, x = (np.mgrid[:n, :n] + 0.5) / n - 0.5
    double = 2 * np.arctan2(y, x) + np.pi
    return Directions(np.cos(double), np.sin(double), np.ones((n, n)))


def field(folder: Path) -> None:
    """Pages that follow a field of circles, and pages that engrave: tone of what they save, processor of a repaint."""
    print("  texture, photo: tone RMS %, bias % at 4 in; ms of processor, 1024 x 1024: the same view in haste, fully,")
    print("  and another zoom fully; KB of SVG")
    for texture in ("engraving-straight", "contour-rings", "engraving", "form", "crosshatch"):
        along = texture in ("engraving", "form")
        for photo in ("camera", "coins"):
            p = picture(photo, texture=texture)
            p = replace(p, layers=(replace(p.layers[0], directions=rings() if along else None),))
            path = folder / "page.html"
            path.write_bytes(html.write(p, photo))
            with Page(path) as shown:
                spent = []
                for call in ("repaint(2)", "repaint()", "(view.zoom = 1.3, repaint())"):
                    before = shown.processor_ms()
                    shown.evaluate(call)
                    spent.append(f"{shown.processor_ms() - before:.0f}")
                saved = shown.evaluate(f"svg(288, [0, 0, 288, {p.height}], 0)")
            (folder / "a.svg").write_text(saved)
            convert = ["rsvg-convert", "-d", "600", "-p", "600", "--background-color=white", str(folder / "a.svg")]
            out = subprocess.run(convert, check=True, capture_output=True).stdout
            rms, bias = tone(np.asarray(Image.open(io.BytesIO(out)).convert("L")) / 255, p.layers[0], 4)
            print(f"  {texture}{' along circles' if along else ''}, {photo}: {rms:.2f} {bias:+.2f};"
                  f" {', '.join(spent)}; {len(saved) // 1024}", flush=True)  # fmt: skip


def places(folder: Path) -> None:
    """Rotated, mirrored, stretched, several on a page, twice in a run."""
    p = picture("camera")
    eps, half = postscript.write(p), "-144 -144 translate\n"
    whole = 1 - expected_tone(p.layers[0], 288, 288).mean() / 255
    for how in ("1 1 scale", "37 rotate", "-1 1 scale", "1 -1 scale", "1.6 0.7 scale", "[1 0.2 0.3 1 0 0] concat"):
        place = f"%!\n<< /PageSize [720 720] >> setpagedevice 360 360 translate {how} {half}".encode()
        page, solid = (printed(place + body, folder, 300) for body in (eps, b"0 0 288 288 rectfill showpage\n"))
        light = page[solid == 0].mean() / 255
        print(f"  {how:26} tone {100 * (light - whole):+.2f} off, ink outside {(page[solid > 0] < 255).mean():.5f}")
    spots = ((36, 36, 288), (360, 36, 72), (36, 360, 216))  # left, bottom, width in points
    three = b"%!\n<< /PageSize [612 612] >> setpagedevice /showpage { } def 7\n/dictionaries countdictstack def\n"
    for x, y, wide in spots:
        three += f"save {x} {y} translate {wide} 288 div dup scale\n".encode() + eps + b"\nrestore\n"
    three += b"count = countdictstack dictionaries sub = = systemdict /showpage get exec\n"
    out = folder / "three.pbm"
    left = ghostscript(three, "-sDEVICE=pbmraw", "-r600", f"-sOutputFile={out}").decode().split()
    page = np.asarray(Image.open(out).convert("L")) / 255.0
    for x, y, wide in spots:
        top, first, side = ((612 - y - wide) * 600 // 72, x * 600 // 72, wide * 600 // 72)
        rms, bias = tone(page[top : top + side, first : first + side], p.layers[0], wide / 72)
        page = page.copy()
        page[top - 1 : top + side + 1, first - 1 : first + side + 1] = 1
        print(f"  three on a page, {wide / 72:g} in: tone RMS {rms:.2f}, bias {bias:+.2f}")
    print(f"  three on a page: objects left on the stack, dictionaries, and what was there: {left};"
          f" ink elsewhere {(page < 1).sum()}")  # fmt: skip
    for pattern in ("a%d.pbm",):
        ghostscript(b"%!\n" + eps + b"\n" + eps, "-sDEVICE=pbmraw", "-r300", f"-sOutputFile={folder / pattern}")
    same = (folder / "a1.pbm").read_bytes() == (folder / "a2.pbm").read_bytes()
    print(f"  twice in a run: {'the same bytes' if same else 'DIFFERENT'}")


def latex(folder: Path) -> None:
    """One EPS at 1, 3 and 6 inches in a LaTeX document, through dvips."""
    if not (shutil.which("latex") and shutil.which("dvips")):
        print("  latex is not installed: left out")
        return
    p = picture("camera")
    (folder / "camera.eps").write_bytes(postscript.write(p))
    (folder / "t.tex").write_text(
        r"\documentclass{article}\usepackage[dvips]{graphicx}\textwidth6in\textheight7in\oddsidemargin0in"
        r"\topmargin-1in\headheight0pt\headsep0pt\topskip0pt\parindent0pt\pagestyle{empty}\begin{document}"
        + r"\newpage ".join(rf"\includegraphics[width={n}in]{{camera.eps}}" for n in (1, 3, 6))
        + r"\end{document}"
    )
    for command in (["latex", "-interaction=nonstopmode", "t.tex"], ["dvips", "-q", "-o", "t.ps", "t.dvi"]):
        subprocess.run(command, cwd=folder, check=True, capture_output=True)
    ghostscript((folder / "t.ps").read_bytes(), "-sDEVICE=pbmraw", "-r600", f"-sOutputFile={folder / 't%d.pbm'}")
    for number, inches in enumerate((1, 3, 6), 1):
        page = np.asarray(Image.open(folder / f"t{number}.pbm").convert("L")) / 255.0
        y, x = np.nonzero(page < 0.5)
        cut = page[y.min() :, x.min() :][: inches * 600, : inches * 600]
        strokes = int((cut[:, 1:] < cut[:, :-1]).sum() / len(cut))
        rms, bias = tone(cut, p.layers[0], inches)
        print(f"  {inches} in: {x.max() - x.min() + 1} pixels wide of {600 * inches}, {strokes} strokes across,"
              f" tone RMS {rms:.2f}, bias {bias:+.2f}")  # fmt: skip


def middle_tone(p: Illustration) -> tuple[float, float]:
    """Where in the picture, in shares of its width and height, the tone is some 30 % and changes least."""
    tones = 1 - p.layers[0].samples.values / p.layers[0].samples.maxval
    change = maximum_filter(tones, 7) - minimum_filter(tones, 7)
    change[(tones < 0.25) | (tones > 0.35)] = 9
    change[:6], change[-6:], change[:, :6], change[:, -6:] = 9, 9, 9, 9
    j, i = np.unravel_index(change.argmin(), tones.shape)
    return (i + 0.5) / tones.shape[1], (j + 0.5) / tones.shape[0]


def page(folder: Path) -> None:
    """Repainting (at most 300 ms), zoom, console and network of the page in Chromium."""
    # with what is drawn read back, or it would only be promised
    timed = (
        "(() => {%s; const began = performance.now(); repaint(); canvas.getContext('2d').getImageData(0, 0, 1, 1);"
        "return performance.now() - began})()"
    )
    print("  medians of 9, ms that passed and (processor, all the browser's threads); strokes' width in pixels, and")
    print("  how many are crossed in 96 pixels at a tone of 30 %, measured on screenshots of a place of middle tone")
    for photo in ("camera", "coins"):
        path = folder / "page.html"
        path.write_bytes(html.write(picture(photo), photo))
        x, y = middle_tone(picture(photo))
        with Page(path) as shown:

            def median(steps: list[str], shown: Page = shown) -> str:
                before = shown.processor_ms()
                times = [shown.evaluate(timed % step) for step in steps]
                each = (shown.processor_ms() - before) / len(steps)
                return f"{statistics.median(times):.0f} ({each:.0f})"

            for zoom in (1, 4, 24):
                still = f"view.zoom = {zoom}, view.x = view.y = {-512 * (zoom - 1)}"
                for _ in range(2):
                    shown.evaluate(timed % still)
                same = median([still] * 9)
                moved = median([f"{still} - {37 * k}" for k in range(1, 10)])
                fresh = median([f"{still}, view.zoom = {zoom * (1 + k / 50)}" for k in range(1, 10)])
                there = f"view.x = 512 - {x} * size[0] * scale(), view.y = 512 - {y} * size[1] * scale()"
                shown.evaluate(f"(view.zoom = {zoom}, {there}, repaint())")
                width, density, patches = crossings(shown.screenshot()[:960])
                strokes = f"strokes {width:.2f} wide, {96 * density:.1f} crossed ({patches} patches)"
                print(f"  {photo}, 1024 x 1024, zoom {zoom}: repaint {same} the same view, {moved} moved,"
                      f" {fresh} zoomed; {strokes}", flush=True)  # fmt: skip
            console = [line for line in shown.console if "willReadFrequently" not in line]
            print(f"  console: {console}; fetched besides the page: {len(shown.requests) - 1}")


def refusals(folder: Path) -> None:
    """Too many samples, and damage."""
    p = picture("camera")
    for w, h in ((254, 254), (255, 20), (20, 255)):
        layer = replace(p.layers[0], samples=GreyImage(np.zeros((h, w), np.uint8), 63), edges=None)
        try:
            print(f"  {w} x {h} samples: {len(postscript.write(replace(p, layers=(layer,))))} bytes")
        except LimitError as error:
            print(f"  {w} x {h} samples: {error}")
    damaged = folder / "a.penink"
    damaged.write_bytes(b"PK\x03\x04 nothing")
    for command in (["to-ps", "--self"], ["to-html"]):
        call = [sys.executable, "-m", "penink_cli", *command, str(damaged)]
        done = subprocess.run(call, capture_output=True, text=True, check=False)
        print(f"  {' '.join(command)}: exit {done.returncode}, {done.stderr.strip()}")


PARTS: dict[str, Callable[[Path], None]] = {
    "size": size, "grid": grid, "tone": printouts, "poster": poster, "textures": textures,
    "engraving": engraving, "places": places, "latex": latex, "page": page, "field": field, "refusals": refusals,
}  # fmt: skip


def main() -> None:
    """Print the figures."""
    for part in sys.argv[1:] or PARTS:
        print(f"{part}: {PARTS[part].__doc__}")
        with tempfile.TemporaryDirectory() as name:
            PARTS[part](Path(name))


if __name__ == "__main__":
    main()
