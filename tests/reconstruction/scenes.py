"""Five scenes known everywhere: a tone for each point of the unit square, and the edges it jumps at."""

from __future__ import annotations

import numpy as np

from penink_cli.ground.model import EdgeList

FRAME = 4096  # pixels of the photo that the edge lists pretend to come from


def _edges(points, closed):
    n = len(points)
    ends = [(k, (k + 1) % n) for k in range(n if closed else n - 1)]
    return EdgeList(FRAME, FRAME, np.array(points, float) * FRAME, np.array(ends, np.int64))


def _inside(points, x, y):
    """Even-odd, for a polygon."""
    found = np.zeros(x.shape, bool)
    for (ax, ay), (bx, by) in zip(points, [*points[1:], points[0]]):
        found ^= ((ay > y) != (by > y)) & (x < (bx - ax) * (y - ay) / ((by - ay) or 1) + ax)
    return found


def _gradient(x, y):
    return 0.25 + 0.2 * x + 0.1 * y


def _two_tones(points):
    def tone(x, y):
        return np.where(_inside(points, x, y), 0.8 - 0.15 * x + 0.05 * y, _gradient(x, y))

    return tone, _edges(points, closed=True)


def disc():
    """A disc as a 64-gon on a gradient."""
    a = np.arange(64) * 2 * np.pi / 64
    return _two_tones([(0.5 + 0.31 * np.cos(t), 0.49 + 0.31 * np.sin(t)) for t in a])


def star():
    """Five long points, sharp angles inside and out."""
    a = np.arange(10) * np.pi / 5 - np.pi / 2
    r = np.where(np.arange(10) % 2, 0.17, 0.43)
    return _two_tones([(0.5 + q * np.cos(t), 0.51 + q * np.sin(t)) for t, q in zip(a, r)])


def wedge():
    """Thinner than a sample at its point."""
    return _two_tones([(0.06, 0.47), (0.92, 0.36), (0.94, 0.63)])


def half_plane():
    """One slanting line from border to border."""
    points = [(0.37, 0.0), (0.61, 1.0)]

    def tone(x, y):
        return np.where(x < 0.37 + 0.24 * y, 0.75 - 0.2 * y, _gradient(x, y))

    return tone, _edges(points, closed=False)


def crease():
    """A step that fades out within the picture, where its edge ends."""

    def tone(x, y):
        t = np.clip((0.62 - x) / 0.62, 0, 1)
        return _gradient(x, y) + np.where(y > 0.48 + 0.1 * x, 1, -1) * 0.25 * t * t * (3 - 2 * t)

    return tone, _edges([(0.0, 0.48), (0.62, 0.542)], closed=False)


# Scene -> (what makes it, the PSNR in dB a correct implementation reaches, its measured prototype's less half a dB).
SCENES = {
    "disc": (disc, 59.2),
    "half plane": (half_plane, 56.8),
    "star": (star, 54.2),
    "thin wedge": (wedge, 44.8),
    "fading crease": (crease, 57.9),
}


def tones(tone, n):
    """(n, n) tones at pixel centres."""
    x, y = np.meshgrid(*[(np.arange(n) + 0.5) / n] * 2)
    return tone(x, y)


def psnr(found, truth):
    """dB, for tones of 0 … 1."""
    return -10 * np.log10(np.mean((found - truth) ** 2))
