"""sRGB's curve, and CIE Lab, the same to the last bit everywhere."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.ground import exact

Floats = npt.NDArray[np.float64]

LEAST = 216 / 24389  # below it CIE's cube root is a straight line


def linear(encoded: npt.ArrayLike) -> Floats:
    """Light of sRGB's values, both 0 … 1."""
    v = np.asarray(encoded, np.float64)
    return np.asarray(np.where(v <= 0.04045, v / 12.92, exact.power((v + 0.055) / 1.055, 2.4)))


def encoded(light: npt.ArrayLike) -> Floats:
    """sRGB's values of light, both 0 … 1."""
    v = np.asarray(light, np.float64)
    return np.asarray(np.where(v <= 0.0031308, v * 12.92, 1.055 * exact.power(v, 1 / 2.4) - 0.055))


#: Linear sRGB to X, Y, Z, scaled so that white (D65) is 1, 1, 1.
XYZ = (
    (0.412453 / 0.950456, 0.357580 / 0.950456, 0.180423 / 0.950456),
    (0.212671, 0.715160, 0.072169),
    (0.019334 / 1.088754, 0.119193 / 1.088754, 0.950227 / 1.088754),
)

#: The inverse of `XYZ`: X, Y, Z to linear sRGB.
RGB = (
    (3.079934935533, -1.537151516271, -0.542783419262),
    (-0.921234182754, 1.87599000149, 0.045244181264),
    (0.052889682046, -0.204041338367, 1.151151656321),
)


def lab_of_light(light: Floats) -> Floats:
    """Lab (…, 3) of linear sRGB (…, 3)."""
    x, y, z = (root(r * light[..., 0] + g * light[..., 1] + b * light[..., 2]) for r, g, b in XYZ)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def light_of_lab(lab: Floats) -> Floats:
    """Linear sRGB (…, 3) of Lab (…, 3): below 0 or above 1 where there is no such light."""
    middle = (lab[..., 0] + 16) / 116
    x, y, z = (_cube(f) for f in (middle + lab[..., 1] / 500, middle, middle - lab[..., 2] / 200))
    return np.stack([a * x + b * y + c * z for a, b, c in RGB], axis=-1)


def _cube(f: Floats) -> Floats:
    """The inverse of `root`."""
    return np.where(f > 6 / 29, f * f * f, (116 * f - 16) * (27 / 24389))


def root(t: Floats) -> Floats:
    """CIE's cube root, with its straight piece near 0; by Newton's method."""
    v = np.maximum(t, LEAST)
    found = 0.25 + 0.75 * v
    for _ in range(6):
        found = found - (found * found * found - v) / (3 * found * found)
    return np.where(t > LEAST, found, (24389 / 27 * t + 16) / 116)
