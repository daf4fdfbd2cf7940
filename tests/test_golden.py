"""Each stage of the chain on a picture of 24 × 16 pixels, byte for byte as in tests/golden.

A stage reads the golden files of the stages before it, so that only the stage that changed fails.
``pytest tests/test_golden.py --rewrite-golden`` writes them anew, in the chain's order: read the diff
before committing it. Grey images are kept as plain PGM, one row of pixels a line.
"""

from __future__ import annotations

import os
import re

import numpy as np
import pytest

from tests.conftest import ROOT

GOLDEN = ROOT / "tests/golden"

# What makes each file, in tests/golden; the first two read the photo from standard input.
STAGES = {
    "edges.json": "detect-edges",
    "samples.pgm": "extract-samples -e edges.json",
    "reduced.pgm": "reduce -e edges.json --factor 2 samples.pgm",
    "enlarged.pgm": "enlarge -e edges.json --scale 3 reduced.pgm",
    "crosshatch.strokes.jsonl": "blast -t crosshatch -e edges.json --width 0.5in enlarged.pgm",
    "stipple.strokes.jsonl": "blast -t stipple -e edges.json --width 0.25in enlarged.pgm",
    "outline.strokes.jsonl": "outline --width 0.5in edges.json",
    "drawing.ps": "to-ps crosshatch.strokes.jsonl outline.strokes.jsonl",
    "drawing.svg": "to-svg crosshatch.strokes.jsonl outline.strokes.jsonl",
    "drawing.pgm": "to-pgm --dpi 72 crosshatch.strokes.jsonl outline.strokes.jsonl",
}


def listing(values: np.ndarray) -> bytes:
    """Grey values of 0 … 255, (h, w), as plain PGM."""
    h, w = values.shape
    return "".join([f"P2\n{w} {h}\n255\n", *(" ".join(f"{v:3}" for v in row) + "\n" for row in values)]).encode()


def readable(output: bytes) -> bytes:
    """A raw PGM as its listing, anything else as it is."""
    if not output.startswith(b"P5"):
        return output
    header = re.match(rb"P5\n(\d+) (\d+)\n255\n", output)
    assert header, output[:20]
    w, h = map(int, header.groups())
    return listing(np.frombuffer(output[header.end() :], np.uint8).reshape(h, w))


def photo() -> bytes:
    """A dark disc on a gradient."""
    i, j = np.mgrid[:16, :24]
    disc = (10 * j - 117) ** 2 + (10 * i - 73) ** 2 < 52**2
    return listing(np.where(disc, 60, 120 + 5 * j))


def compare(name: str, found: bytes) -> None:
    assert (GOLDEN / name).exists(), f"no {name}: pytest tests/test_golden.py --rewrite-golden"
    assert found.decode().split("\n") == (GOLDEN / name).read_bytes().decode().split("\n")


@pytest.mark.parametrize("name", STAGES)
def test_a_stage_writes_its_golden_file(name, penink, request):
    done = penink(*STAGES[name].split(), input=photo(), cwd=GOLDEN)
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
    assert {path.name for path in GOLDEN.iterdir()} == set(STAGES)
    with pytest.raises(AssertionError, match="--rewrite-golden"):
        compare("missing", b"")
