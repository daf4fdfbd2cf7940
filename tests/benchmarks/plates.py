"""Colour plates against the photograph: ``python -m tests.benchmarks.plates [WIDTH_IN] [NAME …]``.

Every plate is separated, blasted and drawn into pixels: each for itself, then drawn anew by corrected tones, then
pressed with the others. The plates are printed over one another as transparent inks and looked at from afar: light is
low-passed by σ = 1/16 in, and compared with the photograph's in CIEDE2000.

Beside them are measured a clustered-dot halftone of the same inks in the same amounts (60 lines an inch at 600 dpi,
15°, 75°, 0° and 45°), calibrated, printed and looked at alike, and the amounts themselves, which neither can surpass
but by chance. Where the inks hold all colours of a photograph, the amounts come within .2 of it, which dots do not. So
three inks are also printed by error diffusion (Floyd and Steinberg), in dots of the size of the finest pen, and of half
that. The error of the latter is a floor for plates of strokes.

On coffee and chelsea plates are below the floor: .79 and .66 of it, 1.56 and 1.54 of the amounts. What else was tried,
in parts of the amounts: forty rounds of pressing, by up to .6 of a width, 1.45 and 1.41; one pen of .45 pt, 1.84 and
1.61, of .3 pt, 2.05 and 1.57; on coffee and rocket plates of dots, 2.24 and 1.34, of engraved lines, 2.47 and 2.22.

lightness: the mean of L* less the photograph's. moiré: how much of the contrast of the overprint, beyond what is in the
photograph, lies in periods of 1/10 to 1/3 in, in L*.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import skimage.color
import skimage.data
from scipy.ndimage import gaussian_filter, zoom

from penink_cli.arrangement.detection import detect_edges
from penink_cli.blasting.balancing import Plate, balanced, corrected
from penink_cli.blasting.blast import blast
from penink_cli.composition import separation
from penink_cli.ground.colour import linear
from penink_cli.ground.model import GreyImage, turned
from penink_cli.options.inks import CMYK
from penink_cli.options.textures import find_texture
from penink_cli.outputs.page import lay_out
from penink_cli.outputs.raster import cover

PHOTOGRAPHS = ("astronaut", "coffee", "chelsea", "rocket")
SPOTS = ((0x1B / 255, 0x4F / 255, 0x9C / 255), (0xD2 / 255, 0x23 / 255, 0x2A / 255), (0xF2 / 255, 0xC3 / 255, 0.0))
DPI, HALFTONE_DPI, LINES = 300, 600, 60
ANGLES = (15.0, 75.0, 0.0, 45.0)


def seen(light: np.ndarray, dpi: float) -> np.ndarray:
    """Lab of light (h, w, 3) from afar, 32 places an inch."""
    low = np.stack([gaussian_filter(light[..., k], dpi / 16, mode="reflect") for k in range(3)], axis=-1)
    step = dpi / 32
    rows, columns = (np.round((np.arange(int(n / step)) + 0.5) * step).astype(int) for n in low.shape[:2])
    small = np.clip(low[rows][:, columns], 0, 1)
    return skimage.color.rgb2lab(np.where(small <= 0.0031308, small * 12.92, 1.055 * small ** (1 / 2.4) - 0.055))


def at_size(values: np.ndarray, width: int, height: int) -> np.ndarray:
    """(h, w) values at that size."""
    return np.clip(zoom(values, (height / values.shape[0], width / values.shape[1]), order=1, grid_mode=True,
                        mode="nearest"), 0, 1)  # fmt: skip


def halftone(amounts: np.ndarray, inks: tuple, width_in: float) -> np.ndarray:
    """Light (h, w, 3) of clustered dots: amounts (n, h, w) against a round spot function.

    Calibrated: of each level just so much of the paper is covered, whatever the screen makes of the device's pixels.
    The waves of the screens at 15°, 75° and 45° add up to nothing: the third is a quarter of a wave off, so that dots
    of the three neither gather nor keep clear of each other (with none off, chelsea and rocket are 1.1 L* too dark).
    """
    w = int(width_in * HALFTONE_DPI)
    h = round(w * amounts.shape[1] / amounts.shape[2])
    y, x = np.mgrid[0:h, 0:w].astype(np.float32)
    light = np.ones((h, w, 3), np.float32)
    level = np.linspace(0, 1, 513)
    for amount, ink, angle in zip(amounts, inks, ANGLES, strict=False):
        c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        k = 2 * np.pi * LINES / HALFTONE_DPI
        off = 0.25 * HALFTONE_DPI / LINES if angle == ANGLES[3] else 0.0
        spot = np.cos(k * (c * x + s * y + off)) + np.cos(k * (c * y - s * x + off))
        table = np.quantile(spot[: min(h, 600)], 1 - level)
        dot = spot > np.interp(at_size(amount, w, h), level, table)
        light *= np.where(dot[..., None], np.maximum(linear(ink), 0.004), 1.0)
    return light


def diffused(amount: np.ndarray, w: int, h: int) -> np.ndarray:
    """Dots (h, w) of an amount by error diffusion, there and back."""
    rows = np.pad(at_size(amount, w, h), ((0, 1), (1, 1))).tolist()
    dots = np.zeros((h, w), np.float32)
    for y in range(h):
        row, below, step = rows[y], rows[y + 1], 1 - 2 * (y % 2)
        for x in range(1, w + 1)[::step]:
            dots[y, x - 1] = dot = float(row[x] > 0.5)
            off = (row[x] - dot) / 16
            row[x + step] += 7 * off
            below[x - step] += 3 * off
            below[x] += 5 * off
            below[x + step] += off
    return dots


def diffusion(amounts: np.ndarray, inks: tuple, width_in: float, dpi: int) -> np.ndarray:
    """Light (h, w, 3) of dots of that many an inch."""
    w = int(width_in * dpi)
    h = round(w * amounts.shape[1] / amounts.shape[2])
    light = np.ones((h, w, 3), np.float32)
    for amount, ink in zip(amounts, inks, strict=True):
        light *= 1.0 - diffused(amount, w, h)[..., None] * (1.0 - np.maximum(linear(ink), 0.004))
    return light


def plates(amounts: Sequence[np.ndarray], inks: tuple, edges, texture_name: str, width_in: float) -> list[Plate]:
    """The plates' strokes, each drawn for itself."""
    texture = find_texture(texture_name)
    first = texture.layers[0].angle if texture.layers else 0.0
    apart = [layer.angle - first if layer.turn is None else layer.turn for layer in texture.layers]
    turn = separation.turns(apart, len(inks))[::-1]
    drawn = []
    for place, number in enumerate(separation.lightest_first(inks)):
        grey = GreyImage.from_grey(1.0 - amounts[number])
        rows, columns = grey.values.shape
        width_pt, height_pt = width_in * 72, width_in * 72 * rows / columns
        tone = at_size(grey.tone, round(width_pt * 2), round(height_pt * 2))
        own = turned(texture, turn[place])
        strokes = blast(tone, width_pt, height_pt, edges, own, seed=place, solid=separation.SOLID, threads=2,
                        device_dpi=None)  # fmt: skip
        drawn.append(Plate(strokes, inks[number], grey.tone))
    return drawn


def light_of(drawn: list[Plate]) -> np.ndarray:
    """Light (h, w, 3) of the plates."""
    light: float | np.ndarray = 1.0
    for plate in drawn:
        ink = np.concatenate(list(cover.bands([plate.strokes], lay_out([plate.strokes]), DPI, 255, 2)))
        ink = ink[: int(plate.strokes.height / 72 * DPI + 1e-6)]  # a row that the sheet fills in part is none
        light = light * (1.0 - (1.0 - ink[..., None] / 255.0) * (1.0 - np.maximum(linear(plate.ink), 0.004)))
    return np.asarray(light)


def figures(light: np.ndarray, dpi: float, wanted: np.ndarray) -> tuple[float, float, float]:
    """Mean ΔE, bias of L*, and moiré."""
    lab = seen(light, dpi)
    rows, columns = (min(a, b) for a, b in zip(lab.shape[:2], wanted.shape[:2], strict=True))
    lab, wanted = lab[:rows, :columns], wanted[:rows, :columns]
    off = lab[..., 0] - wanted[..., 0]
    band = gaussian_filter(off, 0.8) - gaussian_filter(off, 3.0)
    error = skimage.color.deltaE_ciede2000(lab, wanted)
    return float(error.mean()), float(off.mean()), float(band.std())


def main(arguments: list[str]) -> None:
    width_in = float(arguments[0]) if arguments else 6.0
    names = arguments[1:] or PHOTOGRAPHS
    for name in names:
        photo = getattr(skimage.data, name)()[..., :3]
        edges = detect_edges(GreyImage.from_grey(skimage.color.rgb2gray(photo)).grey)
        w = int(width_in * DPI)
        h = round(w * photo.shape[0] / photo.shape[1])
        stored = linear(np.arange(256) / 255.0)[photo]
        wanted = seen(np.stack([at_size(stored[..., k], w, h) for k in range(3)], axis=-1), DPI)
        for label, inks in (("cmyk", CMYK.colours), ("three spots", SPOTS)):
            amounts = separation.amounts(photo, 255, inks)
            model = separation.printed(amounts, inks)
            model = np.stack([at_size(model[..., k], w, h) for k in range(3)], axis=-1)
            best = figures(model, DPI, wanted)
            dots = figures(halftone(amounts, inks, width_in), HALFTONE_DPI, wanted)
            print(f"{name} {width_in:g} in, {label}: mean ΔE2000, bias of L*, moiré")
            print(f"  the amounts themselves      {best[0]:6.2f} {best[1]:+6.2f} {best[2]:6.2f}")
            ratio = f"{dots[0] / best[0]:.3f} of the amounts"
            print(f"  halftone, {LINES} lines/in       {dots[0]:6.2f} {dots[1]:+6.2f} {dots[2]:6.2f}   {ratio}")
            floor = None
            for dpi in (240, 480) * (label == "three spots"):
                found = figures(diffusion(amounts, inks, width_in, dpi), dpi, wanted)
                ratio = f"{found[0] / best[0]:.3f} of the amounts"
                floor = found[0]
                print(f"  error diffusion, {dpi} dpi    {found[0]:6.2f} {found[1]:+6.2f} {found[2]:6.2f}   {ratio}")
            for texture in ("crosshatch",):
                drawn = plates(amounts, inks, edges, texture, width_in)
                anew = dict(zip(separation.lightest_first(inks), corrected(drawn, workers=2), strict=True))
                anew = [anew[number] for number in range(len(inks))]
                again = plates(anew, inks, edges, texture, width_in)
                redrawn = [replace(p, strokes=q.strokes) for p, q in zip(drawn, again, strict=True)]
                pressed = balanced(redrawn, workers=2)
                both = {
                    f"each for itself, {texture}": drawn,
                    "drawn anew": redrawn,
                    "and pressed": [replace(plate, strokes=own) for plate, own in zip(redrawn, pressed, strict=True)],
                }
                for how, strokes in both.items():
                    ours = figures(light_of(strokes), DPI, wanted)
                    parts = f"{ours[0] / dots[0]:.3f} of the halftone, {ours[0] / best[0]:.3f} of the amounts"
                    parts += f", {ours[0] / floor:.3f} of the finer dots" if floor else ""
                    print(f"  {how:28}{ours[0]:6.2f} {ours[1]:+6.2f} {ours[2]:6.2f}   {parts}", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
