"""Strokes swell where the picture is darker than around, the tone stays, and what is black is filled."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import skimage.data

from penink_cli.blasting import bordered
from penink_cli.blasting.blast import blast, left_over
from penink_cli.blasting.sheet import coverage
from penink_cli.blasting.solids import PEN_PT
from penink_cli.ground.model import Strokes
from penink_cli.options.textures import find_texture
from tests.blasting.measures import solids

SIDE = 144.0


def pattern(contrast: float) -> np.ndarray:
    """Tone (288, 288) of stripes 2 points wide, 4 apart, around .35: finer than the hatching's low-pass."""
    x = (np.arange(288) + 0.5) / 2
    return np.broadcast_to(0.35 + contrast * np.sign(np.sin(2 * np.pi * x / 4 + 0.1)), (288, 288)).copy()


def seen(strokes) -> np.ndarray:
    """Ink of the columns, four a point."""
    return coverage(strokes, 576, 576)[32:-32].mean(axis=0)


def test_detail_finer_than_the_lines_is_told_by_their_width():
    tone, texture = pattern(0.1), find_texture("parallel")
    dark = (np.arange(576) + 0.5) / 4 % 4 < 2
    told = []
    for swell in (0.0, 1.0):
        ink = seen(blast(tone, SIDE, SIDE, None, texture, device_dpi=None, swell=swell))[32:-32]
        told.append(ink[dark[32:-32]].mean() - ink[~dark[32:-32]].mean())
    assert abs(told[0]) < 0.01 and told[1] > 0.05  # .2 in the picture, .15 as smooth as it is looked at


def test_the_tone_is_as_true_as_without():
    photo = np.asarray(skimage.data.camera(), float)[:256, 100:356] / 255
    drawn = blast(1 - photo, SIDE, SIDE, None, find_texture("crosshatch"), swell=1.0)
    error = left_over(1 - photo, SIDE, SIDE, drawn, 600.0, 1)
    assert np.sqrt((error**2).mean()) < 0.012 and abs(error.mean()) < 0.004


def test_even_tone_needs_no_knots():
    drawn = blast(np.full((288, 288), 0.3), SIDE, SIDE, None, find_texture("parallel"), device_dpi=None, swell=1.0)
    plain = blast(np.full((288, 288), 0.3), SIDE, SIDE, None, find_texture("parallel"), device_dpi=None)
    assert len(drawn) == len(plain) and len(drawn.points) <= 1.15 * len(plain.points)


def test_one_pen_may_swell_but_never_by_itself():
    tone = pattern(0.2)
    for swell, kinds in ((0.0, 1), (1.0, 10)):
        drawn = blast(tone, SIDE, SIDE, None, find_texture("parallel"), device_dpi=None, pen_pt=0.3, swell=swell)
        assert len(set(drawn.at_knots.round(2).tolist())) >= kinds
        assert swell or drawn.knot_widths is None


def two_blacks() -> np.ndarray:
    """Tone (288, 288): a black square of 40 points with a crisp border, one whose border is soft, grey between."""
    tone = np.full((288, 288), 0.4)
    tone[40:120, 40:120] = 1.0
    y, x = np.mgrid[:288, :288]
    away = np.maximum(np.abs(y - 200), np.abs(x - 200)) / 2
    return np.maximum(tone, np.clip(1.4 - away / 40, 0, 1))


@pytest.mark.parametrize("pen", [None, 0.4])
def test_black_is_solid_with_a_clean_border(pen):
    none = np.zeros((150, 150), np.float32)
    ink = coverage(solids(two_blacks(), SIDE, SIDE, pen, 0.0, none), 1152, 1152)
    assert ink[163:477, 163:477].min() == 1.0  # no flecks
    assert ink[:, :156].max() == 0 and ink[156:484, 486:560].max() == 0  # a quarter of a point out there is nothing
    soft = ink[800]  # black from where the tone is .94
    dark = np.flatnonzero(soft) / 8
    assert abs(dark.min() - (100 - 0.46 * 40)) < 1 and abs(dark.max() - (100 + 0.46 * 40)) < 1


@pytest.mark.parametrize(("pen", "gain"), [(None, 0.0), (0.6, 0.0), (None, 0.06)])
def test_the_border_of_black_is_smooth(pen, gain):
    """Rows that end at a round border stand out of it and leave notches, a quarter of a point and more."""
    centre, fine = np.array([72.3, 71.6]), 32
    y, x = (np.mgrid[: 288 * 16, : 288 * 16] + 0.5) / 32
    tone = (np.hypot(x - centre[0], y - centre[1]) < 15).reshape(288, 16, 288, 16).mean(axis=(1, 3))
    strokes = solids(tone, SIDE, SIDE, pen, gain, np.zeros((150, 150), np.float32))
    ink = coverage(replace(strokes, widths=strokes.widths + gain), int(SIDE) * fine, int(SIDE) * fine)
    angle, radius = np.arange(720)[:, None] * np.pi / 360, np.arange(0.0, 17.0, 0.01)
    column, row = (
        ((c + radius * turn(angle)) * fine).astype(int) for c, turn in zip(centre.tolist(), (np.cos, np.sin))
    )
    along = ink[row, column]
    assert along[:, radius < 14.8].min() > 0.85
    reached = along.sum(axis=1) * 0.01
    assert np.abs(reached - 15).max() < 0.06 and reached.std() < 0.02


def test_black_with_holes_necks_and_the_frame_is_filled_and_nothing_else():
    """Bars narrower than a pen, and than two and a half, join two blacks; one has a hole; both touch the frame."""
    tone = np.zeros((288, 288), np.float32)
    tone[0:90, 0:90] = tone[0:90, 140:240] = 1.0
    tone[40:41, 90:140] = tone[50:53, 90:140] = 1.0
    tone[30:60, 170:200] = 0.0
    chains, widths = [], []
    bordered.fill(tone, np.array([0.5, 0.5]), 0.6, 0.0, chains, widths, False)
    ink = coverage(Strokes.of(SIDE, SIDE, chains, widths), 1152, 1152)
    true = np.kron(tone, np.ones((4, 4)))
    beyond = np.pad(true, 2, mode="edge")
    near = np.max([beyond[i : i + 1152, j : j + 1152] for i in range(5) for j in range(5)], axis=0)
    assert ink[near == 0].max() == 0  # a quarter of a point out
    solid = true.astype(bool)
    solid[:, 360:560] = False
    for edge in (0, 360, 560, 960, 680, 800):
        solid[:, max(0, edge - 3) : edge + 3] = False
    for edge in (0, 360, 120, 240):
        solid[max(0, edge - 3) : edge + 3] = False
    assert ink[solid].min() > 0.9
    assert ink[202:210, 380:540].min() == 1.0  # the bar of a point and a half


def test_what_is_not_black_or_drawn_already_is_left():
    none, full = np.zeros((150, 150), np.float32), np.ones((150, 150), np.float32)
    assert len(solids(np.full((288, 288), 0.92), SIDE, SIDE, None, 0.0, none)) == 0
    assert len(solids(two_blacks(), SIDE, SIDE, None, 0.0, full)) == 0
    specks = np.zeros((288, 288))
    specks[::20, ::20] = 1.0
    assert len(solids(specks, SIDE, SIDE, None, 0.0, none)) == 0


def test_form_hatches_nothing_over_its_blacks():
    texture = find_texture("form")
    drawn = blast(two_blacks(), SIDE, SIDE, None, texture, device_dpi=None)
    rest = drawn.taken(drawn.widths != PEN_PT)
    assert coverage(rest, 576, 576)[90:230, 90:230].mean() < 0.06
    assert coverage(drawn, 1152, 1152)[163:477, 163:477].min() == 1.0


def test_what_lines_on_paper_add_all_strokes_give_back():
    """Lines on bare paper have no hatching beside them to pay with: the mean of the sheet is right none the less."""
    y, x = (np.mgrid[:288, :288] + 0.5) / 288
    tone = np.where(x < 0.5, 0.0, 0.3 + 0.3 * y)
    at = np.arange(10.0, 140.0, 10.0)
    ruled = [np.array([[10.0, a], [30.0, a], [45.0, a], [60.0, a]]) for a in at]
    lines = Strokes.of(SIDE, SIDE, ruled, [0.15] * len(ruled))
    drawn = blast(tone, SIDE, SIDE, None, find_texture("form"), outlines=lines, swell=1.0, device_dpi=None)
    ink = coverage(Strokes.joined([lines, drawn]), 576, 576).astype(float)
    added = coverage(lines, 576, 576).mean()
    assert added > 0.0035
    assert abs(ink.mean() - tone.mean()) < 0.35 * added
