"""What printers add to strokes: mean tone by Ghostscript's rule, by `widened` strokes on a screen, by blasting's sheet.

Run as ``python -m tests.benchmarks.devices [DPI ...]``. Each drawing is of one kind of stroke and of middling tone; the
figures are in % of full scale, and the last column is the largest difference between any two of them. Then single dots
by size, at 600 dpi: by how many pixels Ghostscript widens them, and by how many the model says.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from penink_cli.blasting.blast import blast
from penink_cli.blasting.hatching import paint
from penink_cli.blasting.sheet import Sheet
from penink_cli.ground.device import disc, widened
from penink_cli.ground.model import Strokes
from penink_cli.options.textures import find_texture
from penink_cli.outputs import pdf, postscript
from penink_cli.outputs.page import lay_out
from penink_cli.outputs.raster import cover

SIDE = 216.0  # points


def dots(diameter: float, apart: float) -> Strokes:
    """Dots that do not touch, each at another place in its pixel."""
    x = np.arange(apart / 2, SIDE - apart / 4, apart)
    at = np.stack(np.meshgrid(x, x), axis=-1).reshape(-1, 2)
    at = at + np.random.default_rng(0).uniform(-0.3, 0.3, at.shape)
    return Strokes(SIDE, SIDE, at, np.arange(len(at) + 1), np.full(len(at), diameter))


def lines(angle: float, width: float, apart: float) -> Strokes:
    """Parallel lines across the sheet."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    v = np.arange(-SIDE, SIDE, apart)
    t = np.linspace(-SIDE / 3, SIDE / 3, 4)
    points = SIDE / 2 + t[None, :, None] * np.array((c, s)) + v[:, None, None] * np.array((-s, c)) / 3
    return Strokes(SIDE, SIDE, points.reshape(-1, 2), 4 * np.arange(len(v) + 1), np.full(len(v), width))


def flat(texture: str, tone: float, dpi: float) -> Strokes:
    """A flat tone in a texture, as `blast` draws it."""
    return blast(np.full((8, 8), tone), SIDE, SIDE, None, find_texture(texture), device_dpi=dpi)


def by_ghostscript(strokes: Strokes, dpi: float, folder: Path, kind: str = "ps") -> float:
    """Mean tone as a PostScript printer paints it: every dot that a stroke touches. kind: "ps" or "pdf"."""
    with open(folder / f"d.{kind}", "wb") as out:
        (postscript if kind == "ps" else pdf).write(out, [strokes], lay_out([strokes]))
    side = round(SIDE * dpi / 72)
    command = ["gs", "-dSAFER", "-q", "-dBATCH", "-dNOPAUSE", "-sDEVICE=pbmraw", f"-r{dpi:g}", f"-g{side}x{side}"]
    command += ["-sOutputFile=-", str(folder / f"d.{kind}")]
    picture = subprocess.run(command, capture_output=True, check=True).stdout
    return float(np.unpackbits(np.frombuffer(picture[-(-(-side // 8) * side) :], np.uint8)).sum()) / side**2


def gain_of_dots(pixels: float, folder: Path, kind: str = "ps") -> float:
    """By how many pixels single dots so wide become wider at 600 dpi: those as dark as what is painted."""
    strokes = dots(pixels * 0.12, 0.12 * (pixels + 4) + 0.6)  # apart: they move by 0.3
    ink = by_ghostscript(strokes, 600.0, folder, kind) * (SIDE / 0.12) ** 2
    return float(np.sqrt(4 / np.pi * ink / len(strokes))) - pixels


def on_a_screen(strokes: Strokes, dpi: float) -> float:
    """Mean tone of the strokes, as wide as such a printer would paint them, by exact area."""
    wider = widened(strokes, dpi)
    return 1 - float(np.concatenate(list(cover.bands([wider], lay_out([wider]), 600, 255))).mean()) / 255


def on_the_sheet(strokes: Strokes, dpi: float) -> float:
    """Mean tone as blasting reckons it."""
    sheet = Sheet(np.zeros((1, 1)), SIDE, SIDE, 72 / dpi)
    paint(sheet, strokes)
    return float(sheet.ink.mean(dtype=np.float64))


def main() -> None:
    """Print the table."""
    resolutions = [float(dpi) for dpi in sys.argv[1:]] or [150.0, 300.0, 600.0, 1200.0]
    print(f"{'drawing':26}{'dpi':>6}{'Ghostscript':>13}{'as PDF':>9}{'screen':>9}{'sheet':>9}{'apart':>8}")
    with tempfile.TemporaryDirectory() as name:
        for dpi in resolutions:
            fine = max(0.4, 108 / dpi)
            drawings = {
                **{f"dots of {d:g} pt": dots(d, 2.2 * (d + 72 / dpi)) for d in (fine, 2 * fine, 4 * fine)},
                **{f"lines at {a} degrees": lines(a, fine, 10 * fine) for a in (0, 13, 30, 45, 90)},
                "stipple .4": flat("stipple", 0.4, dpi),
                "crosshatch .4": flat("crosshatch", 0.4, dpi),
            }
            for what, strokes in drawings.items():
                tones = [by_ghostscript(strokes, dpi, Path(name), kind) for kind in ("ps", "pdf")]
                tones += [on_a_screen(strokes, dpi), on_the_sheet(strokes, dpi)]
                figures = "".join(f"{100 * tone:{w}.2f}" for tone, w in zip(tones, (13, 9, 9, 9)))
                print(f"{what:26}{dpi:6g}{figures}{100 * (max(tones) - min(tones)):8.2f}", flush=True)
        print(f"\n{'a dot of':26}{'pixels':>6}{'Ghostscript':>13}{'as PDF':>9}{'model':>9}")
        for pixels in (1.1, 1.5, 2.0, 3.0, 4.6, 5.9, 6.0, 8.3, 12.0, 17.0, 24.0, 30.0):
            gains = [gain_of_dots(pixels, Path(name), kind) for kind in ("ps", "pdf")]
            gains.append(float(disc(np.array(pixels), 1.0)) - pixels)
            print(" " * 26 + f"{pixels:6g}" + "".join(f"{g:{w}.3f}" for g, w in zip(gains, (13, 9, 9))), flush=True)


if __name__ == "__main__":
    main()
