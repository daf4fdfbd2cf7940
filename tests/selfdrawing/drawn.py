"""Illustrations as each of the three draws them: `render`, a printer, a page."""

from __future__ import annotations

import io
import re
import subprocess
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_filter

from penink_cli.ground.model import Illustration, Strokes
from penink_cli.illustration.layering import layer_strokes
from penink_cli.outputs import svg
from penink_cli.outputs.page import Page as Sheet
from penink_cli.selfdrawing import html, postscript
from tests.selfdrawing.chromium import Page
from tests.selfdrawing.pictures import printed

DPI = 600


def rasterised(text: str) -> np.ndarray:
    """Tone (h, w) of an SVG, 0 paper … 1, at DPI."""
    run = ["rsvg-convert", "-d", str(DPI), "-p", str(DPI), "--background-color=white"]
    out = subprocess.run(run, input=text.encode(), capture_output=True, check=True).stdout
    return 1 - np.asarray(Image.open(io.BytesIO(out)).convert("L")) / 255


def page_svg(picture: Illustration, tmp_path: Path, width: float) -> str:
    """What the page saves of the whole picture, so wide."""
    path = tmp_path / "picture.html"
    path.write_bytes(html.write(picture, "picture"))
    with Page(path, 300, 300) as page:
        text = page.evaluate(f"svg({width}, [0, 0, {width}, {width * picture.height / picture.width}], 0)")
        assert page.console == []
    return str(text)


def middles(text: str, width: float, height: float) -> Strokes:
    """The middle lines of the shapes that a page has saved of an engraving so large, points."""
    chains = []
    for d in re.findall(r' d="M([^"]*)z"', text):
        outline = np.array(d.split(), float).reshape(-1, 2) * 72 / 25.4
        half = len(outline) // 2
        knots = (outline[:half] + outline[::-1][:half]) / 2
        third = np.diff(knots, axis=0) / 3
        chain = np.stack([knots[:-1], knots[:-1] + third, knots[1:] - third], axis=1).reshape(-1, 2)
        chains.append(np.concatenate([chain, knots[-1:]]))
    return Strokes.of(width, height, chains, np.ones(len(chains)))


def by_page(picture: Illustration, tmp_path: Path) -> np.ndarray:
    return rasterised(page_svg(picture, tmp_path, picture.width))


def by_printer(picture: Illustration, tmp_path: Path) -> np.ndarray:
    return 1 - printed(postscript.write(picture), tmp_path, DPI, "-dEPSCrop") / 255


def by_render(picture: Illustration) -> np.ndarray:
    drawn = [part for layer in layer_strokes(picture, picture.width, device_dpi=None) for part in layer]
    out = io.BytesIO()
    svg.write(out, [Strokes.joined(drawn)], Sheet(picture.width, picture.height, 0.0, 0.0))
    return rasterised(out.getvalue().decode())


def seen(tone: np.ndarray) -> np.ndarray:
    """The same as the eye sees it: low-passed, and at 60 dpi, without the rim."""
    return gaussian_filter(tone, DPI / 16)[DPI // 16 : -DPI // 16 : 10, DPI // 16 : -DPI // 16 : 10]
