"""What several filters of one process read from the same file is decoded once.

A photograph is remembered by its path as long as its file has not changed; the edges and the lines last read from the
workbench by their text.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar

from penink_cli.ground import changes, streams

if TYPE_CHECKING:
    from penink_cli.ground.model import ColourImage, GreyImage

T = TypeVar("T")

_photos: dict[str | None, tuple[changes.State, ColourImage | GreyImage]] | None = None  # by path, None standard input
_last: dict[str, tuple[changes.State, Any]] = {}  # by kind: the text on the workbench, and what was read from it


@contextmanager
def remembering_inputs() -> Iterator[None]:
    """While the block runs, photographs are remembered; afterwards nothing is."""
    global _photos  # noqa: PLW0603
    before, _photos = _photos, {}
    try:
        yield
    finally:
        _photos = before
        _last.clear()


def known_photo(path: str | None) -> ColourImage | GreyImage | None:
    """The photograph of that path if it is remembered and its file has not changed."""
    state, found = (_photos or {}).get(None if path == "-" else path, (None, None))
    if found is None or state != streams.state(path):
        return None
    if path is not None and path != "-":
        changes.note(path, state)
    return found


def photo(path: str | None, read: Callable[[], ColourImage | GreyImage]) -> ColourImage | GreyImage:
    """The photograph that is remembered of that path, or what `read` reads, which is remembered from then on."""
    known = known_photo(path)
    if known is not None:
        return known
    state = streams.state(path)
    found = read()
    if _photos is not None:
        _photos[None if path == "-" else path] = state, found
    return found


def once(kind: str, path: str, read: Callable[[], T]) -> T:
    """What `read` reads from a file, or what was read before from the same text on the workbench.

    kind: names what is read; of each kind the last one is remembered.
    """
    text = streams.state(path) if streams.on_bench(path) else None
    if text is None:
        return read()
    if kind in _last and _last[kind][0] == text:
        changes.note(path, text)
        return _last[kind][1]
    found = read()
    _last[kind] = text, found
    return found
