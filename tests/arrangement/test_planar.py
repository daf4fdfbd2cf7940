"""Segments on the grid: room that grows, and nothing changed where it cannot."""

import numpy as np
import pytest

from penink_cli.arrangement._compiled import planar as _planar
from penink_cli.arrangement.planar import planar


def grid(segments=40):
    """Segments with both ends in one cell, with room for short ones alone; then the ends are moved apart."""
    vertices = np.array([[10 + k % 2, 10 + 3 * k] for k in range(2 * segments)], np.int64)
    held = planar(400, 400, vertices, np.arange(2 * segments, dtype=np.int32).reshape(-1, 2))
    at = np.asarray(held.vertices)
    at[::2] = [[10, 500 * k] for k in range(segments)]
    at[1::2] = [[39_000, 500 * k + 7] for k in range(segments)]
    return held


def test_segments_longer_than_was_foreseen_find_room():
    held = grid()
    for s in range(40):
        assert held.fits(2 * s, 2 * s + 1)
        held.add(s)
    assert np.asarray(held.live)[:40].all()
    at = np.asarray(held.vertices)
    at[0], at[1] = [20_000, 0], [20_001, 19_990]  # across all of them but its own
    assert not held.fits(0, 1)
    for s in range(40):
        held.remove(s)
    assert held.fits(0, 1)


def test_want_of_memory_changes_nothing(monkeypatch):
    def none(*_):
        raise MemoryError

    held = grid()
    whole = _planar.np
    at = np.asarray(held.vertices)
    with monkeypatch.context() as patch:
        patch.setattr(_planar, "np", type("numpy", (), {"zeros": staticmethod(none), "int32": np.int32}))
        with pytest.raises(MemoryError):
            for s in range(40):
                held.add(s)
    assert _planar.np is whole
    live = np.flatnonzero(np.asarray(held.live))
    assert 0 < len(live) < 40 and (live == np.arange(len(live))).all()
    for s in range(len(live)):
        held.remove(s)
    at[0], at[1] = [20_000, 0], [20_001, 19_990]
    assert held.fits(0, 1)  # nothing of the one that found no room is in the way
    for s in range(40):
        held.add(s)
