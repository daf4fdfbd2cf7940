"""A bank of oriented filters: how much each place of a picture looks like a piece of a dark, or light, line.

Each filter is an elongated difference of Gaussians in one direction: a Gaussian less one that is 1.6 times as wide
across. That is close to a second derivative across the line, and a low-pass along it. The response to dark lines is
above 0, that to light ones below.

This module alone imports the compiled kernel `oriented`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

import numpy as np
import numpy.typing as npt

from penink_cli.ground import exact
from penink_cli.ground import threads as threading
from penink_cli.ground.model import Floats
from penink_cli.lines._compiled import oriented

Picture = npt.NDArray[np.float32]
Bank = npt.NDArray[np.float32]  # (directions, h, w)

DIRECTIONS = 24  # in half a turn, 7.5° apart
WIDER = 1.6  # how many times as wide across the second Gaussian is
CUT = 0.012  # taps at which the wider Gaussian is below this part of its peak are left out
_BAND = 32  # rows of a task


def units(parts: int) -> Floats:
    """(parts, 2) unit vectors x, y of that many directions in a whole turn, the same on every machine."""
    turns = (2 * math.pi * k / parts for k in range(parts))
    return np.array([(round(math.cos(a), 12), round(math.sin(a), 12)) for a in turns])


def responses(picture: Picture, across: float, along: float, threads: int) -> Bank:
    """(DIRECTIONS, h, w) responses to the picture (h, w), which is mirrored beyond its frame.

    across, along: σ of the narrow Gaussian, pixels. A line with that profile has a response of a fifth of its contrast.
    """
    h, w = picture.shape
    r = math.ceil(3 * max(WIDER * across, along))
    padded = np.ascontiguousarray(np.pad(picture, r, mode="symmetric"))
    out = np.empty((DIRECTIONS, h, w), np.float32)
    tasks: list[Callable[[], object]] = []
    for k, (x, y) in enumerate(units(2 * DIRECTIONS)[:DIRECTIONS].tolist()):
        down, right, weight = _taps(across, along, r, x, y)
        offset = (down * padded.shape[1] + right).astype(np.intp)

        def work(top: int, bottom: int, k: int = k, offset=offset, weight=weight) -> None:  # type: ignore[no-untyped-def]
            oriented.respond(padded, offset, weight, out[k], top, bottom)

        tasks += threading.ranges(work, h, 4 * _BAND)
    threading.share(tasks, threads)
    return out


@cache
def _taps(
    across: float, along: float, r: int, x: float, y: float
) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int32], npt.NDArray[np.float32]]:
    """Taps of a filter along (x, y): rows (t,) and columns (t,) in a window of 2 r + 1 pixels a side, weights (t,)."""
    i, j = np.divmod(np.arange((2 * r + 1) ** 2), 2 * r + 1)
    u, v = (j - r) * x + (i - r) * y, (i - r) * x - (j - r) * y
    low = exact.exp(-0.5 * _square(u / along))
    wide = low * exact.exp(-0.5 * _square(v / (WIDER * across)))
    seen = np.flatnonzero(wide > CUT)
    narrow = low[seen] * exact.exp(-0.5 * _square(v[seen] / across))
    a, b = math.fsum(narrow), math.fsum(wide[seen])
    weights = [round(w / b - n / a, 9) for w, n in zip(wide[seen].tolist(), narrow.tolist())]
    weights[len(weights) // 2] -= math.fsum(weights)  # the response to even ground is 0
    return i[seen].astype(np.int32), j[seen].astype(np.int32), np.array(weights, np.float32)


def _square(x: Floats) -> Floats:
    return x * x


def strongest(bank: Bank, threads: int) -> tuple[tuple[Picture, Picture], tuple[Picture, Picture]]:
    """The greatest response of dark lines in any direction (h, w), and the mean over all directions; those of light."""
    _, h, w = bank.shape
    most, mean, light_most, light_mean = (np.empty((h, w), np.float32) for _ in range(4))

    def work(top: int, bottom: int) -> None:
        oriented.strongest(bank, most, mean, light_most, light_mean, top, bottom)

    threading.share(threading.ranges(work, h, _BAND), threads)
    return (most, mean), (light_most, light_mean)


def weigh(bank: Bank, dark: tuple[Picture, Picture], light: tuple[Picture, Picture], threads: int) -> None:
    """Weigh a bank in place: a response r becomes ± (± r · factor − less), or 0 where its sign would change.

    dark, light: factor and less (h, w) for responses above 0, and for those below.
    """
    work = threading.ranges(lambda top, bottom: oriented.weigh(bank, *dark, *light, top, bottom), bank.shape[1], _BAND)
    threading.share(work, threads)
