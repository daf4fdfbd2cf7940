"""What is made of the same things twice, made once: while a drawing follows its files.

`chain.kept` remembers what whole filters have made. In one that runs again most does not depend on what has changed:
of a drawing with another pen the field is read alike, and telling lines and solid black lie where they lay.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

T = TypeVar("T")

#: Results of one name that are remembered: as many as a drawing has plates.
MOST = 8

_made: list[dict[str, dict[bytes, Any]]] = []


@contextmanager
def remembering() -> Iterator[None]:
    """While the block runs, `recalled` remembers."""
    _made.append({})
    try:
        yield
    finally:
        _made.pop()


def recalled(name: str, told: tuple[Any, ...], make: Callable[[], T]) -> T:
    """What `make` makes of what it is told, or has made of the same: nobody may change it.

    name: of what is made. told: all that the result depends on, told by its contents.
    """
    if not _made:
        return make()
    import pickle  # a drawing that follows nothing does without
    from hashlib import blake2b

    known = _made[-1].setdefault(name, {})
    key = blake2b(pickle.dumps(told, protocol=5)).digest()
    if key in known:
        result = known.pop(key)
    else:
        result = make()
    known[key] = result  # the last one used is the last one to go
    if len(known) > MOST:
        del known[next(iter(known))]
    return result
