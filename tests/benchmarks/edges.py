"""Edges and samples measured: ``python -m tests.benchmarks.edges`` (about ten minutes; ``--quick`` half a minute).

Or only some parts: ``python -m tests.benchmarks.edges positions strengths noisy trips heldout …``.

Positions of edges on rendered scenes; round trips photo → edges and samples reduced 4 × → photo; the
grids that --auto chooses and what they take to store; a 12-megapixel photograph; hostile inputs.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from unittest import mock

import numpy as np
import skimage.data
from PIL import Image
from scipy.ndimage import gaussian_filter, map_coordinates
from scipy.spatial import cKDTree

from penink_cli.arrangement import detection
from penink_cli.arrangement import strengths as steps
from penink_cli.arrangement.detection import detect_edges
from penink_cli.arrangement.gradient import noise_level
from penink_cli.formats import archive, edge_list, illustration, pgm, strokes
from penink_cli.geometry import validity
from penink_cli.ground.model import EdgeList, GreyImage, Illustration, Layer, Strokes
from penink_cli.options.illustrations import settled
from penink_cli.options.textures import find_texture
from penink_cli.reconstruction.camera import camera_blur
from penink_cli.reconstruction.enlarge import enlarge, reconstruct
from penink_cli.reconstruction.extraction import contaminated, extract_samples
from penink_cli.reconstruction.grid import choose_grid
from penink_cli.reconstruction.reduction import reduce
from tests.benchmarks._scenes import Scene, random_scene, true_steps
from tests.benchmarks.archives import held

PHOTOS = {"camera": 4.0, "coins": 4.0, "astronaut": 3.5, "coffee": 3.0, "chelsea": 2.5, "rocket": 2.0}
DOWN = (Image.Resampling.BOX, Image.Resampling.BILINEAR, Image.Resampling.HAMMING, Image.Resampling.BICUBIC,
        Image.Resampling.LANCZOS)  # fmt: skip
# Photographs that no constant of the detector, the extraction or the fit was chosen by.
HELD_OUT = (
    "motorcycle", "retina", "immunohistochemistry", "clock", "hubble_deep_field", "moon", "cell", "page", "text",
    "brick", "gravel", "grass", "microaneurysms",
)  # fmt: skip
UP = (Image.Resampling.BICUBIC, Image.Resampling.LANCZOS)


def photograph(name: str) -> np.ndarray:
    """A bundled photograph in grey, 0 … 1."""
    pixels = skimage.data.stereo_motorcycle()[0] if name == "motorcycle" else getattr(skimage.data, name)()
    if pixels.ndim == 3:
        pixels = np.asarray(Image.fromarray(pixels[..., :3]).convert("L"))
    return (pixels / 255).astype(np.float32)


def along(edges: EdgeList, step: float = 0.1) -> np.ndarray:
    """Points (n, 2) on the edges, evenly spaced."""
    points = []
    for a, b in edges.vertices[edges.edges]:
        n = max(1, round(np.hypot(*(b - a)) / step))
        points.append(a + (np.arange(n)[:, None] + 0.5) / n * (b - a))
    return np.concatenate(points) if points else np.zeros((0, 2))


def positions(scenes: int) -> None:
    """Positions of edges on rendered scenes."""
    position_rows(range(scenes))


def position_rows(seeds: range) -> None:
    """A line for each blur and noise, over the scenes of those seeds."""
    print("edges of rendered scenes: distance from the true curve, pixels; found, false: % of length")
    print("blur noise   median    95 %   found  false   corners  T-junctions closed")
    for blur in (0.5, 1.0, 1.5):
        for noise in (0, 2, 4):
            errors, found, corners, tees = [], [], [], []
            for seed in seeds:
                scene = random_scene(seed)
                edges = detect_edges(scene.photo(blur, noise, seed))
                curve, _ = scene.curves()
                seen = along(edges)
                errors.append(cKDTree(curve).query(seen)[0])
                inner = ((curve > 3) & (curve < scene.size - 3)).all(axis=1)
                found.append(cKDTree(seen).query(curve[inner])[0] < 1)
                ends = edges.vertices[np.bincount(edges.edges.ravel(), minlength=len(edges.vertices)) == 1]
                for places, closed in zip(scene.junctions(), (corners, tees)):
                    if len(places):
                        here = cKDTree(seen).query(places)[0] <= 1
                        closed.append(here & (cKDTree(ends).query(places)[0] > 3 if len(ends) else True))
            error, hits = np.concatenate(errors), np.concatenate(found)
            near = error[error < 1]
            corner, tee = (np.concatenate(c) if c else np.zeros(0) for c in (corners, tees))
            print(
                f"{blur:4.1f} {noise:5d} {np.median(near):8.3f} {np.quantile(near, 0.95):7.3f} {100 * hits.mean():7.1f}"
                f" {100 * (error >= 1).mean():6.1f}   {int(corner.sum())}/{len(corner)}    {int(tee.sum())}/{len(tee)}"
            )


def psnr(a: np.ndarray, b: np.ndarray, where: np.ndarray) -> float:
    """Peak signal to noise ratio, dB."""
    return float(-10 * np.log10(np.mean((a - b)[where] ** 2)))


def best_plain(photo: np.ndarray, width: int, height: int, truth: np.ndarray, where: np.ndarray) -> float:
    """The best PSNR of Pillow's filters down and up again, with samples of 8 bits as the reconstruction has them."""
    picture = Image.fromarray(photo.astype(np.float32))
    small = [np.round(np.asarray(picture.resize((width, height), d)) * 255) / 255 for d in DOWN]
    again = [Image.fromarray(s.astype(np.float32)).resize(picture.size, u) for s in small for u in UP]
    return max(psnr(np.clip(np.asarray(image), 0, 1), truth, where) for image in again)


def seen_again(samples: np.ndarray, edges: EdgeList, width: int, height: int, blur: float) -> np.ndarray:
    """Samples as 8 bits, enlarged, area-sampled with 2 × 2 points a pixel, and blurred."""
    levels = np.round(samples.astype(float) * 255) / 255
    fine = np.clip(reconstruct(levels, edges, 2 * width, 2 * height), 0, 1)
    area = fine.reshape(height, 2, width, 2).mean(axis=(1, 3))
    return gaussian_filter(area, blur) if blur else area


def round_trip(name: str) -> tuple[int, float, list[float], list[float]]:
    """Edges, blur, the best plain PSNR near edges and elsewhere, and what --fit none and lsq gain on each."""
    photo = photograph(name)
    height, width = (n - n % 4 for n in photo.shape)
    photo = photo[:height, :width]
    edges = detect_edges(photo)
    blur = camera_blur(photo, edges)
    near = contaminated(photo, edges, 3)
    plain = [best_plain(photo, width // 4, height // 4, photo, where) for where in (near, ~near)]
    clean = extract_samples(photo, edges)
    gains = []
    for fit in ("none", "lsq"):
        samples = reduce(clean, edges, width // 4, height // 4, photo=photo, fit=fit)
        again = seen_again(samples, edges, width, height, blur)
        gains += [psnr(again, photo, where) - p for where, p in zip((near, ~near), plain)]
    return len(edges.edges), blur, plain, gains


def trip_rows(photographs: dict[str, str]) -> None:
    """A line for each photograph and what is wanted of it."""
    print("photograph           edges  blur   plain (elsewhere)    --fit none        --fit lsq     lsq - none  wanted")
    for name, wanted in photographs.items():
        edges, blur, plain, gains = round_trip(name)
        print(
            f"{name:20s} {edges:5d} {blur:5.2f}  {plain[0]:6.2f} ({plain[1]:5.2f})"
            f"   {gains[0]:+6.2f} ({gains[1]:+5.2f})"
            f"  {gains[2]:+6.2f} ({gains[3]:+5.2f})   {gains[2] - gains[0]:+6.2f}   {wanted}",
            flush=True,
        )


def held_out() -> None:
    """Round trips of photographs, and positions on scenes, by which no constant was chosen."""
    print("\nheld out: reduced 4 x and enlarged again, gain over the best plain resampling, dB, near edges (elsewhere)")
    trip_rows(dict.fromkeys(HELD_OUT, ""))
    print()
    position_rows(range(100, 140))


def round_trips(scenes: int) -> None:
    """Round trips of photographs, and of rendered scenes against their sharp truth."""
    print("\nreduced 4 x and enlarged again, gain over the best plain resampling, dB, within 3 px of edges (elsewhere)")
    trip_rows({name: f"{wanted:+.1f}" for name, wanted in PHOTOS.items()})
    print("rendered scenes, against the sharp truth")
    for blur, noise in ((0.5, 0), (1.0, 0), (1.0, 2), (1.5, 4)):
        rows = []
        for seed in range(scenes):
            scene = random_scene(seed)
            photo, truth, n = scene.photo(blur, noise, seed).astype(np.float32), scene.sharp(), scene.size
            edges = detect_edges(photo)
            near = contaminated(photo, edges, 3)
            plain = best_plain(photo, n // 4, n // 4, truth, near)
            clean = extract_samples(photo, edges)
            fitted = [reduce(clean, edges, n // 4, n // 4, photo=photo, fit=fit) for fit in ("none", "lsq")]
            rows.append([psnr(seen_again(s, edges, n, n, 0), truth, near) - plain for s in fitted])
        none, lsq = np.mean(rows, axis=0)
        print(
            f"blur {blur} noise {noise}    none {none:+6.2f}   lsq {lsq:+6.2f}   wanted {8 if blur <= 1 else 6.5:+.1f}"
        )


def storage() -> None:
    """The grid that --auto chooses, bytes of the illustration packed, and of its PostScript.

    PostScript is measured twice: as `to-ps` writes it, which is compact, and with plain path operators, as in the
    paper's time. Dots do not end at edges, so 24 inches have sixteen times as many as 6; the first photograph shows
    that.
    """
    print("\n--auto --max-error 8: the grid, and the illustration packed")
    print("its PostScript at 24 in, as to-ps writes it and as moveto, lineto, curveto and stroke with two decimals")
    for name in PHOTOS:
        photo = photograph(name)
        edges = detect_edges(photo)
        start = time.process_time()
        grid = choose_grid(extract_samples(photo, edges), edges, photo=photo)
        seconds = time.process_time() - start
        height, width = grid.samples.shape
        samples = GreyImage.from_grey(grid.samples)
        layer = Layer(samples, edges, find_texture("stipple"), "stipple")
        packed = archive.pack(illustration.members(settled(Illustration(576, 576 * height / width, (layer,)))))
        members = held(packed)
        print(
            f"{name:10s} {width} x {height} (factor {photo.shape[1] / width:.1f}), error {255 * grid.error:.2f}, "
            f"{grid.empty_regions} empty regions, "
            f"{len(packed) / 1e3:.1f} kB (samples {len(members['samples']) / 1e3:.1f},"
            f" {len(edges.edges)} edges {len(members['edges']) / 1e3:.1f}), found in {seconds:.1f} s of processor",
            flush=True,
        )
        drawings = {
            "crosshatch": _paper(samples, edges, "crosshatch", 24),
            "stipple, 16 times 6 in": [16 * size for size in _paper(samples, edges, "stipple", 6)],
        }
        if name == next(iter(PHOTOS)):
            drawings["stipple"] = _paper(samples, edges, "stipple", 24)
        for texture, (compact, plain) in drawings.items():
            print(
                f"{'':10s} {texture}: {compact / 1e6:.1f} MB = {compact / len(packed):.0f} x,"
                f" plain {plain / 1e6:.1f} MB = {plain / len(packed):.0f} x",
                flush=True,
            )


def _paper(samples: GreyImage, edges: EdgeList, texture: str, inches: int) -> tuple[int, int]:
    """Bytes of the PostScript of that width: as `to-ps` writes it, and by plain operators."""
    with tempfile.TemporaryDirectory() as folder:
        where = Path(folder)
        with open(where / "s.pgm", "wb") as out:
            pgm.write(out, samples)  # type: ignore[arg-type]
        with open(where / "e.json", "wb") as out:
            edge_list.write(out, edges)  # type: ignore[arg-type]
        penink = f"{sys.executable} -m penink_cli"
        subprocess.run(
            f"{penink} enlarge -q -e e.json --scale 8 s.pgm | {penink} blast -q --texture {texture} --width {inches}in"
            f" -o p.strokes.jsonl && {penink} to-ps -q p.strokes.jsonl -o p.ps",
            shell=True, check=True, cwd=where,
        )  # fmt: skip
        with open(where / "p.strokes.jsonl", "rb") as stream:
            return (where / "p.ps").stat().st_size, plain_postscript(strokes.read(stream, "p.strokes.jsonl"))


def plain_postscript(drawing: Strokes) -> int:
    """Bytes of a program that draws each stroke by moveto, lineto or curveto, and stroke; the pen where it changes."""
    size, pen = 0, 0.0
    for i, width in enumerate(drawing.widths):
        points = drawing[i].tolist()
        program = "" if width == pen else f"{width:g} setlinewidth\n"
        program += "{:.2f} {:.2f} moveto\n".format(*points[0])
        if len(points) == 1:
            program += "{:.2f} {:.2f} lineto\n".format(*points[0])
        for k in range(3, len(points), 3):
            before, first, second, to = points[k - 3 : k + 1]
            if _straight(before, first, to) and _straight(before, second, to):
                program += "{:.2f} {:.2f} lineto\n".format(*to)
            else:
                program += "{:.2f} {:.2f} {:.2f} {:.2f} {:.2f} {:.2f} curveto\n".format(*first, *second, *to)
        size += len(program) + len("stroke\n")
        pen = width
    return size


def _straight(a: list[float], b: list[float], c: list[float]) -> bool:
    """Whether b lies within 1/50 point of the line from a to c."""
    x, y = c[0] - a[0], c[1] - a[1]
    return abs(x * (b[1] - a[1]) - y * (b[0] - a[0])) <= 0.02 * (x * x + y * y) ** 0.5


def large() -> None:
    """Twelve megapixels: a photograph with noise, one that is all edges, one that is all texture; time by the pixel."""
    random = np.random.default_rng(0)
    base = Image.fromarray(np.uint8(photograph("astronaut") * 255)).resize((4000, 4000), Image.Resampling.BICUBIC)
    mosaic = np.kron(random.integers(0, 256, (600, 800)), np.ones((5, 5))).astype(np.uint8)
    pictures = {
        "astronaut": np.uint8(np.clip(np.round(np.asarray(base)[:3000] + random.normal(0, 2, (3000, 4000))), 0, 255)),
        "mosaic": mosaic,
        "grass": np.tile(np.uint8(photograph("grass") * 255), (6, 8))[:3000, :4000],
    }
    print("\ntwelve megapixels and a quarter of them, wanted 10 s and 1000 MB: s, s of processor, MB")
    with tempfile.TemporaryDirectory() as folder:
        for name, pixels in pictures.items():
            small, whole = _filters(pixels[:1500, :2000], folder), _filters(pixels, folder)
            for command in whole:
                wall, processor, memory = whole[command]
                print(
                    f"{name:10s} {command:16s} {wall:5.1f} {processor:6.1f} {memory:6.0f}"
                    f"   {processor / small[command][1] / 4:.2f} times the processor time a pixel of a quarter"
                )
            wall, processor = (sum(figures[k] for figures in whole.values()) for k in (0, 1))
            print(f"{name:10s} together         {wall:5.1f} {processor:6.1f} {max(f[2] for f in whole.values()):6.0f}")


def mosaics() -> None:
    """Large photographs that are nothing but details: many small photographs side by side, drawn by all of `draw`."""
    print("\nmosaics of photographs drawn: megapixels, s of processor, MB, KB of drawing")
    tiles = [Image.fromarray(np.uint8(photograph(name) * 255)).resize((240, 160)) for name in PHOTOS]
    for width, height in ((3840, 2560), (6000, 4000)):
        mosaic = Image.new("L", (width, height))
        for k in range(-(-width // 240) * -(-height // 160)):
            row, column = divmod(k, -(-width // 240))
            mosaic.paste(tiles[(k * 7 + row) % len(tiles)], (240 * column, 160 * row))
        with tempfile.TemporaryDirectory() as folder:
            mosaic.save(Path(folder) / "p.jpg", quality=90)
            for style in ("true", "house"):
                command = [sys.executable, "-m", "penink_cli", "draw", "p.jpg", "--style", style, "-o", "d.ps"]
                process = subprocess.Popen([*command, "--width", "10in"], cwd=folder)
                _, status, usage = os.wait4(process.pid, 0)
                assert status == 0
                size, spent = (Path(folder) / "d.ps").stat().st_size, usage.ru_utime + usage.ru_stime
                print(f"{width} x {height} {style:6} {width * height / 1e6:5.0f}", end="")
                print(f"{spent:7.1f}{usage.ru_maxrss / 1e3:7.0f}{size / 1000:8.0f}", flush=True)


def _filters(pixels: np.ndarray, folder: str) -> dict[str, tuple[float, float, float]]:
    """Seconds, seconds of processor and megabytes of each filter."""
    Image.fromarray(pixels).save(Path(folder) / "p.png")
    figures = {}
    for command in (
        "detect-edges p.png -o e.json",
        "extract-samples -e e.json p.png -o s.pgm",
        "reduce -e e.json --photo p.png --factor 4 s.pgm -o r.pgm",
    ):
        start = time.perf_counter()
        process = subprocess.Popen([sys.executable, "-m", "penink_cli", *command.split()], cwd=folder)
        _, status, usage = os.wait4(process.pid, 0)
        assert status == 0
        wall = time.perf_counter() - start
        figures[command.split()[0]] = wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1e3
    return figures


def hostile(count: int) -> None:
    """Hostile pictures: whatever the detector finds in them must be an arrangement."""
    random = np.random.default_rng(1)
    photos = [photograph(name) for name in PHOTOS]
    edge_count = 0
    telling = detection.TELLING
    for k in range(count):
        height, width = random.integers(1, 70, 2)
        if k % 4 == 0:
            grey = random.random((height, width))
        elif k % 4 == 1:
            grey = (random.random((height, width)) < random.random()).astype(float)
        elif k % 4 == 2:
            photo = photos[random.integers(len(photos))]
            top, left = random.integers(0, photo.shape[0] - 70), random.integers(0, photo.shape[1] - 70)
            grey = photo[top : top + height, left : left + width]
        else:
            y, x = np.mgrid[:height, :width]
            a, b, c = random.uniform(0, 2), random.uniform(0, 2), random.uniform(0, 0.05)
            grey = 0.5 + 0.5 * np.sin(a * x + b * y + c * (x * x + y * y))
        detection.TELLING = telling if k % 3 == 0 else 0.0  # texture and noise left in: the hard case
        edges = detect_edges(
            grey, sigma=random.uniform(0.5, 2), high=10 ** random.uniform(-2.5, -0.3),
            tolerance=10 ** random.uniform(-1.5, 1), min_length=random.uniform(0, 8),
        )  # fmt: skip
        edge_count += len(edges.edges)
        edges = edge_list.rounded(edges)
        edge_list.check(edges)
        validity.check(edges)
        if k % 20 == 0:
            enlarge(GreyImage.from_grey(grey), edges, 2 * width, 2 * height)
    detection.TELLING = telling
    print(f"\n{count} hostile inputs, {edge_count} edges, every list accepted")


def strengths(scenes: int) -> None:
    """How far strengths are from the scene's own step, on rendered scenes; and what no measure could tell better.

    The truth is the step of the noiseless scene at the outline nearest to the middle of each edge, within a pixel. "as
    told" are the detector's strengths, "samples" the difference of clean samples 1½ pixels to either side of the
    middle. The other columns are parts of the edges. "spread": the truth itself is unsure, for the scene's greys ½, 1
    or 1½ pixels to both sides of the middle differ by more than .02 from the step of the nearest outline; that is so
    near junctions, where one edge is nearest to another's outline. "unblamed": strengths as told that are off where the
    truth has no such spread. "noise": a photo of the same scene with other noise gives the edge a strength that differs
    by more than .02. "noiseless" and "sharp": strengths of the same edges that are off on the same blurred photo
    without noise, and on one without noise or blur; their error lies in the edges.
    """
    print("strengths: part of the edges off by more than .02, the median and 95 % of how far off")
    print("blur noise  edges       as told                samples           spread unblamed  noise noiseless sharp")
    for blur, noise in ((0.5, 0), (0.6, 1), (1.0, 2), (1.5, 4)):
        told, sampled, steady, again, clean, sharp = [], [], [], [], [], []
        for seed in range(scenes):
            scene = random_scene(seed)
            photo = scene.photo(blur, noise, seed).astype(np.float32)
            edges = detect_edges(photo)
            assert edges.strength is not None
            near, truth = true_steps(scene, edges)
            told.append(np.abs(edges.strength - truth)[near])
            sampled.append(np.abs(sampled_steps(photo, edges) - truth)[near])
            direct = np.stack([direct_steps(scene, edges, off) for off in (0.5, 1.0, 1.5)])
            steady.append((np.abs(direct - truth).max(axis=0) <= 0.02)[near])
            other = measured(scene.photo(blur, noise, seed + 1000).astype(np.float32), edges, blur)
            again.append(np.abs(other - measured(photo, edges, blur))[near])
            clean.append(np.abs(measured(scene.photo(blur, 0).astype(np.float32), edges, blur) - truth)[near])
            sharp.append(np.abs(measured(scene.sharp().astype(np.float32), edges, 0.0) - truth)[near])
        columns = "".join(
            f"   {np.mean(far > 0.02):6.1%}{np.median(far):7.4f}{np.percentile(far, 95):7.4f}"
            for far in (np.concatenate(told), np.concatenate(sampled))
        )
        sure = np.concatenate(steady)
        off, moved, left, own = (np.concatenate(far) > 0.02 for far in (told, again, clean, sharp))
        columns += f"   {1 - sure.mean():6.1%}{np.mean(off & sure):9.1%}{moved.mean():7.1%}{left.mean():10.1%}"
        print(f"{blur:4.1f}{noise:6}{sum(map(len, told)):7}{columns}{own.mean():6.1%}", flush=True)


WAYS: dict[str, dict[str, object]] = {
    "near alone": {"_BEYOND": (4.5,), "_NEIGHBOURS": 0},
    "8 px alone": {"_BEYOND": (8.0,), "_NEIGHBOURS": 0},
    "and farther": {"_NEIGHBOURS": 0},
    "neighbours": {"_BEYOND": (4.5,)},
    "both": {},
}


def noisy() -> None:
    """What averaging does to strengths on photographs: at half size, noise added that was not there.

    Errors are from the strengths that near pixels tell without the noise. A longer reach alone would average out more
    noise on scenes of planes; on photographs it reaches other things.
    """
    print("noisy: part of the edges off by more than .02, and by how much, RMS")
    print("photograph   noise  " + "".join(f"{way:>19}" for way in WAYS))
    for name in ("camera", "coins", "astronaut", "coffee", "chelsea"):
        pixels = Image.fromarray((photograph(name) * 255).astype(np.uint8)).reduce(2)
        photo = np.asarray(pixels, np.float32)[:256, :256] / 255
        for levels in (0, 2, 4):
            noise = np.random.default_rng(1).normal(0, levels / 255, photo.shape)
            noisy = np.clip(photo + noise, 0, 1).astype(np.float32)
            edges = detect_edges(noisy)
            own = measured(photo, edges, 0.8, **WAYS["near alone"])
            line = ""
            for way in WAYS.values():
                moved = np.abs(measured(noisy, edges, 0.8, **way) - own)[own >= 0]
                line += f"{np.mean(moved > 0.02):11.1%}{np.sqrt(np.mean(moved * moved)):8.4f}"
            print(f"{name:12}{levels:6}  {line}", flush=True)


def direct_steps(scene: Scene, edges: EdgeList, off: float) -> np.ndarray:
    """The difference (m,) of a scene's greys so far (pixels) to either side of the middle of each edge."""
    a, b = edges.vertices[edges.edges[:, 0]], edges.vertices[edges.edges[:, 1]]
    along = (b - a) / np.maximum(np.hypot(*(b - a).T), 1e-9)[:, None]
    aside = off * np.column_stack([-along[:, 1], along[:, 0]])
    return np.abs(scene.truth(*((a + b) / 2 + aside).T) - scene.truth(*((a + b) / 2 - aside).T))


def measured(photo: np.ndarray, edges: EdgeList, lens: float, **way: object) -> np.ndarray:
    """Strengths (m,) of given edges. way: constants of strengths.py, by name, that are to have other values."""
    with mock.patch.multiple(steps, **{"_ALIKE": steps._ALIKE, **way}):
        return steps.strengths(photo, edges, lens, noise_level(photo))


def sampled_steps(photo: np.ndarray, edges: EdgeList) -> np.ndarray:
    """The difference (m,) of clean samples 1½ pixels to either side of the middle of each edge."""
    clean = np.asarray(extract_samples(photo, edges), np.float64)
    a, b = edges.vertices[edges.edges[:, 0]], edges.vertices[edges.edges[:, 1]]
    along = (b - a) / np.maximum(np.hypot(*(b - a).T), 1e-9)[:, None]
    normal = np.column_stack([-along[:, 1], along[:, 0]])
    sides = [map_coordinates(clean, ((a + b) / 2 + s * 1.5 * normal)[:, ::-1].T - 0.5, order=1, mode="nearest")
             for s in (-1, 1)]  # fmt: skip
    return np.abs(sides[1] - sides[0])


PARTS = {
    "positions": positions,
    "strengths": strengths,
    "noisy": noisy,
    "trips": round_trips,
    "heldout": held_out,
    "hostile": hostile,
    "storage": storage,
    "large": large,
    "mosaics": mosaics,
}


def main() -> None:
    """Print the tables."""
    chosen = [name for name in sys.argv[1:] if name in PARTS]
    quick = "--quick" in sys.argv
    counts = {"positions": 8, "strengths": 20, "trips": 5, "hostile": 10_000}
    if quick:
        counts = {"positions": 3, "strengths": 4, "trips": 2, "hostile": 500}
    for name in chosen or (counts if quick else PARTS):
        PARTS[name](*([counts[name]] if name in counts else []))  # type: ignore[operator]


if __name__ == "__main__":
    main()
