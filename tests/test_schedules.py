"""Threads may take tasks in any order, and be ahead of who uses the results: the bytes are the same.

Real threads show such a fault once in many runs. Here they are none: every order that is tried is played by one thread.
"""

from __future__ import annotations

import hashlib
import random
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest
import skimage.data
from PIL import Image

from penink_cli.arrangement.detection import detect_edges
from penink_cli.ground import threads
from penink_cli.main import penink

Order = Callable[[int], list[int]]


def shuffled(count: int) -> list[int]:
    numbers = list(range(count))
    random.Random(count).shuffle(numbers)
    return numbers


ORDERS: dict[str, Order | None] = {
    "one at a time, used before the next": None,
    "all before any is used": lambda count: list(range(count)),
    "all, the last first": lambda count: list(range(count))[::-1],
    "all, in a random order": shuffled,
}


def play(monkeypatch: pytest.MonkeyPatch, order: Order | None) -> None:
    """Let what is shared among three threads be done in that order."""

    def in_order(tasks: Iterator[Callable[[], Any]], count: int, ahead: int | None = None) -> Iterator[Any]:
        if order is None:
            yield from (task() for task in tasks)
            return
        waiting = list(tasks)
        done = {number: waiting[number]() for number in order(len(waiting))}
        yield from (done[number] for number in range(len(waiting)))

    @contextmanager
    def meanwhile(work: Callable[[], Any], count: int) -> Iterator[Callable[[], Any]]:
        if order is None:
            with one_thread(work, 1) as result:
                yield result
            return
        done = work()
        yield lambda: done

    one_thread = threads.meanwhile
    monkeypatch.setattr(threads, "in_order", in_order)
    monkeypatch.setattr(threads, "meanwhile", meanwhile)
    monkeypatch.setattr(threads, "count", lambda asked: 3)


def busy(width: int, height: int) -> np.ndarray[Any, Any]:
    """A picture (h, w, 3) of crossing bars and discs with a camera's grain and blur: edges and junctions everywhere."""
    y, x = np.mgrid[: 2 * height, : 2 * width] / 2.0
    rng = np.random.default_rng(5)
    picture = np.full((2 * height, 2 * width, 3), 0.8) - 0.3 * (x / width)[..., None]
    for k in range(90):
        colour, angle = rng.uniform(0, 1, 3), rng.uniform(0, np.pi)
        u, v, size = rng.uniform(0, width), rng.uniform(0, height), rng.uniform(3, 25)
        right, down, (sine, cosine) = x - u, y - v, (np.sin(angle), np.cos(angle))
        bar = (np.abs(right * cosine + down * sine) < 3 * size) & (np.abs(down * cosine - right * sine) < size / 3)
        inside = np.hypot(right, down) < size if k % 3 == 0 else bar
        picture[inside] = colour
    small = picture.reshape(height, 2, width, 2, 3).mean(axis=(1, 3))
    return np.clip(255 * (small + rng.normal(0, 0.01, small.shape)), 0, 255).astype(np.uint8)


@pytest.mark.parametrize(
    "options",
    [
        ["--style", "house", "--as", "ps"],
        ["--style", "true", "--as", "jsonl"],
        ["--style", "engraving", "--as", "svg"],
        ["--style", "fur", "--as", "png"],
        ["--as", "penink"],
        ["--inks", "cmyk", "--width", "2in", "--as", "pdf"],
    ],
    ids=" ".join,
)
def test_any_order_of_the_threads_draws_the_same(monkeypatch, tmp_path, options):
    photo = tmp_path / "busy.png"
    Image.fromarray(busy(420, 300)).save(photo)
    found = {}
    for name, order in ORDERS.items():
        with monkeypatch.context() as patch:
            play(patch, order)
            output = tmp_path / "drawing"
            penink.main(["draw", str(photo), "--width", "3in", *options, "-o", str(output)], standalone_mode=False)
            found[name] = hashlib.sha256(output.read_bytes()).hexdigest()
    assert len(set(found.values())) == 1, found


def test_any_order_of_the_threads_finds_the_same_edges(monkeypatch):
    """In gravel a junction's change reached into the view of another that shares no edge with it."""
    grey, found = skimage.data.gravel() / 255, set()
    for order in ORDERS.values():
        with monkeypatch.context() as patch:
            play(patch, order)
            edges = detect_edges(grey, high=0.1)
            found.add((edges.vertices.tobytes(), edges.edges.tobytes()))
    assert len(found) == 1


@pytest.mark.parametrize("count", [1, 2])
def test_what_is_done_meanwhile_is_done_once_and_its_error_is_raised_where_it_is_asked_for(count):
    done = []

    def work():
        done.append(1)
        return 7

    with threads.meanwhile(work, count) as result:
        assert (result(), result()) == (7, 7)
    assert done == [1]
    with threads.meanwhile(lambda: done.append(2), count):
        pass
    assert done in ([[1]] if count == 1 else [[1], [1, 2]])  # what has begun has ended with the block
    with threads.meanwhile(lambda: 1 // 0, count):
        pass
    with pytest.raises(ZeroDivisionError), threads.meanwhile(lambda: 1 // 0, count) as result:
        result()
