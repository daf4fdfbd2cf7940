"""Small dark things keep their darkness: pupils, nostrils, the frame of glasses.

The exposure lightens all darks alike where a picture has many of them. What is broad is still told by its border and
its hatching; a small thing is told by its darkness alone.
"""

from __future__ import annotations

import numpy as np

from penink_cli.composition.filters import Picture, blurred, closed, enlarged, shrunk

_CELL_PT = 0.5  # of the grid that they are looked for on: what is finer is grain
_HALF_PT = 4.0  # half the breadth of the broadest
_AROUND_PT = 14.0  # σ of the surroundings
# What is darker than the lights about it by STEP, and OFTEN times as much as is usual around, is a thing a little, by
# FULL more wholly. In fur and leaves much is so, and no more than texture.
_STEP, _OFTEN, _FULL = 0.15, 2.0, 0.12
_DARK, _NEARLY = 0.2, 0.1  # it is wholly one up to this grey, and NEARLY lighter none
_DARKER = 0.12  # by so much they are darker than they were
_LIGHT, _LIGHTER = 0.35, 0.1  # the grey from which on what is about it is light, and LIGHTER more wholly


def with_small_darks(composed: Picture, grey: Picture, pt: float, threads: int) -> Picture:
    """The composed grey (h, w) whose small dark things are as dark as in grey (h, w), and a little darker."""
    share = small_darks(grey, pt, threads)
    share *= np.maximum(composed - np.maximum(grey - np.float32(_DARKER), 0), 0)
    return composed - share


def small_darks(grey: Picture, pt: float, threads: int) -> Picture:
    """How much each place of grey (h, w), 0 ink … 1 paper, belongs to a small dark thing, 0 … 1; pt: pixels a point."""
    height, width = grey.shape
    cell = max(1.0, _CELL_PT * pt)
    w, h = max(1, round(width / cell)), max(1, round(height / cell))
    view = grey if cell == 1 else shrunk(grey, w, h, threads=threads)
    px = pt * w / width
    about = closed(view, max(1, round(_HALF_PT * px)))
    step = about - view
    usual = blurred(np.sqrt(np.sqrt(step)), _AROUND_PT * px, threads)
    usual *= usual
    share = np.clip((step - np.float32(_STEP) - np.float32(_OFTEN) * (usual * usual)) * np.float32(1 / _FULL), 0, 1)
    share *= np.clip((np.float32(_DARK + _NEARLY) - view) * np.float32(1 / _NEARLY), 0, 1)
    share *= np.clip((about - np.float32(_LIGHT)) * np.float32(1 / _LIGHTER), 0, 1)
    return enlarged(share, width, height, threads)
