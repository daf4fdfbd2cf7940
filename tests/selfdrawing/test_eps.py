"""The EPS that draws itself, in Ghostscript."""

from __future__ import annotations

import json
import re
from dataclasses import replace

import numpy as np
import pytest

from penink_cli.ground.errors import LimitError
from penink_cli.ground.model import GreyImage, Layer, OutlineChoice
from penink_cli.options.textures import find_texture
from penink_cli.selfdrawing import data, packer, postscript
from tests.selfdrawing.pictures import CROSSHATCH, expected_tone, ghostscript, illustration, printed, two_layers

CROP = ("-dEPSCrop",)


@pytest.fixture(scope="module")
def eps() -> bytes:
    return postscript.write(illustration())


def ink(page: np.ndarray) -> float:
    return float(1 - page.mean() / 255)


def test_the_devices_tone_grid_equals_enlarge():
    picture = illustration(inches=4)
    program = postscript.write(picture, "readable").decode()
    n = 288
    show = "Tone { (%stdout)(w) file exch writehexstring (\\n) print } forall\n"
    program = program.replace("  Gamma 1 ne { Curve } if\n", show)
    out = ghostscript(program.encode(), "-sDEVICE=pbmraw", "-r600", "-sOutputFile=/dev/null").decode()
    tone = np.array([list(bytes.fromhex(line)) for line in out.split()], float)
    assert tone.shape == (n, n)
    off = np.abs(tone - expected_tone(picture.layers[0], n, n))
    assert (off <= 1.5).mean() >= 0.999


@pytest.mark.parametrize("packing", ["lzw", "readable"])
def test_every_packing_draws_the_same(eps, packing, tmp_path):
    other = postscript.write(illustration(), packing)
    assert np.array_equal(printed(eps, tmp_path, 150, *CROP), printed(other, tmp_path, 150, *CROP))


@pytest.mark.parametrize("dpi", [300, 600, 1200])
def test_tone_is_that_of_the_samples_on_any_device(eps, dpi, tmp_path):
    wanted = expected_tone(illustration().layers[0], 108, 108).mean() / 255
    assert ink(printed(eps, tmp_path, dpi, *CROP)) == pytest.approx(wanted, abs=0.02)


@pytest.mark.parametrize(
    "how", ["2 2 scale", "3 0.8 scale", "60 rotate", "-1 1 scale", "1 -1 scale", "[1 .2 .3 1 0 0] concat"]
)
def test_placed_in_any_way_it_keeps_its_tone(eps, how, tmp_path):
    place = f"%!\n<< /PageSize [700 700] >> setpagedevice 350 350 translate {how} -54 -54 translate\n".encode()
    page = printed(place + eps, tmp_path, 300)
    solid = printed(place + b"0 0 108 108 rectfill showpage\n", tmp_path, 300)
    wanted = expected_tone(illustration().layers[0], 108, 108).mean() / 255
    assert ink(page) / ink(solid) == pytest.approx(wanted, abs=0.025)
    assert ((page < 255) & (solid == 255)).mean() < 0.001, "ink outside the frame"


def test_larger_means_more_strokes_not_wider_ones(eps, tmp_path):
    def edge_length(scale: int) -> tuple[float, float]:
        body = f"%!\n<< /PageSize [{108 * scale} {108 * scale}] >> setpagedevice {scale} dup scale\n".encode()
        dark = printed(body + eps, tmp_path, 300) < 128
        return float(dark.mean()), float((dark[:, 1:] != dark[:, :-1]).mean())

    (tone, edges), (tone4, edges4) = edge_length(1), edge_length(4)
    assert tone4 == pytest.approx(tone, abs=0.02)
    assert edges4 == pytest.approx(edges, rel=0.12)


def test_three_on_a_page_leave_stacks_and_dictionaries_as_found(eps):
    out = ghostscript(
        b"%!\n/showpage {} def /before countdictstack def 7\n" + eps + b"\n" + eps + b"\n2 dup scale " + eps
        + b"\ncount = countdictstack before sub = = flush\n", "-sDEVICE=pbmraw", "-r300", "-sOutputFile=/dev/null",
    )  # fmt: skip
    assert out.split() == [b"1", b"0", b"7"]


def test_twice_in_a_run_it_draws_the_same(eps, tmp_path):
    ghostscript(b"%!\n" + eps + b"\n" + eps, "-sDEVICE=pbmraw", "-r150", f"-sOutputFile={tmp_path / '%d.pbm'}")
    first, second = ((tmp_path / f"{n}.pbm").read_bytes() for n in (1, 2))
    assert first == second and len(set(first)) > 20


@pytest.mark.parametrize("name", ["stipple", "lawn", "grain"])
def test_every_kind_of_texture_keeps_its_tone(name, tmp_path):
    picture = illustration(texture=find_texture(name))
    wanted = expected_tone(picture.layers[0], 108, 108).mean() / 255
    assert ink(printed(postscript.write(picture), tmp_path, 300, *CROP)) == pytest.approx(wanted, abs=0.03)


def test_the_structuring_conventions(eps):
    lines = eps.decode("ascii").split("\n")
    assert lines[0] == "%!PS-Adobe-3.0 EPSF-3.0"
    assert "%%BoundingBox: 0 0 108 108" in lines
    assert max(map(len, lines)) <= 255
    assert "%%LanguageLevel: 2" in postscript.write(illustration(), "lzw").decode("ascii")


def test_no_name_hides_an_operator():
    text = "\n".join(packer.source(name) for name in postscript.SOURCES)
    names = sorted(set(re.findall(r"/([A-Za-z][A-Za-z0-9-]*)", re.sub(r"%.*", "", text))) - {"ge", "currentpagedevice"})
    asked = "".join(f"systemdict /{name} known {{ ({name} ) print }} if\n" for name in names)
    assert len(names) > 200
    assert ghostscript(f"%!\n{asked}".encode(), "-dNODISPLAY") == b""


def test_the_program_changes_no_device():
    text = "".join(packer.source(name) for name in postscript.SOURCES)
    for operator in ("setpagedevice", "showpage", "initgraphics", "initclip", "copypage", "erasepage", "grestoreall"):
        assert not re.search(rf"\b{operator}\b", text), operator


def test_outlines_are_drawn_and_weigh_in_the_tone(tmp_path):
    outlined = printed(postscript.write(illustration(outline=OutlineChoice(pen_pt=1.5))), tmp_path, 300, *CROP)
    plain = printed(postscript.write(illustration()), tmp_path, 300, *CROP)
    assert not np.array_equal(outlined, plain)
    # the top of the disc, where the outline runs through light hatching
    y, x = round(300 * 1.5 * 0.23), round(300 * 1.5 * 0.4)
    assert (outlined[y - 3 : y + 4, x - 8 : x + 8] < 128).any(axis=0).all()


@pytest.mark.parametrize("below", ["crosshatch", "stipple"])
def test_tones_of_layers_add_up(below, tmp_path):
    picture = two_layers(find_texture(below), find_texture("crosshatch"), inches=3)
    page = 1 - printed(postscript.write(picture), tmp_path, 600, *CROP) / 255
    total = sum(1 - layer.samples.values / 63 for layer in picture.layers)
    blocks = page[:1800, :1800].reshape(10, 180, 10, 180).mean(axis=(1, 3))
    wanted = total.reshape(10, 4, 10, 4).mean(axis=(1, 3))
    within = np.s_[3:7, 3:7]  # the square; tones there are .42 to .68
    assert np.abs(blocks - wanted)[within].mean() < 0.02
    assert (blocks - wanted)[within].mean() == pytest.approx(0, abs=0.012)
    around = np.ones((10, 10), bool)
    around[2:8, 2:8] = False
    assert (blocks - wanted)[around].mean() == pytest.approx(0, abs=0.012)


def test_outlines_are_those_of_the_regions_chosen():
    found = {}
    for regions in ((), ((256.0, 288.0),), ((620.0, 30.0),)):
        (layer,) = data.layers(illustration(outline=OutlineChoice(pen_pt=1.0, regions=regions)))
        found[regions] = layer.outlined
    within, without = list(found.values())[1:]
    assert found[()] == 2  # the disc, and the crease
    assert within == 1  # the disc alone is around what is in it
    assert without == 2


def test_too_many_samples_are_refused_in_one_line():
    picture = illustration()
    layer = replace(picture.layers[0], samples=GreyImage(np.zeros((255, 10), np.uint8), 63), edges=None)
    with pytest.raises(LimitError, match="layer 1: 10 x 255 samples"):
        postscript.write(replace(picture, layers=(layer,)))


def test_a_damaged_illustration_is_refused(tmp_path):
    from penink_cli.main import _run

    (tmp_path / "a.penink").write_bytes(b"PK\x03\x04 nothing")
    assert _run(["to-ps", "--self", str(tmp_path / "a.penink"), "-o", str(tmp_path / "a.eps")]) == 1
    assert _run(["to-html", str(tmp_path / "a.penink"), "-o", str(tmp_path / "a.html")]) == 1
    assert not (tmp_path / "a.eps").exists() and not (tmp_path / "a.html").exists()


@pytest.mark.parametrize("command", [["to-ps", "--self"], ["to-html"]])
def test_more_pixels_than_allowed_are_refused(command, tmp_path, capfd):
    from penink_cli.main import _run

    (tmp_path / "a.pgm").write_bytes(b"P5 40 30 255\n" + bytes(1200))
    manifest = {"format": "penink-illustration", "version": 1, "width": 72, "height": 54}
    manifest["layers"] = [{"samples": "a.pgm", "texture": "crosshatch"}]
    (tmp_path / "a.illustration.json").write_text(json.dumps(manifest))
    call = [*command, str(tmp_path / "a.illustration.json"), "-o", str(tmp_path / "out")]
    assert _run([*call, "--max-pixels", "1199"]) == 1
    assert "declares 40 x 30 pixels; at most 1199" in capfd.readouterr().err
    assert not (tmp_path / "out").exists()
    assert _run([*call, "--max-pixels", "1200"]) == 0


@pytest.mark.parametrize("size", [0, 1, 700, 9000])
def test_lzw_is_undone_by_a_device(size):
    data = bytes(np.random.default_rng(size).integers(97, 100, size, np.uint8))
    program = b"""%!
/O (%stdout) (w) file def
{ /F currentfile /ASCII85Decode filter /LZWDecode filter def { F read { O exch write } { exit } ifelse } loop } exec
"""
    assert ghostscript(program + packer.ascii85(packer.lzw(data)), "-dNODISPLAY") == data


def test_slow_ramps_of_few_levels_have_no_stairs():
    """What a device is sent of a ramp in 16 levels is nearer to the ramp than the levels are, by more than half."""
    x = (np.arange(128) + 0.5) / 128
    ramp = np.tile(0.3 + 0.3 * x, (96, 1))
    kept = GreyImage(np.rint(15 * ramp).astype(np.uint8), 15)
    sent, _ = data.as_sent(Layer(kept, None, CROSSHATCH, levels=16))
    inner = (slice(8, -8), slice(24, -24))  # the first and last levels have a neighbour on one side only
    stairs, eased = (np.sqrt(np.mean((image.grey - ramp)[inner] ** 2)) for image in (kept, sent))
    assert eased < 0.4 * stairs
