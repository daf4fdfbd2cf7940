"""render, draw and separate, as processes: the same bytes as the chain, whatever the form of the illustration."""

from __future__ import annotations

import io
import json
import re
import shlex
import subprocess
import sys
import zipfile
import zlib

import jsonschema
import numpy as np
import pytest
from PIL import Image
from scipy.ndimage import gaussian_filter

from tests.conftest import ROOT, environment
from tests.formats.photo_cases import cases


def strokes(text: bytes) -> list[dict]:
    return [json.loads(line) for line in text.splitlines()]


def ran(done) -> bytes:
    assert done.returncode == 0 and not done.stderr, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def photo(tmp_path_factory):
    """A small photograph: a disc on a gradient, blurred as a camera would."""
    y, x = np.mgrid[0:120, 0:160] + 0.5
    grey = np.where(np.hypot(x - 70, y - 60) < 35, 0.25 + 0.002 * y, 0.9 - 0.002 * x)
    path = tmp_path_factory.mktemp("photo") / "disc.png"
    Image.fromarray(np.uint8(gaussian_filter(grey, 0.7) * 255)).save(path)
    return path


def test_packed_and_loose_give_the_same_strokes_and_a_size_of_ones_own(penink, loose, tmp_path):
    packed = ran(penink("pack", loose))
    first = ran(penink("render", loose, "--width", "2in"))
    assert ran(penink("render", "--width", "144", "--threads", 1, input=packed)) == first
    with zipfile.ZipFile(io.BytesIO(packed)) as z:
        z.extractall(tmp_path / "out")
    assert ran(penink("render", tmp_path / "out" / "illustration.json", "--scale", 1.5)) == first
    head = strokes(first)[0]
    assert (head["width"], head["height"]) == (144, 96)


def test_one_layer_alone_is_what_it_is_among_the_others(penink, loose):
    every = strokes(ran(penink("render", loose)))
    shade = strokes(ran(penink("render", loose, "--layer", "shade")))
    other = strokes(ran(penink("render", loose, "--layer", 2)))
    assert shade[0]["layer"] == "shade" and shade[0]["texture"] == "parallel"
    assert shade[1:] + other[1:] == every[1:]
    done = penink("render", loose, "--layer", "nobody")
    assert done.returncode == 1 and b"there are 1 shade, 2" in done.stderr


def test_the_manifest_written_obeys_its_schema(penink, loose):
    schema = json.loads((ROOT / "penink_cli/formats/schemas/illustration.schema.json").read_text())
    jsonschema.validate(json.loads(loose.read_text()), schema)
    with zipfile.ZipFile(io.BytesIO(ran(penink("pack", loose)))) as z:
        jsonschema.validate(json.loads(z.read("illustration.json")), schema)


REJECTED = [
    ({"width": 0}, "width is 0"),
    ({"width": True}, "width is true"),
    ({"layers": []}, "0 layers; 1 to 64"),
    ({"layers": [3]}, "layer 0 is 3"),
    ({"layers": [{}]}, "samples"),
    ({"layers": [{"samples": ""}]}, "relative"),
    ({"layers": [{"samples": "/etc/passwd"}]}, "relative"),
    ({"layers": [{"samples": "none.pgm"}]}, "No such file"),
    ({"layers": [{"samples": "two.illustration.json"}]}, "layer 0: samples"),
    ({"layers": [{"samples": "square.pgm", "edges": "square.pgm"}]}, "layer 0: edges"),
    ({"layers": [{"samples": "square.pgm", "texture": "velvet"}]}, "no texture velvet"),
    ({"layers": [{"samples": "square.pgm", "rule": "worst"}]}, "known are best"),
    ({"layers": [{"samples": "square.pgm", "pen": 0}]}, "pen is 0"),
    ({"layers": [{"samples": "square.pgm", "levels": 1}]}, "levels is 1"),
    ({"layers": [{"samples": "square.pgm", "seed": 1.5}]}, "seed is 1.5"),
    ({"layers": [{"samples": "square.pgm", "outline": True}]}, "outline is true"),
    ({"layers": [{"samples": "square.pgm", "outline": {"even": 1}}]}, "even is 1"),
    ({"layers": [{"samples": "square.pgm", "outline": {"regions": [[1]]}}]}, "region 0"),
]


def test_bad_manifests_are_refused(loose):
    from penink_cli.ground.errors import PeninkError
    from penink_cli.options.illustrations import read_illustration

    good = json.loads(loose.read_text())
    for change, reason in REJECTED:
        loose.write_text(json.dumps({**good, **change}))
        with pytest.raises(PeninkError) as raised:
            read_illustration(str(loose), 10**6)
        assert reason in str(raised.value) and str(raised.value).startswith(str(loose)), (change, str(raised.value))


THIN = '<svg xmlns="http://www.w3.org/2000/svg" width="48" height="48"><line x1="3" y1="3" x2="40" y2="40"/></svg>'


@pytest.fixture(scope="module")
def noise(tmp_path_factory):
    """A photograph that no grid represents, and that has no edge worth an outline."""
    path = tmp_path_factory.mktemp("photo") / "noise.png"
    Image.fromarray(np.random.default_rng(1).integers(0, 256, (75, 100), np.uint8)).save(path)
    return path


@pytest.mark.parametrize("picture", ["photo", "noise"])
def test_draw_gives_the_bytes_of_the_chain_it_prints(penink, picture, request, tmp_path):
    photo = request.getfixturevalue(picture)
    done = penink("draw", photo, "--width", "2in", "--verbose", "-o", "drawn.eps", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    direct = (tmp_path / "drawn.eps").read_bytes()
    assert ran(penink("draw", photo, "--width", "2in", "--threads", 1)) == direct
    chain = f'penink() {{ {shlex.quote(sys.executable)} -m penink_cli "$@"; }}\nset -euo pipefail\n'
    chain += done.stderr.decode().replace("drawn.eps", "chained.eps")
    assert chain.count("penink ") >= 6
    again = subprocess.run(["bash", "-c", chain], cwd=tmp_path, env=environment(), capture_output=True, check=False)
    assert again.returncode == 0 and not again.stderr, again.stderr
    assert (tmp_path / "chained.eps").read_bytes() == direct


CHAINS = {
    "d.svg": ("--color", "sepia", "--color", "#123", "--paper", "a5", "--margin", "1cm", "--order"),
    "d.pdf": ("--texture", "parallel", "--pen", "0.4", "--gamma", "1.2", "--seed", "3", "--landscape"),
    "d.png": ("--strength", "0.7", "--mix", "0.2,0.7,0.1", "--vignette", "20", "--no-outlines", "--threads", "3"),
    "d.penink": ("--target", "spot", "--texture", "stipple"),
    "d.html": ("--height", "1in", "--outlines"),
    "d.jsonl": ("--style", "engraving"),
    "d.ps": ("--style", "fur", "--mask", "{mask}", "--directions", "{strokes}", "--no-lines", "--paper", "letter"),
}


@pytest.mark.parametrize("output", CHAINS)
def test_every_option_of_draw_is_in_the_chain_it_prints(penink, photo, output, tmp_path):
    width = () if "--height" in CHAINS[output] else ("--width", "2in")
    own = {"mask": photo.parent / "mask.pgm", "strokes": photo.parent / "strokes.svg"}
    own["mask"].write_bytes(b"P5 160 120 255\n" + bytes([255] * 80 + [0] * 80) * 120)
    own["strokes"].write_text(THIN)
    given = [option.format(**own) for option in CHAINS[output]]
    done = penink("draw", photo, *width, "--verbose", *given, "-o", output, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    direct = (tmp_path / output).read_bytes()
    (tmp_path / output).unlink()
    assert not [path for path in tmp_path.iterdir() if path.is_file()]  # nothing else is written
    chain = f'penink() {{ {shlex.quote(sys.executable)} -m penink_cli "$@"; }}\nset -euo pipefail\n'
    chain += done.stderr.decode()
    again = subprocess.run(["bash", "-c", chain], cwd=tmp_path, env=environment(), capture_output=True, check=False)
    assert again.returncode == 0 and not again.stderr, again.stderr
    assert (tmp_path / output).read_bytes() == direct


@pytest.mark.parametrize("more", [[], ["--inks", "cmyk"], ["--style", "comic", "--as", "penink"]], ids=" ".join)
def test_threads_change_nothing_of_what_is_said(penink, photographs, more):
    """Filters that run at the same time say what they have to say one after the other."""
    call = ["draw", photographs("coins"), "--width", "30pt", "--verbose", *more]
    one, three = (penink(*call, "--threads", count) for count in ("1", "3"))
    assert one.returncode == 0 and one.stderr.count(b"penink ") > 4
    assert (three.stdout, three.stderr) == (one.stdout, one.stderr)


def test_a_photo_from_standard_input_is_a_file_in_the_chain_that_draw_prints(penink, photo, tmp_path):
    """Several filters read it, and standard input has it but once."""
    data = photo.read_bytes()
    done = penink("draw", "--width", "2in", "--verbose", "-o", "d.svg", input=data, cwd=tmp_path)
    assert done.returncode == 0 and done.stderr.startswith(b"cat > photo\n") and b" - " not in done.stderr
    direct = (tmp_path / "d.svg").read_bytes()
    chain = f'penink() {{ {shlex.quote(sys.executable)} -m penink_cli "$@"; }}\nset -euo pipefail\n'
    chain += done.stderr.decode().replace("d.svg", "again.svg")
    again = subprocess.run(
        ["bash", "-c", chain], cwd=tmp_path, env=environment(), input=data, capture_output=True, check=False
    )
    assert again.returncode == 0 and not again.stderr, again.stderr
    assert (tmp_path / "again.svg").read_bytes() == direct


def test_files_of_the_user_s_are_not_those_of_the_chain(penink, photo, tmp_path):
    (tmp_path / "grey.pgm").write_bytes(pgm_bytes := b"P5 40 30 255\n" + bytes(range(256)) * 4 + bytes(176))
    done = penink("draw", "grey.pgm", "--width", "1in", "-v", "-o", "e.json.svg", cwd=tmp_path)
    assert done.returncode == 0 and b"-o drawing-grey.pgm" in done.stderr
    assert (tmp_path / "grey.pgm").read_bytes() == pgm_bytes
    assert sorted(path.name for path in tmp_path.iterdir()) == ["e.json.svg", "grey.pgm"]


def test_draw_says_what_is_of_no_use(penink, photo, tmp_path):
    for options, complaint in (
        (("--order", "-o", "d.pdf"), b"--order is of no use for .pdf"),
        (("--paper", "a4", "-o", "d.penink"), b"--paper is of no use for .penink"),
        (("--width", "1in", "--height", "1in"), b"give one of --width and --height"),
        (("--style", "velvet"), b"no style velvet; known are "),
    ):
        done = penink("draw", photo, *options, cwd=tmp_path)
        assert done.returncode in (1, 2) and complaint in done.stderr and done.stderr.count(b"\n") == 1, done.stderr
    assert not list(tmp_path.iterdir())


def test_the_ending_tells_what_is_drawn(penink, photo, tmp_path):
    begins = {"svg": b"<?xml", "pdf": b"%PDF-", "png": b"\x89PNG", "jsonl": b'{"format"', "penink": b"PK\x03\x04"}
    for ending, magic in begins.items():
        path = tmp_path / f"d.{ending}"
        ran(penink("draw", photo, "--width", "1in", "--texture", "parallel", "-o", path))
        assert path.read_bytes().startswith(magic)
    assert strokes(ran(penink("render", tmp_path / "d.penink")))[0]["width"] == 72
    done = penink("draw", photo, "-o", tmp_path / "d.doc")
    assert done.returncode == 2 and b"known endings" in done.stderr


def test_an_archive_keeps_the_lines_and_the_field_of_its_style(penink, photo, tmp_path):
    ran(penink("draw", photo, "--style", "engraving", "--width", "2in", "-o", tmp_path / "d.penink"))
    with zipfile.ZipFile(tmp_path / "d.penink") as archive:
        (layer,) = json.loads(archive.read("illustration.json"))["layers"]
    assert layer["texture"] == "engraving" and "directions" in layer and "lines" in layer
    assert layer["line"] == {"pen": 0.75, "per_inch2": 3.5}
    # and is drawn as the drawing is, of its own size
    ran(penink("draw", photo, "--style", "engraving", "--width", "2in", "-o", tmp_path / "d.jsonl"))
    direct = strokes((tmp_path / "d.jsonl").read_bytes())[1:]
    rendered = strokes(ran(penink("render", tmp_path / "d.penink")))[1:]
    ink = [sum(len(s["points"]) * s["width"] for s in found) for found in (direct, rendered)]
    assert ink[1] == pytest.approx(ink[0], rel=0.1)


def test_an_archive_swells_as_its_style_does_and_one_pen_does_not(penink, photo, tmp_path):
    for options, swells in (((), True), (("--pen", "0.4"), False)):
        ran(penink("draw", photo, "--width", "2in", *options, "-o", tmp_path / "d.penink"))
        with zipfile.ZipFile(tmp_path / "d.penink") as archive:
            (layer,) = json.loads(archive.read("illustration.json"))["layers"]
        assert layer.get("swell", 0) == swells
        ran(penink("draw", photo, "--width", "2in", "--no-lines", *options, "-o", tmp_path / "d.jsonl"))
        assert any("widths" in s for s in strokes((tmp_path / "d.jsonl").read_bytes())[1:]) == swells


def test_what_was_read_or_is_lost_is_said_in_one_line(penink, tmp_path):
    white = np.full((40, 60), 255, np.uint8)
    Image.fromarray(white).save(tmp_path / "white.png")
    lost = np.dstack([white, np.where(np.arange(60) < 30, 255, 0)[None].repeat(40, 0).astype(np.uint8)])
    Image.fromarray(lost, "LA").save(tmp_path / "lost.png")
    pages = [Image.fromarray(np.full((40, 60), v, np.uint8)) for v in (90, 200)]
    pages[0].save(tmp_path / "pages.tiff", save_all=True, append_images=pages[1:])
    dull = np.random.default_rng(0).integers(100, 140, (40, 60), np.uint8)
    Image.fromarray(dull).save(tmp_path / "dull.png")
    for name, said in (
        ("white.png", b"a drawing without a stroke"),
        ("lost.png", b"is lost on white"),
        ("pages.tiff", b"the first of 2 pages is read"),
        ("dull.png", b"of the range of grey"),
    ):
        done = penink("draw", name, "--width", "1in", "-o", "d.svg", cwd=tmp_path)
        assert done.returncode == 0 and done.stderr.count(said) == 1, done.stderr
        assert all(line.startswith(b"penink draw: warning: ") for line in done.stderr.splitlines()), done.stderr


def test_a_raw_s_preview_is_said_to_be_read(penink, tmp_path):
    case = {case.name: case.data for case in cases()}["a camera raw with a preview"]
    (tmp_path / "raw.tiff").write_bytes(case)
    done = penink("draw", "raw.tiff", "--width", "1in", "-o", "d.svg", cwd=tmp_path)
    assert done.returncode == 0 and done.stderr.count(b"a camera raw") == 1, done.stderr
    assert b"which is not read: its preview of 40 x 24 is" in done.stderr


@pytest.mark.parametrize("ending", ["svg", "pdf", "ps"])
def test_a_drawing_of_several_layers_is_drawn_in_each_output(penink, tmp_path, ending):
    """Two inks and lines, a layer each, in this order, each of its colour; what lies below shines through."""
    y, x = np.mgrid[0:80, 0:100] + 0.5
    red, blue = np.hypot(x - 35, y - 40) < 22, np.hypot(x - 65, y - 40) < 22
    photo = np.full((80, 100, 3), 255, np.uint8)
    photo[red & ~blue], photo[blue & ~red], photo[red & blue] = (200, 40, 50), (40, 60, 190), (40, 20, 60)
    Image.fromarray(photo).save(tmp_path / "photo.png")
    inks = ("--inks", "#d2232a,#1b4f9c", "--width", "1in", "-q")
    ran(penink("draw", "photo.png", *inks, "-o", f"d.{ending}", cwd=tmp_path))
    text = (tmp_path / f"d.{ending}").read_bytes()
    if ending == "svg":
        colours = re.findall(rb'inkscape:groupmode="layer" .*\n *fill="none" stroke="([^"]*)".*multiply', text)
        assert colours == [b"#d2232a", b"#1b4f9c", b"#1b4f9c"]
        assert all(b"<path" in layer for layer in text.split(b"inkscape:groupmode")[1:])
        return
    if ending == "pdf":
        parts = [zlib.decompress(part) for part in re.findall(rb"stream\r?\n(.*?)\r?\nendstream", text, re.DOTALL)]
        assert sum(b"/OC /L1 BDC\n/X1 Do\nEMC\n/OC /L2 BDC\n/X2 Do" in part for part in parts) == 1
        text = b"".join(parts)
    word = b"RG" if ending == "pdf" else b"setrgbcolor"
    found = [tuple(map(float, colour.split())) for colour in re.findall(rb"((?:[\d.]+ ){3})" + word, text)]
    wanted = [(210 / 255, 35 / 255, 42 / 255), (27 / 255, 79 / 255, 156 / 255), (27 / 255, 79 / 255, 156 / 255)]
    assert len(found) == 3
    np.testing.assert_allclose(found, wanted, atol=6e-4)


def test_a_picture_for_a_screen_has_the_photo_s_tone_as_it_is(penink, photo, tmp_path):
    wanted = np.asarray(Image.open(photo).convert("L"), dtype=float).mean()
    true = ("--style", "true", "--width", "3in")
    ran(penink("draw", photo, *true, "-o", tmp_path / "d.png"))
    assert abs(np.asarray(Image.open(tmp_path / "d.png").convert("L"), dtype=float).mean() - wanted) < 2.5
    ran(penink("draw", photo, *true, "--device-dpi", "600", "-o", tmp_path / "d.png"))  # as that printer prints it
    assert abs(np.asarray(Image.open(tmp_path / "d.png").convert("L"), dtype=float).mean() - wanted) < 5


def test_a_texture_that_cannot_be_dark_enough_is_warned_about(penink, photo, tmp_path):
    (tmp_path / "thin.svg").write_text(THIN)
    ran(penink("texture", "import", tmp_path / "thin.svg", "-o", tmp_path / "thin.texture.json"))
    done = penink("draw", photo, "-t", tmp_path / "thin.texture.json", "--width", "1in")
    assert done.returncode == 0 and b"penink draw: warning: " in done.stderr and b"darker than" in done.stderr


def test_a_drawing_has_the_tone_of_its_photo_at_every_size(penink, photo, ghostscript, tmp_path):
    ran(penink("draw", photo, "--style", "true", "--width", "1in", "-o", tmp_path / "d.penink"))
    grey = np.asarray(Image.open(photo), dtype=float) / 255
    for width in (1.5, 4):
        lines = ran(penink("render", tmp_path / "d.penink", "--width", f"{width}in"))
        drawn = ghostscript(ran(penink("to-ps", input=lines)), dpi=600, antialias=False)
        target = np.asarray(Image.fromarray(np.float32(grey)).resize(drawn.shape[::-1], Image.BILINEAR))
        error = gaussian_filter(drawn - target, 600 / 16)
        assert np.sqrt((error**2).mean()) < 0.03
        assert abs(error.mean()) < 0.01


@pytest.mark.parametrize("choice", [["--mask", "mask.png"], ["--grey", "0,0.5"], ["--point", "70,60", "-e", "e.json"]])
def test_overlays_add_up_to_the_photo(penink, photo, tmp_path, choice):
    y, x = np.mgrid[0:120, 0:160]
    Image.fromarray(np.uint8(np.clip(x * 2, 0, 255))).save(tmp_path / "mask.png")
    ran(penink("detect-edges", photo, "-o", tmp_path / "e.json"))
    one = ran(penink("separate", photo, *choice, cwd=tmp_path))
    other = ran(penink("separate", photo, *choice, "--invert", cwd=tmp_path))
    tones = [255 - np.asarray(Image.open(io.BytesIO(part)), dtype=int) for part in (one, other)]
    assert np.array_equal(tones[0] + tones[1], 255 - np.asarray(Image.open(photo), dtype=int))
    assert all((tone > 0).any() for tone in tones)
    if "--mask" not in choice:
        disc = np.hypot(x + 0.5 - 70, y + 0.5 - 60)
        assert (tones[0][disc < 33] > 0).all() and (tones[0][disc > 37] == 0).all()


def test_layers_that_share_the_page_add_up(penink, photo, tmp_path, ghostscript):
    """Two half-tone overlays of everything draw as dark as one whole layer, not darker and not lighter."""
    Image.fromarray(np.full((120, 160), 128, np.uint8)).save(tmp_path / "half.png")
    for name, invert in (("a", []), ("b", ["--invert"])):
        part = tmp_path / f"{name}.pgm"
        ran(penink("separate", photo, "--mask", tmp_path / "half.png", *invert, "-o", part))
    layers = [{"samples": "a.pgm", "texture": "parallel"}, {"samples": "b.pgm", "texture": "stipple"}]
    manifest = {"format": "penink-illustration", "version": 1, "width": 216, "height": 162, "layers": layers}
    (tmp_path / "two.json").write_text(json.dumps(manifest))
    lines = ran(penink("render", tmp_path / "two.json"))
    drawn = ghostscript(ran(penink("to-ps", input=lines)), dpi=600, antialias=False)
    grey = np.asarray(Image.open(photo).resize(drawn.shape[::-1], Image.BILINEAR), dtype=float) / 255
    error = gaussian_filter(drawn - grey, 600 / 16)
    assert abs(error.mean()) < 0.015
    assert np.sqrt((error**2).mean()) < 0.04


def test_separate_needs_one_choice(penink, photo):
    for arguments in ([], ["--mask", "m.png", "--grey", "0,1"], ["--point", "1,1"], ["--grey", "0.5,0.5"]):
        assert penink("separate", photo, *arguments).returncode == 2


@pytest.mark.parametrize(
    "style", sorted(path.name.split(".")[0] for path in (ROOT / "penink_cli/styles").glob("*.json"))
)
def test_a_drawing_says_for_which_printer_it_is(penink, photo, tmp_path, style):
    """Whatever it is made of: else a screen would draw it thinner than the printer does."""
    for dpi in (300, None):
        drawn = penink(
            "draw",
            photo,
            "--style",
            style,
            "--width",
            "1in",
            "-q",
            "--device-dpi",
            dpi or "none",
            "-o",
            tmp_path / "d.jsonl",
        )
        assert drawn.returncode == 0, drawn.stderr
        with (tmp_path / "d.jsonl").open("rb") as file:
            assert json.loads(file.readline())["device_dpi"] == dpi
