#!/usr/bin/env python3
"""The paper's figures with pictures of our own: ``figures.py FOLDER`` writes them and one page that shows all.

FOLDER must hold the photographs and scenes (see the Makefile). Each figure is made by the commands that a
user has, from illustrations that are written to FOLDER as they go: *.illustration.json, *.penink, *.eps.
figures.pdf and figures.png are the page, sizes.pdf and sizes.png one of walls and portraits, table1.md the
table. PENINK and GS name the programs.
"""

import json
import os
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

PENINK = shlex.split(os.environ.get("PENINK", "penink"))
GS = os.environ.get("GS", "gs")
PAGE = (18.6 * 72, 26.0 * 72)
MARGIN = 0.7 * 72


class Studio:
    """A folder of pictures, and the commands run in it; each file is made once."""

    def __init__(self, folder: Path):
        self.folder = folder

    def penink(self, *arguments: object) -> None:
        subprocess.run([*PENINK, *map(str, arguments)], cwd=self.folder, check=True)

    def represent(self, photo: str, name: str, size: int, *detect: object) -> None:
        """NAME.edges.json and NAME.pgm: edges, and samples on a grid of that width."""
        w, h = pixels(self.folder / photo)
        self.penink("detect-edges", *detect, photo, "-o", f"{name}.edges.json")
        self.penink("extract-samples", "-e", f"{name}.edges.json", photo, "-o", f"{name}.full.pgm")
        grid = f"{size}x{round(size * h / w)}"
        self.penink("reduce", "-e", f"{name}.edges.json", "--size", grid, f"{name}.full.pgm", "-o", f"{name}.pgm")

    def illustrate(self, name: str, width_in: float, layers: list[dict]) -> None:
        """NAME.illustration.json and NAME.penink of layers {"of": represented name, …}."""
        w, h = pixels(self.folder / f"{layers[0]['of']}.pgm")
        items = []
        for layer in layers:
            of = layer.pop("of")
            item = {"samples": f"{of}.pgm", "edges": f"{of}.edges.json"}
            if layer.pop("smooth", False):
                del item["edges"]
            items.append({**item, **layer})
        manifest = {"format": "penink-illustration", "version": 1, "width": width_in * 72}
        manifest |= {"height": width_in * 72 * h / w, "layers": items}
        (self.folder / f"{name}.illustration.json").write_text(json.dumps(manifest, indent=1) + "\n")
        self.penink("pack", f"{name}.illustration.json", "-o", f"{name}.penink")

    def print(self, name: str, to: str, width_in: float, *options: object) -> None:
        """TO.jsonl and TO.eps: the illustration at that width."""
        self.penink("render", f"{name}.penink", "--width", f"{width_in}in", *options, "-o", f"{to}.jsonl")
        self.penink("to-ps", f"{to}.jsonl", "-o", f"{to}.eps")

    def blast(self, grey: str, to: str, width_in: float, *options: object) -> None:
        self.penink("blast", grey, "--width", f"{width_in}in", *options, "-o", f"{to}.jsonl")
        self.penink("to-ps", f"{to}.jsonl", "-o", f"{to}.eps")


def pixels(path: Path) -> tuple[int, int]:
    """Width and height of a PNG or PGM file."""
    data = path.read_bytes()[:64]
    if data.startswith(b"\x89PNG"):
        return int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")
    return int(data.split()[1]), int(data.split()[2])


# ------------------------------------------------------------------- the figures


def scales(s: Studio) -> None:
    """Figures 1 and 3: one subject at three sizes, drawn anew for each; figures.py's page also scales the strokes."""
    s.represent("coffee.png", "cup", 128, "--high", 0.14, "--min-length", 14)
    outline = {"pen": 0.7, "min_strength": 0.15, "min_length": 24}
    s.illustrate("cup", 2.2, [{"of": "cup", "texture": "crosshatch", "outline": outline}])
    for width in (1.1, 2.2, 4.4):
        s.print("cup", f"cup-{width}", width)


MAN = 7.6  # inches wide, of which the page shows this part: left, top and side as shares of the width
HEAD = (0.27, 0.05, 0.55)


def with_and_without(s: Studio) -> None:
    """Figure 4: samples of the same resolution, enlarged without and with their discontinuities."""
    s.represent("camera.png", "man", 80, "--high", 0.12, "--min-length", 12)
    outline = {"pen": 0.6, "min_strength": 0.16, "min_length": 24}
    s.illustrate("man", 4.2, [{"of": "man", "texture": "crosshatch", "outline": outline}])
    s.print("man", "man-with", MAN)
    # Without: the samples of a plain reduction, enlarged by a plain filter, hatched up to the same outline strokes.
    nothing = {"format": "penink-edges", "version": 1, "width": 512, "height": 512, "vertices": [], "edges": []}
    (s.folder / "none.edges.json").write_text(json.dumps(nothing))
    s.penink("extract-samples", "-e", "none.edges.json", "camera.png", "-o", "man.plain.full.pgm")
    s.penink("reduce", "--fit", "none", "--size", "80x80", "man.plain.full.pgm", "-o", "man.plain.pgm")
    side = round(2 * 72 * MAN)
    s.penink("enlarge", "--soften", "--size", f"{side}x{side}", "man.plain.pgm", "-o", "man.large.pgm")
    s.penink(
        "outline", "--width", f"{MAN}in", "--weight", 0.6, "--min-strength", 0.16, "--min-length", 24, "man.edges.json",
        "-o", "man.outlines.jsonl",
    )  # fmt: skip
    s.blast("man.large.pgm", "man-hatching", MAN, "--texture", "crosshatch", "--ink", "man.outlines.jsonl")
    s.penink("to-ps", "man-hatching.jsonl", "man.outlines.jsonl", "-o", "man-without.eps")


def portrait(s: Studio) -> None:
    """A portrait as `draw` makes it, with nothing chosen by hand."""
    s.penink("draw", "astronaut.png", "--width", "5in", "-o", "portrait.eps")


def keys(s: Studio) -> None:
    """Figure 5: two layers, each with its texture, from one photograph and a mask."""
    s.penink("separate", "keys.png", "--mask", "keys-mask.png", "-o", "keys-only.pgm")
    s.penink("separate", "keys.png", "--mask", "keys-mask.png", "--invert", "-o", "shadow-only.pgm")
    s.represent("keys-only.pgm", "metal", 128, "--high", 0.12, "--min-length", 10)
    s.represent("shadow-only.pgm", "shadow", 64, "--high", 0.16, "--min-length", 20)
    outline = {"pen": 0.6, "min_strength": 0.2, "min_length": 30}
    s.illustrate(
        "keys", 4.6, [{"of": "shadow", "name": "shadow", "texture": "stipple"},
                      {"of": "metal", "name": "keys", "texture": "crosshatch", "outline": outline}],
    )  # fmt: skip
    s.print("keys", "keys-print", 5.0)


CLOSE = (82, 44, 32)  # the close-up's corner and side, in samples of the keys


def close_up(s: Studio) -> None:
    """Figures 6 and 7: a corner of the keys' metal, its samples and edges, enlarged two ways, both drawn."""
    left, top, side = CLOSE
    w, h = pixels(s.folder / "metal.pgm")
    scale = 25
    window = ",".join(str(v * scale) for v in (left, top, side, side))
    large = ("--soften", "--size", f"{w * scale}x{h * scale}", "--window", window, "metal.pgm", "-o")
    s.penink("enlarge", *large, "close-plain.pgm")
    s.penink("enlarge", "-e", "metal.edges.json", *large, "close-sharp.pgm")
    for kind in ("plain", "sharp"):
        s.illustrate(f"metal-{kind}", 4.6, [{"of": "metal", "texture": "crosshatch", "smooth": kind == "plain"}])
        s.print(f"metal-{kind}", f"close-{kind}-drawn", 2.75 * w / side)
    edges = json.loads((s.folder / "metal.edges.json").read_text())
    unit = edges["width"] / w
    at = [((x / unit - left) / side, (y / unit - top) / side) for x, y in edges["vertices"]]
    (s.folder / "close-edges.json").write_text(json.dumps([(at[a], at[b]) for a, b in edges["edges"]]))
    raster = (s.folder / "metal.pgm").read_bytes()[-w * h :]
    rows = [raster[(top + i) * w + left :][:side] for i in range(side)]
    (s.folder / "close-samples.pgm").write_bytes(b"P5\n%d %d\n255\n" % (side, side) + b"".join(rows))


def billiard(s: Studio) -> None:
    """Figure 8: a scene with strong edges."""
    s.represent("billiard.png", "billiard", 120, "--high", 0.08, "--min-length", 12)
    outline = {"pen": 0.7, "min_strength": 0.12, "min_length": 24}
    s.illustrate("billiard", 5, [{"of": "billiard", "texture": "crosshatch", "outline": outline}])
    s.print("billiard", "billiard-print", 6.667)


CUP = (0.13, 0.0, 2 / 3)  # the part of the coffee shown in each texture, and its side on paper
SWATCH = 1.9
TEXTURES = ("parallel", "crosshatch", "crosshatch4", "grain", "scribble", "stipple", "brick", "lawn")


def textures(s: Studio) -> None:
    """One subject in every texture that comes with the program."""
    s.represent("coffee.png", "small", 80, "--high", 0.2, "--min-length", 20)
    for texture in TEXTURES:
        s.illustrate(f"small-{texture}", 2, [{"of": "small", "texture": texture}])
        s.print(f"small-{texture}", f"small-{texture}", round(SWATCH / CUP[2], 4))


WALLS, PORTRAITS = (2, 4, 8, 16), (1, 2, 6, 24)  # inches


def every_size(s: Studio) -> None:
    """A brick wall and a portrait on a stamp, on a page and on a poster; the wall as it was before it grew, too."""
    w, h = 240, 96
    ramp = bytes(round(235 - 150 * x / w - 40 * y / h) for y in range(h) for x in range(w))
    (s.folder / "wall.pgm").write_bytes(b"P5\n%d %d\n255\n" % (w, h) + ramp)
    s.penink("texture", "show", "--json", "brick", "-o", "brick.texture.json")
    brick = json.loads((s.folder / "brick.texture.json").read_text())
    del brick["scales"]
    brick["strokes"] = [stroke for stroke in brick["strokes"] if stroke.get("scale", [0])[0] <= 1]
    (s.folder / "bricks.texture.json").write_text(json.dumps(brick))
    for inches in WALLS:
        s.blast("wall.pgm", f"wall-before-{inches}", inches, "--texture", "bricks.texture.json")
        s.blast("wall.pgm", f"wall-{inches}", inches, "--texture", "brick", "--natural", "4in")
    s.penink("draw", "astronaut.png", "-o", "face.penink")
    for inches in PORTRAITS:
        s.print("face", f"face-{inches}", inches)


#: Nine strokes on the camera picture, in its 512 pixels: the grass level, the coat falling.
STROKES = (
    "M20 470H150", "M270 470C350 462 430 466 500 460", "M260 400C340 394 420 398 500 390",
    "M300 330C370 324 440 326 500 320", "M150 110C140 200 120 300 110 420", "M190 110C190 200 180 290 165 400",
    "M100 190C80 260 65 330 60 430", "M225 150C230 210 235 250 215 300", "M130 100C110 130 85 170 70 220",
)  # fmt: skip


def along(s: Studio) -> None:
    """Hatching straight, along the form and in fur; along the form at three sizes; with a user's strokes; engraved."""
    for name in ("chelsea", "camera", "astronaut"):
        s.penink("detect-edges", f"{name}.png", "-o", f"{name}.form.edges.json")
        s.penink("extract-samples", "-e", f"{name}.form.edges.json", f"{name}.png", "-o", f"{name}.form.pgm")
        s.penink("detect-directions", "-e", f"{name}.form.edges.json", f"{name}.png", "-o", f"{name}.directions.pgm")
    edges = ("-e", "chelsea.form.edges.json")
    follow = (*edges, "--directions", "chelsea.directions.pgm")
    s.blast("chelsea.form.pgm", "cat-straight", 3.75, *edges, "--texture", "crosshatch")
    s.blast("chelsea.form.pgm", "cat-form", 3.75, *follow, "--texture", "form")
    s.blast("chelsea.form.pgm", "cat-fur", 3.75, *follow, "--texture", "fur")
    for width in (1.1, 2.2, 4.4):
        s.blast("chelsea.form.pgm", f"cat-form-{width}", width, *follow, "--texture", "form")
    for width in (0.9, 1.8, 3.6):
        s.blast(
            "astronaut.form.pgm", f"engraved-{width}", width, "-e", "astronaut.form.edges.json", "--directions",
            "astronaut.directions.pgm", "--texture", "engraving",
        )  # fmt: skip
    paths = "".join(f'<path d="{d}" fill="none" stroke="black"/>' for d in STROKES)
    svg = f'<svg xmlns="http://www.w3.org/2000/svg" width="512" height="512" viewBox="0 0 512 512">{paths}</svg>\n'
    (s.folder / "nine.svg").write_text(svg)
    s.penink(
        "detect-directions", "-e", "camera.form.edges.json", "--strokes", "nine.svg", "camera.png", "-o",
        "camera.nine.directions.pgm",
    )  # fmt: skip
    for name, field in (("own", "camera.directions.pgm"), ("nine", "camera.nine.directions.pgm")):
        s.blast(
            "camera.form.pgm", f"man-{name}", 2.5, "-e", "camera.form.edges.json", "--directions", field, "--texture",
            "form",
        )  # fmt: skip


# ------------------------------------------------------------------- the page


class Sheet:
    """A PostScript page that drawings, pictures and captions are put on; x, y from the top-left corner, points."""

    def __init__(self, width: float, height: float):
        self.width, self.height = width, height
        self.out = [
            f"%!PS-Adobe-3.0\n%%BoundingBox: 0 0 {width:g} {height:g}\n%%Pages: 1\n%%EndComments\n",
            f"<< /PageSize [{width:g} {height:g}] >> setpagedevice\n",
            "/caption { moveto /Times-Roman 13 selectfont show } bind def\n",
            "/title { moveto /Times-Bold 26 selectfont show } bind def\n",
        ]

    def text(self, x: float, y: float, words: str, style: str = "caption") -> None:
        escaped = words.replace("\\", r"\\").replace("(", r"\(").replace(")", r"\)")
        self.out.append(f"({escaped}) {x:.2f} {self.height - y:.2f} {style}\n")

    def drawing(
        self, x: float, y: float, eps: Path, width: float | None = None, crop: tuple[float, float, float] | None = None
    ) -> tuple[float, float]:
        """An EPS with its top-left corner there, at its own width or scaled to another; its size on the page.

        crop: left, top and side, as shares of the width, of the square of it to show.
        """
        text = eps.read_text("latin-1")
        # Strokes may reach over their sheet, which lies at 0, 0; show the sheet alone.
        line = next(line for line in text.splitlines() if line.startswith("%%HiResBoundingBox:"))
        x0, y0, x1, y1 = map(float, line.split()[1:])
        if (strokes := eps.with_suffix(".jsonl")).exists():
            head = json.loads(strokes.open().readline())
            x0, y0, x1, y1 = 0.0, 0.0, head["width"], head["height"]
        if crop:
            share, x0, y0 = x1 - x0, x0 + crop[0] * (x1 - x0), y1 - (crop[1] + crop[2]) * (x1 - x0)
            x1, y1 = x0 + crop[2] * share, y0 + crop[2] * share
        scale = 1.0 if width is None else width / (x1 - x0)
        bottom = self.height - y - (y1 - y0) * scale
        self.out.append(
            f"save /showpage {{}} def {x:.2f} {bottom:.2f} translate {scale:.6f} dup scale\n"
            f"{-x0:.3f} {-y0:.3f} translate {x0:.3f} {y0:.3f} {x1 - x0:.3f} {y1 - y0:.3f} rectclip\n"
            f"%%BeginDocument: {eps.name}\n{text}\n%%EndDocument\nrestore\n"
        )
        return (x1 - x0) * scale, (y1 - y0) * scale

    def picture(self, x: float, y: float, pgm: Path, width: float) -> None:
        """A PGM picture of that width, its pixels as squares."""
        w, h = pixels(pgm)
        raster = pgm.read_bytes()[-w * h :].hex()
        lines = "\n".join(raster[i : i + 120] for i in range(0, len(raster), 120))
        height = width * h / w
        self.out.append(
            f"gsave {x:.2f} {self.height - y - height:.2f} translate {width:.2f} {height:.2f} scale\n"
            f"{w} {h} 8 [{w} 0 0 {-h} 0 {h}] currentfile /ASCIIHexDecode filter image\n{lines}>\ngrestore\n"
        )

    def lines(self, x: float, y: float, side: float, segments: list) -> None:
        """Segments within the unit square, drawn in a square of that side."""
        bottom = self.height - y - side
        self.out.append(f"gsave {x:.2f} {bottom:.2f} translate 0 0 {side:g} {side:g} rectclip 1 setlinecap\n")
        for (x0, y0), (x1, y1) in segments:
            self.out.append(
                f"{x0 * side:.2f} {(1 - y0) * side:.2f} moveto {x1 * side:.2f} {(1 - y1) * side:.2f} lineto stroke\n"
            )
        self.out.append(f"grestore gsave 0.4 setlinewidth {x:.2f} {bottom:.2f} {side:g} {side:g} rectstroke grestore\n")

    def write(self, folder: Path, name: str) -> None:
        """NAME.ps, NAME.pdf and NAME.png."""
        (folder / f"{name}.ps").write_text("".join(self.out) + "showpage\n%%EOF\n", "latin-1")
        common = [GS, "-q", "-dSAFER", "-dBATCH", "-dNOPAUSE"]
        png = [*common, "-sDEVICE=pnggray", "-r150", "-dGraphicsAlphaBits=4", "-dTextAlphaBits=4"]
        for command, ending in ((["-sDEVICE=pdfwrite"], "pdf"), (png[5:], "png")):
            to = f"-sOutputFile={name}.{ending}"
            subprocess.run([*common, *command, to, f"{name}.ps"], cwd=folder, check=True)


def compose(folder: Path) -> None:
    """The page: what `scales` and the others have made, side by side, in the order of the paper."""
    sheet = Sheet(*PAGE)
    inch = 72.0
    left, y = MARGIN, MARGIN + 22
    sheet.text(left, y, "Pen-and-ink illustrations that keep their tone and their edges at any size", "title")
    y += 26
    tallest = 4.4 * inch * 2 / 3
    naive = left + 8.9 * inch
    for start, anew in ((left, True), (naive, False)):
        x = start
        for width in (1.1, 2.2, 4.4):
            top = y + tallest - width * inch * 2 / 3  # all stand on one line
            sheet.drawing(x, top, folder / f"cup-{width if anew else 2.2}.eps", width * inch)
            x += width * inch + 14
    sheet.text(left, y + tallest + 18, "1  One illustration at three sizes, drawn anew for each: one pen, one tone.")
    sheet.text(naive, y + tallest + 18, "2  The strokes of the middle one, scaled: clogged, and coarse.")
    y += tallest + 40
    w, h = sheet.drawing(left, y, folder / "keys-print.eps")
    sheet.text(left, y + h + 18, "3  Two layers: cross-hatched keys, their shadow in stipple.")
    x = left + w + 18
    w, _ = sheet.drawing(x, y, folder / "billiard-print.eps")
    sheet.text(x, y + h + 18, "4  Strong edges: each stroke ends at them.")
    x += w + 18
    sheet.drawing(x, y, folder / "portrait.eps")
    sheet.text(x, y + h + 18, "5  A photograph as penink draw makes it.")
    y += h + 40
    w, h = sheet.drawing(left, y, folder / "man-without.eps", crop=HEAD)
    sheet.text(left, y + h + 18, "6  From 80 by 80 samples, enlarged plainly;")
    x = left + w + 14
    sheet.drawing(x, y, folder / "man-with.eps", crop=HEAD)
    sheet.text(x, y + h + 18, "enlarged with their discontinuities.")
    x += w + 22
    across = (PAGE[0] - MARGIN - x - SWATCH * inch) / 3
    for i, texture in enumerate(TEXTURES):
        at = x + i % 4 * across, y + i // 4 * (h - SWATCH * inch)
        _, deep = sheet.drawing(*at, folder / f"small-{texture}.eps", crop=CUP)
        sheet.text(at[0], at[1] + deep + (18 if i > 3 else 16), f"7  {texture}" if i == 0 else texture)
    y += h + 40
    side, gap = 2.75 * inch, 10.0
    panels = ("samples", "edges", "plain", "sharp", "plain-drawn", "sharp-drawn")
    captions = ("8  The samples of a corner of 3", "their discontinuity edges", "plainly enlarged", "edge-aware",
                "plainly enlarged, drawn", "edge-aware, drawn")  # fmt: skip
    for i, (panel, caption) in enumerate(zip(panels, captions)):
        x = left + i * (side + gap)
        if panel == "edges":
            sheet.lines(x, y, side, json.loads((folder / "close-edges.json").read_text()))
        elif panel.endswith("drawn"):
            crop = tuple(v / pixels(folder / "metal.pgm")[0] for v in CLOSE)
            sheet.drawing(x, y, folder / f"close-{panel}.eps", crop=crop)
        else:
            sheet.picture(x, y, folder / f"close-{panel}.pgm", side)
        sheet.text(x, y + side + 18, caption)
    y += side + 40
    x = left
    for name, caption in (
        ("cat-straight", "9  Hatched straight;"), ("cat-form", "along the form;"), ("cat-fur", "in fur."),
        ("man-own", "10  Along a field that was found;"), ("man-nine", "helped by nine strokes."),
    ):  # fmt: skip
        w, h = sheet.drawing(x, y, folder / f"{name}.eps")
        sheet.text(x, y + 2.5 * inch + 18, caption)
        x += w + 12
    y += 2.5 * inch + 40
    x = left
    for name, sizes, words in (
        ("cat-form", (1.1, 2.2, 4.4), "11  Along the form at three sizes: as many strokes to the inch."),
        ("engraved", (0.9, 1.8, 3.6), "12  Engraved: lines that swell."),
    ):
        sheet.text(x, y + 3.6 * inch + 18, words)
        for width in sizes:
            deep = width * inch * (1 if name == "engraved" else 2 / 3)
            w, _ = sheet.drawing(x, y + 3.6 * inch - deep, folder / f"{name}-{width}.eps")
            x += w + 12
        x += 12
    sheet.write(folder, "figures")


def compose_sizes(folder: Path) -> None:
    """The page of `every_size`: walls all as wide as one another, portraits as they are, the poster at a quarter."""
    inch, width = 72.0, 4.1
    sheet = Sheet(19.2 * inch, 13.6 * inch)
    left, y = MARGIN, MARGIN + 22
    sheet.text(left, y, "One wall and one portrait, from a stamp to a poster", "title")
    y += 26
    for prefix, caption in (("wall-before", "of bricks of one size"), ("wall", "that grows")):
        for k, inches in enumerate(WALLS):
            x = left + k * (width + 0.3) * inch
            _, h = sheet.drawing(x, y, folder / f"{prefix}-{inches}.eps", width * inch)
            sheet.text(x, y + h + 18, f"A wall {caption}, {inches} in wide, shown at {width} in.")
        y += h + 44
    size = (folder / "face.penink").stat().st_size
    x = left
    for inches in PORTRAITS:
        shown = min(inches, 6)
        w, h = sheet.drawing(x, y, folder / f"face-{inches}.eps", shown * inch)
        sheet.text(x, y + h + 18, f"{inches} in" + (", shown at 6 in" if shown < inches else ""))
        x += w + 22
    sheet.text(left, y + 6 * inch + 44, f"Four drawings of one file of {size} bytes.")
    sheet.write(folder, "sizes")


def main() -> None:
    folder = Path(sys.argv[1])
    studio = Studio(folder)
    with ThreadPoolExecutor(2) as pool:
        figures = (scales, billiard, portrait, with_and_without, textures, every_size, along)
        made = [pool.submit(figure, studio) for figure in figures]
        keys(studio)
        close_up(studio)
        for figure in made:
            figure.result()
    compose(folder)
    compose_sizes(folder)


if __name__ == "__main__":
    main()
