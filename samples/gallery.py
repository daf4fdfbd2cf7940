#!/usr/bin/env python3
"""The README's pictures: ``gallery.py PHOTOS FOLDER [PAGES]``, from the sample photographs to small PNG files.

One photograph and its drawing at three sizes on paper, side by side, and a strip of all styles; in PAGES, gallery.html
and gallery.pdf, all photographs in all styles. `penink` is the one on the PATH; equal photographs give equal bytes.
"""

import base64
import io
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

PORTRAIT = "astronaut"
SIZES = (1.0, 1.8, 3.2)  # inches
ANIMAL, STRIP, ROW = "chelsea", 2.2, 3  # the strip's photograph, inches of a drawing, drawings a row
PAGE = 3.0  # inches of a drawing on the gallery's pages
NAMES = ("astronaut", "camera", "chelsea", "coffee", "coins", "moon", "rocket")
DPI, GAP = 120, 12
STYLES = ("house", "engraving", "sketch", "comic", "stipple", "architect", "fur", "true")


def drawn(photo, style, inches, folder):
    target = folder / "d.jsonl"
    command = ["penink", "draw", photo, "--style", style, "--width", f"{inches}in", "--device-dpi", "none"]
    subprocess.run([*command, "-o", target], check=True)
    subprocess.run(["penink", "to-png", "--dpi", str(DPI), target, "-o", folder / "d.png"], check=True)
    with Image.open(folder / "d.png") as image:
        return np.asarray(image.convert("L"))


def side_by_side(pictures, rows):
    """The pictures in rows on white, their lower borders in line."""
    lines = [pictures[i : i + rows] for i in range(0, len(pictures), rows)]
    width = max(sum(p.shape[1] for p in line) + GAP * (len(line) - 1) for line in lines)
    height = sum(max(p.shape[0] for p in line) for line in lines) + GAP * (len(lines) - 1)
    sheet = np.full((height, width), 255, np.uint8)
    top = 0
    for line in lines:
        tall, left = max(p.shape[0] for p in line), 0
        for p in line:
            sheet[top + tall - p.shape[0] : top + tall, left : left + p.shape[1]] = p
            left += p.shape[1] + GAP
        top += tall + GAP
    return sheet


def write(sheet, path):
    """16 greys are enough for strokes, and half the bytes."""
    levels = (sheet.astype(int) * 15 + 127) // 255
    image = Image.fromarray((levels * 17).astype(np.uint8)).quantize(16, dither=Image.Dither.NONE)
    image.save(path, optimize=True)


def pages(photos, folder, out):
    """A page for each photograph, with its drawings in all styles: one HTML file and one PDF."""
    out.mkdir(parents=True, exist_ok=True)
    sheets, parts = [], []
    for photo in sorted(photos.glob("*.png")):
        if photo.stem not in NAMES:
            continue
        with Image.open(photo) as image:
            side = round(PAGE * DPI)
            grey = np.asarray(image.convert("L").resize((side, side * image.height // image.width)))
        drawings = [grey, *(drawn(photo, style, PAGE, folder) for style in STYLES)]
        sheets.append(Image.fromarray(side_by_side(drawings, ROW)))
        figures = []
        for name, picture in zip(("photograph", *STYLES), drawings, strict=True):
            data = io.BytesIO()
            Image.fromarray(picture).save(data, "png", optimize=True)
            code = base64.b64encode(data.getvalue()).decode()
            figures.append(
                f'<figure><img src="data:image/png;base64,{code}" alt=""><figcaption>{name}</figcaption></figure>'
            )
        parts.append(f"<h2>{photo.stem}</h2>\n<div>" + "\n".join(figures) + "</div>")
    head = '<!DOCTYPE html>\n<html lang="en"><meta charset="utf-8"><title>penink: photographs and styles</title>\n'
    look = "<style>body{font-family:sans-serif}div{display:flex;flex-wrap:wrap;gap:1em}figure{margin:0}</style>\n"
    (out / "gallery.html").write_text(head + look + "\n".join(parts) + "\n</html>\n", encoding="utf-8")
    sheets[0].save(out / "gallery.pdf", save_all=True, append_images=sheets[1:], resolution=DPI)


def main():
    photos, out = Path(sys.argv[1]), Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        portrait = photos / f"{PORTRAIT}.png"
        with Image.open(portrait) as image:
            side = round(SIZES[-1] * DPI)
            size = (side, side * image.height // image.width)
            grey = np.asarray(image.convert("L").resize(size, Image.Resampling.BOX))
        sizes = [drawn(portrait, "house", inches, folder) for inches in SIZES]
        write(side_by_side([grey, *reversed(sizes)], 4), out / "sizes.png")
        styles = [drawn(photos / f"{ANIMAL}.png", style, STRIP, folder) for style in STYLES]
        write(side_by_side(styles, ROW), out / "styles.png")
        if len(sys.argv) > 3:
            pages(photos, folder, Path(sys.argv[3]))


if __name__ == "__main__":
    main()
