"""Measures of drawings are held to drawings whose figures are known."""

from __future__ import annotations

import io
import json

import numpy as np
import pytest

from penink_cli.formats import pgm, strokes
from penink_cli.ground.model import GreyImage, Strokes
from penink_cli.measuring import difference, lines, tone

SIZE = 144.0
MANY = 10**8


def hatch(gap: float, width: float, shift: float = 0.0, size: float = SIZE) -> Strokes:
    """Lines from side to side, as ink covers width / gap of the sheet."""
    y = np.arange(gap / 2, size, gap) + shift * np.where(np.arange(len(np.arange(gap / 2, size, gap))) % 2, 1, -1)
    chains = [[[-5, v], [size / 3, v], [2 * size / 3, v], [size + 5, v]] for v in y]
    return Strokes.of(size, size, chains, [width] * len(y))


def written(value: Strokes) -> bytes:
    out = io.BytesIO()
    strokes.write(out, value)
    return out.getvalue()


def image(values: np.ndarray) -> bytes:
    out = io.BytesIO()
    pgm.write(out, GreyImage(values.astype(np.uint8)))
    return out.getvalue()


@pytest.mark.parametrize(("gap", "width"), [(3.0, 0.6), (2.0, 1.0), (4.0, 3.0)])
def test_tone_is_the_share_that_ink_covers(gap, width):
    have = tone.printed([hatch(gap, width)], MANY, 1)
    assert have.shape == (200, 200) and abs(have.mean() - width / gap) < 0.003
    want = tone.wanted(GreyImage(np.full((10, 10), round(255 * (1 - width / gap)), np.uint8)), 200, 200)
    found = tone.figures(want, have)
    assert found.rms < 0.8 and abs(found.bias) < 0.3 and found.stray == 0


def test_too_light_is_above_0_and_too_dark_below():
    have = tone.printed([hatch(2.0, 1.0)], MANY, 1)
    darker, lighter = (tone.figures(np.full_like(have, t), have) for t in (0.6, 0.4))
    assert abs(darker.bias - 10) < 0.3 and abs(lighter.bias + 10) < 0.3
    assert abs(darker.rms - 10) < 0.5 and 9.5 < darker.worst < 12


def test_ink_on_white_is_stray_and_ink_at_its_border_is_not():
    want = np.zeros((200, 200), np.float32)
    want[:, 100:] = 0.5
    half = Strokes.of(
        SIZE, SIZE, [[[72.3, y], [90, y], [110, y], [144, y]] for y in np.arange(1, 144, 2.0)], [1.0] * 72
    )
    assert tone.figures(want, tone.printed([half], MANY, 1)).stray == 0
    spot = Strokes.of(SIZE, SIZE, [[[36.0, 72.0]]], [10.0])
    stray = tone.figures(want, tone.printed([half, spot], MANY, 1)).stray
    assert abs(stray - 100 * np.pi * 25 / (71.3 * 144)) < 0.05


def test_evenness_falls_as_lines_come_in_pairs():
    even, uneven, paired = (lines.evenness(hatch(4.0, 0.5, shift)) for shift in (0.0, 0.4, 1.2))
    assert even > 0.999 and abs(uneven - (1 - 2 * 0.4 * 2 / 8)) < 0.02 and abs(paired - (1 - 2 * 1.2 * 2 / 8)) < 0.02
    turned = hatch(4.0, 0.5, 0.4)
    turned = Strokes.of(SIZE, SIZE, [turned[i][:, ::-1] for i in range(len(turned))], turned.widths)
    assert abs(lines.evenness(turned) - uneven) < 1e-9
    assert lines.evenness(Strokes(9, 9)) is None


def test_lengths_and_lifts():
    drawn = Strokes.of(
        99, 99, [[[0, 0], [1, 0], [2, 0], [3, 0]], [[3, 0], [4, 0], [5, 0], [6, 0]], [[9, 4]]], [1.0] * 3
    )
    found = lines.figures([drawn])
    assert (found.strokes, found.lifts, round(found.length_pt, 6), round(found.travel_pt, 6)) == (3, 1, 6, 5)
    assert lines.figures([drawn, drawn]).lifts == 3


def test_a_difference_of_strokes_is_how_far_they_moved():
    one, other = hatch(4.0, 0.5), hatch(4.0, 0.5)
    assert difference.of_strokes(one, other, MANY, 1) == difference.Difference(0, 0, 0)
    moved = Strokes.of(SIZE, SIZE, [one[i] + (0, 0.3) for i in range(len(one))], one.widths)
    assert abs(difference.of_strokes(one, moved, MANY, 1).place - 0.3) < 1e-6
    fewer = Strokes.of(SIZE, SIZE, [one[i] for i in range(len(one) - 1)], one.widths[:-1])
    for pair in ((one, fewer), (fewer, one)):
        found = difference.of_strokes(*pair, MANY, 1)
        assert abs(found.place - 4) < 1e-6 and found.tone > 5
    assert difference.of_strokes(one, Strokes(SIZE, SIZE), MANY, 1).place == np.inf
    wider = Strokes.of(SIZE, SIZE, [one[i] for i in range(len(one))], one.widths * 1.2)
    found = difference.of_strokes(one, wider, MANY, 1)
    assert found.place == 0 and 2 < found.tone < 4


def test_a_difference_of_pictures_is_what_no_pixel_near_has():
    a = np.zeros((9, 9), np.uint8)
    a[4, 4] = 255
    b = np.roll(a, 1, axis=1)
    assert difference.of_pictures(GreyImage(a), GreyImage(b), 0).tone == 100
    assert difference.of_pictures(GreyImage(a), GreyImage(b), 1).tone == 0
    assert difference.of_pictures(GreyImage(a), GreyImage(np.zeros_like(a)), 3).tone == 100


def test_measure_as_a_table_and_as_json(penink, tmp_path):
    (tmp_path / "s.jsonl").write_bytes(written(hatch(2.0, 1.0)))
    (tmp_path / "p.pgm").write_bytes(image(np.full((8, 8), 128)))
    done = penink("measure", "--against", tmp_path / "p.pgm", tmp_path / "s.jsonl", "--json")
    found = json.loads(done.stdout)
    assert not done.stderr and found["strokes"] == 72 and abs(found["tone_bias"]) < 0.5 and found["stray"] == 0
    table = penink("measure", "--against", tmp_path / "p.pgm", input=written(hatch(2.0, 1.0))).stdout.decode()
    assert "strokes                               72\n" in table and len(table.splitlines()) == 11
    alone = json.loads(penink("measure", "--json", tmp_path / "s.jsonl").stdout)
    assert alone["tone_rms"] is None and abs(alone["ink"] - 50) < 0.5
    against = penink("measure", "--json", "--against", tmp_path / "s.jsonl", tmp_path / "s.jsonl")
    assert json.loads(against.stdout)["tone_worst"] == 0


@pytest.mark.parametrize(
    ("limit", "line"),
    [
        (["--max-rms", "9"], "the tone's RMS error is "),
        (["--max-bias", "9"], "the tone's bias is "),
        (["--max-rms", "9", "--max-bias", "9"], "(--max-rms); the tone's bias is "),
    ],
)
def test_a_limit_that_is_passed_is_one_line_and_status_1(penink, tmp_path, limit, line):
    (tmp_path / "s.jsonl").write_bytes(written(hatch(2.0, 1.0)))
    (tmp_path / "p.pgm").write_bytes(image(np.full((8, 8), 100)))
    done = penink("measure", "--against", tmp_path / "p.pgm", *limit, tmp_path / "s.jsonl")
    assert done.returncode == 1 and done.stderr.decode().count("\n") == 1 and line in done.stderr.decode()
    assert b"strokes" in done.stdout
    limit = [word if word.startswith("-") else "12" for word in limit]
    assert penink("measure", "--against", tmp_path / "p.pgm", *limit, tmp_path / "s.jsonl").returncode == 0


def test_ink_on_white_beyond_its_limit(penink, tmp_path):
    (tmp_path / "s.jsonl").write_bytes(written(Strokes.of(SIZE, SIZE, [[[36.0, 72.0]]], [10.0])))
    (tmp_path / "p.pgm").write_bytes(image(np.full((8, 8), 255)))
    done = penink("measure", "--against", tmp_path / "p.pgm", "--max-stray", "0.1", tmp_path / "s.jsonl")
    assert done.returncode == 1 and b"ink on paper white is 0.38 %, more than 0.1 (--max-stray)" in done.stderr
    done = penink("measure", "--max-stray", "1", tmp_path / "s.jsonl")
    assert done.returncode == 2 and b"go with --against" in done.stderr


def test_compare_says_by_its_status(penink, tmp_path):
    (tmp_path / "a.jsonl").write_bytes(written(hatch(4.0, 0.5)))
    moved = Strokes.of(SIZE, SIZE, [hatch(4.0, 0.5)[i] + (0, 0.3) for i in range(36)], [0.5] * 36)
    (tmp_path / "b.jsonl").write_bytes(written(moved))
    assert penink("compare", tmp_path / "a.jsonl", tmp_path / "a.jsonl").returncode == 0
    done = penink("compare", tmp_path / "a.jsonl", tmp_path / "b.jsonl")
    assert done.returncode == 1 and b"place by 0.300 pt, 0.1 are allowed (--place)" in done.stderr
    assert (
        penink("compare", "--place", "0.31", "--tone", "2", tmp_path / "a.jsonl", tmp_path / "b.jsonl").returncode == 0
    )
    (tmp_path / "a.pgm").write_bytes(image(np.full((8, 8), 100)))
    assert penink("compare", tmp_path / "a.pgm", input=image(np.full((8, 8), 102))).returncode == 0
    done = penink("compare", tmp_path / "a.pgm", input=image(np.full((8, 8), 104)))
    assert done.returncode == 1 and b"and <stdin> differ: tone by 1.57 %, 1 are allowed (--tone)" in done.stderr
    done = penink("compare", tmp_path / "a.pgm", input=image(np.full((8, 9), 104)))
    assert done.returncode == 1 and b"differ: 8 x 8 and 9 x 8 pixels" in done.stderr
    done = penink("compare", tmp_path / "a.pgm", tmp_path / "a.jsonl")
    assert done.returncode == 1 and b"strokes and a picture" in done.stderr
