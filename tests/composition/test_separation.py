"""Separation into inks: nearest colours by the model, least ink, plates through the filters."""

from __future__ import annotations

import io
import json

import numpy as np
import pytest
import skimage.color
from PIL import Image

from penink_cli.composition import separation
from penink_cli.formats import pgm
from penink_cli.ground.colour import lab_of_light, linear
from penink_cli.options.inks import CMYK

SPOTS = ((0.11, 0.31, 0.61), (0.82, 0.14, 0.16), (0.95, 0.8, 0.2))


def off(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Distance in Lab of light (m, 3) each."""
    return np.sqrt(((lab_of_light(one) - lab_of_light(other)) ** 2).sum(axis=1))


def test_lab_is_cies():
    colours = np.random.default_rng(0).random((500, 3))
    assert np.abs(lab_of_light(linear(colours)) - skimage.color.rgb2lab(colours)).max() < 0.02


@pytest.mark.parametrize("black", [0.0, 0.5, 1.0])
def test_what_the_inks_can_print_is_found_again(black):
    amount = np.random.default_rng(1).random((4, 800)) ** 1.5
    amount[3] *= 0.5
    light = separation.printed(amount, CMYK.colours)
    found = separation.solved(light, CMYK.colours, black=black)
    assert ((found >= 0) & (found <= 1)).all()
    error = off(separation.printed(found, CMYK.colours), light)
    assert np.percentile(error, 99) < (0.6 if black else 1.5)
    assert error.mean() < 0.1


def test_no_mixture_of_spot_inks_is_nearer():
    light = linear(np.random.default_rng(2).random((150, 3)))
    found = off(separation.printed(separation.solved(light, SPOTS), SPOTS), light)
    steps = np.linspace(0, 1, 33)
    every = np.stack(np.meshgrid(steps, steps, steps, indexing="ij")).reshape(3, -1)
    tried = lab_of_light(separation.printed(every, SPOTS))
    nearest = np.array([np.sqrt(((tried - lab) ** 2).sum(axis=1)).min() for lab in lab_of_light(light)])
    assert np.percentile(found - nearest, 95) < 0.1
    assert found.mean() < 1.01 * nearest.mean()


def test_black_does_its_share_and_saves_ink():
    greys = linear(np.repeat(np.linspace(0.3, 0.95, 14)[:, None], 3, axis=1))
    shares = [separation.solved(greys, CMYK.colours, black=share) for share in (0.0, 0.5, 1.0)]
    assert shares[0][3].max() < 0.1
    assert shares[2][:3].max() < 0.12
    assert (np.diff([s.sum() for s in shares]) < 0).all()


def test_the_paper_counts():
    paper = (0.9, 0.85, 0.7)
    amount = separation.solved(linear(np.array([paper])), CMYK.colours, paper)
    assert amount.max() < 0.01
    on_white = separation.solved(linear(np.array([paper])), CMYK.colours)
    assert on_white[2, 0] > 0.1


def test_between_the_grid_amounts_are_as_good():
    rng = np.random.default_rng(3)
    values = rng.integers(0, 256, (40, 40, 3)).astype(np.uint8)
    light = linear(values.reshape(-1, 3) / 255.0)
    quick = separation.amounts(values, 255, CMYK.colours).reshape(4, -1)
    exact = separation.solved(light, CMYK.colours)
    worse = off(separation.printed(quick, CMYK.colours), light) - off(separation.printed(exact, CMYK.colours), light)
    assert worse.mean() < 0.15
    assert np.percentile(worse, 99) < 1.5
    deep = separation.amounts(values.astype(np.uint16) * 257, 65535, CMYK.colours).reshape(4, -1)
    assert np.abs(deep - quick).max() < 1e-9


@pytest.mark.parametrize("apart", [[0.0], [0.0, 50.0, 0.0], [0.0, 90.0], [0.0, 90.0, 45.0, -45.0]])
@pytest.mark.parametrize("inks", range(2, 7))
def test_hatching_of_two_inks_is_never_within_15_degrees(apart, inks):
    turns = separation.turns(apart, inks)
    first = np.array(turns) % 180
    gap = np.abs(first[:, None] - first)[~np.eye(inks, dtype=bool)]
    assert np.minimum(gap, 180 - gap).min() >= 15
    if inks <= 4 and len(set(apart)) <= 2:
        every = [(t + a) % 180 for t in turns for a in set(apart)]
        gap = np.abs(np.subtract.outer(every, every))[~np.eye(len(every), dtype=bool)]
        assert np.minimum(gap, 180 - gap).min() >= 15


def photo(tmp_path) -> str:
    y, x = np.mgrid[0:24, 0:32] * 8
    Image.fromarray(np.dstack([y, x, 255 - x]).astype(np.uint8)).save(tmp_path / "photo.png")
    return str(tmp_path / "photo.png")


def test_plates_by_name_place_and_colour(tmp_path, penink):
    path = photo(tmp_path)
    by_name = penink("separate", "--plate", "magenta", path)
    assert by_name.returncode == 0, by_name.stderr
    plate = pgm.read(io.BytesIO(by_name.stdout), "", 10**6)
    values = np.asarray(Image.open(path))
    assert np.abs(plate.tone - separation.amounts(values, 255, CMYK.colours)[1]).max() <= 0.5 / 255
    assert penink("separate", "--plate", "2", path).stdout == by_name.stdout
    inks = ("--inks", "#1b4f9c,red")
    by_place = penink("separate", *inks, "--plate", "2", path).stdout
    assert by_place == penink("separate", *inks, "--plate", "red", path).stdout != b""
    inverse = pgm.read(io.BytesIO(penink("separate", "--plate", "2", "--invert", path).stdout), "", 10**6)
    assert (inverse.values + plate.values == 255).all()


def test_all_plates_in_one_call_are_those_of_one_each(tmp_path, penink):
    path = photo(tmp_path)
    done = penink("separate", "--plates", "p{}.pgm", path, cwd=tmp_path)
    assert done.returncode == 0 and not done.stdout
    assert sorted(file.name for file in tmp_path.glob("*.pgm")) == [f"p{i}.pgm" for i in (1, 2, 3, 4)]
    for i in (1, 2, 3, 4):
        assert (tmp_path / f"p{i}.pgm").read_bytes() == penink("separate", "--plate", str(i), path).stdout
    (tmp_path / "photo1.png").write_bytes((tmp_path / "photo.png").read_bytes())
    over = penink("separate", "--plates", "photo{}.png", "photo1.png", cwd=tmp_path)
    assert over.returncode == 1 and b"which it would overwrite" in over.stderr


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--plates", "p.pgm"], "has no {} for the number"),
        (["--plates", "{}{}.pgm"], "has no {} for the number"),
        (["--plates", "p{}.pgm", "-o", "a.pgm"], "-o has no use"),
        (["--plates", "p{}.pgm", "--plate", "1"], "give one of"),
        (["--plate", "green"], "the inks are cyan, magenta, yellow, black, or 1 to 4"),
        (["--plate", "5"], "the inks are cyan"),
        (["--inks", "red", "--plate", "1"], "2 to 6 colours"),
        (["--inks", "red,red", "--plate", "1"], "no two alike"),
        (["--inks", "red,blurple", "--plate", "1"], "is not #rrggbb"),
        (["--black", "2", "--plate", "1"], "2"),
        (["--inks", "cmyk", "--grey", "0,0.5"], "--inks goes with --plate"),
        (["--plate", "1", "--grey", "0,0.5"], "give one of"),
    ],
)
def test_what_is_no_plate_is_a_usage_error(tmp_path, penink, options, said):
    done = penink("separate", *options, photo(tmp_path))
    assert done.returncode == 2
    assert said in done.stderr.decode()


def test_draw_in_inks_is_the_chain_it_prints(tmp_path, penink):
    path = photo(tmp_path)
    drawn = penink(
        "draw", "--inks", "#1b4f9c,#d2232a,#f2c300", "--width", "1in", "--style", "true", path, "-v", "-o",
        str(tmp_path / "drawn.svg"),
    )  # fmt: skip
    assert drawn.returncode == 0, drawn.stderr
    import shlex

    for line in drawn.stderr.decode().splitlines():
        command = shlex.split(line.replace("drawn.svg", "again.svg"))
        assert command[0] == "penink"
        assert penink(*command[1:], cwd=tmp_path).returncode == 0, line
    assert (tmp_path / "again.svg").read_bytes() == (tmp_path / "drawn.svg").read_bytes()
    header = json.loads((tmp_path / "3-hatching.jsonl").read_text().splitlines()[0])
    assert (header["color"], header["layer"]) == ("#f2c300", "#f2c300")
    plain = [line for line in drawn.stderr.decode().splitlines() if "--color" in line and "compose" in line]
    assert not plain  # the photo's own colours
    packed = penink("draw", "--inks", "cmyk", "--width", "1in", path, "-o", str(tmp_path / "drawn.penink"))
    assert packed.returncode == 0, packed.stderr
    import zipfile

    with zipfile.ZipFile(tmp_path / "drawn.penink") as archive:
        layers = json.loads(archive.read("illustration.json"))["layers"]
    assert [layer["name"] for layer in layers] == ["yellow", "cyan", "magenta", "black"]
    assert len({layer["edges"] for layer in layers}) == 1


@pytest.mark.parametrize("options", [("--strength", "0.6"), ("--style", "house"), ("--mask", "mask.png")])
def test_plates_are_composed_where_the_call_says_how(tmp_path, penink, options):
    y, x = np.mgrid[0:60, 0:80]
    Image.fromarray(np.dstack([2 * x + 40, 3 * y, 90 + 0 * x]).astype(np.uint8)).save(tmp_path / "photo.png")
    Image.fromarray(np.where(x < 40, 255, 0).astype(np.uint8)).save(tmp_path / "mask.png")
    call = ("draw", "--inks", "cmyk", "--width", "1in", *options, "photo.png", "-v", "--as", "png", "-o", "a.png")
    done = penink(*call, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    (composing,) = (line for line in done.stderr.decode().splitlines() if "penink compose" in line)
    assert "--color" in composing
    import shlex

    assert penink(*shlex.split(composing)[1:], cwd=tmp_path).returncode == 0
    colours = np.asarray(Image.open(tmp_path / "colours.ppm"))
    assert colours.shape == (60, 80, 3)
    if "--mask" in options:
        assert (colours[:, 42:] == 255).all()
        assert np.asarray(Image.open(tmp_path / "a.png"))[:, 82:].min() > 200
    assert np.abs(colours.astype(int) - np.asarray(Image.open(tmp_path / "photo.png"))).mean() > 10


@pytest.mark.parametrize(("width", "sides"), [("1.3in", (97, 61)), ("101pt", (61, 97))])
def test_plates_and_lines_whose_sheets_are_a_part_of_a_pixel_apart(tmp_path, penink, width, sides):
    """The hatching's height is that of a grey in whole pixels, the lines' that of the photo."""
    path = tmp_path / "odd.png"
    y, x = np.mgrid[: sides[1], : sides[0]]
    disc = np.hypot(x - sides[0] / 2, y - sides[1] / 2) < 20
    Image.fromarray(np.where(disc[..., None], (60, 90, 160), (230, 210, 140)).astype(np.uint8)).save(path)
    for style in ("house", "architect"):
        drawn = penink(
            "draw", "--inks", "cmyk", "--style", style, "--width", width, "-q", path, "-o", tmp_path / "odd.svg"
        )
        assert drawn.returncode == 0, drawn.stderr
