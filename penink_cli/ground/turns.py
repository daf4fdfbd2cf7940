"""Two things done at the same time that look as if the second had begun when the first had ended.

What the second has to say waits for the first one's end, and is never said where the first fails.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from contextvars import ContextVar
from typing import Any, TypeVar, cast

from penink_cli.ground import threads as threading

First = TypeVar("First")
Second = TypeVar("Second")

_waiting: ContextVar[list[Callable[[], object]] | None] = ContextVar("waiting", default=None)


def in_turn(say: Callable[[], object]) -> None:
    """Say something to the user: now, or when all that comes before has ended."""
    waiting = _waiting.get()
    if waiting is None:
        say()
    else:
        waiting.append(say)


def together(first: Callable[[], First], second: Callable[[], Second], threads: int) -> tuple[First, Second]:
    """What both make; by as many threads, one after the other where there is but one.

    An exception of the second is raised after the first has ended; if both raise one it is the first one's.
    """

    def held() -> tuple[Second | None, BaseException | None, list[Callable[[], object]]]:
        waiting: list[Callable[[], object]] = []
        before = _waiting.set(waiting)
        try:
            return second(), None, waiting
        except BaseException as error:
            return None, error, waiting
        finally:
            _waiting.reset(before)

    tasks: list[Callable[[], Any]] = [first, held]
    with closing(threading.in_order(iter(tasks), min(threads, 2))) as results:  # type: ignore[type-var]
        one = next(results)
        other, error, waiting = next(results)
    for say in waiting:
        in_turn(say)
    if error is not None:
        raise error
    return one, cast(Second, other)
