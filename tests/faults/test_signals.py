"""Runs that are told to stop, or killed, at any moment: the old file or the new one, and nothing besides."""

from __future__ import annotations

import contextlib
import os
import random
import select
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.conftest import environment
from tests.faults.calls import CALLS, arguments

NAMES = list(CALLS)
STOPS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


@pytest.mark.parametrize("number", [*STOPS, signal.SIGKILL], ids=lambda number: number.name)
def test_stopped_at_any_moment(number, server, inputs, tmp_path):
    """Every subcommand, at moments spread over its run. A forked run has no start-up to be stopped in."""
    chance = random.Random(8)
    stopped = 0
    for name in NAMES:
        out = tmp_path / name
        begun = time.monotonic()
        new = server.run(*arguments(name, inputs)).out
        took = time.monotonic() - begun
        for _ in range(6):
            out.write_bytes(b"old")
            done = server.run(*arguments(name, inputs), "-o", out, kill=(number, chance.uniform(0, took)))
            assert (done.status, done.out, done.err) in ((0, b"", b""), (-number, b"", b""))
            assert out.read_bytes() in (b"old", new)
            stopped += done.status != 0
            if number != signal.SIGKILL:
                assert os.listdir(tmp_path) == [name]
        out.unlink()
        assert server.run(*arguments(name, inputs), "-o", out).status == 0
        assert os.listdir(tmp_path) == [name]  # what the killed ones left is swept by the next run
        out.unlink()
    assert stopped > len(NAMES), "the moments were too late to stop anything"


@pytest.mark.parametrize("number", STOPS, ids=lambda number: number.name)
def test_stopped_while_it_waits_for_input(number, inputs, tmp_path):
    """A whole process, in the middle of a raster that never ends: it dies of the signal without a word."""
    reading, writing = os.pipe()
    command = [sys.executable, "-m", "penink_cli", *arguments("reduce", inputs, by_name=False), "-o", f"{tmp_path}/out"]
    process = subprocess.Popen(command, env=environment(), stdin=reading, stderr=subprocess.PIPE)
    os.close(reading)
    os.set_blocking(writing, False)
    os.write(writing, b"P5 9999 9999 255\n")
    with contextlib.suppress(BlockingIOError):
        while True:
            os.write(writing, bytes(1 << 16))
    assert select.select([], [writing], [], 60)[1]  # there is room again: it is reading
    process.send_signal(number)
    try:
        _, err = process.communicate(timeout=60)
    finally:
        process.kill()
        os.close(writing)
    assert (process.returncode, err) == (-number, b"") and os.listdir(tmp_path) == []


def test_ctrl_c_while_it_still_imports():
    """From the first line of ours on, it kills without a traceback, also where no thread can be had to wait for it."""
    script = "import signal, penink_cli.__main__; signal.raise_signal(signal.SIGINT)"
    done = subprocess.run([sys.executable, "-c", script], env=environment(), capture_output=True, check=False)
    assert (done.returncode, done.stderr) == (-signal.SIGINT, b"")
    script = (
        "import signal, threading, penink_cli.__main__ as m\n"
        "def start(thread): raise RuntimeError\n"
        "threading.Thread.start = start; m.streams.install_signals(); signal.raise_signal(signal.SIGTERM)"
    )
    done = subprocess.run([sys.executable, "-c", script], env=environment(), capture_output=True, check=False)
    assert (done.returncode, done.stderr) == (-signal.SIGTERM, b"")


def test_stopped_between_the_last_byte_and_the_rename(tmp_path):
    """The temporary file is gone already and the process not yet dead: it says nothing of a file that is missing."""
    script = """if True:
        import os, signal, sys, threading, penink_cli.__main__ as m
        from penink_cli.ground.streams import signals, temporary

        class Guard:
            lock, removed, waits = threading.Lock(), threading.Event(), threading.Event()
            def acquire(self):
                self.lock.acquire()
            def __enter__(self):
                if self.removed.is_set():
                    self.waits.set()
                self.lock.acquire()
            def __exit__(self, *_):
                self.lock.release()

        def dying(number, die=signals.die_of):
            guard.removed.set()
            guard.waits.wait()
            die(number)

        temporary._guard = guard = Guard()
        signals.die_of = dying
        m.streams.install_signals()
        with m.streams.writing(sys.argv[1]) as out:
            out.write(b"new")
            os.kill(os.getpid(), signal.SIGTERM)
            guard.removed.wait()
    """
    out = tmp_path / "out"
    out.write_bytes(b"old")
    command = [sys.executable, "-c", script, str(out)]
    done = subprocess.run(command, env=environment(), capture_output=True, check=False)
    assert (done.returncode, done.stderr) == (-signal.SIGTERM, b"")
    assert out.read_bytes() == b"old" and os.listdir(tmp_path) == ["out"]


def test_a_signal_that_the_caller_ignores_is_ignored(server, inputs, tmp_path):
    """As under nohup, or for a job in the background of a script."""
    for number in (signal.SIGINT, signal.SIGHUP):
        for delay in (0.001, 0.01, 0.02):
            words = arguments("blast", inputs)
            done = server.run(*words, "-o", tmp_path / "out", ignore=(number,), kill=(number, delay))
            assert (done.status, done.err) == (0, b"")


def test_eight_writers_to_one_path(inputs, tmp_path):
    """Whoever is last, the file is one of theirs and whole, and nothing is left beside it."""
    expected = set()
    processes = []
    for i in range(8):
        command = [sys.executable, "-m", "penink_cli", *arguments("reduce", inputs), "--factor", str(1 + i % 4)]
        if i < 4:
            expected.add(subprocess.run(command, env=environment(), capture_output=True, check=True).stdout)
        processes.append(subprocess.Popen([*command, "-o", str(tmp_path / "out")], env=environment()))
    assert [process.wait() for process in processes] == [0] * 8
    assert (tmp_path / "out").read_bytes() in expected and len(expected) == 4
    assert os.listdir(tmp_path) == ["out"]


def test_a_tool_of_the_shell_stops_it(inputs):
    """The real pipe: head takes what it wants and the filter dies in silence."""
    script = '"$@" | head -c 10; echo "${PIPESTATUS[*]}"'
    for prefix in ("", "trap '' PIPE; "):
        command = ["bash", "-c", prefix + script, "-", sys.executable, "-m", "penink_cli"]
        done = subprocess.run(
            [*command, *arguments("enlarge", inputs), "--scale", "20"],
            env=environment(),
            capture_output=True,
            check=False,
        )
        assert done.stdout.startswith(b"P5\n480 360") and done.stdout.endswith(b"141 0\n") and not done.stderr


def test_descriptors_closed_from_the_start(inputs, tmp_path: Path):
    """`<&-`, `>&-`, `2>&-`: never another file in their place, never silence where something was lost."""

    def run(closed: str, *words: str) -> subprocess.CompletedProcess[bytes]:
        script = f'exec {closed}; exec "$@"'
        command = ["sh", "-c", script, "-", sys.executable, "-m", "penink_cli", *words]
        return subprocess.run(command, env=environment(), capture_output=True, check=False)

    out = str(tmp_path / "out")
    words = arguments("reduce", inputs)
    good = run("2>&-", *words).stdout
    assert good
    done = run("<&-", *arguments("reduce", inputs, by_name=False))  # its edge list must not become its standard input
    assert (done.returncode, done.stdout) == (1, b"")
    assert done.stderr == b"penink reduce: <stdin>: standard input is closed\n"
    done = run(">&-", *words)
    assert done.returncode == 1 and done.stderr == b"penink reduce: <stdout>: standard output is closed\n"
    done = run(">&-", "--help")
    assert done.returncode == 1 and b"cannot be written" in done.stderr
    done = run("2>&-", "reduce", "/nowhere", *words[1:-1])
    assert (done.returncode, done.stdout) == (1, b"")
    for closed in ("<&-", ">&-", "2>&-", "<&- >&-", "<&- >&- 2>&-"):
        done = run(closed, *words, "-o", out)
        assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")
        assert Path(out).read_bytes() == good and os.listdir(tmp_path) == ["out"]
        Path(out).unlink()
