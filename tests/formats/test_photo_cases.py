"""Photographs with something the matter, as photo_cases.py has them."""

from __future__ import annotations

import io

import numpy as np
import pytest
from PIL import Image

from penink_cli.formats import photo
from tests.formats.photo_cases import COLOUR, Case, cases, given, luma

CASES = {f"{case.group}: {case.name}": case for case in cases()}


@pytest.mark.parametrize("name", CASES)
def test_a_case(name):
    found, right = given(CASES[name])
    assert right, found


def test_a_case_can_fail():
    whole = CASES["metadata: PNG: no end"]
    assert not given(Case("", "", whole.data, whole.wanted))[1]  # no line was wanted
    assert not given(Case("", "", whole.data, np.asarray(whole.wanted) + 2, lines=whole.lines))[1]
    assert not given(Case("", "", whole.data, "damaged", lines=whole.lines))[1]


def test_heic_where_its_package_is_there():
    heif = pytest.importorskip("pillow_heif")
    heif.register_heif_opener()
    out = io.BytesIO()
    Image.fromarray(np.kron(COLOUR, np.ones((4, 4, 1), np.uint8))).save(out, "HEIF", quality=95)
    grey = photo.read_grey(io.BytesIO(out.getvalue()), "p", 10**6)
    assert np.abs(grey.values - luma(np.kron(COLOUR, np.ones((4, 4, 1))))).mean() < 3


def test_heic_without_its_package(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pillow_heif", None)
    with pytest.raises(photo.PeninkError, match=r"HEIC photograph: its reader is an extra"):
        photo.read_grey(io.BytesIO(b"\0\0\0\x18ftypheic\0\0\0\0heicmif1" + bytes(50)), "p", 100)
