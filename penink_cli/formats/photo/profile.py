"""What stored colours mean if they are not sRGB's: a curve for each channel, and a matrix.

A value goes through its channel's curve to light, the light through the matrix to light of sRGB's red, green and blue,
and that through sRGB's own curve (IEC 61966-2-1). Luma is then taken as of any other photograph, and tone is true to
what a viewer that manages colours shows. Curves are tables, made once; no power is taken for a pixel.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from penink_cli.formats._compiled import colours as _colours
from penink_cli.ground.exact import power
from penink_cli.ground.model import Floats

STEPS = 1 << 16  # of the table of sRGB's curve
SAME = 0.6 / 255  # a profile that moves no colour by more is taken for sRGB's
NEUTRAL = 0.02  # a matrix that moves white by no more is made to keep it

# Light of red, green and blue from CIE XYZ at the D50 white of profiles (sRGB primaries, adapted by Bradford).
FROM_XYZ = (
    (3.1338561, -1.6168667, -0.4906146),
    (-0.9787684, 1.9161415, 0.0334540),
    (0.0719453, -0.2289914, 1.4052427),
)
IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
Matrix = tuple[tuple[float, ...], ...]
Curve = Callable[[Floats], Floats]


def to_srgb(light: Floats) -> Floats:
    """sRGB's value, 0 … 1, of light 0 … 1."""
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * power(light, 1 / 2.4) - 0.055)


def from_srgb(value: Floats) -> Floats:
    """Light, 0 … 1, of sRGB's value 0 … 1."""
    return np.where(value <= 0.04045, value / 12.92, power((value + 0.055) / 1.055, 2.4))


@dataclass(frozen=True, eq=False)
class Profile:
    """Curves from values to light, both 0 … 1, one or three; and the matrix to sRGB's light, where there are three."""

    curves: tuple[Curve, ...]
    matrix: Matrix = IDENTITY

    def conversion(self, maxval: int) -> Callable[[npt.NDArray[Any]], npt.NDArray[Any]] | None:
        """A function from bands (k, w, 1 or 3) of values 0 … maxval to sRGB's values; None for sRGB's own profile."""
        if self._is_srgb():
            return None
        stored = np.arange(maxval + 1) / maxval
        tables = tuple(np.clip(curve(stored), 0.0, 1.0) for curve in self.curves)
        depth = np.uint8 if maxval < 256 else np.uint16
        light = np.array((tables * 3)[:3])
        matrix = np.array(self._neutral())
        coding = to_srgb(np.arange(STEPS + 1) / STEPS) * maxval

        def coded(light: Floats) -> npt.NDArray[Any]:
            """The nearest values of light 0 … 1, linear between two steps of sRGB's table."""
            place = np.clip(light, 0.0, 1.0) * STEPS
            step = np.minimum(place.astype(np.int64), STEPS - 1)
            low = coding[step]
            return np.floor(low + (coding[step + 1] - low) * (place - step) + 0.5).astype(depth)

        def convert(band: npt.NDArray[Any]) -> npt.NDArray[Any]:
            if band.shape[2] == 1:
                return table[band]
            flat = np.ascontiguousarray(band).reshape(-1, 3)
            shown = np.empty_like(flat)
            _colours.convert(flat, light, matrix, coding, shown)
            return shown.reshape(band.shape)

        if len(tables) == 1:
            table = coded(tables[0])
        else:  # a grey value is one of equal red, green and blue
            from penink_cli.formats.photo.decoded import luma

            grey = np.repeat(np.arange(maxval + 1, dtype=depth)[None, :, None], 3, axis=2)
            table = luma(convert(grey))[0].astype(depth)
        return convert

    def _neutral(self) -> Matrix:
        """The matrix, made to keep white if it nearly does."""
        sums = [a + b + c for a, b, c in self.matrix]
        if any(abs(total - 1.0) > NEUTRAL for total in sums):
            return self.matrix
        return tuple(tuple(x / total for x in row) for row, total in zip(self.matrix, sums, strict=True))

    def _is_srgb(self) -> bool:
        """Whether the profile moves no colour of a coarse lattice, and no grey, by more than SAME."""
        stored = np.arange(256) / 255.0
        for curve in self.curves:
            if np.abs(to_srgb(np.clip(curve(stored), 0.0, 1.0)) - stored).max() > SAME:
                return False
        if len(self.curves) == 1:
            return True
        side = np.arange(9) / 8.0
        lattice = np.stack(np.meshgrid(side, side, side, indexing="ij")).reshape(3, -1)
        light = [np.clip(curve(row), 0.0, 1.0) for curve, row in zip(self.curves, lattice, strict=True)]
        for i, (a, b, c) in enumerate(self._neutral()):
            shown = to_srgb(np.clip(a * light[0] + b * light[1] + c * light[2], 0.0, 1.0))
            if np.abs(shown - lattice[i]).max() > SAME:
                return False
        return True


def of_gamma(gamma: float, primaries: tuple[float, ...] | None = None) -> Profile | None:
    """The profile of values that are light to the power gamma; None where they are sRGB's.

    primaries: x and y of white, red, green and blue, None for sRGB's.
    """
    matrix = _of_primaries(primaries) if primaries else IDENTITY
    if abs(gamma - 1 / 2.2) < 0.005:  # how programs that mean sRGB say so
        return None if matrix is None or matrix == IDENTITY else Profile((from_srgb,) * 3, matrix)

    def curve(value: Floats) -> Floats:
        return power(value, 1.0 / gamma)

    return Profile((curve,) * 3, matrix or IDENTITY)


def _of_primaries(xy: tuple[float, ...]) -> Matrix | None:
    """The matrix from light of primaries to sRGB's, by way of XYZ adapted to D50 (Bradford); None for no such matrix.

    xy: x and y of white, red, green and blue.
    """
    try:
        points = [(x / y, 1.0, (1.0 - x - y) / y) for x, y in zip(xy[::2], xy[1::2], strict=True)]
        white, columns = points[0], points[1:]
        rows = tuple(tuple(column[i] for column in columns) for i in range(3))
        amounts = applied(inverse(rows), white)
        scaled = tuple(tuple(x * s for x, s in zip(row, amounts, strict=True)) for row in rows)
        bradford = ((0.8951, 0.2664, -0.1614), (-0.7502, 1.7135, 0.0367), (0.0389, -0.0685, 1.0296))
        seen, wanted = applied(bradford, white), applied(bradford, (0.9642, 1.0, 0.8249))
        gains = tuple(tuple(w / s if i == j else 0.0 for j in range(3)) for i, (s, w) in enumerate(zip(seen, wanted)))
        adapted = product(inverse(bradford), product(gains, bradford))
        return product(FROM_XYZ, product(adapted, scaled))
    except ZeroDivisionError:
        return None


def product(a: Matrix, b: Matrix) -> Matrix:
    """The product of two matrices of three rows."""
    return tuple(tuple(row[0] * b[0][j] + row[1] * b[1][j] + row[2] * b[2][j] for j in range(len(b[0]))) for row in a)


def applied(a: Matrix, v: tuple[float, ...]) -> tuple[float, ...]:
    """A matrix times a vector."""
    return tuple(row[0] * v[0] + row[1] * v[1] + row[2] * v[2] for row in a)


def inverse(m: Matrix) -> Matrix:
    """The inverse of a matrix of 3 × 3, by its cofactors."""
    (a, b, c), (d, e, f), (g, h, i) = m
    determinant = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    rows = (
        (e * i - f * h, c * h - b * i, b * f - c * e),
        (f * g - d * i, a * i - c * g, c * d - a * f),
        (d * h - e * g, b * g - a * h, a * e - b * d),
    )
    return tuple(tuple(x / determinant for x in row) for row in rows)
