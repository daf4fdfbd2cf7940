"""JSON as its definition has it, not as Python's reader would let it pass.

UTF-8 without a byte order mark; no NaN, no infinity (``1e999`` included), no number beyond a
double; no member twice; no half of a surrogate pair; nothing after the value. `number`, `whole`,
`text`, `pairs` and their like then take typed values out of what was read, and never a bool for a number.
`written` is for writers: it refuses the text that `loads` would refuse.
"""

from __future__ import annotations

import json
import math
import re
from itertools import chain
from typing import Any

import numpy as np
import numpy.typing as npt

from penink_cli.ground.errors import FormatError, ParameterError, printable
from penink_cli.ground.model import Floats, Ints

_LONG = re.compile(rb"[0-9]{309}")  # digits: the shortest integer that may be beyond a double
_HALF_SURROGATE = re.compile(rb"\\u[dD][89a-fA-F]")


class _Refused(Exception):
    """Raised by a hook of the decoder, which does not know the file; `loads` turns it into a FormatError."""


def _members(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    members = dict(pairs)
    if len(members) != len(pairs):
        seen: set[str] = set()
        for name, _ in pairs:
            if name in seen:
                raise _Refused(f"member {quoted(name)} appears twice")
            seen.add(name)
    return members


def _finite(digits: str) -> float:
    value = float(digits)
    if value - value:  # infinite: the difference is NaN, and true
        raise _Refused(f"number {printable(digits, 60)} is out of range")
    return value


def _in_range(digits: str) -> int:
    try:
        float(value := int(digits))
    except OverflowError:
        raise _Refused(f"number {printable(digits, 60)} is out of range") from None
    return value


def _constant(name: str) -> Any:
    raise _Refused(f"{name} is not JSON")


_DECODER = json.JSONDecoder(object_pairs_hook=_members, parse_float=_finite, parse_constant=_constant)
_LONG_DECODER = json.JSONDecoder(
    object_pairs_hook=_members, parse_float=_finite, parse_constant=_constant, parse_int=_in_range
)


def loads(text: bytes, source: str | None = None, place: str = "") -> Any:
    """The value of one JSON text.

    source: the file, for the error. place: such as ``line 3``, put before what was found. Raises FormatError.
    """
    where = f"{place}: " if place else ""
    if text.startswith(b"\xef\xbb\xbf"):
        raise FormatError(f"{where}begins with a byte order mark; plain UTF-8 is needed", source)
    try:
        decoded = text.decode("utf-8")
    except UnicodeDecodeError as error:
        raise FormatError(f"{where}byte {error.start}: not UTF-8", source) from None
    try:
        value = (_LONG_DECODER if _LONG.search(text) else _DECODER).decode(decoded)
        if _HALF_SURROGATE.search(text):
            _check_surrogates(value)
    except _Refused as error:
        raise FormatError(f"{where}{error}", source) from None
    except json.JSONDecodeError as error:
        line = "" if place else f"line {error.lineno}, "
        what = error.msg[:1].lower() + error.msg[1:]
        if not text.strip(b" \t\r\n"):
            what = "empty"
        raise FormatError(f"{where}{line}column {error.colno}: not JSON: {what}", source) from None
    except RecursionError:
        raise FormatError(f"{where}nested too deeply", source) from None
    except ValueError:
        raise FormatError(f"{where}a number has too many digits", source) from None
    return value


def _check_surrogates(value: Any) -> None:
    for part in (value, *value) if isinstance(value, dict) else (value,):
        if isinstance(part, str):
            try:
                part.encode("utf-8")
            except UnicodeEncodeError:
                raise _Refused(f"text {quoted(part)} has half of a surrogate pair") from None
    if isinstance(value, (dict, list)):
        for part in value.values() if isinstance(value, dict) else value:
            _check_surrogates(part)


# ------------------------------------------------------- typed values out of what was read


def quoted(value: Any) -> str:
    """A value for an error line: one printable line of at most 60 characters."""
    if isinstance(value, str):
        return f'"{printable(value, 60)}"'
    if isinstance(value, dict):
        return "an object"
    if isinstance(value, list):
        return "an array" if len(value) > 4 or not all(isinstance(v, (int, float)) for v in value) else _brief(value)
    return _brief(value)


def _brief(value: Any) -> str:
    try:
        return printable(json.dumps(value), 60)
    except ValueError:  # an integer of more digits than Python likes to print
        return "a huge number"


def member(container: Any, name: str, place: str = "") -> Any:
    """A member that must be there. Raises FormatError."""
    try:
        return container[name]
    except KeyError:
        raise FormatError(f'{place}{": " if place else ""}member "{name}" is missing') from None


def members(value: Any, what: str) -> dict[str, Any]:
    """An object. Raises FormatError, in which ``what`` names it."""
    if type(value) is not dict:
        raise FormatError(f"{what} is {quoted(value)}; an object is needed")
    return value


def header(document: Any, format_name: str, place: str = "") -> dict[str, Any]:
    """An object that says ``"format": format_name, "version": 1``. Raises FormatError."""
    where = f"{place}: " if place else ""
    if not isinstance(document, dict):
        raise FormatError(f"{where}an object is expected, found {quoted(document)}")
    found = member(document, "format", place)
    if found != format_name:
        raise FormatError(f'{where}format is {quoted(found)}; "{format_name}" is expected')
    version = member(document, "version", place)
    if type(version) is not int or version != 1:
        raise FormatError(f"{where}version is {quoted(version)}; 1 is the only one known")
    return document


def whole(value: Any, what: str, least: int, most: int) -> int:
    """A whole number from ``least`` to ``most``. Raises FormatError, in which ``what`` names it."""
    if type(value) is not int or not least <= value <= most:
        raise FormatError(f"{what} is {quoted(value)}; a whole number from {least} to {most} is needed")
    return value


def number(value: Any, what: str, least: float = -math.inf, most: float = math.inf) -> float:
    """A number from ``least`` to ``most``. Raises FormatError, in which ``what`` names it."""
    try:
        if type(value) not in (int, float) or not least <= float(value) <= most:
            raise OverflowError
        return float(value)
    except OverflowError:
        bounds = f" from {least:g} to {most:g}" if math.isfinite(least + most) else ""
        bounds = bounds or (f" of at least {least:g}" if math.isfinite(least) else "")
        raise FormatError(f"{what} is {quoted(value)}; a number{bounds} is needed") from None


def flag(value: Any, what: str) -> bool:
    """``true`` or ``false``. Raises FormatError, in which ``what`` names it."""
    if type(value) is not bool:
        raise FormatError(f"{what} is {quoted(value)}; true or false is needed")
    return value


def text(value: Any, what: str) -> str:
    """A string. Raises FormatError, in which ``what`` names it."""
    if type(value) is not str:
        raise FormatError(f"{what} is {quoted(value)}; text is needed")
    return value


def colour(value: Any, what: str) -> str:
    """The value, which is ``#rrggbb``. Raises FormatError, in which ``what`` names it."""
    if not (isinstance(value, str) and re.fullmatch("#[0-9a-fA-F]{6}", value, re.ASCII)):
        raise FormatError(f"{what} {quoted(value)} is not #rrggbb")
    return value


def array(value: Any, what: str) -> list[Any]:
    """An array. Raises FormatError, in which ``what`` names it."""
    if type(value) is not list:
        raise FormatError(f"{what} is {quoted(value)}; an array is needed")
    return value


def numbers(value: Any, what: str, each: str) -> Floats:
    """An array of numbers as (n,). Raises FormatError, in which ``each`` names one of them (``strength``)."""
    if not set(map(type, array(value, what))) <= {int, float}:
        _refuse_first(value, each, (int, float))
    try:
        return np.fromiter(value, np.float64, len(value))
    except OverflowError:
        _refuse_first(value, each, (float,))
        raise AssertionError("unreachable") from None


def pairs(value: Any, what: str, each: str) -> Floats:
    """An array of pairs of numbers as (n, 2). Raises FormatError, in which ``each`` names one of them (``vertex``)."""
    return _table(value, what, each, (int, float), np.float64)


def whole_pairs(value: Any, what: str, each: str) -> Ints:
    """An array of pairs of whole numbers of any sign as (n, 2). Raises FormatError as `pairs` does."""
    return _table(value, what, each, (int,), np.int64)


def _table(value: Any, what: str, each: str, kinds: tuple[type, ...], dtype: Any) -> npt.NDArray[Any]:
    """An array of pairs as (n, 2) of ``dtype``, their numbers of one of ``kinds``. Raises FormatError.

    Types are gathered in sets, not looked at one by one: 20 000 pairs take 3 ms, not 20.
    """
    items = array(value, what)
    if not set(map(type, items)) <= {list} or not set(map(len, items)) <= {2}:
        at = next(i for i, pair in enumerate(items) if type(pair) is not list or len(pair) != 2)
        raise FormatError(f"{each} {at} is {quoted(items[at])}; a pair of numbers is needed")
    flat = list(chain.from_iterable(items))
    if not set(map(type, flat)) <= set(kinds):
        _refuse_first(flat, each, kinds, 2)
    try:
        return np.fromiter(flat, dtype, len(flat)).reshape(-1, 2)
    except OverflowError:
        _refuse_first(flat, each, (float,), 2)
        raise AssertionError("unreachable") from None


def _refuse_first(values: list[Any], each: str, kinds: tuple[type, ...], group: int = 1) -> None:
    """Raise FormatError for the first value that is of none of ``kinds``, or is an integer beyond int64.

    group: values that ``each`` counts as one.
    """
    needed = "whole numbers are" if kinds == (int,) else "numbers in range are"
    for i, value in enumerate(values):
        fits = type(value) is int and -(2**63) <= value < 2**63
        if not fits and (type(value) not in kinds or type(value) is int):
            raise FormatError(f"{each} {i // group} holds {quoted(value)}; {needed} needed")


# --------------------------------------------------------------------------- for writers


def written(value: str, what: str) -> str:
    """A text as JSON, in ASCII. Raises ParameterError, in which ``what`` names it, where `loads` would refuse it.

    Python makes half of a surrogate pair of each byte that is not UTF-8 in a command line or in the name of a file.
    """
    try:
        value.encode("utf-8")
    except UnicodeEncodeError:
        raise ParameterError(f"{what} {quoted(value)} is not UTF-8") from None
    return json.dumps(value)
