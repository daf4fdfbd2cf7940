"""Telling lines in illustrations: kept in few bytes, drawn at every size."""

from __future__ import annotations

import contextlib
import io
import json

import numpy as np
import pytest
import skimage.data

from penink_cli.formats import compact_lines, pgm, strokes
from penink_cli.formats import lines as lines_format
from penink_cli.geometry import curves
from penink_cli.ground.errors import FormatError, LimitError
from penink_cli.ground.model import GreyImage, Lines
from penink_cli.lines.detection import detect_lines
from tests.formats.readers import written


@pytest.fixture(scope="module")
def face() -> Lines:
    return detect_lines(skimage.data.astronaut()[:, :, 1].astype(np.float32) / 255)


def test_lines_come_back_near_and_then_exactly(face):
    packed = compact_lines.lines_bytes(face)
    back = compact_lines.lines_from(packed)
    assert compact_lines.lines_bytes(back) == packed
    assert (back.width, back.height) == (512, 512) and len(back) <= len(face)
    assert (np.diff(back.rank) <= 0).all()
    for i in range(20):
        assert face.rank[i] - 1e-4 <= back.rank[i] <= 1.1 * face.rank[i] and back.white[i] == face.white[i]
        assert np.abs(back[i][0] - face[i][0]).max() < 0.45
    assert back.breadth.sum() == pytest.approx(face.breadth.sum(), rel=0.05)
    assert len(packed) < 4500


def test_no_lines_and_a_single_spot():
    empty = compact_lines.lines_from(compact_lines.lines_bytes(Lines(7, 9)))
    assert len(empty) == 0 and (empty.width, empty.height) == (7, 9)
    spot = Lines(
        10**6, 1, np.array([[5e5, 0.5]]), np.array([0, 1]), np.ones(1), np.array([3.0]), np.zeros(1, bool),
        np.array([4.0]),
    )  # fmt: skip
    back = compact_lines.lines_from(compact_lines.lines_bytes(spot))
    assert len(back) == 1 and back.breadth[0] > 0


@pytest.mark.parametrize("cut", [0, 4, 9, 40, -20])
def test_what_is_cut_short_is_refused(cut, face):
    packed = compact_lines.lines_bytes(face)
    with pytest.raises(FormatError):
        compact_lines.lines_from(packed[:cut] if cut else b"PIl3")


def test_damage_is_refused_or_sound(face):
    packed = compact_lines.lines_bytes(face)
    for at in range(10, len(packed), len(packed) // 25):
        damaged = packed[:at] + bytes([packed[at] ^ 0x55]) + packed[at + 1 :]
        with contextlib.suppress(FormatError, LimitError):
            lines_format.check(compact_lines.lines_from(damaged))


def manifest(folder, **layer: object) -> None:
    y, x = np.mgrid[:64, :64]
    with (folder / "s.pgm").open("wb") as out:
        pgm.write(out, GreyImage((120 + x + y // 2).astype(np.uint8)))
    t = np.linspace(0, 3, 30)
    points = np.column_stack([100 + 60 * np.cos(t), 100 + 60 * np.sin(t)])
    lines = Lines(
        200, 200, np.concatenate([points, [[50, 50]]]), np.array([0, 30, 31]), np.ones(31), np.array([9.0, 3]),
        np.zeros(2, bool), np.array([0, 9.0]),
    )  # fmt: skip
    (folder / "l.json").write_bytes(written(lines_format.write, lines))
    document = {
        "format": "penink-illustration", "version": 1, "width": 144, "height": 144,
        "layers": [{"samples": "s.pgm", "lines": "l.json", **layer}],
    }  # fmt: skip
    (folder / "i.illustration.json").write_text(json.dumps(document))


def drawn(penink, folder, *words: object):
    done = penink("render", *words)
    assert done.returncode == 0, done.stderr
    return strokes.read(io.BytesIO(done.stdout), "r")


def test_loose_and_packed_draw_the_same_lines(penink, tmp_path):
    manifest(tmp_path, line={"pen": 2, "min_rank": 1})
    loose = tmp_path / "i.illustration.json"
    assert penink("pack", loose, "-o", tmp_path / "i.penink").returncode == 0
    assert penink("render", loose, "--scale", 1).stdout == penink("render", tmp_path / "i.penink", "--scale", 1).stdout
    for scale in (0.2, 0.3, 1, 3):
        found = drawn(penink, tmp_path, tmp_path / "i.penink", "--scale", scale, "--device-dpi", "none")
        if scale < 1:  # the spot grows, the pen does not
            assert found.widths.max() == pytest.approx(9 * 144 * scale / 200, rel=0.05)
        else:  # until hatching can draw it
            assert found.widths.max() < 2.0
        assert found.widest.max() <= 2.0
        assert found.swells.any()


def test_another_choice_is_another_drawing(penink, tmp_path):
    manifest(tmp_path, line={"even": True, "pen": 0.5})
    plain = drawn(penink, tmp_path, tmp_path / "i.illustration.json")
    assert not plain.swells.any()
    manifest(tmp_path, line={"even": True, "pen": 0.5, "loose": 1.0})
    assert len(drawn(penink, tmp_path, tmp_path / "i.illustration.json")) > len(plain)


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        ([], "line is []"),
        ({"pen": 0}, "line: pen is 0"),
        ({"even": 1}, "line: even is 1"),
        ({"density": -1}, "line: density is -1"),
        ({"per_inch2": True}, "line: per_inch2 is true"),
        ({"min_rank": None}, "line: min_rank is null"),
        ({"ruled": -1}, "line: ruled is -1"),
        ({"loose": "2pt"}, 'line: loose is "2pt"'),
    ],
)
def test_a_wrong_choice_is_named(penink, tmp_path, line, complaint):
    manifest(tmp_path, line=line)
    done = penink("render", tmp_path / "i.illustration.json")
    assert done.returncode == 1 and f"layer 0: {complaint}" in done.stderr.decode()


def test_a_curve_is_kept_by_few_points_and_stays_near_what_was_given():
    """A wavy line of 400 points with noise of a quarter of a step, and a circle that must stay closed."""
    rng = np.random.default_rng(3)
    t = np.linspace(0, 1, 400)
    wave = np.column_stack([20 + 460 * t, 200 + 40 * np.sin(9 * t)])
    turn = 2 * np.pi * np.arange(121) / 120
    circle = np.column_stack([300 + 60 * np.cos(turn), 400 + 60 * np.sin(turn)])
    points = np.concatenate([wave, circle])
    noisy = points + rng.normal(0, 0.2, points.shape)
    noisy[-1] = noisy[400]
    weight = np.full(len(points), 0.7)
    given = Lines(
        512, 512, noisy, np.array([0, 400, 521]), weight, np.array([3.0, 2.0]), np.zeros(2, bool), np.zeros(2)
    )
    back = compact_lines.lines_from(compact_lines.lines_bytes(given))
    assert len(back.points) < 40
    for i, exact in enumerate((wave, circle)):
        control = curves.through(back[i], i == 1)
        u = np.linspace(0, 1, 40)[:, None]
        dense = np.concatenate([
            (1 - u) ** 3 * a + 3 * u * (1 - u) ** 2 * b + 3 * u * u * (1 - u) * c + u**3 * d
            for a, b, c, d in zip(control[:-3:3], control[1:-2:3], control[2:-1:3], control[3::3])
        ])  # fmt: skip
        away = np.sqrt(((exact[:, None] - dense[None]) ** 2).sum(axis=2)).min(axis=1)
        assert away.max() < 1.5 * 512 / 640 and away.mean() < 0.6 * 512 / 640
    assert np.array_equal(back[1][0], back[1][-1]) and len(back[1]) >= 6
    assert back.weight == pytest.approx(np.full(len(back.weight), 2 / 3))


def test_a_bow_that_nearly_closes_stays_open():
    turn = np.radians(np.linspace(8, 352, 90))
    bow = np.column_stack([100 + 50 * np.cos(turn), 100 + 50 * np.sin(turn)])
    given = Lines(200, 200, bow, np.array([0, 90]), np.ones(90), np.ones(1), np.zeros(1, bool), np.zeros(1))
    back = compact_lines.lines_from(compact_lines.lines_bytes(given))
    gap = np.sqrt(((back[0][0] - back[0][-1]) ** 2).sum())
    assert 12 < gap < 16 and (len(back[0]) < 6 or gap > curves.lengths(back[0]).max() / 3)
