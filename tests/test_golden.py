"""Each stage of the chain on a picture of 24 × 16 pixels, byte for byte as in tests/golden.

A stage reads the golden files of the stages before it, so that only the stage that changed fails.
``pytest tests/test_golden.py --rewrite-golden`` writes them anew, in the chain's order: read the diff
before committing it. Grey images are kept as plain PGM, one row of pixels a line; so are the three of a
direction field, one after another.
"""

from __future__ import annotations

import os
import re
import shutil

import numpy as np
import pytest

from tests.conftest import ROOT

GOLDEN = ROOT / "tests/golden"

# What makes each file, in tests/golden; those that name no picture read a photo from standard input.
STAGES = {
    "edges.json": "detect-edges",
    "directions.pgm": "detect-directions -e edges.json --size 12",
    "lines.json": "detect-lines",
    "composed.pgm": "compose --width 0.5in",
    "samples.pgm": "extract-samples -e edges.json",
    "reduced.pgm": "reduce -e edges.json --factor 2 samples.pgm",
    "enlarged.pgm": "enlarge -e edges.json --scale 3 reduced.pgm",
    "crosshatch.strokes.jsonl": "blast -t crosshatch -e edges.json --width 0.5in enlarged.pgm",
    "stipple.strokes.jsonl": "blast -t stipple -e edges.json --width 0.25in enlarged.pgm",
    "form.strokes.jsonl": "blast -t form -e edges.json --directions directions.pgm --width 0.5in enlarged.pgm",
    "outline.strokes.jsonl": "outline --width 0.5in edges.json",
    "lines.strokes.jsonl": "lines --width 0.5in lines.json",
    "rendered.strokes.jsonl": "render --width 0.5in disc.illustration.json",
    "drawing.ps": "to-ps crosshatch.strokes.jsonl outline.strokes.jsonl",
    "drawing.svg": "to-svg crosshatch.strokes.jsonl outline.strokes.jsonl",
    "drawing.pgm": "to-pgm --dpi 72 crosshatch.strokes.jsonl outline.strokes.jsonl",
}
GIVEN = {"disc.illustration.json"}  # written by hand


def listing(values: np.ndarray, maxval: int = 255) -> bytes:
    """Grey values of 0 … maxval, (h, w), as plain PGM."""
    h, w = values.shape
    return "".join([f"P2\n{w} {h}\n{maxval}\n", *(" ".join(f"{v:3}" for v in row) + "\n" for row in values)]).encode()


def readable(output: bytes) -> bytes:
    """Raw PGM images as their listings, anything else as it is."""
    listings = b""
    while output.startswith(b"P5"):
        header = re.match(rb"P5\n(\d+) (\d+)\n(\d+)\n", output)
        assert header, output[:20]
        w, h, maxval = map(int, header.groups())
        end = header.end() + w * h
        listings += listing(np.frombuffer(output[header.end() : end], np.uint8).reshape(h, w), maxval)
        output = output[end:]
    return listings + output


def raw(listings: bytes) -> bytes:
    """Listings as the raw PGM images that they are of."""
    images = b""
    for text in listings.split(b"P2\n")[1:]:
        size, maxval, values = text.split(b"\n", 2)
        images += b"P5\n%s\n%s\n%s" % (size, maxval, bytes(map(int, values.split())))
    return images


def photo() -> bytes:
    """A dark disc on a gradient."""
    i, j = np.mgrid[:16, :24]
    disc = (10 * j - 117) ** 2 + (10 * i - 73) ** 2 < 52**2
    return listing(np.where(disc, 60, 120 + 5 * j))


def whisker() -> bytes:
    """A dark line, bent, two pixels wide in the middle and none at its ends, on a gradient."""
    i, j = np.mgrid[:16, :24]
    off = abs(40 * i - (j - 12) ** 2 - 240)  # fortieths of a pixel
    wide = np.maximum(0, 40 - 4 * abs(j - 12))
    return listing(120 + 5 * j - np.clip(3 * (wide + 20 - off), 0, 110))


def compare(name: str, found: bytes) -> None:
    assert (GOLDEN / name).exists(), f"no {name}: pytest tests/test_golden.py --rewrite-golden"
    assert found.decode().split("\n") == (GOLDEN / name).read_bytes().decode().split("\n")


@pytest.fixture
def files(tmp_path):
    """The golden files, with the direction field as the stages read it: of raw images."""
    shutil.copytree(GOLDEN, tmp_path, dirs_exist_ok=True)
    if (field := tmp_path / "directions.pgm").exists():
        field.write_bytes(raw(field.read_bytes()))
    return tmp_path


@pytest.mark.parametrize("name", STAGES)
def test_a_stage_writes_its_golden_file(name, penink, request, files):
    done = penink(*STAGES[name].split(), input=whisker() if name == "lines.json" else photo(), cwd=files)
    assert done.returncode == 0 and not done.stderr, done.stderr
    found = readable(done.stdout)
    assert len(found) < 20_000, "too long to be read"
    if request.config.getoption("--rewrite-golden"):
        assert "PYTEST_XDIST_WORKER" not in os.environ, "stages are rewritten in their order: without -n"
        (GOLDEN / name).write_bytes(found)
    compare(name, found)


@pytest.mark.parametrize("name", STAGES)
def test_one_byte_fails_the_comparison(name):
    golden = (GOLDEN / name).read_bytes()
    middle = len(golden) // 2
    for changed in (golden[:-1], golden + b"\n", golden[:middle] + b"~" + golden[middle + 1 :]):
        with pytest.raises(AssertionError):
            compare(name, changed)


def test_another_hand_fails_the_comparison(penink):
    other = penink(*STAGES["stipple.strokes.jsonl"].split(), "--seed", 1, cwd=GOLDEN).stdout
    with pytest.raises(AssertionError):
        compare("stipple.strokes.jsonl", other)


def test_there_is_no_golden_file_that_no_stage_writes():
    assert {path.name for path in GOLDEN.iterdir()} == set(STAGES) | GIVEN
    with pytest.raises(AssertionError, match="--rewrite-golden"):
        compare("missing", b"")
