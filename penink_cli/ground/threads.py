"""Work shared among threads. The compiled loops let go of Python's lock, so plain threads are enough."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TypeVar

T = TypeVar("T")

_most: list[int | None] = [None]  # how many threads `count` says where it is given no number


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
    for _ in in_order(iter(tasks), threads, ahead=len(tasks)):
        pass


def ranges(work: Callable[[int, int], object], total: int, size: int) -> list[Callable[[], object]]:
    """Tasks `work(begin, end)` for pieces of 0 … total, each of at most the given size."""
    return [partial(work, k, min(k + size, total)) for k in range(0, total, size)]


def in_order(tasks: Iterator[Callable[[], T]], threads: int, ahead: int | None = None) -> Iterator[T]:
    """Results in the order of the tasks, computed by several threads, at most `ahead` of them waiting.

    The caller's own thread works too, so that two threads cost one start. Where the system lets no further thread start
    the others do its work. An exception of a task, or of the iterator of tasks, is raised here.
    """
    if threads <= 1:
        for task in tasks:
            yield task()
        return
    ahead = 2 * threads if ahead is None else ahead
    lock = threading.Condition()
    ready: dict[int, T] = {}
    failed: list[BaseException] = []
    taken = delivered = 0
    finished = False

    def take(*, wait: bool) -> tuple[int, Callable[[], T]] | None:
        nonlocal taken, finished
        with lock:
            while wait and not finished and taken - delivered >= ahead:
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
            return taken - 1, task

    def work(*, wait: bool) -> bool:
        nonlocal finished
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
                lock.notify_all()
            return False
        with lock:
            ready[number] = result
            lock.notify_all()
        return True

    def labour() -> None:
        while work(wait=True):
            pass

    others: list[threading.Thread] = []
    try:
        for _ in range(threads - 1):
            other = threading.Thread(target=labour, daemon=True)
            try:
                other.start()
            except RuntimeError:  # too many processes, or no memory for a stack
                break
            others.append(other)
        while True:
            while delivered not in ready and work(wait=False):
                pass
            with lock:
                while delivered not in ready and not failed and not (finished and delivered >= taken):
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
        for other in others:
            other.join()
