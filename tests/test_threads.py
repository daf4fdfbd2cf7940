"""Work shared among threads: order, exceptions, and what is done where no further thread can be started."""

from __future__ import annotations

import threading
from functools import partial

import pytest

from penink_cli.ground import threads


def squares(count):
    return (partial(pow, k, 2) for k in range(count))


@pytest.mark.parametrize("count", [1, 2, 5])
def test_results_come_in_the_order_of_the_tasks(count):
    assert list(threads.in_order(squares(200), count)) == [k * k for k in range(200)]


@pytest.mark.parametrize("count", [1, 2, 5])
@pytest.mark.parametrize("at", [0, 7, 199])
def test_an_exception_of_a_task_is_raised(count, at):
    with pytest.raises(ZeroDivisionError):
        list(threads.in_order((partial(divmod, 1, k - at) for k in range(200)), count))


@pytest.mark.parametrize("count", [1, 2, 5])
@pytest.mark.parametrize("at", [0, 7, 199])
def test_an_exception_of_what_makes_the_tasks_is_raised_and_no_result_is_missing(count, at, monkeypatch):
    said = []
    monkeypatch.setattr(threading, "excepthook", said.append)

    def tasks():
        yield from squares(at)
        raise MemoryError

    found = []
    with pytest.raises(MemoryError):
        for result in threads.in_order(tasks(), count):
            found.append(result)
    assert found == [k * k for k in range(len(found))] and not said


@pytest.mark.parametrize("least", [0, 1, 3])
def test_where_no_further_thread_can_be_started_the_others_do_its_work(least, monkeypatch):
    start, started = threading.Thread.start, []

    def refused(self):
        if len(started) >= least:
            raise RuntimeError("can't start new thread")
        started.append(self)
        start(self)

    monkeypatch.setattr(threading.Thread, "start", refused)
    wanted = threads._threads + 8  # those of earlier tests are kept
    assert list(threads.in_order(squares(50), wanted)) == [k * k for k in range(50)]
    assert len(started) == least


def test_threads_are_as_many_as_told():
    before = threads.limit(3)
    try:
        assert (threads.count(None), threads.count(2), threads.count(0)) == (3, 2, 1)
        assert threads.limit(None) == 3 and threads.count(None) >= 1
    finally:
        threads.limit(before)
