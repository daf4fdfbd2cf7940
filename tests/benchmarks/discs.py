"""Small things drawn as themselves: ``python -m tests.benchmarks.discs [TEXTURE …]``, all textures unless told.

Discs of 2 to 12 points, black on white and white in black, by every rule that the texture can be drawn by, for a
screen and for a printer of 600 dpi, as that prints them. A row each; a figure a diameter:

    black    tone inside the black disc: at least .75, .6 at 2 pt
    stray    ink further than a point outside it, in % of the disc: at most 10
    white    paper inside the white disc: at least .75, .6 at 2 pt
    around   tone from one to four points beside that: what the texture has for black
"""

import sys

from penink_cli.blasting.blast import blast
from penink_cli.blasting.rules import rule as find_rule
from penink_cli.ground.device import widened
from penink_cli.ground.rules import RULES
from penink_cli.options.textures import find_texture, shipped
from tests.blasting.test_marks import SIDE, disc, inside_and_stray, light_and_around

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


def main():
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
