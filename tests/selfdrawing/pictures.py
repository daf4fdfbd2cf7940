"""Small illustrations to draw, and ways to run the renderers."""

from __future__ import annotations

import io
import subprocess
from pathlib import Path

import numpy as np
from PIL import Image

from penink_cli.ground.model import (
    EdgeList,
    GreyImage,
    HatchLayer,
    Illustration,
    Layer,
    OutlineChoice,
    Strokes,
    Texture,
)
from penink_cli.reconstruction.enlarge import enlarge
from penink_cli.selfdrawing import data

CROSSHATCH = Texture(
    "crosshatch", Strokes(144, 144), np.zeros(0), layers=(HatchLayer(-45, 0, 0.5), HatchLayer(45, 0.46, 0.99))
)


def illustration(n: int = 40, inches: float = 1.5, texture: Texture = CROSSHATCH, outline: OutlineChoice | None = None):
    """A ramp; on it a dark disc, an open crease with a bend and a dangling edge that reaches the border."""
    y, x = (np.mgrid[:n, :n] + 0.5) / n
    tone = 0.15 + 0.35 * x
    disc = np.hypot(x - 0.4, y - 0.45) < 0.22
    tone[disc] = 0.8
    turn = np.arange(24) * 2 * np.pi / 24
    ring = np.column_stack([0.4 + 0.22 * np.cos(turn), 0.45 + 0.22 * np.sin(turn)])
    crease = np.array([(0.7, 0.2), (0.75, 0.5), (0.9, 0.6), (0.6, 0.85), (0.6, 1.0)])
    vertices = np.vstack([ring, crease]) * 640
    edges = [(i, (i + 1) % 24) for i in range(24)] + [(24 + i, 25 + i) for i in range(4)]
    samples = GreyImage(np.rint((1 - tone) * 63).astype(np.uint8), 63)
    layer = Layer(samples, EdgeList(640, 640, vertices, np.array(edges)), texture, levels=64, outline=outline)
    return Illustration(72 * inches, 72 * inches, (layer,))


def two_layers(below: Texture, above: Texture, inches: float = 1.5) -> Illustration:
    """A ramp of light tone, and over it a square of middle tone within its edges, elsewhere paper."""
    n = 40
    y, x = (np.mgrid[:n, :n] + 0.5) / n
    ramp = 0.1 + 0.3 * x
    square = (np.abs(x - 0.5) < 0.25) & (np.abs(y - 0.5) < 0.25)
    corners = np.array([(0.25, 0.25), (0.75, 0.25), (0.75, 0.75), (0.25, 0.75)]) * 640
    edges = EdgeList(640, 640, corners, np.array([(0, 1), (1, 2), (2, 3), (3, 0)]))
    grey = [GreyImage(np.rint((1 - tone) * 63).astype(np.uint8), 63) for tone in (ramp, np.where(square, 0.35, 0.0))]
    layers = (Layer(grey[0], None, below, levels=64), Layer(grey[1], edges, above, levels=64))
    return Illustration(72 * inches, 72 * inches, layers)


def expected_tone(layer: Layer, n: int, m: int) -> np.ndarray:
    """Ink in 255ths (m, n) as `enlarge` has it, not rounded to whole numbers."""
    samples, edges = data.as_sent(layer)
    return 255 - enlarge(samples, edges, n, m, maxval=65535).values / 257.0


def ghostscript(program: bytes, *options: str) -> bytes:
    """What Ghostscript writes to standard output and standard error."""
    run = subprocess.run(
        ["gs", "-q", "-dBATCH", "-dNOPAUSE", "-dSAFER", *options, "-"], input=program, capture_output=True, check=False
    )
    assert run.returncode == 0, (run.stdout + run.stderr)[-800:]
    return run.stdout + run.stderr


def printed(program: bytes, tmp_path: Path, dpi: int = 300, *options: str) -> np.ndarray:
    """The page (h, w), 255 for paper."""
    out = tmp_path / "page.pgm"
    source = tmp_path / "page.ps"
    source.write_bytes(program)
    run = subprocess.run(
        ["gs", "-q", "-dBATCH", "-dNOPAUSE", "-dSAFER", f"-r{dpi}", "-sDEVICE=pgmraw", f"-sOutputFile={out}",
         *options, str(source)], capture_output=True, check=False,
    )  # fmt: skip
    assert run.returncode == 0, (run.stdout + run.stderr)[-800:]
    return np.asarray(Image.open(io.BytesIO(out.read_bytes())))
