"""Work shared among threads: as many at a time as were asked for, and all told as if one thing came after the other."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from contextvars import ContextVar
from typing import Any

import pytest

from penink_cli.ground import changes, threads
from penink_cli.ground.turns import in_turn, together

LONG = 30  # seconds after which a test that waits for another thread fails


class AtOnce:
    """How many run at a time, at the most."""

    def __init__(self) -> None:
        self.lock, self.now, self.most = threading.Lock(), 0, 0

    def work(self, *_: object) -> None:
        with self.lock:
            self.now += 1
            self.most = max(self.most, self.now)
        time.sleep(0.002)
        with self.lock:
            self.now -= 1


def test_shared_work_within_shared_work_takes_no_more_threads():
    seen = AtOnce()

    def nested() -> None:
        threads.share(threads.ranges(seen.work, 40, 1), 3)

    threads.share([nested] * 5, 3)
    assert seen.most == 3


def test_a_thread_that_waits_lets_another_work():
    """The second goes on with two threads as soon as the first has nothing left to do but to wait for it."""
    seen, ended = AtOnce(), threading.Event()

    def second() -> None:
        assert ended.wait(LONG)
        for _ in range(LONG * 100):
            threads.share(threads.ranges(seen.work, 4, 1), 2)
            if seen.most == 2:
                return

    together(ended.set, second, 2)
    assert seen.most == 2


def test_nobody_waits_for_a_thread_that_gets_no_processor(monkeypatch):
    """Who has the work does it alone, and is done."""
    monkeypatch.setattr(threads, "_threads", 0)
    monkeypatch.setattr(threading.Thread, "start", lambda self: None)
    done: list[int] = []
    for _ in range(3):
        threads.share([lambda: done.append(1)] * 4, 4)
    assert len(done) == 12 and threads._working == 1


def test_threads_are_kept_and_work_in_the_context_of_who_shares(monkeypatch):
    started, named = [], ContextVar("named", default="nobody")
    start = threading.Thread.start
    monkeypatch.setattr(threading.Thread, "start", lambda self: (started.append(self), start(self)))
    meet = threading.Barrier(3)

    def told() -> str:
        meet.wait(LONG)
        return named.get()

    for name in ("one", "two", "three"):
        named.set(name)
        assert list(threads.in_order(iter([told] * 3), 3)) == [name] * 3
    assert len(started) <= 2


def test_an_exception_leaves_all_threads_free():
    def fail() -> None:
        raise ValueError

    for _ in range(5):
        with pytest.raises(ValueError):
            threads.share([fail] * 8, 4)
    assert threads._working == 1 and not threads._posts
    for _ in threads.in_order(iter([int] * 9), 4):
        break  # and so does one who wants no more
    assert threads._working == 1 and not threads._posts


@pytest.mark.parametrize("count", [1, 2])
def test_what_is_said_is_said_in_turn(count):
    said: list[str] = []
    second_spoke = threading.Event()

    def first() -> int:
        if count > 1:
            assert second_spoke.wait(LONG), "they are to run at the same time"
        in_turn(lambda: said.append("first"))
        return 1

    def inner(name: str) -> Callable[[], None]:
        return lambda: in_turn(lambda: said.append(name))

    def second() -> str:
        in_turn(lambda: said.append("second"))
        together(inner("third"), inner("fourth"), count)
        second_spoke.set()
        return "2"

    assert together(first, second, count) == (1, "2")
    assert said == ["first", "second", "third", "fourth"]


@pytest.mark.parametrize("count", [1, 2])
def test_the_first_one_to_fail_is_the_first_one(count):
    """Also where the second fails before it; then nothing that the second had to say is said."""
    said: list[str] = []
    failed = threading.Event()

    def fail(error: Exception) -> None:
        in_turn(lambda: said.append(str(error)))
        failed.set()
        raise error

    def late() -> None:
        if count > 1:
            assert failed.wait(LONG)
        fail(KeyError("first"))

    with pytest.raises(KeyError):
        together(late, lambda: fail(ValueError("second")), count)
    assert said == ["'first'"]
    said.clear()
    with pytest.raises(ValueError):
        together(lambda: in_turn(lambda: said.append("first")), lambda: fail(ValueError("second")), count)
    assert said == ["first", "second"]


def test_each_notes_what_it_opens_itself():
    opened = [threading.Event(), threading.Event()]

    def open_one(k: int) -> dict[str, Any]:
        with changes.noting() as read:
            changes.note(f"file {k}", None)
            opened[k].set()
            assert opened[1 - k].wait(LONG)
            changes.note(f"other {k}", None)
        return read

    with changes.noting() as all_read:
        found = together(lambda: open_one(0), lambda: open_one(1), 2)
    assert found == ({"file 0": None, "other 0": None}, {"file 1": None, "other 1": None})
    assert set(all_read) == {"file 0", "other 0", "file 1", "other 1"}
