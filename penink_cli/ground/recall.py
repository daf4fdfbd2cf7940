"""Results remembered while `draw --watch` draws again, so that nothing is made twice of the same things.

`chain.kept` remembers what whole filters have made. Most of the work of a filter that runs again does not depend on
what has changed either: with another pen the field is read alike, and telling lines and solid black stay in place.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

T = TypeVar("T")

#: How many results of one name are remembered: more than a drawing has plates.
MOST = 8

_made: list[dict[str, dict[bytes, Any]]] = []


@contextmanager
def remembering() -> Iterator[None]:
    """Let `recalled` remember results while the block runs."""
    _made.append({})
    try:
        yield
    finally:
        _made.pop()


def recalled(name: str, told: tuple[Any, ...], make: Callable[[], T]) -> T:
    """What `make` returns, or what it returned before for the same name and `told`. The caller must not change it.

    name: of what is made. told: all that the result depends on; it is compared by its contents.
    """
    if not _made:
        return make()
    import pickle  # not loaded where nothing is remembered
    from hashlib import blake2b

    known = _made[-1].setdefault(name, {})
    key = blake2b(pickle.dumps(told, protocol=5)).digest()
    if key in known:
        result = known.pop(key)
    else:
        result = make()
    known[key] = result  # at the end: the result that has not been used for longest is the first to go
    if len(known) > MOST:
        del known[next(iter(known))]
    return result
