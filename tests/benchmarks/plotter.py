"""What plotters make of penink's SVG: ``python -m tests.benchmarks.plotter [saxi=FOLDER] [vpype=PROGRAM]``.

saxi: the folder of the npm package saxi, whose own planner (run by node) times the same strokes for an AxiDraw. vpype:
the program; it counts strokes, their length and those of its HPGL, of plain files and of files with --merge.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from penink_cli.blasting.blast import blast
from penink_cli.ground.model import Directions, Strokes
from penink_cli.ground.units import POINT_MM
from penink_cli.options.textures import find_texture
from penink_cli.outputs import svg
from penink_cli.outputs.page import Page
from penink_cli.travel import clock
from penink_cli.travel.order import ordered

PLAN = """
const {plan, AxidrawFast, Device} = require(process.argv[1] + "/dist/server/planning.js");
const steps = Device.Axidraw.stepsPerMm;
const paths = JSON.parse(require("fs").readFileSync(0)).map(p => p.map(([x, y]) => ({x: x * steps, y: y * steps})));
console.log(plan(paths, AxidrawFast).duration());
"""


def drawings() -> dict[str, Strokes]:
    """Drawings of 2 in, by what they are."""
    y, x = (np.mgrid[0:288, 0:288] + 0.5) / 288
    tone = 0.1 + 0.5 * x
    rings = np.arctan2(x - 0.5, 0.5 - y)
    field = Directions(np.cos(2 * rings), np.sin(2 * rings), np.ones_like(rings))
    made = {
        "dots": blast(tone, 144, 144, None, find_texture("stipple"), device_dpi=None),
        "hatching": blast(tone, 144, 144, None, find_texture("crosshatch"), device_dpi=None),
        "along a form": blast(tone, 144, 144, None, find_texture("form"), device_dpi=None, directions=field),
        "engraving": replace(
            blast(tone, 144, 144, None, find_texture("engraving"), device_dpi=None, directions=field), knot_widths=None
        ),
    }
    return {name: ordered(strokes, improve=False) for name, strokes in made.items()}


def by_saxi(folder: str, strokes: Strokes) -> float:
    """Seconds by its planner, curves drawn as 16 chords a segment."""
    t = np.arange(1, 17)[:, None] / 16
    paths = []
    for i in range(len(strokes)):
        p = strokes[i] * POINT_MM
        line = [p[:1]]
        for a, b, c, d in (p[k : k + 4] for k in range(0, len(p) - 1, 3)):
            line.append((1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t * t * (1 - t) * c + t**3 * d)
        paths.append(np.concatenate(line).tolist())
    command = ["node", "-e", PLAN, folder]
    done = subprocess.run(command, input=json.dumps(paths).encode(), capture_output=True, check=True)
    return float(done.stdout)


def by_vpype(program: str, strokes: Strokes, merge: bool) -> tuple[int, float, int]:
    """Strokes, length in mm, and how often the pen goes down in HPGL."""
    with tempfile.TemporaryDirectory() as folder:
        drawing, hpgl = Path(folder, "a.svg"), Path(folder, "a.hpgl")
        with drawing.open("wb") as out:
            svg.write(out, [strokes], Page(595.276, 841.89, 72, 72), merge=merge)  # type: ignore[arg-type]
        wanted = ["write", "--device", "hp7475a", "--page-size", "a4", str(hpgl)]
        command = [program, "read", str(drawing), "stat", *wanted]
        done = subprocess.run(command, capture_output=True, check=True, text=True)
        said = done.stdout + done.stderr
        count, length = (re.search(rf"{what}: ([0-9.]+)", said) for what in ("Path count", "Length"))
        down = downs = 0
        for word in hpgl.read_text().split(";"):
            downs += word[:2] == "PD" and not down
            down = word[:2] == "PD" or (down and word[:2] != "PU")
        assert count and length, said
        return int(count[1]), float(length[1]) * 25.4 / 96, downs


def main(arguments: list[str]) -> None:
    tools = dict(argument.split("=", 1) for argument in arguments)
    for name, strokes in drawings().items():
        ours = clock.seconds([strokes], clock.Plotter())
        print(f"{name}: {len(strokes)} strokes, {ours:.1f} s by our estimate", flush=True)
        if "saxi" in tools:
            theirs = by_saxi(tools["saxi"], strokes)
            print(f"  saxi's planner {theirs:.1f} s: ours is {ours / theirs:.4f} of it", flush=True)
        if "vpype" in tools:
            for merge in (False, True):
                count, length, downs = by_vpype(tools["vpype"], strokes, merge)
                how = "merged" if merge else "plain"
                print(f"  vpype, {how}: {count} strokes, {length:.1f} mm; HPGL {downs} strokes", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
