"""Plates drawn so that together they print the right colours, held against another rasteriser and another Lab."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import skimage.color
from scipy.ndimage import gaussian_filter

from penink_cli.blasting import balancing
from penink_cli.blasting.balancing import Plate, balanced, corrected
from penink_cli.blasting.blast import blast
from penink_cli.blasting.frame_ends import drawn_on
from penink_cli.blasting.sheet import coverage
from penink_cli.composition.separation import SOLID
from penink_cli.formats import pgm, strokes
from penink_cli.ground.colour import encoded, linear
from penink_cli.ground.model import GreyImage, Strokes, turned
from penink_cli.options.textures import find_texture
from penink_cli.outputs.page import lay_out
from penink_cli.outputs.raster import cover

INKS = ((0.11, 0.31, 0.61), (0.82, 0.14, 0.16), (0.95, 0.77, 0.0))
SIDE, DPI = 108.0, 288


def tones() -> list[np.ndarray]:
    """Amounts of three inks: two slopes, and a disc."""
    y, x = (np.mgrid[0:216, 0:216] + 0.5) / 216
    disc = np.where((x - 0.5) ** 2 + (y - 0.5) ** 2 < 0.1, 0.7, 0.25)
    return [0.15 + 0.6 * x, 0.7 - 0.5 * y, disc]


def drawn(wanted: list[np.ndarray], solid: float | None = None) -> list[Plate]:
    plates = []
    for i, (tone, ink) in enumerate(zip(wanted, INKS, strict=True)):
        texture = turned(find_texture("crosshatch"), 25.0 * i)
        strokes = blast(tone, SIDE, SIDE, None, texture, seed=i, solid=solid, device_dpi=None)
        plates.append(Plate(strokes, ink, tone))
    return plates


@pytest.fixture(scope="module")
def plates():
    return drawn(tones())


def off(plates: list[Plate], amounts: list[np.ndarray] | None = None) -> float:
    """Mean ΔE2000 of the print from the tones', both as the eye sees them."""
    printed, wanted = 1.0, 1.0
    for plate, tone in zip(plates, tones() if amounts is None else amounts, strict=True):
        bare = np.concatenate(list(cover.bands([plate.strokes], lay_out([plate.strokes]), DPI, 255))) / 255
        printed = printed * (bare[..., None] + (1 - bare[..., None]) * linear(plate.ink))
        wanted = wanted * (1 - tone[..., None] * (1 - linear(plate.ink)))
    labs = []
    for light in (printed, wanted):
        low = np.stack([gaussian_filter(light[..., k], len(light) / SIDE * 4.5) for k in range(3)], axis=-1)
        step = len(light) // 36
        labs.append(skimage.color.rgb2lab(encoded(low[step // 2 :: step, step // 2 :: step])))
    return float(skimage.color.deltaE_ciede2000(*labs).mean())


def test_pressed_plates_print_truer_colours(plates):
    pressed = balanced(plates)
    after = off([replace(plate, strokes=own) for plate, own in zip(plates, pressed, strict=True)])
    assert after < 0.6 * off(plates)
    for plate, own in zip(plates, pressed, strict=True):
        moved = (own.points != plate.strokes.points).any(axis=1)  # drawn on to the frame
        assert np.minimum(own.points, 108 - own.points).min(axis=1)[moved].max(initial=0) < 0.6
        factor = own.widths / plate.strokes.widths
        assert np.abs(factor - 1).max() <= balancing.PRESSURE + 0.01 / plate.strokes.widths.min()
        assert np.percentile(np.abs(factor - 1), 50) < 0.2


def test_a_dark_tint_is_no_solid():
    """Filled from where black on white looks black, a plate of .975 would be all ink."""
    tone = np.full((216, 216), 0.975)
    covered = []
    for solid in (None, SOLID):
        strokes = blast(tone, SIDE, SIDE, None, find_texture("crosshatch"), solid=solid, device_dpi=None)
        covered.append(float(coverage(strokes, 1080, 1080)[100:-100, 100:-100].mean()))
    assert covered[0] > 0.995
    assert covered[1] == pytest.approx(0.975, abs=0.01)


def test_dark_plates_are_not_pressed_past_the_right_colour():
    """Where strokes lie over one another, what a first glance promises of pressing them does not come."""
    wanted = [np.full((216, 216), tone) for tone in (0.95, 0.9, 0.8)]
    wanted[0][:, 108:] = 0.75
    dark = drawn(wanted, SOLID)
    pressed = balanced(dark)
    after = off([replace(plate, strokes=own) for plate, own in zip(dark, pressed, strict=True)], wanted)
    assert after < 0.13 * off(dark, wanted)


def test_threads_change_nothing(plates):
    one, three = balanced(plates), balanced(plates, workers=3)
    assert all(np.array_equal(a.widths, b.widths) for a, b in zip(one, three, strict=True))


def test_what_a_plate_lacks_all_make_up_for(plates):
    """Red is drawn too light by a third on the left: all are to do more there, red the most, and no more elsewhere."""
    light = tones()
    light[1] = np.where(np.arange(216) < 108, light[1] / 1.5, light[1])
    wrong = [replace(plate, tone=tone) for plate, tone in zip(drawn(light), tones(), strict=True)]
    more = [new - tone for new, tone in zip(corrected(wrong), tones(), strict=True)]
    means = [change[:, 20:88].mean() for change in more]
    assert means[1] > 0.05 and means[1] == max(means)
    assert abs(more[1][:, 128:196].mean()) < 0.02


def test_nothing_makes_up_for_what_is_left_white(plates):
    """A white line through all plates: their tones are corrected for it unless it is said to be meant."""
    line = np.ones((216, 216))
    line[96:104] = 0.0
    cut = []
    for plate in plates:
        y = np.add.reduceat(plate.strokes.points[:, 1], plate.strokes.first[:-1]) / np.diff(plate.strokes.first)
        cut.append(replace(plate, strokes=plate.strokes.taken((y < 46) | (y > 54))))
    beside = np.r_[80:92, 108:120]
    change = [
        np.mean([(tone - plate.tone)[beside].mean() for tone, plate in zip(corrected(given), given, strict=True)])
        for given in (plates, cut, [replace(plate, left=plate.tone * line) for plate in cut])
    ]
    assert change[1] > change[0] + 0.02
    assert change[2] < change[0] + 0.25 * (change[1] - change[0])


def test_plates_drawn_anew_are_truer(plates):
    anew = drawn(corrected(plates))
    assert off([replace(p, strokes=q.strokes) for p, q in zip(plates, anew, strict=True)]) < 0.9 * off(plates)


def test_strokes_that_swell_are_pressed_at_their_knots(plates):
    first = plates[0].strokes
    swelling = first.swelling(first.at_knots * np.where(np.arange(first.knots[-1]) % 2, 0.9, 1.1))
    pressed = balanced([replace(plates[0], strokes=swelling), *plates[1:]])
    factor = pressed[0].at_knots / swelling.at_knots
    assert factor.std() > 0.01
    assert np.array_equal(pressed[0].knots, swelling.knots)


def test_outlines_that_are_there_count_and_a_plate_may_be_empty(plates):
    empty = replace(plates[2], strokes=Strokes(SIDE, SIDE), tone=np.zeros((216, 216)))
    there = Strokes.of(SIDE, SIDE, [[[54, y], [60, y], [70, y], [100, y]] for y in range(10, 100, 4)], [2.0] * 23)
    alone = balanced([*plates[:2], empty])
    beside = balanced([plates[0], replace(plates[1], there=there), empty])
    assert len(beside[2]) == 0
    right = plates[1].strokes.points[plates[1].strokes.first[:-1], 0] > 64
    assert beside[1].widths[right].mean() < 0.97 * alone[1].widths[right].mean()


def test_ends_near_the_frame_are_drawn_on_to_it_and_no_ink_over_it():
    rng = np.random.default_rng(3)
    ends = rng.uniform(0.6, 59.4, (500, 2, 2))
    thirds = np.linspace(0, 1, 4)[None, :, None]
    chains = ends[:, :1] + thirds * (ends[:, 1:] - ends[:, :1])
    points = np.concatenate([chains.reshape(-1, 2), [[0.5, 0.5]]])
    first = np.append(np.arange(501) * 4, 2001)
    before = Strokes(60.0, 60.0, points, first, np.append(rng.uniform(0.1, 0.9, 500), 0.3))
    after = drawn_on(before)
    moved = (after.points != before.points).any(axis=1)
    assert not moved[-1] and not moved[:-1][np.arange(2000) % 4 % 3 > 0].any()  # dots, and what is between ends
    assert 10 < moved.sum() < 200
    half = np.repeat(before.widths, np.diff(first)) / 2
    gaps = [np.minimum(s.points, 60 - s.points).min(axis=1) - half for s in (before, after)]
    assert (np.abs(gaps[1][moved] - 0.01) < 1e-9).all() and (gaps[0][moved] < 0.61).all()
    inside = gaps[0] > 0.01
    assert (gaps[1][inside] > 0.0099).all()
    way = np.diff(ends, axis=1)[:, 0]
    way /= np.hypot(way[:, :1], way[:, 1:])
    out = np.concatenate([-way, way])  # of both ends, and what lies before each there
    at = np.concatenate([ends[:, 0], ends[:, 1]])
    place = np.concatenate([first[:-2], first[:-2] + 3])
    before_it = np.where(out > 0, 60 - at, at) - half[place, None] - 0.01
    wanted = ((before_it > 0) & (before_it < 0.59) & (np.abs(out) > 0.6)).any(axis=1) & (before_it > 0.6).any(axis=1)
    assert wanted.sum() > 10 and moved[place[wanted]].all()


def test_least_squares_and_the_smallest_change_are_numpys():
    rng = np.random.default_rng(0)
    a, wanted = rng.normal(size=(60, 20)), rng.normal(size=60)
    exact = np.linalg.solve(a.T @ a + 3.0 * np.eye(20), a.T @ wanted)
    found = balancing.least_squares(lambda x: a @ x, lambda y: a.T @ y, wanted, 3.0, 20, np.zeros(20))
    assert np.abs(found - exact).max() < 1e-6
    slopes, wrong = [rng.normal(size=(5, 3)) * 30 for _ in range(4)], rng.normal(size=(5, 3))
    change = np.stack(balancing._least_change(wrong, slopes))
    for i in range(5):
        s = np.stack([slope[i] for slope in slopes])
        best = -s @ np.linalg.solve(s.T @ s + balancing.CAUTION * np.eye(3), wrong[i])
        assert np.abs(change[:, i] - best).max() < 1e-9


def put(tmp_path, plates) -> list[str]:
    """Files of the plates, and the words that name them."""
    words = []
    for i, plate in enumerate(plates):
        code = "#" + "".join(f"{round(255 * part):02x}" for part in plate.ink)
        with open(tmp_path / f"{i}.jsonl", "wb") as out:
            strokes.write(out, replace(plate.strokes, color=code))
        with open(tmp_path / f"{i}.pgm", "wb") as out:
            pgm.write(out, GreyImage.from_grey(1 - plate.tone))
        words += ["--tone", f"{i}.pgm"]
    return [*words, *(f"{i}.jsonl" for i in range(len(plates)))]


def test_the_filter_writes_one_plate(tmp_path, penink, plates):
    words = put(tmp_path, plates)
    done = penink("balance", "--plate", "2", *words, "-o", "b.jsonl", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    before, after = (strokes.read((tmp_path / name).open("rb"), name) for name in ("1.jsonl", "b.jsonl"))
    assert (after.color, len(after)) == (before.color, len(before))
    assert not np.array_equal(after.widths, before.widths)
    done = penink("balance", "--plate", "1", "--correct", *words, cwd=tmp_path)
    assert done.stdout.startswith(b"P5\n216 216\n255\n")
    done = penink("balance", "--plates", "all-{}.jsonl", *words, cwd=tmp_path)
    assert done.returncode == 0 and len(list(tmp_path.glob("all-*.jsonl"))) == len(plates)
    assert (tmp_path / "all-2.jsonl").read_bytes() == (tmp_path / "b.jsonl").read_bytes()


@pytest.mark.parametrize(
    ("change", "status", "said"),
    [
        ([], 2, "give one of --plate and --plates"),
        (["--plates", "0.jsonl"], 2, "has no {} for the number"),
        (["--plates", "{}.pgm"], 1, "which it would overwrite"),
        (["--plate", "4"], 2, "there are 3 files"),
        (["--plate", "1", "--tone", "0.pgm"], 2, "3 files of strokes need as many --tone, not 4"),
        (["--plate", "1", "--correct", "--gamma", "2"], 2, "--correct does not go with --gamma"),
        (["--plate", "1", "--ink", "other.jsonl"], 1, "other.jsonl: a sheet of 9 x 9 pt, the first one 108 x 108"),
    ],
)
def test_what_does_not_fit_is_one_line(tmp_path, penink, plates, change, status, said):
    words = put(tmp_path, plates)
    with open(tmp_path / "other.jsonl", "wb") as out:
        strokes.write(out, Strokes(9, 9))
    done = penink("balance", *change, *words, cwd=tmp_path)
    assert (done.returncode, said in done.stderr.decode()) == (status, True), done.stderr
