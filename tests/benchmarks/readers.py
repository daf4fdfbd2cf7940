"""How readers read penink's SVG: ``python -m tests.benchmarks.readers [vpype=PYTHON] [saxi=FOLDER] [axidraw=PYTHON]``.

Three files of one picture in two inks: that of to-svg, the same merged, and the one that the page saves. Each reader
counts layers, strokes and colours and adds up lengths; the first line is what svgelements reads. Differences are
marked, and end the run with status 1.

vpype: a Python that has it. saxi: the folder of the npm package, whose flattener is run on a page, as saxi does. (Its
command line takes the sheet's millimetres for pixels; it scales to the paper unless told otherwise.) axidraw: a
Python that has plotink and ink_extensions, with which the AxiDraw's own program reads.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from penink_cli.ground.codes import of_code
from penink_cli.ground.model import Illustration
from penink_cli.illustration.layering import layer_strokes
from penink_cli.options.textures import find_texture
from penink_cli.outputs import svg
from penink_cli.outputs.page import lay_out
from penink_cli.selfdrawing import html
from penink_cli.travel.order import ordered
from tests.selfdrawing.chromium import Page
from tests.selfdrawing.pictures import two_layers

LENGTH, SIDE = 0.01, 216  # how far lengths may differ; points
INKS = ("#1b4f9c", "#d2232a")

VPYPE = """
import json, sys, vpype
document = vpype.read_multilayer_svg(sys.argv[1], 0.02)
print(json.dumps([[layer.property("vp_color").as_hex(), len(layer), layer.length() * 25.4 / 96]
                  for layer in document.layers.values()]))
"""
SAXI = """
(() => {
  const layers = {};
  for (const line of flattenSVG(document.querySelector("svg"), {maxError: 0.02})) {
    const layer = layers[line.groupId] ||= [line.stroke, 0, 0];
    layer[1] += 1;
    for (let i = 1; i < line.points.length; i++)
      layer[2] += Math.hypot(...[0, 1].map(k => line.points[i][k] - line.points[i - 1][k])) * 25.4 / 96;
  }
  return Object.values(layers);
})()
"""
AXIDRAW = """
import json, math, sys
from ink_extensions import cubicsuperpath
from lxml import etree
from plotink import plot_utils
root = etree.parse(sys.argv[1]).getroot()
sides = [plot_utils.unitsToUserUnits(root.get(side)) for side in ("width", "height")]  # pixels of 96 an inch
scale = plot_utils.vb_scale(root.get("viewBox"), root.get("preserveAspectRatio"), *sides)[0] * 25.4 / 96
layers = []
for group in root:
    if group.get("{http://www.inkscape.org/namespaces/inkscape}groupmode") != "layer":
        continue
    count, length = 0, 0.0
    for path in group:
        for part in cubicsuperpath.parsePath(path.get("d")):
            plot_utils.subdivideCubicPath(part, 0.01)
            count += 1
            length += sum(math.dist(a[1], b[1]) for a, b in zip(part, part[1:])) * scale
    layers.append([group.get("stroke"), count, length])
print(json.dumps(layers))
"""

Seen = list[tuple[str, int, float]]  # of each layer: colour, strokes, mm


def ours(path: Path) -> Seen:
    import svgelements

    found = []
    for group in svgelements.SVG.parse(str(path)).select(lambda e: isinstance(e, svgelements.Group)):
        paths = [e for e in group if isinstance(e, svgelements.Path)]
        if paths:
            parts = [svgelements.Path(part) for path in paths for part in path.as_subpaths()]
            length = float(np.sum([part.length(error=1e-3) for part in parts])) * 25.4 / 96
            found.append((paths[0].stroke.hex, len(parts), length))
    return found


def told(command: list[str], path: Path) -> Seen:
    done = subprocess.run([*command, str(path)], capture_output=True, check=True, text=True)
    return [tuple(layer) for layer in json.loads(done.stdout)]


def by_saxi(folder: str, path: Path) -> Seen:
    """By its flattener, on a page, as its own page does."""
    polyfill, flatten = (
        Path(folder, "..", "flatten-svg", "dist", f"{name}.js").read_text("utf-8")
        for name in ("path-data-polyfill", "svg-to-paths")
    )
    page = path.with_suffix(".saxi.html")
    page.write_text(
        f'<!doctype html><meta charset="utf-8"><body>{path.read_text("utf-8").rpartition("?>")[2]}'
        "<script>const load = (code, require) => {\n"
        "  const module = {exports: {}};\n"
        '  new Function("module", "exports", "require", code)(module, module.exports, require);\n'
        "  return module.exports;\n};\n"
        f"const polyfill = load({json.dumps(polyfill)});\n"
        f"const {{flattenSVG}} = load({json.dumps(flatten)}, () => polyfill);\n"
        'document.body.dataset.ready = "yes"</script>',
        "utf-8",
    )
    with Page(page, 300, 300) as opened:
        return [(colour_code(colour), count, length) for colour, count, length in opened.evaluate(SAXI)]


def colour_code(colour: str) -> str:
    """``rgb(1, 2, 3)`` as a code."""
    parts = [int(part) for part in re.findall("[0-9]+", colour)] if colour.startswith("rgb") else []
    return "#" + "".join(f"{part:02x}" for part in parts) if parts else colour


def files(folder: Path) -> dict[str, Path]:
    below, above = two_layers(find_texture("stipple"), find_texture("crosshatch"), SIDE / 72).layers
    picture = Illustration(SIDE, SIDE, (replace(below, color=INKS[0]), replace(above, color=INKS[1])))
    layers = [ordered(layer, improve=False) for layer, _ in layer_strokes(picture, SIDE, device_dpi=None)]
    colours = [of_code(layer.color or "#000000") for layer in layers]
    result = {}
    for name, merge in (("to-svg", False), ("to-svg --merge", True)):
        result[name] = folder / f"{name.replace(' ', '')}.svg"
        with result[name].open("wb") as out:
            svg.write(out, layers, lay_out(layers), colours, merge=merge)  # type: ignore[arg-type]
    page = folder / "page.html"
    page.write_bytes(html.write(picture, "picture"))
    result["the page's"] = folder / "page.svg"
    with Page(page, 300, 300) as opened:
        result["the page's"].write_text(opened.evaluate(f"svg({SIDE}, [0, 0, {SIDE}, {SIDE}], 0)"))
    return result


def main(arguments: list[str]) -> int:
    tools = dict(argument.split("=", 1) for argument in arguments)
    readers: dict[str, Callable[[Path], Seen]] = {"ours": ours}
    for name, program in (("vpype", VPYPE), ("axidraw", AXIDRAW)):
        if name in tools:
            readers[name] = partial(told, [tools[name], "-c", program])
    if "saxi" in tools:
        readers["saxi"] = partial(by_saxi, tools["saxi"])
    bad = False
    with tempfile.TemporaryDirectory() as folder:
        for name, path in files(Path(folder)).items():
            print(f"{name}, {path.stat().st_size} bytes:", flush=True)
            wanted: Seen | None = None
            for reader, read in readers.items():
                found = read(path)
                wanted = wanted or found
                same = len(found) == len(wanted) and all(
                    a[:2] == b[:2] and abs(a[2] - b[2]) < LENGTH * b[2] for a, b in zip(found, wanted, strict=True)
                )
                bad |= not same
                layers = "; ".join(f"{colour} {count} strokes {length:.1f} mm" for colour, count, length in found)
                print(f"  {reader:8} {len(found)} layers: {layers}{'' if same else '   DIFFERS'}", flush=True)
    return int(bad)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
