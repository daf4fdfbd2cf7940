"""Illustrations that draw themselves: bytes, tone at many sizes and devices, seconds, memory.

The camera man, 96 x 96 and 128 x 128 samples of 64 levels; tone by a low-pass of sigma 1/16 inch. Seconds are CPU time.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_filter
from skimage import data as pictures

from penink_cli.arrangement.detection import detect_edges
from penink_cli.model import GreyImage, Illustration, Layer
from penink_cli.reconstruction import extraction, reduction
from penink_cli.reconstruction.enlarge import enlarge
from penink_cli.selfdrawing import data, html, postscript
from penink_cli.texture_options import find_texture
from tests.selfdrawing.chromium import Page

Image.MAX_IMAGE_PIXELS = None


def picture(name: str, n: int, **options: float) -> Illustration:
    """A bundled photograph at n samples across, 4 inches wide."""
    grey = getattr(pictures, name)() / 255.0
    edges = detect_edges(grey, **options)
    h = round(n * grey.shape[0] / grey.shape[1])
    samples = reduction.reduce(extraction.extract_samples(grey, edges), edges, n, h)
    values = np.rint(np.clip(samples, 0, 1) * 63).astype(np.uint8)
    layer = Layer(GreyImage(values, 63), edges, find_texture("crosshatch"))
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


def main() -> None:
    """Print the figures."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for n, high in ((96, 0.3), (128, 0.3)):
            p = picture("camera", n, sigma=1.6, high=high, low=0.12, tolerance=1.0, min_length=18.0)
            eps = postscript.write(p)
            page = html.write(p, "camera")
            edges = len(data.as_sent(p.layers[0])[1].edges)
            print(f"{n} x {n}, {edges} edges: EPS {len(eps)} bytes, page {len(page)} bytes")
        print("inches  dpi  RMS %  bias %  CPU s  s/sq in  MB")
        for photo in ("camera", "coins", "moon"):
            p = picture(photo, 96, sigma=1.6, high=0.3, low=0.12, tolerance=1.0, min_length=18.0)
            eps = postscript.write(p)
            sizes = ((1, 600), (2, 600), (4, 300), (4, 600), (4, 1200), (12, 300))
            for inches, dpi in (*sizes, (24, 300)) if photo == "camera" else sizes:
                got, seconds, memory = run(eps, inches / 4, dpi, folder, p.width, p.height)
                rms, bias = tone(got, p.layers[0], inches)
                area = inches * inches * p.height / p.width
                cost = f"{seconds:7.2f} {seconds / area:7.3f} {memory:6.0f}"
                print(f"{photo:7} {inches:3} {dpi:5} {rms:6.2f} {bias:+6.2f} {cost}", flush=True)
        path = folder / "camera.html"
        path.write_bytes(html.write(picture("camera", 96, sigma=1.6, high=0.3, low=0.12, tolerance=1.0), "camera"))
        with Page(path) as page_of:
            for zoom in (1, 4, 24):
                view = f"view.zoom = {zoom}, view.x = view.y = {-400 * (zoom - 1)}"
                times = [page_of.evaluate(f"({view}, repaint(), painted.ms)") for _ in range(6)]
                print(f"Chromium, 1024 x 1024, zoom {zoom}: repaint {min(times):.0f} ms, the best of 6")
            print(f"console: {page_of.console}; fetched: {len(page_of.requests) - 1}")


if __name__ == "__main__":
    main()
