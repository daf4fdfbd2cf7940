"""`penink enlarge` as a filter."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

SQUARE = """{"format": "penink-edges", "version": 1, "width": 60, "height": 50,
 "vertices": [[10, 10], [40, 10], [40, 40], [10, 40]], "edges": [[0, 1], [1, 2], [2, 3], [3, 0]]}"""
CROSSING = """{"format": "penink-edges", "version": 1, "width": 60, "height": 50,
 "vertices": [[10, 10], [40, 40], [40, 10], [10, 40]], "edges": [[0, 1], [2, 3]]}"""


def enlarge(*arguments, data=b""):
    command = [sys.executable, "-m", "penink_cli", "enlarge", *map(str, arguments)]
    return subprocess.run(command, input=data, capture_output=True, check=False)


@pytest.fixture
def files(tmp_path):
    (tmp_path / "square.json").write_text(SQUARE)
    (tmp_path / "crossing.json").write_text(CROSSING)
    y, x = np.mgrid[:5, :6]
    inside = (x > 0) & (x < 4) & (y > 0) & (y < 4)
    return tmp_path, b"P5\n6 5\n255\n" + np.where(inside, 200, 50).astype(np.uint8).tobytes()


def raster(stdout):
    _, size, maxval, rest = stdout.split(b"\n", 3)
    width, height = map(int, size.split())
    kind = np.uint8 if int(maxval) < 256 else ">u2"
    return np.frombuffer(rest, kind).reshape(height, width), int(maxval)


def test_it_is_sharp_and_a_window_is_part_of_it(files):
    folder, samples = files
    done = enlarge("-e", folder / "square.json", "--scale", "10", data=samples)
    assert (done.returncode, done.stderr) == (0, b"")
    whole, maxval = raster(done.stdout)
    assert (whole.shape, maxval) == ((50, 60), 255)
    assert set(np.unique(whole)) == {50, 200}
    part = enlarge(
        "-e", folder / "square.json", "--size", "60x50", "--window", "5,6,20,9", "--threads", 3, data=samples
    )
    assert np.array_equal(raster(part.stdout)[0], whole[6:15, 5:25])


def test_maxval_scale_below_one_and_soften(files):
    folder, samples = files
    deep, maxval = raster(enlarge("--scale", "2.5", "--maxval", "65535", "--kernel", "bspline", data=samples).stdout)
    assert (deep.shape, maxval) == ((13, 15), 65535)
    assert raster(enlarge("--scale", "0.5", data=samples).stdout)[0].shape == (3, 3)
    soft = raster(enlarge("-e", folder / "square.json", "--scale", "8", "--soften", data=samples).stdout)[0]
    assert len(np.unique(soft)) > 2


@pytest.mark.parametrize(
    ("arguments", "status", "message"),
    [
        (["--scale", "2", "-e", "crossing.json"], 1, "crossing.json: edges 0 and 1 cross"),
        (["--scale", "2", "--window", "0,0,13,2"], 1, "window 0,0,13,2 is not within the 12 x 10 pixels of output"),
        ([], 2, "one of --scale and --size is needed"),
        (["--scale", "2", "--size", "3x3"], 2, "one of --scale and --size is needed"),
        (["--scale", "0"], 2, "0"),
        (["--scale", "1e12"], 2, "more than 2147483647 pixels along a side"),
    ],
)
def test_what_it_refuses_leaves_no_output(files, arguments, status, message):
    folder, samples = files
    done = enlarge(*(folder / a if a.endswith(".json") else a for a in arguments), data=samples)
    assert done.returncode == status
    assert done.stdout == b""
    assert done.stderr.count(b"\n") == 1
    assert message in done.stderr.decode()
