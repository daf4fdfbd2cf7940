"""Small things drawn as themselves: ``python -m tests.benchmarks.discs [TEXTURE …]``, all textures unless told.

Discs of 2 to 12 points, black on white and white in black, by every rule that can draw the texture, for a screen and
as a printer of 600 dpi prints them. A row has a figure for each diameter:

    black    tone inside the black disc: at least .75, .6 at 2 pt
    stray    ink further than a point outside it, in % of the disc: at most 10
    white    paper inside the white disc: at least .75, .6 at 2 pt
    around   tone from one to four points beside the white disc: what the texture has for black

Then lettering of 9 and 7 points, drawn 4 in wide by all of `draw`: tone inside, and ink further than a point outside,
at most 2 % of all. ``lettering`` in place of textures is that alone.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from penink_cli.blasting.blast import blast
from penink_cli.blasting.rules import rule as find_rule
from penink_cli.blasting.sheet import coverage
from penink_cli.formats import strokes
from penink_cli.ground.device import widened
from penink_cli.ground.masks import distance
from penink_cli.ground.rules import RULES
from penink_cli.options.textures import find_texture, shipped
from tests.blasting.test_marks import SIDE, disc, inside_and_stray, light_and_around

FINE = 8  # pixels a point
DIAMETERS = (2, 3, 4, 6, 8, 12)
LEAST = {2: 0.6}


def row(texture, rule, dpi):
    """The four figures, a list by diameter each."""
    black, stray, white, around = found = [], [], [], []
    for diameter in DIAMETERS:
        for tone, measure, one, other in (
            (disc(diameter), inside_and_stray, black, stray),
            (1 - disc(diameter), light_and_around, white, around),
        ):
            drawn = blast(tone, SIDE, SIDE, None, find_texture(texture), device_dpi=dpi, rule=rule)
            a, b = measure(widened(drawn, dpi) if dpi else drawn, diameter)
            one.append(a)
            other.append(b)
    return found


def lettering(points, folder):
    """Tone inside two lines of type on a page of 288 × 72 points, and the share of the ink that is beyond a point."""
    page = Image.new("L", (288 * FINE, 72 * FINE), 255)
    for k, line in enumerate(("Hamburgefonts 0123456789", "sphinx of black quartz, judge")):
        ImageDraw.Draw(page).text((80, 80 + 200 * k), line, 0, ImageFont.load_default(size=FINE * points))
    page.resize((288 * 4, 72 * 4), Image.Resampling.BOX).save(folder / "page.png")
    told = ["draw", folder / "page.png", "--width", "288", "--device-dpi", "none", "-q", "-o", folder / "d.jsonl"]
    subprocess.run([sys.executable, "-m", "penink_cli", *told], check=True)
    with open(folder / "d.jsonl", "rb") as stream:
        ink = coverage(strokes.read(stream, "d.jsonl"), 72 * FINE, 288 * FINE)
    letters = np.asarray(page) < 128
    return float(ink[letters].mean()), float(ink[distance(~letters) > FINE].sum() / ink.sum())


def main():
    with tempfile.TemporaryDirectory() as name:
        for points in (9, 7):
            inside, stray = lettering(points, Path(name))
            print(f"lettering of {points} pt at 4 in: {inside:.2f} inside, {100 * stray:.2f} % beyond a point")
    if "lettering" in sys.argv:
        return
    print(f"{'texture':18} {'rule':9} {'dpi':4} {'black':>29} {'stray %':>23} {'white':>29} {'around':>29}")
    misses = 0
    for texture in sys.argv[1:] or shipped():
        for rule in RULES:
            if find_texture(texture).oriented and not find_rule(rule).SETS:
                continue
            for dpi in (None, 600.0):
                black, stray, white, around = row(texture, rule, dpi)
                wrong = sum(
                    v < LEAST.get(d, 0.75) for figures in (black, white) for d, v in zip(DIAMETERS, figures)
                ) + sum(v > 0.1 for v in stray)
                misses += wrong
                shown = (" ".join(f"{v:.2f}"[-4:] for v in figures) for figures in (black, white, around))
                a, b, c = shown
                s = " ".join(f"{100 * v:3.0f}" for v in stray)
                name = f"{texture:18} {rule:9} {'600' if dpi else '-':4}"
                print(f"{name} {a:>29} {s:>23} {b:>29} {c:>29}{' *' * (wrong > 0)}", flush=True)
    print(f"{misses} figures miss what is wanted")


if __name__ == "__main__":
    main()
