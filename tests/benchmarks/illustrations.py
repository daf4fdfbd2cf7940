"""Storage of illustrations, what coarser greys cost, their tone at three sizes, and the paper's Table 1.

``python -m tests.benchmarks.illustrations [storage greys tone table]`` prints all, or those parts; ``--table FOLDER``
prints the table alone. Tone and table are of the figures that `make figures` leaves in samples/out (or the folder).
"""

from __future__ import annotations

import io
import sys
import time
from pathlib import Path

import numpy as np
from PIL import Image

from penink_cli.arrangement import detection
from penink_cli.blasting.blast import blast
from penink_cli.formats import archive, edge_list, illustration
from penink_cli.ground.model import EdgeList, GreyImage, Illustration, Layer, Strokes
from penink_cli.illustration.drawing import enlarged
from penink_cli.illustration.layering import layer_strokes
from penink_cli.options.illustrations import read_illustration, settled
from penink_cli.options.textures import find_texture
from penink_cli.outputs import postscript
from penink_cli.outputs.page import lay_out
from penink_cli.reconstruction import extraction, reduction
from penink_cli.reconstruction.enlarge import bands
from tests.blasting import measures

PHOTOGRAPHS = ("camera", "astronaut", "coffee", "coins", "chelsea")
# Grid, edges and kilobytes in the paper's Table 1, and those of an object when archives had 64 levels: at most LEAST of
# that is allowed.
STORED = (
    ("3 Pepper", 102, 128, 270, 10.5, 4.2),
    ("5 Keys", 128, 128, 504, 7.9, 5.3),
    ("4b Hand", 64, 64, 237, 2.3, 2.2),
)
LEAST = 0.8


def photograph(name: str) -> GreyImage:
    """A bundled photograph in grey."""
    import skimage.data

    grey = Image.fromarray(np.asarray(getattr(skimage.data, name)())).convert("L")
    return GreyImage(np.asarray(grey), 255)


def object_of(photo: GreyImage) -> GreyImage:
    """The middle of a photograph, an ellipse of 45 % of the page, on white: an overlay as `separate` makes it."""
    h, w = photo.values.shape
    y, x = np.mgrid[0:h, 0:w] + 0.5
    inside = (x / w - 0.5) ** 2 + (y / h - 0.5) ** 2 < 0.45 / np.pi
    return GreyImage(np.where(inside, photo.values, np.uint8(255)), 255)


def with_edges(photo: GreyImage, count: int) -> EdgeList:
    """The detector's edges at the threshold that gives as near to count of them as can be, no fewer than 97 %.

    Where a photograph has no more chains to give (an ellipse of fur has few) its chains are cut into shorter edges.
    """
    for tolerance in (0.4, 0.2, 0.1, 0.05):
        low, high = 0.0, 1.0
        best = None
        for _ in range(12):
            middle = (low + high) / 2
            found = detection.detect_edges(photo.grey, high=max(middle, 0.01), min_length=8, tolerance=tolerance)
            n = len(found.edges)
            if n >= 0.97 * count and (best is None or n < len(best.edges)):
                best = found
            if n > count:
                low = middle
            else:
                high = middle
        if best is not None:
            return edge_list.rounded(best)
    raise AssertionError("a photograph with too few edges")


def packed_size(photo: GreyImage, edges: EdgeList, columns: int, rows: int) -> int:
    """Bytes of the whole *.penink file of one layer."""
    samples = extraction.extract_samples(photo.grey, edges, None)
    reduced = GreyImage.from_grey(reduction.reduce(samples, edges, columns, rows), 255)
    layer = Layer(reduced, edges, find_texture("crosshatch"), "crosshatch")
    return len(archive.pack(illustration.members(settled(Illustration(288, 288, (layer,))))))


def storage() -> None:
    """Sizes against the paper's, with the worst of all photographs."""
    print("whole *.penink file, kilobytes of 1000 bytes; edges with strengths")
    print("| as in the paper | grid | edges | paper KB | before, allowed | object, worst | frame, worst |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for content, columns, rows, count, kilobytes, before in STORED:
        cells = []
        for make in (object_of, lambda photo: photo):
            worst = (0, "", 0)
            for name in PHOTOGRAPHS:
                photo = make(photograph(name))
                edges = with_edges(photo, count)
                worst = max(worst, (packed_size(photo, edges, columns, rows), name, len(edges.edges)))
            cells.append(f"{worst[0] / 1000:.2f} ({worst[1]}, {worst[2]} edges)")
        print(
            f"| {content} | {columns} x {rows} | {count} | {kilobytes} "
            f"| {before}, {LEAST * before:.2f} | {' | '.join(cells)} |", flush=True,
        )  # fmt: skip


def greys() -> None:
    """What is lost when samples are kept at fewer grey levels than 256, all over the picture and near edges."""
    print("PSNR of the reconstruction of 128 columns against the photograph, dB, and what fewer bits a sample cost")
    print("| photograph | 8 bits | 7 | 6 | 5 |")
    print("| --- | --- | --- | --- | --- |")
    for name in PHOTOGRAPHS:
        photo = photograph(name)
        rows, columns = photo.values.shape
        edges = with_edges(photo, 500)
        samples = extraction.extract_samples(photo.grey, edges, None)
        reduced = reduction.reduce(samples, edges, 128, round(128 * rows / columns))
        found = []
        for bits in (8, 7, 6, 5):
            levels = (1 << bits) - 1
            kept = (np.round(reduced * levels) / levels).astype(np.float32)
            large = np.concatenate(list(bands(GreyImage.from_grey(kept, 65535), edges, columns, rows, maxval=65535)))
            found.append(-10 * np.log10(np.mean((large / 65535 - photo.grey) ** 2)))
        print(f"| {name} | {found[0]:.2f} | {' | '.join(f'{v - found[0]:+.3f}' for v in found[1:])} |", flush=True)


def tone(folder: Path) -> None:
    """The two-layer illustration of keys and shadow, printed at three sizes, against its photograph."""
    whole = read_illustration(str(folder / "keys.penink"), 10**8)
    photo = GreyImage(np.asarray(Image.open(folder / "keys.png").convert("L")), 255)
    print(f"keys and shadow, {(folder / 'keys.penink').stat().st_size / 1000:.1f} KB, printed at 600 dpi")
    print("| inches | tone RMS % | bias % | worst % | width of hatching, pt: 10, 50, 90 % of it | strokes |")
    print("| --- | --- | --- | --- | --- | --- |")
    for inches in (1, 4, 24):
        parts = layer_strokes(whole, 72.0 * inches, threads=2)
        strokes = Strokes.joined([part for layer in parts for part in layer])
        rms, bias, worst = measures.tone_figures(strokes, photo.tone)
        low, middle, high = np.quantile(parts[-1][0].widths, (0.1, 0.5, 0.9))
        print(
            f"| {inches} | {rms:.2f} | {bias:+.2f} | {worst:.1f} | {low:.2f}, {middle:.2f}, {high:.2f} "
            f"| {len(strokes)} |",
            flush=True,
        )


# ------------------------------------------------------------------- Table 1

# Figure, illustration, layer; width and height that are blasted; the paper's row of the same kind.
ROWS = (
    ("1a", "cup", 0, 204, "3a Pepper | 102x128 | 270 | 10.5 | 204x256 | 0.2 | 39 | 3 | 5"),
    ("1b", "cup", 0, 408, "3b Pepper | 102x128 | 270 | 10.5 | 408x512 | 1.0 | 39 | 35 | 11"),
    ("1c", "cup", 0, 816, "3c Pepper | 102x128 | 270 | 10.5 | 816x1024 | 3.8 | 39 | 108 | 35"),
    ("3", "keys", 1, 1024, "5 Keys | 128x128 | 504 | 7.9 | 1024x1024 | 2.4 | 220 | 142 | 43"),
    ("3", "keys", 0, 1024, "5 Shadow | 64x64 | 111 | 1.5 | 1024x1024 | 2.4 | 3 | 100 | 120"),
    ("4", "billiard", 0, 568, "8 Billiard | 71x61 | 326 | 5.4 | 568x488 | 1.3 | 47 | 81 | 19"),
    ("6", "man", 0, 1024, "4b Hand | 64x64 | 237 | 2.3 | 1024x1024 | 1.0 | 19 | 130 | 41"),
)


def seconds(work) -> tuple[float, object]:  # type: ignore[no-untyped-def]
    """Time that a piece of work takes, and what it gives."""
    start = time.perf_counter()
    found = work()
    return time.perf_counter() - start, found


def table(folder: Path) -> None:
    """Each row beside the paper's of the same kind; its times are those of a 250 MHz R4400 of 1996."""
    head = "fig, content | samples | edges | KB | output px | PS MB | preproc s | enlarge s | blast s"
    print(f"| {head} | the paper's: {head} |")
    print("|" + " --- |" * 18)
    for figure, name, number, width, paper in ROWS:
        whole = read_illustration(str(folder / f"{name}.penink"), 10**8)
        layer = whole.layers[number]
        stored = len(archive.pack(illustration.members(Illustration(whole.width, whole.height, (layer,)))))
        rows, columns = layer.samples.values.shape
        size = width, round(width * whole.height / whole.width)
        # Preprocessing is what enlarging costs before its first pixel: a window of almost nothing.
        before, _ = seconds(
            lambda layer=layer, size=size: list(
                bands(layer.samples, layer.edges, *size, soften=True, window=(0, 0, 2, 2), maxval=255)
            )
        )
        large, grey = seconds(lambda layer=layer, size=size: enlarged(layer.samples, layer.edges, size, None))
        assert isinstance(grey, GreyImage)
        width_pt = width / 2.0
        drawn, strokes = seconds(
            lambda layer=layer, grey=grey, size=size: blast(
                grey.tone, size[0] / 2.0, size[1] / 2.0, layer.edges, layer.texture, threads=2
            )
        )
        out = io.BytesIO()
        postscript.write(out, [strokes], lay_out([strokes]))  # type: ignore[list-item, arg-type]
        print(
            f"| {figure} {layer.name or name} | {columns}x{rows} | {len(layer.edges.edges) if layer.edges else 0} "
            f"| {stored / 1000:.1f} | {size[0]}x{size[1]} ({width_pt / 72:.1f} in) | {out.tell() / 1e6:.2f} "
            f"| {before:.3f} | {max(0.0, large - before):.3f} | {drawn:.2f} | {paper} |", flush=True,
        )  # fmt: skip


def main() -> None:
    if sys.argv[1:2] == ["--table"]:
        table(Path(sys.argv[2]))
        return
    chosen = sys.argv[1:] or ["storage", "greys", "tone", "table"]
    made = Path(__file__).resolve().parents[2] / "samples" / "out"
    for part in chosen:
        if part in ("tone", "table") and not (made / "keys.penink").exists():
            print(f"{part}: needs the figures: make figures")
            continue
        {"storage": storage, "greys": greys, "tone": lambda: tone(made), "table": lambda: table(made)}[part]()
        print()


if __name__ == "__main__":
    main()
