"""Inputs and outputs within one process; what takes a process of its own is in tests/faults."""

from __future__ import annotations

import errno
import fcntl
import os
import socket
import stat
import threading
from pathlib import Path

import numpy as np
import pytest

from penink_cli.ground import changes, streams
from penink_cli.ground.errors import LimitError, StreamError
from penink_cli.ground.streams import inputs


def names(folder: Path) -> list[str]:
    return sorted(entry.name for entry in folder.iterdir())


def put(path: Path | str, *pieces: bytes) -> None:
    with streams.writing(str(path)) as out:
        for piece in pieces:
            out.write(piece)


@pytest.fixture(params=[b"", b"x", b"y" * 999_999], ids=["nothing", "one byte", "more than a buffer"])
def content(request):
    return request.param


def test_what_is_written_is_read(tmp_path, content):
    put(tmp_path / "a", content, b"end")
    with streams.reading(str(tmp_path / "a")) as stream:
        assert stream.read() == content + b"end"
    assert names(tmp_path) == ["a"]


def test_order_is_kept_between_small_and_large_pieces(tmp_path):
    pieces = [
        bytes([i % 256]) * size for i, size in enumerate([1, streams.BUFFER, 3, 2 * streams.BUFFER + 1, 0, 7] * 3)
    ]
    put(tmp_path / "a", *pieces)
    assert (tmp_path / "a").read_bytes() == b"".join(pieces)


def test_anything_that_is_bytes_is_written(tmp_path):
    array = np.arange(12, dtype=">u2").reshape(3, 4)
    with streams.writing(str(tmp_path / "a")) as out:
        for piece in (b"1", bytearray(b"2"), memoryview(b"3"), array, np.zeros((0, 4), np.uint8)):
            assert out.write(piece) == memoryview(piece).nbytes
    assert (tmp_path / "a").read_bytes() == b"123" + array.tobytes()


@pytest.mark.parametrize("mask", [0o022, 0o077, 0o002, 0o000])
def test_the_mode_is_that_of_any_new_file(tmp_path, mask):
    (tmp_path / "old").touch(0o600)
    before = os.umask(mask)
    try:
        put(tmp_path / "new", b"")
        put(tmp_path / "old", b"")
    finally:
        os.umask(before)
    for name in ("new", "old"):
        assert stat.S_IMODE((tmp_path / name).stat().st_mode) == 0o666 & ~mask


@pytest.mark.parametrize("old", [None, b"old"])
@pytest.mark.parametrize("failure", [ValueError, KeyboardInterrupt, StreamError])
def test_a_failure_leaves_what_was_there(tmp_path, old, failure):
    target = tmp_path / "a"
    if old is not None:
        target.write_bytes(old)
    with pytest.raises(failure), streams.writing(str(target)) as out:
        out.write(b"new" * streams.BUFFER)
        assert (target.read_bytes() if target.exists() else None) == old
        raise failure("stop")
    assert names(tmp_path) == (["a"] if old is not None else [])
    assert old is None or target.read_bytes() == old


@pytest.mark.parametrize("call", ["write", "fsync", "replace", "close"])
def test_a_failing_system_call_leaves_what_was_there(tmp_path, monkeypatch, call):
    target = tmp_path / "a"
    target.write_bytes(b"old")
    working = getattr(os, call)

    def fails(*arguments, **options):
        if call == "close":
            working(*arguments)
            monkeypatch.setattr(os, "close", working)
        raise OSError(errno.ENOSPC, "full")

    with pytest.raises(StreamError, match=r"a: cannot be written: No space left on device"):  # noqa: SIM117
        with streams.writing(str(target)) as out:
            out.write(b"new" * streams.BUFFER)
            monkeypatch.setattr(os, call, fails)
            out.write(b"and more")
    monkeypatch.undo()
    assert names(tmp_path) == ["a"]
    assert target.read_bytes() == b"old" or call == "close"  # the rename has been made by then


def test_links_are_followed(tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "link").symlink_to("folder/target")
    put(tmp_path / "link", b"1")  # the target does not exist yet
    assert (tmp_path / "link").is_symlink() and (tmp_path / "folder/target").read_bytes() == b"1"
    put(tmp_path / "link", b"2")
    assert (tmp_path / "link").is_symlink() and (tmp_path / "folder/target").read_bytes() == b"2"
    assert names(tmp_path) == ["folder", "link"] and names(tmp_path / "folder") == ["target"]


def test_a_fifo_is_written_straight(tmp_path):
    os.mkfifo(tmp_path / "f")
    got = []
    reader = threading.Thread(target=lambda: got.append((tmp_path / "f").read_bytes()))
    reader.start()
    put(tmp_path / "f", b"x" * 300_000)
    reader.join()
    assert got == [b"x" * 300_000] and stat.S_ISFIFO((tmp_path / "f").stat().st_mode) and names(tmp_path) == ["f"]


def test_devices_are_written_straight():
    for device in ("/dev/null", "/dev/zero"):
        put(device, b"x")
        assert stat.S_ISCHR(os.stat(device).st_mode)
    with pytest.raises(StreamError, match=r"^/dev/full: cannot be written: No space left on device$"):
        put("/dev/full", b"x")


@pytest.mark.parametrize("failure", [ValueError("stop"), LimitError("too many", "in.pgm"), OSError("else")])
@pytest.mark.parametrize("where", ["file", "device", "bench"])
def test_a_failure_of_the_writer_is_told_in_its_own_words_wherever_it_writes(tmp_path, where, failure):
    target = {"file": str(tmp_path / "a"), "device": "/dev/null", "bench": "b"}[where]
    with streams.workbench({"b": b""}), pytest.raises(type(failure)) as caught, streams.writing(target):
        raise failure
    assert caught.value is failure


def test_an_input_that_is_there_and_cannot_be_opened_is_noted_as_it_is(tmp_path):
    """Who watches it would else take it for a file that has come into being, again and again."""
    path = str(tmp_path / "socket")
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind(path)
        with changes.noting() as read, pytest.raises(StreamError), streams.reading(path):
            pass
        assert read == {path: changes.of_file(path)} and read[path] is not None


@pytest.mark.parametrize("name", ["/dev/fd/%d", "/proc/self/fd/%d"])
def test_a_descriptor_by_its_name_is_that_descriptor(tmp_path, name):
    with open(tmp_path / "a", "wb") as file:
        file.write(b"before ")
        file.flush()
        put(name % file.fileno(), b"after")
    assert (tmp_path / "a").read_bytes() == b"before after" and names(tmp_path) == ["a"]


@pytest.mark.parametrize(
    ("path", "complaint"),
    [
        ("", "No such file or directory"),
        ("missing/a", "No such file or directory"),
        ("folder", "Is a directory"),
        ("folder/", "Is a directory"),
        ("new/", "Is a directory"),
        ("file/a", "Not a directory"),
        ("loop", "Too many levels of symbolic links"),
        ("n" * 256, "File name too long"),
        ("a\0b", "null"),
    ],
)
def test_outputs_that_cannot_be(tmp_path, monkeypatch, path, complaint):
    monkeypatch.chdir(tmp_path)
    Path("folder").mkdir()
    Path("file").touch()
    Path("loop").symlink_to("loop")
    with pytest.raises(StreamError, match=complaint):
        put(path, b"x")
    assert names(tmp_path) == ["file", "folder", "loop"]


@pytest.mark.parametrize(
    ("path", "complaint"),
    [("", "No such file"), ("missing", "missing: No such file"), (".", r"\.: .*Is a directory"), ("a\0b", "null")],
)
def test_inputs_that_cannot_be(tmp_path, monkeypatch, path, complaint):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(StreamError, match=complaint), streams.reading(path) as stream:
        stream.read(1)


def test_the_longest_name_there_can_be(tmp_path):
    put(tmp_path / ("n" * 255), b"x")
    assert names(tmp_path) == ["n" * 255]


def orphan(folder: Path, name: str = ".penink-0123456789abcdef.tmp") -> Path:
    path = folder / name
    path.write_bytes(b"half")
    return path


def test_what_a_killed_run_left_is_swept(tmp_path):
    orphan(tmp_path)
    put(tmp_path / "a", b"x")
    assert names(tmp_path) == ["a"]


def test_what_a_neighbour_is_writing_is_not_swept(tmp_path):
    held = orphan(tmp_path)
    with held.open("rb") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        put(tmp_path / "a", b"x")
        assert names(tmp_path) == [held.name, "a"]
    with streams.writing(str(tmp_path / "b")):
        put(tmp_path / "a", b"x")
    assert names(tmp_path) == ["a", "b"]


@pytest.mark.parametrize(
    "name", [".penink-0123.tmp", ".penink-0123456789abcdef.tmp.pgm", "penink-0123456789abcdef.tmp"]
)
def test_nothing_else_is_swept(tmp_path, name):
    orphan(tmp_path, name)
    put(tmp_path / "a", b"x")
    assert name in names(tmp_path)


def test_links_and_folders_named_like_leftovers_are_no_leftovers(tmp_path):
    (tmp_path / "precious").write_bytes(b"x")
    (tmp_path / ".penink-0123456789abcdef.tmp").symlink_to("precious")
    (tmp_path / ".penink-1123456789abcdef.tmp").mkdir()
    os.mkfifo(tmp_path / ".penink-2123456789abcdef.tmp")
    put(tmp_path / "a", b"x")
    assert len(names(tmp_path)) == 5


def test_a_file_taken_for_an_orphan_between_its_creation_and_its_lock_is_made_anew(tmp_path, monkeypatch):
    working, swept = fcntl.flock, []

    def neighbour_first(descriptor: int, operation: int) -> None:
        if not swept:
            swept.append(names(tmp_path)[0])
            (tmp_path / swept[0]).unlink()
        working(descriptor, operation)

    monkeypatch.setattr(fcntl, "flock", neighbour_first)
    put(tmp_path / "a", b"x")
    assert swept and names(tmp_path) == ["a"] and (tmp_path / "a").read_bytes() == b"x"


def test_binary_output_is_refused_on_a_terminal_and_text_is_not():
    ours, theirs = os.openpty()
    try:
        terminal = os.ttyname(theirs)
        with pytest.raises(StreamError, match="not written to a terminal"):
            put(terminal, b"P5")
        with streams.writing(terminal, binary=False) as out:
            out.write(b"text")
        assert os.read(ours, 4) == b"text"
    finally:
        os.close(ours)
        os.close(theirs)


def test_a_slow_non_blocking_pipe_gets_everything(monkeypatch):
    reading, writing = os.pipe()
    os.set_blocking(writing, False)
    got = []

    def read():
        while piece := os.read(reading, 5000):
            got.append(piece)

    reader = threading.Thread(target=read)
    reader.start()
    put(f"/dev/fd/{writing}", b"0123456789" * 100_000)
    os.close(writing)
    reader.join()
    os.close(reading)
    assert b"".join(got) == b"0123456789" * 100_000


def test_a_slow_non_blocking_input_is_read_to_its_end():
    reading, writing = os.pipe()
    os.set_blocking(reading, False)
    writer = threading.Thread(target=lambda: (os.write(writing, b"0123456789" * 50_000), os.close(writing)))
    raw = inputs._Source(reading, "x", owned=True)
    writer.start()
    found = b""
    while piece := raw.read(100_000):
        found += piece
    writer.join()
    raw.close()
    assert found == b"0123456789" * 50_000


def test_what_lies_on_the_workbench_is_in_no_file(tmp_path, monkeypatch, content):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a").write_bytes(b"a file")
    with streams.workbench({"a": b""}):
        put("a", content, b"end")
        put("b", b"a file too")
        with streams.reading("a") as stream:
            assert stream.read() == content + b"end"
        with pytest.raises(RuntimeError), streams.writing("a"):
            raise RuntimeError
        assert streams.on_bench("a") and not streams.on_bench("b")
    with streams.reading("a") as stream:
        assert stream.read() == b"a file" and not streams.on_bench("a")
    assert names(tmp_path) == ["a", "b"]
