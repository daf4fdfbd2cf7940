"""Drawings to try the outputs on."""

import numpy as np

from penink_cli.ground.model import Strokes


def strokes_of(chains, widths, width=144.0, height=144.0, layer=None):
    """Strokes from a list of (3k + 1, 2) arrays."""
    chains = [np.asarray(c, float).reshape(-1, 2) for c in chains]
    first = np.concatenate([[0], np.cumsum([len(c) for c in chains], dtype=int)]).astype(np.int64)
    points = np.concatenate(chains) if chains else np.zeros((0, 2))
    return Strokes(width, height, points, first, np.broadcast_to(np.asarray(widths, float), len(chains)).copy(), layer)


def crosshatch(count=15000, side=576.0, pen=0.4, seed=0):
    """Slightly bowed strokes of 8 to 60 pt in two directions, all within the sheet."""
    rng = np.random.default_rng(seed)
    length = rng.uniform(8, 60, count)
    angle = np.where(np.arange(count) % 2, 1, -1) * np.pi / 4 + rng.normal(0, 0.02, count)
    along = np.stack([np.cos(angle), np.sin(angle)], axis=1) * length[:, None]
    across = np.stack([-along[:, 1], along[:, 0]], axis=1) * rng.normal(0, 0.006, (count, 1))
    reach = np.abs(along) / 2 + 3
    middle = reach + rng.random((count, 2)) * (side - 2 * reach)
    thirds = np.array([0, 1 / 3, 2 / 3, 1])[:, None, None]
    bow = np.array([0, 1, 1.2, 0])[:, None, None]
    points = (middle - along / 2) + thirds * along + bow * across
    points = points.transpose(1, 0, 2).reshape(-1, 2)
    return Strokes(side, side, points, np.arange(count + 1) * 4, np.full(count, pen), texture="crosshatch", seed=seed)


def every_kind():
    """Dots, straight and bowed strokes, loops, chains long and short, several pens, some over the border."""
    rng = np.random.default_rng(1)
    straight = [[[10 + i, 10], [10 + i, 20], [10 + i, 30], [10 + i, 40]] for i in range(0, 30, 3)]
    loop = [[60, 20], [110, -20], [110, 80], [60, 40]]
    cusp = [[80, 60], [120, 60], [80, 60.5], [120, 61]]
    back = [[20, 60], [60, 60], [10, 60], [40, 60]]  # there and back on one line
    t = np.linspace(0, 12 * np.pi, 3 * 250 + 1)
    spiral = np.stack([70 + t * np.cos(t), 100 + t * np.sin(t)], axis=1)
    zigzag = np.cumsum(rng.normal(0, 6, (13, 2)), axis=0) + np.array((100, 100))
    over = [[-8, 130], [20, 150], [120, 150], [150, 130]]
    dots = [[[x, 50]] for x in (10, 14.5, 19, 30)]
    nothing = [[50, 50]] * 4  # a segment that goes nowhere is a dot
    chains = [*straight, loop, cusp, back, spiral, zigzag, over, *dots, nothing]
    pens = np.array([0.4, 1, 2.5, 0.25])[np.arange(len(chains)) % 4]
    return strokes_of(chains, pens, layer="Every kind")


def swelling():
    """Strokes whose width changes: wavy lines as an engraver's, a taper, a corner, a hairpin, a loop, tangles."""
    rng = np.random.default_rng(2)
    lines, widths = [], []
    t = np.linspace(0, 1, 3 * 16 + 1)
    for i in range(16):
        lines.append(np.stack([8 + 128 * t, 8 + 4 * i + 3 * np.sin(6 * t + i / 5)], axis=1))
        widths.append(np.clip(1.5 + 1.6 * np.sin(np.arange(17) / 2.5 + i / 3), 0, 3))
    lines += [
        [[10, 90], [20, 86], [30, 86], [40, 90]],  # a taper
        [[50, 90], [53, 90], [57, 90], [60, 90], [60, 93], [60, 97], [60, 100]],  # a corner
        [[70, 88], [76, 88], [76, 92], [70, 92]],  # a hairpin
        [[80, 80], [120, 120], [120, 70], [85, 100]],  # a loop
        [[120, 90]] * 4,  # goes nowhere
        [[120, 110], [120, 110], [130, 110], [130, 110]],  # slow at its ends
        [[10, 120], [10.2, 120], [10.4, 120], [10.6, 120]],  # shorter than it is wide
    ]
    widths += [[3, 0], [3, 4, 2], [4, 6], [1, 5], [1, 3], [6, 1], [5, 0]]
    for _ in range(12):
        lines.append(np.cumsum(rng.normal(0, 2, (3 * 4 + 1, 2)), axis=0) + rng.uniform(100, 130, 2))
        widths.append(rng.uniform(0, 2, 5))
    return Strokes.of(144, 144, lines, widths)
