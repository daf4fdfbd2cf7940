"""Work shared among threads. The compiled loops let go of Python's lock, so plain threads are enough.

Where shared work shares work again no more threads begin than are not at work elsewhere: as many work at a time as were
asked for, however deep they are nested. A thread works within the context of who shares (Python's `contextvars`).
"""

from __future__ import annotations

import os
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import Context, copy_context
from functools import partial
from typing import TypeVar

T = TypeVar("T")

_most: list[int | None] = [None]  # how many threads `count` says where it is given no number
_working = 1  # threads that are at work now, the one that everything began in among them
_threads = _busy = 0  # threads that have been begun, and those of them that are at work
_change = threading.Condition()  # of all these


def count(threads: int | None) -> int:
    """How many threads to use: as many as asked for, else as `limit` says, else one a processor of this process."""
    if threads is not None:
        return max(1, threads)
    if _most[0] is not None:
        return _most[0]
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def limit(threads: int | None) -> int | None:
    """Set how many threads `count` says where it is given no number, None for one a processor; the former setting."""
    before, _most[0] = _most[0], threads
    return before


def share(tasks: Sequence[Callable[[], object]], threads: int) -> None:
    """Run every task once, each by the first thread that is free. An exception of a task is raised here."""
    if threads <= 1 or len(tasks) <= 1:
        for task in tasks:
            task()
        return
    for _ in in_order(iter(tasks), min(threads, len(tasks)), ahead=len(tasks)):
        pass


def ranges(work: Callable[[int, int], object], total: int, size: int) -> list[Callable[[], object]]:
    """Tasks `work(begin, end)` for pieces of 0 … total, each of at most the given size."""
    return [partial(work, k, min(k + size, total)) for k in range(0, total, size)]


def in_order(tasks: Iterator[Callable[[], T]], threads: int, ahead: int | None = None) -> Iterator[T]:
    """Results in the order of the tasks, computed by several threads, at most `ahead` of them waiting.

    The caller's own thread works too, and waits for tasks that others do and not for others that have not begun: where
    all processors are busy that may take longer than the work. Where the system lets no further thread start the others
    do its work. An exception of a task, or of the iterator of tasks, is raised here.
    """
    crew = _Crew(threads - 1)
    if not crew.called:
        for task in tasks:
            yield task()
        return
    ahead = 2 * threads if ahead is None else ahead
    lock = threading.Condition()
    ready: dict[int, T] = {}
    failed: list[BaseException] = []
    taken = delivered = doing = 0
    finished = False

    def take(*, wait: bool) -> tuple[int, Callable[[], T]] | None:
        nonlocal taken, finished, doing
        with lock:
            while wait and not finished and taken - delivered >= ahead:
                with _at_rest():
                    lock.wait()
            if finished or taken - delivered >= ahead:
                return None
            try:
                task = next(tasks)
            except StopIteration:
                finished = True
                lock.notify_all()
                return None
            except BaseException as error:
                failed.append(error)
                finished = True
                lock.notify_all()
                return None
            taken += 1
            doing += 1
            return taken - 1, task

    def work(*, wait: bool) -> bool:
        nonlocal finished, doing
        mine = take(wait=wait)
        if mine is None:
            return False
        number, task = mine
        try:
            result = task()
        except BaseException as error:
            with lock:
                failed.append(error)
                finished = True
                doing -= 1
                lock.notify_all()
            return False
        with lock:
            ready[number] = result
            doing -= 1
            lock.notify_all()
        return True

    def labour() -> None:
        while work(wait=True):
            pass

    try:
        crew.begin(labour)
        while True:
            while delivered not in ready and work(wait=False):
                pass
            with lock:
                while delivered not in ready and not failed and not (finished and delivered >= taken):
                    with _at_rest():
                        lock.wait()
                if failed:
                    raise failed[0]
                if delivered not in ready:
                    return
                result = ready.pop(delivered)
                delivered += 1
                lock.notify_all()
            yield result
    finally:
        with lock:
            finished = True
            lock.notify_all()
            with _at_rest():
                while doing:
                    lock.wait()
        crew.dismiss()


def at_once(*tasks: Callable[[], T], threads: int) -> list[T]:
    """The results of some tasks that have no part in each other, in their order."""
    return list(in_order(iter(tasks), min(threads, len(tasks)), ahead=len(tasks)))


@contextmanager
def meanwhile(work: Callable[[], T], threads: int) -> Iterator[Callable[[], T]]:
    """Let another thread do work while the block runs; what the block gets waits for the result, or raises.

    Where no other thread has begun it when it is asked for, it is done then and there.
    """
    crew = _Crew(min(threads, 2) - 1)
    lock = threading.Condition()
    results: list[T] = []
    failed: list[BaseException] = []
    begun = False

    def labour() -> None:
        nonlocal begun
        with lock:
            if begun:
                return
            begun = True
        try:
            results.append(work())
        except BaseException as error:
            failed.append(error)
        with lock:
            lock.notify_all()

    def done() -> bool:
        return bool(results or failed)

    def result() -> T:
        labour()
        with lock:
            while not done():
                with _at_rest():
                    lock.wait()
        if failed:
            raise failed[0]
        return results[0]

    crew.begin(labour)
    try:
        yield result
    finally:
        with lock:
            while begun and not done():
                with _at_rest():
                    lock.wait()
            begun = True
        crew.dismiss()


class _Crew:
    """Threads that help with some work: as many as are wanted, and no more than are not at work elsewhere.

    They are kept from one work to the next. To begin a thread takes as long as a band of a picture does.
    """

    def __init__(self, wanted: int):
        global _working  # noqa: PLW0603
        with _change:
            self.called = max(0, min(wanted, wanted + 1 - _working))
            _working += self.called

    def begin(self, labour: Callable[[], object]) -> None:
        """Let each of them labour, within the context of the caller, as soon as it can."""
        global _threads  # noqa: PLW0603
        with _change:
            _posts.extend((self, copy_context(), labour) for _ in range(self.called))
            _change.notify(self.called)
            while len(_posts) > _threads - _busy:
                try:
                    threading.Thread(target=_serve, daemon=True).start()
                except RuntimeError:  # too many processes, or no memory for a stack
                    break
                _threads += 1

    def dismiss(self) -> None:
        """Nothing is left to do for those who have not begun."""
        global _working  # noqa: PLW0603
        with _change:
            for post in [post for post in _posts if post[0] is self]:
                _posts.remove(post)
            _working -= self.called
            self.called = 0

    def leave(self) -> None:
        """One of them has ended."""
        global _working  # noqa: PLW0603
        if self.called:
            self.called -= 1
            _working -= 1


_posts: deque[tuple[_Crew, Context, Callable[[], object]]] = deque()


def _serve() -> None:
    while True:
        _labour()


def _labour() -> None:
    """Wait for work and do it; nothing of it is held on to afterwards."""
    global _busy  # noqa: PLW0603
    with _change:
        while not _posts:
            _change.wait()
        crew, context, labour = _posts.popleft()
        _busy += 1
    context.run(labour)
    with _change:
        crew.leave()
        _busy -= 1


@contextmanager
def _at_rest() -> Iterator[None]:
    """While the block runs this thread waits, and another may work."""
    global _working  # noqa: PLW0603
    with _change:
        _working -= 1
    try:
        yield
    finally:
        with _change:
            _working += 1
