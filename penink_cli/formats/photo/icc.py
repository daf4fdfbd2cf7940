"""ICC profiles (ICC.1) of a curve for grey, or of curves and a matrix for red, green and blue.

A profile of another kind is reported and not applied.
"""

from __future__ import annotations

import struct

import numpy as np

from penink_cli.formats.photo.choices import Verdict
from penink_cli.formats.photo.profile import FROM_XYZ, Curve, Profile, product
from penink_cli.ground.exact import power
from penink_cli.ground.model import Floats

MOST = 1 << 22  # bytes of a profile that are read
WORDS = 1 << 16  # the most entries of a curve's table
_PARAMETERS = (1, 3, 4, 5, 7)  # how many of g a b c d e f each function of a parametric curve has
_TRIED = np.arange(5) / 4  # values at which a curve is tried


class Unread(Exception):
    """A profile cannot be applied; the message is the end of a sentence that begins with "its colour profile"."""


def read(profile: bytes, grey: bool) -> Profile:
    """The profile of a grey or a coloured picture.

    Raises Unread for a profile that makes no sense, is not for such a picture, or is of a kind that is not read.
    """
    try:
        return _read(profile[:MOST], grey)
    except (struct.error, IndexError, OverflowError, ZeroDivisionError):
        raise Unread("makes no sense") from None


def profile_of(embedded: bytes | None, grey: bool, verdict: Verdict) -> Profile | None:
    """The profile embedded in a grey or a coloured picture; None, with a line, where it cannot be applied."""
    if not embedded or not verdict.choices.profile:
        return None
    try:
        return read(embedded, grey)
    except Unread as error:
        verdict.say(f"its colour profile {error}: it is read as sRGB")
        return None


def _read(profile: bytes, grey: bool) -> Profile:
    space, connection = profile[16:20], profile[20:24]
    if profile[36:40] != b"acsp":
        raise Unread("makes no sense")
    if space not in (b"GRAY", b"RGB ") or (space == b"GRAY" and not grey):
        raise Unread("is not for its kind of colours")
    tags: dict[bytes, bytes] = {}
    for i in range(min(struct.unpack_from(">I", profile, 128)[0], 256)):
        name, at, length = struct.unpack_from(">4sII", profile, 132 + 12 * i)
        tags.setdefault(name, profile[at : at + length])
    if space == b"GRAY":
        if b"kTRC" not in tags:
            raise Unread("has no curve")
        curve = _curve(tags[b"kTRC"])
        return Profile((curve if connection == b"XYZ " else _of_lightness(curve),))
    if connection != b"XYZ " or any(
        name not in tags for name in (b"rXYZ", b"gXYZ", b"bXYZ", b"rTRC", b"gTRC", b"bTRC")
    ):
        raise Unread("is made of tables of colours")
    columns = [_point(tags[name]) for name in (b"rXYZ", b"gXYZ", b"bXYZ")]
    rows = tuple(tuple(column[i] for column in columns) for i in range(3))
    return Profile(tuple(_curve(tags[name]) for name in (b"rTRC", b"gTRC", b"bTRC")), product(FROM_XYZ, rows))


def _point(tag: bytes) -> tuple[float, ...]:
    """X, Y and Z of a tag of type XYZ."""
    return tuple(v / 65536 for v in struct.unpack_from(">3i", tag, 8))


def _curve(tag: bytes) -> Curve:
    """The curve that a tag defines, from values to light, both 0 … 1.

    Raises Unread for one that gives no number, or the same light for all values.
    """
    curve = _defined(tag)
    with np.errstate(all="ignore"):
        light = curve(_TRIED)
    if not np.isfinite(light).all() or (light == light[0]).all():
        raise Unread("has a curve that makes no sense")
    return curve


def _defined(tag: bytes) -> Curve:
    """The curve as the tag has it, whatever it gives."""
    if tag[:4] == b"para":
        return _parametric(tag)
    if tag[:4] != b"curv":
        raise Unread("has a curve that makes no sense")
    count = struct.unpack_from(">I", tag, 8)[0]
    if count == 0:
        return lambda value: value
    if count == 1:
        return _gamma(struct.unpack_from(">H", tag, 12)[0] / 256)
    if count > WORDS:
        raise Unread("has a curve that makes no sense")
    table = np.array(struct.unpack_from(f">{count}H", tag, 12)) / 65535

    def between(value: Floats) -> Floats:
        place = value * (count - 1)
        step = np.minimum(place.astype(np.int64), count - 2)
        low = table[step]
        return low + (table[step + 1] - low) * (place - step)

    return between


def _gamma(g: float) -> Curve:
    return lambda value: power(value, g)


def _parametric(tag: bytes) -> Curve:
    """Functions 0 … 4 of parametricCurveType. Raises ZeroDivisionError where b/a is needed and a is 0."""
    function = struct.unpack_from(">H", tag, 8)[0]
    count = _PARAMETERS[function]
    given = [v / 65536 for v in struct.unpack_from(f">{count}i", tag, 12)]
    g, a, b, c, d, e, f = given + [0.0] * (7 - count)
    if g <= 0:
        raise Unread("has a curve that makes no sense")
    if function == 0:
        return _gamma(g)
    if function in (1, 2):  # (a·x + b)^g + c from -b/a on, c below
        begin = -b / a
        return lambda x: np.where(x >= begin, power(np.maximum(a * x + b, 0.0), g) + c, c)
    # (a·x + b)^g + e from d on, c·x + f below
    return lambda x: np.where(x >= d, power(np.maximum(a * x + b, 0.0), g) + e, c * x + f)


def _of_lightness(curve: Curve) -> Curve:
    """From values to light, of a curve from values to CIE lightness, 0 … 1 for L* 0 … 100."""

    def light(value: Floats) -> Floats:
        lightness = 100.0 * curve(value)
        root = (lightness + 16.0) / 116.0
        return np.where(lightness > 8.0, root * root * root, lightness / 903.2963)

    return light
